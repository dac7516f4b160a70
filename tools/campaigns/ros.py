# SPDX-License-Identifier: BSD-3-Clause
"""A ROS master, sim nodes and trainings for a campaign, on free ports of the loopback address."""
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import time
import urllib.parse
import xmlrpc.client

from campaigns import common

sys.path.append(str(common.ROOT / "aquafarm_agents" / "test"))
from processes import free_port  # noqa: E402

SIM_LOST = 4         # exit code of a trainer whose sim node is gone
START_LIMIT_S = 120
FARMS = 16  # of a sim node; a call of a trainer steps all of them

# Matches the first line of a sanitizer's report. The programs may be built with sanitizers.
SANITIZER = re.compile(r"(?:WARNING|ERROR): \w+Sanitizer.*|.*: runtime error: .*")


class Ros:
    """A master with its files in a folder. Leaving the context ends all processes and records
    reports of sanitizers in their logs as failures."""

    def __init__(self, campaign, folder):
        self.campaign = campaign
        self.folder = pathlib.Path(folder)
        self.uri = f"http://127.0.0.1:{free_port()}"
        self.processes = []
        self.environment = dict(os.environ, ROS_IP="127.0.0.1", ROS_HOME=str(self.folder),
                                ROS_LOG_DIR=str(self.folder / "log"))

    def __enter__(self):
        try:
            self.start_master()
        except BaseException:
            self.__exit__()
            raise
        return self

    def start_master(self):
        process = self.start("rosmaster", "rosmaster", "--core", "-p", self.uri.rsplit(":", 1)[1])
        self.wait_for(lambda: self.master().getPid("/campaign"), "the master")
        return process

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for log in sorted(self.folder.glob("*.log")):
            words = log.read_text(errors="replace")
            for found in SANITIZER.finditer(words):
                self.campaign.fail(f"{log.name}: {words[found.start():found.start() + 2500]}")

    def master(self):
        return xmlrpc.client.ServerProxy(self.uri)

    def start(self, log, *words, uri=None):
        """Starts a program with its output in a file; returns the process."""
        with open(self.folder / f"{log}.log", "ab") as output:
            process = subprocess.Popen(
                [str(word) for word in words], stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, cwd=self.folder,
                env=dict(self.environment, ROS_MASTER_URI=uri or self.uri))
        self.processes.append(process)
        return process

    def log(self, name):
        return (self.folder / f"{name}.log").read_text(errors="replace")

    def wait_for(self, what, name, limit_s=START_LIMIT_S):
        """Calls `what` until it returns a true value; returns this value. @raises TimeoutError with
        the ends of the logs"""
        end = time.monotonic() + limit_s
        while True:
            try:
                value = what()
                if value:
                    return value
            except OSError:
                pass
            if time.monotonic() > end:
                logs = "".join(f"\n{path.name}: {path.read_text(errors='replace')[-400:]}"
                               for path in self.folder.glob("*.log"))
                raise TimeoutError(f"{name} did not come up within {limit_s} s{logs}")
            time.sleep(0.05)

    def service(self, name):
        """Returns the URI of a service; "" if the service is not registered."""
        code, _, uri = self.master().lookupService("/campaign", name)
        return uri if code == 1 else ""

    def sim(self, namespace, *arguments):
        """Starts a sim node and waits until its service `step` accepts connections; returns the
        process."""
        process = self.start(f"sim_{namespace}", self.campaign.program("sim_node"),
                             f"__ns:=/{namespace}", "__name:=sim",
                             f"_scenario:={common.SCENARIOS / 'paper.yaml'}", f"_farms:={FARMS}",
                             *arguments)
        self.wait_for(lambda: self.answers(f"/{namespace}/step"), "the sim node")
        return process

    def answers(self, name):
        """Returns whether a service is registered and its address accepts connections. Raises
        OSError if no process listens there: the master keeps the address of a killed process."""
        place = urllib.parse.urlparse(self.service(name))
        if not place.port:
            return False
        socket.create_connection((place.hostname, place.port), timeout=5).close()
        return True

    def train(self, namespace, run, steps, *arguments, uri=None):
        """Starts a Q-learning training with the farms of a namespace; returns the process."""
        return self.start(run, self.campaign.program("train_node"), f"__ns:=/{namespace}",
                          "__name:=train", "_algorithm:=q_learning", f"_steps:={steps}",
                          f"_run_dir:={self.folder / run}", "_evaluation_episodes:=0",
                          "_random_episodes:=0", "_values_period_s:=0",
                          *(arguments if any("_sim_timeout_s" in word for word in arguments)
                            else (*arguments, "_sim_timeout_s:=60")), uri=uri)

    def results(self, run):
        """Returns {name: bytes} of the files that a disturbance must not change."""
        return {name: (self.folder / run / name).read_bytes()
                for name in ("policy.ckpt", "metrics.csv")}


def memory(process):
    """Returns the resident memory of a process [bytes]; 0 if it has ended but is not reaped."""
    words = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    found = re.search(r"VmRSS:\s+(\d+) kB", words)
    return int(found.group(1)) << 10 if found else 0


def receive(connection, size):
    """Reads `size` bytes. @raises ConnectionError at the end of the stream"""
    data = b""
    while len(data) < size:
        part = connection.recv(size - len(data))
        if not part:
            raise ConnectionError("closed")
        data += part
    return data


def receive_frame(connection):
    """Returns a TCPROS frame: its length in four bytes, then its content."""
    head = receive(connection, 4)
    return head + receive(connection, struct.unpack("<I", head)[0])


def header(**fields):
    """Returns a TCPROS connection header."""
    lines = [f"{key}={value}".encode() for key, value in fields.items()]
    body = b"".join(struct.pack("<I", len(line)) + line for line in lines)
    return struct.pack("<I", len(body)) + body
