# SPDX-License-Identifier: BSD-3-Clause
"""Runs two trainings at the same time, each with its own sim node on the same master. One sim node
has 200 subscribers that read and one that never reads. The memory of this sim node must grow by
less than 64 MiB. The results must equal those of a training that runs alone."""
import contextlib
import pathlib
import select
import socket
import tempfile
import threading
import urllib.parse
import xmlrpc.client

from campaigns import ros

SUBSCRIBERS = 200
STEPS = 16_000
LIMIT_S = 1200
# Max growth of the memory of the sim node with the subscribers, each of which has a message queue.
MOST_GROWTH = 64 << 20
TYPE = "aquafarm_msgs/FarmState"


class Subscribers:
    """201 connections to the topic `state` of a sim node. The first connection is never read."""

    def __init__(self, ranch, namespace, checksum):
        self.bytes_read = 0
        self.lines = []
        self._end = False
        code, _, uri = ranch.master().lookupNode("/campaign", f"/{namespace}/sim")
        assert code == 1, uri
        topic = f"/{namespace}/state"
        answer = xmlrpc.client.ServerProxy(uri).requestTopic("/campaign", topic, [["TCPROS"]])
        place = (urllib.parse.urlparse(f"//{answer[2][1]}:{answer[2][2]}"))
        for number in range(SUBSCRIBERS + 1):
            line = socket.create_connection((place.hostname, place.port), timeout=30)
            line.sendall(ros.header(callerid=f"/campaign_{number}", topic=topic, type=TYPE,
                                    md5sum=checksum))
            ros.receive_frame(line)
            self.lines.append(line)
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        readers = self.lines[1:]
        while not self._end:
            for line in select.select(readers, [], [], 0.2)[0]:
                with contextlib.suppress(OSError):
                    self.bytes_read += len(line.recv(1 << 16))

    def close(self):
        self._end = True
        self._thread.join()
        for line in self.lines:
            line.close()


def alone(campaign, folder):
    """Runs one training alone on its master; returns its results, or None after a failure."""
    folder.mkdir()
    with ros.Ros(campaign, folder) as ranch:
        ranch.sim("one")
        code = ranch.train("one", "run", STEPS).wait(timeout=LIMIT_S)
        campaign.check(code == 0, f"alone: exit code {code}: {ranch.log('run')[-1000:]}")
        return ranch.results("run") if code == 0 else None


def together(campaign, folder, expected):
    """Runs two trainings at the same time with the subscribers, and checks results and memory."""
    folder.mkdir()
    with ros.Ros(campaign, folder) as ranch:
        sims = {name: ranch.sim(name, "_publish_hz:=50") for name in ("one", "two")}
        from aquafarm_msgs.msg import FarmState  # of the sourced workspace
        watchers = Subscribers(ranch, "one", FarmState._md5sum)
        before = ros.memory(sims["one"])
        trainings = {name: ranch.train(name, f"run_{name}", STEPS) for name in sims}
        for name, process in trainings.items():
            code = process.wait(timeout=LIMIT_S)
            if campaign.check(code == 0, f"{name}: exit code {code}: "
                              f"{ranch.log(f'run_{name}')[-1000:]}"):
                campaign.attempt("trainings compared")
                campaign.check(ranch.results(f"run_{name}") == expected,
                               f"{name}: differs from the training alone")
        growth = ros.memory(sims["one"]) - before
        watchers.close()
        campaign.attempt("subscribers", len(watchers.lines))
        campaign.attempt("bytes read by subscribers", watchers.bytes_read)
        campaign.attempt("MiB that the sim node grew", growth >> 20)
        campaign.check(watchers.bytes_read > 0, "no subscriber got anything")
        campaign.check(growth < MOST_GROWTH, f"the sim node grew by {growth >> 20} MiB")


def run(campaign):
    """Runs campaign.count pairs of trainings. If the count is 0, starts pairs for
    campaign.seconds."""
    with tempfile.TemporaryDirectory(prefix="aquafarm_concurrency_") as place:
        place = pathlib.Path(place)
        expected = alone(campaign, place / "alone")
        number = 0
        while expected and campaign.more(number):
            together(campaign, place / f"pair_{number}", expected)
            number += 1
