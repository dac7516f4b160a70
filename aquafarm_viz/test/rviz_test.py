#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Shows a ranch in rviz on a virtual screen and checks the pixels.

Every shipped configuration must load. Its view must show devices of all kinds, the ship and the
rings. The panel must show the tables and the training curve. Some configurations must also show a
policy's values, its greedy actions, and its choice next to the recorded actions. Skips with a
message if rviz or Xvfb is not installed. AQUAFARM_SCREENSHOTS=FOLDER saves the screens as PNGs.
"""
import os
import shutil
import struct
import subprocess
import tempfile
import sys
import time
import unittest
import xml.etree.ElementTree as ElementTree

import numpy
import rospkg
import rospy
import rostest
from aquafarm_msgs.msg import (Cell, DeviceState, DisasterState, FarmSpec, FarmState, PolicyChoice,
                               PortInfo, RockInfo, ShipState, TrainingStatus)
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import PointCloud2, PointField

DISPLAY = ":%d" % (100 + os.getpid() % 800)
LIMIT_S = 60
SIDE = 25
WHY_NOT = "" if shutil.which("Xvfb") and shutil.which("rviz") else "rviz or Xvfb is not installed"
# Colours of palette.cpp in the view, as R, G, B.
WANTED = {
    "temporary breeding": (0xe8, 0xdc, 0xc8),
    "monitoring": (0xa8, 0xe6, 0xa0),
    "breeding release": (0xc4, 0xc4, 0xff),
    "deep water breeding": (0x7f, 0xd4, 0xd4),
    "deck of ship 0": (0xd5, 0x5e, 0x00),
    "full health": (0x3d, 0xdc, 0x6f),
    "outer ring": (0xff, 0xd4, 0x3b),
}
ROUTE = {"route, a thin line over the sea": (0x57, 0x97, 0xc5)}
CHOICE = {"choice of the other policy": (0x4d, 0xe3, 0xff)}
# Colours of CurveWidget in the panel.
PANEL = {
    "back of the curve": (0x10, 0x1d, 0x2a),
    "curve of mean returns": (0xff, 0xd4, 0x3b),
    "curve of success": (0x5f, 0xe0, 0x8a),
}
PANEL_WIDTH = 560  # in a window of 1600 x 900
VIEW = (slice(80, 860), slice(600, 1590))


def farm_spec(width=SIDE, height=SIDE, cell_size_m=1000.0, episode=0):
    spec = FarmSpec(scenario_name="rviz", seed=1, width=width, height=height, episode=episode,
                    cell_size_m=cell_size_m, step_limit=5000, ships=1, agents=1)
    spec.islands = [Cell(x, y) for x in range(9, 14) for y in range(10, 13)]
    spec.rocks = [RockInfo(cell=Cell(3 * i + 1, (7 * i) % SIDE), reward=-3) for i in range(8)]
    spec.ports = [PortInfo(id=0, cell=Cell(14, 11))]
    return spec


def farm_state(step):
    state = FarmState(observer=-1, seed=1, step=step)
    state.ships = [ShipState(x=step % SIDE, y=16, visible=True, own_device=-1, capacity=1,
                             active=True, action=3)]
    state.devices = [DeviceState(id=kind, kind=kind, x=3 + 5 * kind, y=21, value=75, health=1,
                                 health_known=True, carrier=-1) for kind in range(4)]
    state.disasters = [DisasterState(grade=3, x=6, y=5, heading_deg=90, speed=0.5,
                                     radii=[1, 2, 4], risks=[-20, -10, -5], steps_left=900,
                                     known=True, visible=True)]
    return state


def corner_state(spec, step, outside=False):
    """Returns a state with one device of each kind in the corners, or outside the farm."""
    state = FarmState(observer=-1, seed=1, episode=spec.episode, step=step)
    corners = [(x, y) for x in (0, spec.width - 1) for y in (0, spec.height - 1)]
    if outside:
        corners = [(-1, -1)] * 4
    state.devices = [DeviceState(id=kind, kind=kind, x=x, y=y, value=75, health=1,
                                 health_known=True, carrier=-1)
                     for kind, (x, y) in enumerate(corners)]
    return state


def values():
    """Returns V (max in the north-east) as a grid and as points. All moves go north."""
    grid = OccupancyGrid()
    grid.header.frame_id = "map"
    grid.info.width = grid.info.height = SIDE
    grid.info.resolution = 1000
    grid.info.origin.position.x = grid.info.origin.position.y = -500
    grid.info.origin.orientation.w = 1
    grid.data = [2 * (x + y) for y in range(SIDE) for x in range(SIDE)]
    cloud = PointCloud2(width=SIDE * SIDE, height=1, point_step=17)
    cloud.header.frame_id = "map"
    cloud.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1)
                    for i, name in enumerate(("x", "y", "z", "value"))]
    cloud.fields.append(PointField("action", 16, PointField.UINT8, 1))
    cloud.data = b"".join(struct.pack("<4fB", 1000 * x, 1000 * y, 0, x + y, 0)
                          for y in range(SIDE) for x in range(SIDE))
    cloud.row_step = len(cloud.data)
    return grid, cloud


def training(episode):
    return TrainingStatus(phase=TrainingStatus.TRAINING, algorithm="q_learning", episode=episode,
                          episodes=2000, mean_return=100 - 1000 / (episode + 1),
                          success_rate=min(1, episode / 40), steps_per_second=250000,
                          time_left_s=42)


def screen(path):
    """Returns the picture of an Xvfb screen, [height, width, RGB], from its XWD file."""
    with open(path, "rb") as file:
        data = file.read()
    header = struct.unpack(">25I", data[:100])
    height, width, bytes_per_line = header[5], header[4], header[12]
    start = header[0] + 12 * header[19]
    rows = numpy.frombuffer(data, numpy.uint8, height * bytes_per_line, start)
    lines = rows.reshape(height, bytes_per_line)[:, :4 * width]
    return lines.reshape(height, width, 4)[:, :, 2::-1]


def missing(picture, wanted, tolerance=30):
    """Returns the names of absent colours with the number of their pixels in the picture."""
    def seen(color):
        near = numpy.abs(picture.astype(int) - numpy.array(color)).max(axis=2) <= tolerance
        return int(near.sum())
    return {name: seen(color) for name, color in wanted.items() if seen(color) < 20}


def words(picture):
    """Returns the number of dark pixels (text) of a picture."""
    return int((picture.max(axis=2) < 100).sum())


def arrows(picture):
    """Returns the number of light pixels, which are the arrows of greedy actions."""
    return int((picture.min(axis=2) > 200).sum())


def widest_space(view):
    """Returns the widest gap in the first line of text, in heights of its letters."""
    light = view.min(axis=2) > 150
    rows = numpy.flatnonzero(light.any(axis=1))
    if len(rows) == 0:
        return numpy.inf
    end = next((a + 1 for a, b in zip(rows, rows[1:]) if b > a + 2), rows[-1] + 1)
    columns = numpy.flatnonzero(light[rows[0]:end].any(axis=0))
    return numpy.diff(columns).max(initial=0) / (end - rows[0])


class RvizTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="aquafarm_rviz_")
        self.processes = []
        self.publishers = {}
        self.send("spec", farm_spec(), latch=True)

    def send(self, topic, message, latch=False):
        if topic not in self.publishers:
            self.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=10,
                                                     latch=latch)
        self.publishers[topic].publish(message)

    def tearDown(self):
        for publisher in self.publishers.values():
            publisher.unregister()
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

    def keep(self, picture, name):
        folder = os.environ.get("AQUAFARM_SCREENSHOTS")
        if not folder:
            return
        import cv2  # only needed for screenshots
        cv2.imwrite(os.path.join(folder, name + ".png"), picture[:, :, ::-1])

    def open_rviz(self, job):
        """Opens rviz with a configuration. Returns the path of its frame buffer file."""
        self.start("xvfb", "Xvfb", DISPLAY, "-screen", "0", "1600x900x24", "-fbdir", self.folder,
                   "-nolisten", "tcp")
        time.sleep(1)
        path = os.path.join(rospkg.RosPack().get_path("aquafarm_viz"), "rviz", job + ".rviz")
        self.start("rviz", "rviz", "-d", path, "__name:=rviz_" + job, DISPLAY=DISPLAY,
                   LIBGL_ALWAYS_SOFTWARE="1", XDG_RUNTIME_DIR=self.folder)
        return os.path.join(self.folder, "Xvfb_screen0")

    def show(self, job, view_wanted, look=lambda view: True):
        """Shows the ranch with a configuration until all wanted colours are visible."""
        frame_buffer = self.open_rviz(job)
        end = time.monotonic() + LIMIT_S
        step = 0
        absent, picture, looks_right = {"everything": 0}, None, False
        grid, cloud = values()
        while (absent or not looks_right) and time.monotonic() < end:
            step += 1
            self.send("values", grid, latch=True)
            self.send("values/points", cloud, latch=True)
            self.send("training", training(step))
            self.send("choice", PolicyChoice(seed=1, step=step, policy="dqn", actions=[4]))
            self.send("state", farm_state(step))
            time.sleep(0.5)
            self.assertIsNone(self.processes[-1].poll(), "rviz ended by itself")
            picture = screen(frame_buffer)
            panel = picture[:, :PANEL_WIDTH]
            absent = {**missing(picture[VIEW], view_wanted), **missing(panel, PANEL)}
            looks_right = look(picture[VIEW]) and words(panel) > 2000
        self.keep(picture, job)
        self.assertFalse(absent, "pixels of its colour, after %d s: %s" % (LIMIT_S, absent))
        self.assertTrue(looks_right, "ink in the panel: %d, arrows in the view: %d" %
                        (words(picture[:, :PANEL_WIDTH]), arrows(picture[VIEW])))

    def test_a_farm_of_any_size_is_seen_up_to_its_corners(self):
        frame_buffer = self.open_rviz("watch")
        devices = dict(list(WANTED.items())[:4])
        for episode, size in enumerate(((SIDE, SIDE, 1000.0), (500, 500, 100.0), (20, 14, 0.5))):
            spec = farm_spec(*size, episode)
            end, absent, step = time.monotonic() + LIMIT_S, devices, 0
            while absent and time.monotonic() < end:
                step += 1
                self.send("spec", spec, latch=True)
                self.send("state", corner_state(spec, step))
                time.sleep(0.5)
                picture = screen(frame_buffer)
                absent = missing(picture[VIEW], devices, tolerance=8)  # excludes blended pixels
            self.keep(picture, "size_%d" % episode)
            self.assertFalse(absent, "a farm of %d x %d cells of %g m" % size)
            # Removes the devices, so that this picture is not taken for one of the next farm.
            end = time.monotonic() + LIMIT_S
            while len(absent) < len(devices) and time.monotonic() < end:
                step += 1
                self.send("state", corner_state(spec, step, outside=True))
                time.sleep(0.5)
                absent = missing(screen(frame_buffer)[VIEW], devices, tolerance=8)
            self.assertEqual(set(devices), set(absent), "devices that are gone are seen")

    def test_watch_shows_the_ranch_and_the_panel(self):
        # The line has two spaces in a row. With rviz's default width they are 2 heights wide.
        self.show("watch", WANTED, lambda view: widest_space(view) < 1.5)

    def test_train_shows_values_and_best_moves_too(self):
        self.show("train", WANTED, lambda view: arrows(view) > 8000)

    def test_replay_shows_the_ranch_and_the_panel(self):
        self.show("replay", {**WANTED, **ROUTE})

    def test_compare_shows_what_another_policy_would_do(self):
        self.show("compare", {**WANTED, **CHOICE}, lambda view: arrows(view) > 8000)


def tell_skipped():
    """Writes a result file with skipped tests, because rosunit counts skipped tests as passed."""
    names = unittest.TestLoader().getTestCaseNames(RvizTest)
    suite = ElementTree.Element("testsuite", tests=str(len(names)), errors="0", failures="0")
    for name in names:
        case = ElementTree.SubElement(suite, "testcase", classname="RvizTest", name=name)
        ElementTree.SubElement(case, "skipped", message=WHY_NOT)
    path = [a.split(":", 1)[1] for a in sys.argv if a.startswith("--gtest_output=xml:")]
    if path:
        ElementTree.ElementTree(suite).write(path[0])
    print(f"skipped: {WHY_NOT}")


if __name__ == "__main__":
    if WHY_NOT:
        tell_skipped()
    else:
        rospy.init_node("rviz_test")
        rostest.rosrun("aquafarm_viz", "rviz_test", RvizTest)
