# SPDX-License-Identifier: BSD-3-Clause
"""Helpers for the tests of the agents' nodes: programs that are started, watched and ended."""
import contextlib
import ipaddress
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import time
import unittest

LIMIT_S = 60.0
DATA = pathlib.Path(__file__).resolve().parent / "data"
PORTS = range(20000, 32768)  # ip_local_port_range begins at 32768 (ip(7))


def program(package, name):
    """Path of an executable of a package."""
    import roslib.packages  # only here: tools/campaigns import this module also without ROS

    found = roslib.packages.find_node(package, name)
    assert found, f"{package} has no {name}"
    return found[0]


class Program:
    """A running program whose output goes to a file; killed at the end of the test."""

    def __init__(self, test, *command):
        self._file = tempfile.NamedTemporaryFile("w+", prefix="aquafarm_", suffix=".log")
        self.process = subprocess.Popen([str(word) for word in command], stdout=self._file,
                                        stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        test.addCleanup(self.kill)

    def words(self):
        """Complete output so far."""
        return pathlib.Path(self._file.name).read_text()

    def code(self, limit_s=LIMIT_S):
        """Waits for the program to end and returns its exit code."""
        try:
            return self.process.wait(timeout=limit_s)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"did not end within {limit_s} s:\n{self.words()}") from None

    def send(self, number):
        """Sends a signal."""
        self.process.send_signal(number)

    def interrupt(self, limit_s=LIMIT_S):
        """Ends the program and its child processes like Ctrl-C."""
        if self.process.poll() is None:
            self.send(signal.SIGINT)
            self.code(limit_s)

    def kill(self):
        """Kills the program, also when it is suspended."""
        if self.process.poll() is None:
            self.send(signal.SIGKILL)
        self.process.wait()

    def wait_for(self, condition, what, limit_s=LIMIT_S):
        """Waits until a condition holds while the program runs."""
        end = time.monotonic() + limit_s
        while not condition():
            assert self.process.poll() is None, f"ended before {what}:\n{self.words()}"
            assert time.monotonic() < end, f"timed out waiting for {what}:\n{self.words()}"
            time.sleep(0.02)


def free_port():
    """Returns an unused port below the range from which Linux assigns ports to nodes."""
    for port in random.SystemRandom().sample(PORTS, 100):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("", port))
            return port
    raise AssertionError(f"of 100 ports from {PORTS.start} to {PORTS.stop - 1} none is free")


class SecondHost:
    """Another host: a network namespace with a virtual cable to this one; removed after the test.

    Skips the test if ip (iproute2) is missing or namespaces are not permitted.
    """

    def __init__(self, test):
        # Four addresses from the range reserved for tests between hosts (RFC 2544).
        network = int(ipaddress.ip_address("198.18.0.0")) + os.getpid() % 32768 * 4
        self.here = str(ipaddress.ip_address(network + 1))
        self.there = str(ipaddress.ip_address(network + 2))
        name = f"aquafarm{os.getpid()}"
        cable = f"aqf{os.getpid()}"
        self.inside = ("ip", "netns", "exec", name)
        if shutil.which("ip") is None:
            raise unittest.SkipTest("no second host here: there is no ip (package iproute2)")
        test.addCleanup(subprocess.run, ["ip", "netns", "del", name], check=False,
                        stderr=subprocess.DEVNULL)
        for command in (f"netns add {name}",
                        f"link add {cable} type veth peer name eth0 netns {name}",
                        f"addr add {self.here}/30 dev {cable}", f"link set {cable} up",
                        f"-n {name} addr add {self.there}/30 dev eth0",
                        f"-n {name} link set eth0 up", f"-n {name} link set lo up"):
            done = subprocess.run(["ip", *command.split()], capture_output=True, text=True,
                                  check=False)
            refused = "not permitted|denied|not supported|unknown device type|read-only"
            if done.returncode and (command.startswith("netns add") or
                                    re.search(refused, done.stderr, re.I)):
                raise unittest.SkipTest(f"no second host here: ip {command}: {done.stderr.strip()}")
            assert done.returncode == 0, f"ip {command}: {done.stderr.strip()}"

    def environment(self, port, inside):
        """Prefix of a command that runs on this host or inside the other, with a master here."""
        words = ("env", "-u", "ROS_HOSTNAME", f"ROS_MASTER_URI=http://{self.here}:{port}",
                 f"ROS_IP={self.there if inside else self.here}")
        return (*self.inside, *words) if inside else words


def start_sim(test, namespace, scenario, *parameters):
    """Starts a sim node in a namespace."""
    return Program(test, program("aquafarm_sim", "sim_node"), f"__ns:={namespace}", "__name:=sim",
                   f"_scenario:={scenario}", "_publish_clock:=false", *parameters)


def start_agent(test, node, namespace, *parameters):
    """Starts train_node or policy_node under a unique name, so that it does not inherit parameters
    of an earlier node."""
    start_agent.count = getattr(start_agent, "count", 0) + 1
    return Program(test, program("aquafarm_agents", node), f"__ns:={namespace}",
                   f"__name:=agent_{os.getpid()}_{start_agent.count}", *parameters)


def newest_checkpoint(run_folder):
    """Name of a run folder's newest checkpoint; empty if there is none."""
    names = sorted(path.name for path in pathlib.Path(run_folder).glob("checkpoints/step_*.ckpt"))
    return names[-1] if names else ""
