#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Shows a ranch in the real rviz on a virtual screen and looks at the pixels.

Every shipped configuration must load, and devices of all kinds, the ship and the rings must be
seen in its view. Skips with a word where rviz or Xvfb is not installed.
"""
import os
import shutil
import struct
import subprocess
import tempfile
import time
import unittest

import numpy
import rospkg
import rospy
import rostest
from aquafarm_msgs.msg import (Cell, DeviceState, DisasterState, FarmSpec, FarmState, PortInfo,
                               RockInfo, ShipState)

DISPLAY = ":%d" % (100 + os.getpid() % 800)
LIMIT_S = 60
SIDE = 25
# Colours of palette.cpp, R G B.
WANTED = {
    "temporary breeding": (0xff, 0xa9, 0x4d),
    "monitoring": (0xff, 0xe0, 0x3d),
    "breeding release": (0xf7, 0x83, 0xc9),
    "deep water breeding": (0xb5, 0x9c, 0xff),
    "deck of ship 0": (0xe0, 0x31, 0x31),
    "full health": (0x3d, 0xdc, 0x6f),
    "outer ring": (0xff, 0xd4, 0x3b),
}


def farm_spec():
    spec = FarmSpec(scenario_name="rviz", seed=1, width=SIDE, height=SIDE, cell_size_m=1000,
                    step_limit=5000, ships=1, agents=1)
    spec.islands = [Cell(x, y) for x in range(9, 14) for y in range(10, 13)]
    spec.rocks = [RockInfo(cell=Cell(3 * i + 1, (7 * i) % SIDE), reward=-3) for i in range(8)]
    spec.ports = [PortInfo(id=0, cell=Cell(14, 11))]
    return spec


def farm_state(step):
    state = FarmState(observer=-1, seed=1, step=step)
    state.ships = [ShipState(x=18, y=6, visible=True, own_device=-1, capacity=1, active=True,
                             action=3)]
    state.devices = [DeviceState(id=kind, kind=kind, x=3 + 5 * kind, y=21, value=75, health=1,
                                 health_known=True, carrier=-1) for kind in range(4)]
    state.disasters = [DisasterState(grade=3, x=6, y=5, heading_deg=90, speed=0.5,
                                     radii=[1, 2, 4], risks=[-20, -10, -5], steps_left=900,
                                     known=True, visible=True)]
    return state


def screen(path):
    """The picture of an Xvfb screen, [height, width, RGB], from its frame buffer file (XWD)."""
    with open(path, "rb") as file:
        data = file.read()
    header = struct.unpack(">25I", data[:100])
    height, width, bytes_per_line = header[5], header[4], header[12]
    start = header[0] + 12 * header[19]
    rows = numpy.frombuffer(data, numpy.uint8, height * bytes_per_line, start)
    return rows.reshape(height, bytes_per_line)[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1]


def missing(picture):
    """The wanted things whose colour is not in the picture."""
    def seen(color):
        near = numpy.abs(picture.astype(int) - numpy.array(color)).max(axis=2) <= 30
        return int(near.sum())
    return {name: seen(color) for name, color in WANTED.items() if seen(color) < 20}


@unittest.skipUnless(shutil.which("Xvfb") and shutil.which("rviz"), "rviz or Xvfb is not installed")
class RvizTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="aquafarm_rviz_")
        self.processes = []
        self.spec = rospy.Publisher("spec", FarmSpec, queue_size=1, latch=True)
        self.state = rospy.Publisher("state", FarmState, queue_size=1)
        self.spec.publish(farm_spec())

    def tearDown(self):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, name, *command, **environment):
        log = open(os.path.join(self.folder, name + ".log"), "wb")
        self.processes.append(subprocess.Popen(command, stdout=log, stderr=log,
                                               env=dict(os.environ, **environment)))
        log.close()

    def show(self, configuration):
        self.start("xvfb", "Xvfb", DISPLAY, "-screen", "0", "1400x900x24", "-fbdir", self.folder,
                   "-nolisten", "tcp")
        time.sleep(1)
        path = os.path.join(rospkg.RosPack().get_path("aquafarm_viz"), "rviz", configuration)
        self.start("rviz", "rviz", "-d", path, "__name:=rviz_" + configuration.split(".")[0],
                   DISPLAY=DISPLAY, LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=self.folder)
        frame_buffer = os.path.join(self.folder, "Xvfb_screen0")
        end = time.monotonic() + LIMIT_S
        step = 0
        absent = dict.fromkeys(WANTED, 0)
        while absent and time.monotonic() < end:
            step += 1
            self.state.publish(farm_state(step))
            time.sleep(0.5)
            self.assertIsNone(self.processes[-1].poll(), "rviz ended by itself")
            picture = screen(frame_buffer)
            # The view fills the right of the window; the picture of the farm is on the left.
            absent = missing(picture[70:720, 600:])
        self.assertFalse(absent, "pixels of its colour, after %d s: %s" % (LIMIT_S, absent))

    def test_watch_shows_the_ranch(self):
        self.show("watch.rviz")

    def test_replay_shows_the_ranch(self):
        self.show("replay.rviz")


if __name__ == "__main__":
    rospy.init_node("rviz_test")
    rostest.rosrun("aquafarm_viz", "rviz_test", RvizTest)
