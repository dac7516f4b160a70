#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Topics, services and the master listen on the loopback address alone. The exception is the
XML-RPC server of each C++ node: it listens on all addresses, whatever ROS_IP is
(docs/security.md)."""
import os
import pathlib
import sys
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch  # noqa: E402

START_LIMIT_S = 60
LISTENING = "0A"
LOOPBACK = {"0100007F", "00000000000000000000000001000000"}  # as in /proc/net/tcp and tcp6


def processes_of(ranch):
    """Process ids of a launch, by the address of their master or their command line."""
    address = ranch.environment["ROS_MASTER_URI"].encode()
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            if address in (entry / "environ").read_bytes():
                yield entry
        except OSError:
            continue  # ended, or of another user


def listeners(processes):
    """(process, program, address, port) of each TCP socket on which a process waits for connections."""
    found = set()
    for process in processes:
        try:
            sockets = {os.readlink(link) for link in (process / "fd").iterdir()}
            name = (process / "comm").read_text().strip()
            for table in ("tcp", "tcp6"):
                for line in (process / "net" / table).read_text().splitlines()[1:]:
                    fields = line.split()
                    if fields[3] == LISTENING and f"socket:[{fields[9]}]" in sockets:
                        found.add((process.name, name, *fields[1].split(":")))
        except OSError:
            continue
    return found


class SocketsTest(unittest.TestCase):

    def test_only_the_xmlrpc_server_of_a_node_listens_beyond_the_loopback_address(self):
        with Ranch("sim", "headless:=true", "policy:=random") as ranch:
            wanted = {"sim_node", "policy_node", "viz_node", "rosmaster", "roslaunch"}

            def all_listen():
                found = listeners(processes_of(ranch))
                return found if wanted <= {one[1] for one in found} else None

            found = ranch.wait_for(all_listen, START_LIMIT_S)
        beyond = [one for one in found if one[2] not in LOOPBACK]
        self.assertEqual(set(), {"rosmaster", "roslaunch"} & {one[1] for one in beyond}, beyond)
        for process in {one[0] for one in beyond}:
            self.assertEqual(1, sum(one[0] == process for one in beyond), beyond)
            self.assertTrue(any(one[0] == process and one[2] in LOOPBACK for one in found), found)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "sockets", SocketsTest, sys.argv)
