#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""No node allocates memory for entries that a message states and does not contain.

roscpp allocates as many entries as an array states before it looks for them. The messages of this
test are some hundred bytes long and state entries of a gibibyte.
"""
import io
import pathlib
import re
import struct
import sys
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from aquafarm_msgs.msg import FarmSpec, FarmState, PolicyChoice, RockInfo, ShipState
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

LIMIT_S = 60
STATED = 1 << 30       # bytes
MOST_GROWTH = 1 << 27  # bytes that a node may use more than before


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def overstated(message, field, entry):
    """Returns a serialized message whose array `field` states a length of STATED bytes but contains
    no entry."""
    empty = serialized(message)
    size = 1 if isinstance(entry, bytes) else len(serialized(entry)) if entry else 4
    setattr(message, field, entry if isinstance(entry, bytes) else [entry or 0.0])
    filled = serialized(message)
    at = next(i for i, (a, b) in enumerate(zip(empty, filled)) if a != b)
    return empty[:at] + struct.pack("<I", STATED // size) + empty[at + 4:]


def raw(message_type):
    """Returns a message type that is serialized as the bytes of its member `content`."""

    class Raw(message_type):
        def serialize(self, buff):
            buff.write(self.content)

    return Raw


class Peak:
    """Measures the peak memory of a node's process since this object was made."""

    def __init__(self, node):
        uri = rosgraph.Master("/test").lookupNode(node)
        pid = xmlrpc.client.ServerProxy(uri).getPid("/test")[2]
        self.process = pathlib.Path(f"/proc/{pid}")
        (self.process / "clear_refs").write_text("5")  # proc(5): the peak begins again
        self.first = self.bytes()

    def bytes(self):
        status = (self.process / "status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1)) << 10

    def growth(self):
        return self.bytes() - self.first


class OverstatedArraysTest(unittest.TestCase):

    def setUp(self):
        self.refused = set()
        self.log = rospy.Subscriber("/rosout", Log, self.on_log)

    def on_log(self, line):
        if "deserializing" in line.msg:
            self.refused.add(line.name)

    def until(self, condition, what):
        end = time.monotonic() + LIMIT_S
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

    def check(self, topic, message_type, field, entry, *nodes):
        """Publishes an overstated message. Each node must refuse it, without using more memory."""
        kind = raw(message_type)
        publisher = rospy.Publisher(topic, kind, queue_size=10)
        self.addCleanup(publisher.unregister)
        self.until(lambda: publisher.get_num_connections() >= len(nodes), f"no node reads {topic}")
        peaks = {node: Peak(node) for node in nodes}
        self.refused.clear()
        message = kind()
        message.content = overstated(message_type(), field, entry)

        def refused():
            publisher.publish(message)
            time.sleep(0.2)
            return set(nodes) <= self.refused

        self.until(refused, f"{topic}: refused by {self.refused} only, expected {nodes}")
        for node, peak in peaks.items():
            grown = peak.growth()
            self.assertLess(grown, MOST_GROWTH, f"{node} allocated {grown >> 20} MiB for {topic}")

    def test_of_a_spec(self):
        self.check("spec", FarmSpec, "rocks", RockInfo(), "/ranch/viz", "/ranch/plan")

    def test_of_a_state(self):
        self.check("state", FarmState, "ships", ShipState(), "/ranch/viz", "/ranch/plan")

    def test_of_an_observation(self):
        self.check("ship_0/observation", FarmState, "ships", ShipState(), "/ranch/agent")

    def test_of_a_choice(self):
        self.check("choice", PolicyChoice, "values", None, "/ranch/viz")

    def test_of_a_map_of_values(self):
        moves = rospy.Subscriber("moves", MarkerArray, lambda _: None)
        self.addCleanup(moves.unregister)
        self.check("values/points", PointCloud2, "data", b"0", "/ranch/viz")


if __name__ == "__main__":
    rospy.init_node("overstated_arrays_test")
    rostest.rosrun("aquafarm_bringup", "overstated_arrays", OverstatedArraysTest, sys.argv)
