#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bulletins put into a folder reach the running episode and the ship's observation."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from aquafarm_msgs.msg import FarmState
from aquafarm_msgs.srv import SetDisaster, SetDisasterResponse

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import LIMIT_S, call, message, state  # noqa: E402

NORTH = 0


def storm(latitude, radius_km, forecast=None):
    """Returns a bulletin of 2021-07-24 00:00 UTC, the scenario's start, in Beijing time."""
    point = {"time": "2021-07-24T08:00:00", "lat": latitude, "lng": 122.7, "strong": "台风(TY)",
             "speed": 35, "move_dir": "北", "move_speed": 10, "radius7": radius_km,
             "radius10": radius_km / 2, "radius12": radius_km / 4, "forecast": forecast}
    return json.dumps([{"tfbh": "202106", "ename": "In-Fa", "points": [point]}])


class BulletinNodeTest(unittest.TestCase):

    def start(self, folder, namespace=None, *arguments):
        """Starts the node as rosrun does, in the ranch's namespace, with a unique name."""
        self.started = getattr(self, "started", 0) + 1
        name = f"{self._testMethodName[:12]}_{self.started}"
        return subprocess.Popen(
            ["rosrun", "aquafarm_sim", "bulletin_node", f"_folder:={folder}", "_period_s:=0.1",
             "__name:=" + name, "__ns:=" + (namespace or rospy.get_namespace().rstrip("/")),
             *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env=dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1"))

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="bulletins.")
        self.node = self.start(self.folder)

    def put(self, name, text):
        """Writes a temporary file and renames it, as writers should."""
        path = os.path.join(self.folder, name)
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(path + ".part", path)

    def wait(self, condition, what):
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            disaster = state().disasters[0]
            if condition(disaster):
                return disaster
            time.sleep(0.05)
        self.fail(f"timed out waiting for {what}: {disaster}")

    def test_a_bulletin_reaches_the_episode_and_the_next_observation(self):
        message("spec", rospy.AnyMsg)
        self.assertEqual(2, state().disasters[0].grade)
        self.put("first.json", storm(30.0, 50.0))
        got = self.wait(lambda d: d.grade == 3, "the storm")
        # 0.2 degrees south of the ranch, in cells of 100 m.
        self.assertAlmostEqual(-221.7, got.y, delta=1.0)
        self.assertEqual([125.0, 250.0, 500.0], [round(r, 3) for r in got.radii])

        # A file that is not a bulletin changes nothing, and the node keeps running.
        self.put("broken.json", '[{"tfbh": "202106", "points": [')
        self.put("other.txt", "not a bulletin at all")
        time.sleep(0.5)
        self.assertEqual(3, state().disasters[0].grade)

        ahead = [{"sets": "中国", "points": [
            {"time": "2021-07-25T08:00:00", "lat": 30.2, "lng": 122.7, "speed": 45,
             "strong": "强台风(STY)", "radius7": 80}]}]
        self.put("second.json", storm(30.1, 60.0, ahead))
        got = self.wait(lambda d: d.y > -120.0, "the correction")
        self.assertEqual([150.0, 300.0, 600.0], [round(r, 3) for r in got.radii])
        result = call("ship_0/move", direction=NORTH).result
        self.assertTrue(result.message == "" or result.code == 0, result.message)
        seen = message("ship_0/observation", FarmState, lambda s: s.step > 0)
        self.assertEqual(3, seen.disasters[0].grade)
        self.assertLess(seen.disasters[0].y, -100.0)

    def test_a_folder_that_is_not_there_is_refused(self):
        missing = os.path.join(self.folder, "missing")
        node = self.start(missing)
        error, _ = node.communicate(timeout=LIMIT_S)
        self.assertEqual(2, node.returncode)
        self.assertIn(f"bulletin_node: {missing}: cannot read this folder: No such file", error)

    def test_a_storm_of_before_1970_is_refused_by_its_time(self):
        folder = tempfile.mkdtemp(prefix="bulletins.")
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        with open(os.path.join(folder, "old.json"), "w", encoding="utf-8") as file:
            file.write(storm(30.0, 50.0).replace("2021-07-24", "1949-07-24"))
        words = "old.json: In-Fa: got positions before 1970, expected later ones"
        self.assertIn(words, self.read_until(self.start(folder), words))

    def read_until(self, node, words):
        """Returns a node's output up to the given words, or all of it at the timeout."""
        os.set_blocking(node.stdout.fileno(), False)
        text, end = b"", time.monotonic() + LIMIT_S
        while words not in text.decode(errors="replace") and time.monotonic() < end:
            try:
                text += os.read(node.stdout.fileno(), 4096)
            except BlockingIOError:
                time.sleep(0.05)
        node.terminate()
        node.wait(LIMIT_S)
        node.stdout.close()
        return text.decode(errors="replace")

    def test_the_log_separates_what_is_recorded_from_what_is_forecast(self):
        folder = tempfile.mkdtemp(prefix="bulletins.")
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        bulletin = os.path.join(folder, "one.json")
        with open(bulletin, "w", encoding="utf-8") as file:
            file.write(storm(30.0, 50.0))
        words = ("In-Fa is now disaster 0; known until 2021-07-24T00:00:00Z only; no forecast: it is "
                 "assumed to keep its motion, wind and rings until 2021-07-25T00:00:00Z")
        self.assertIn(words, self.read_until(self.start(folder), words))
        ahead = [{"sets": "CMA", "points": [
            {"time": "2021-07-25T20:00:00", "lat": 30.2, "lng": 122.7, "speed": 45}]}]
        with open(bulletin, "w", encoding="utf-8") as file:
            file.write(storm(30.0, 50.0, ahead))
        words = ("In-Fa is now disaster 0; recorded until 2021-07-24T00:00:00Z, then forecast until "
                 "2021-07-25T12:00:00Z (issued 2021-07-24T00:00:00Z by CMA)")
        self.assertIn(words, self.read_until(self.start(folder), words))

    def test_a_ranch_that_is_away_or_hangs_gets_the_bulletin_later(self):
        calls = []

        def hang_once(request):
            calls.append(request)
            if len(calls) == 1:
                time.sleep(3.0)
            return SetDisasterResponse(ok=True)

        folder = tempfile.mkdtemp(prefix="bulletins.")
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        with open(os.path.join(folder, "first.json"), "w", encoding="utf-8") as file:
            file.write(storm(30.0, 50.0))
        node = self.start(folder, "/elsewhere", "_call_limit_s:=0.5")
        time.sleep(1.0)  # the service does not exist yet
        service = rospy.Service("/elsewhere/set_disaster", SetDisaster, hang_once)
        end = time.monotonic() + LIMIT_S
        while len(calls) < 2 and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(1.0)
        self.assertEqual(2, len(calls), "once answered, it is not sent again")
        self.assertIsNone(node.poll(), "the node lives on")
        service.shutdown()
        node.terminate()
        node.communicate(timeout=LIMIT_S)
        told = calls[1].storm
        self.assertEqual("In-Fa", told.name)
        self.assertEqual(30.0, told.fixes[0].latitude_deg)
        self.assertEqual([34, 50, 64], [ring.wind_kt for ring in told.fixes[0].rings])

    def tearDown(self):
        self.node.terminate()
        self.node.communicate(timeout=LIMIT_S)
        shutil.rmtree(self.folder, ignore_errors=True)


if __name__ == "__main__":
    rospy.init_node("bulletin_node_test")
    rostest.rosrun("aquafarm_sim", "bulletin_node_test", BulletinNodeTest, sys.argv)
