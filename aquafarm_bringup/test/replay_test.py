#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A replay is paused, stepped, paced and sent to a step, beside what another policy would do."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rosgraph
import roslib.packages
import rospy
import rostest
from aquafarm_msgs.msg import FarmState, PolicyChoice
from aquafarm_msgs.srv import Jump, Pause, SetPace

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, free_port  # noqa: E402

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
LIMIT_S = 20


def make_bag(folder):
    """A bag of one episode, some fifty steps."""
    def run(package, name, *arguments):
        subprocess.run([roslib.packages.find_node(package, name)[0], *map(str, arguments)],
                       check=True, stdout=subprocess.DEVNULL, timeout=60)
    scenario = roslib.packages.get_pkg_dir("aquafarm_sim") + "/scenarios/paper.yaml"
    run("aquafarm_agents", "aquafarm_evaluate", "clairvoyant", scenario, "--episodes", 1, "--route",
        folder / "r.json")
    run("aquafarm_sim", "episode_bag", scenario, folder / "r.json", "-o", folder / "x.bag")
    return folder / "x.bag"


class ReplayTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_replay_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.bag = make_bag(cls.folder)
        cls.ranch = Ranch("replay", f"bag:={cls.bag}", "headless:=true", "viz:=false",
                          "policy:=random", "paused:=true", "start_step:=7", port=free_port())
        cls.ranch.__enter__()
        cls.addClassCleanup(lambda: cls.ranch.__exit__())
        os.environ.update(cls.ranch.environment)
        cls.ranch.wait_for(rosgraph.is_master_online, LIMIT_S)
        rospy.init_node("replay_test", disable_signals=True)
        cls.states, cls.choices = [], []
        rospy.Subscriber("/aquafarm/state", FarmState, cls.states.append, queue_size=1000)
        rospy.Subscriber("/aquafarm/choice", PolicyChoice, cls.choices.append)
        for name in ("pause", "set_pace", "jump"):
            rospy.wait_for_service(f"/aquafarm/{name}", LIMIT_S)
        cls.pause = rospy.ServiceProxy("/aquafarm/pause", Pause)
        cls.pace = rospy.ServiceProxy("/aquafarm/set_pace", SetPace)
        cls.jump = rospy.ServiceProxy("/aquafarm/jump", Jump)

    def shown(self, step):
        """Waits until a step is what was shown last."""
        self.ranch.wait_for(lambda: self.states and self.states[-1].step == step, LIMIT_S)

    def test_it_begins_at_the_step_asked_for_with_the_choice_of_the_policy(self):
        self.jump(step=7)
        self.shown(7)
        self.ranch.wait_for(lambda: self.choices and self.choices[-1].step == 7, LIMIT_S)
        self.assertEqual("random", self.choices[-1].policy)
        self.assertIn("choices agree with what was done", self.ranch.words())

    def test_paused_it_goes_step_by_step(self):
        self.assertEqual(20, self.jump(step=20).step)
        self.shown(20)
        answer = self.pause(paused=True, steps=1)
        self.assertTrue(answer.ok and answer.paused)
        self.shown(21)
        self.pause(paused=True, steps=3)
        self.shown(24)
        self.assertEqual(list(range(20, 25)),
                         [state.step for state in self.states if state.step >= 20][-5:])

    def test_it_jumps_back_and_forth_and_says_what_there_is_not(self):
        answer = self.jump(step=1000000)
        self.assertTrue(answer.ok)
        with rosbag.Bag(str(self.bag)) as bag:
            last = max(m.step for _, m, _ in bag.read_messages("/aquafarm/state"))
        self.assertEqual(last, answer.step)
        self.shown(last)
        self.assertEqual(3, self.jump(step=3).step)
        self.shown(3)
        answer = self.jump(has_episode=True, episode=99)
        self.assertFalse(answer.ok)
        self.assertEqual("episode: got 99, the bag has episodes 0 to 0 (not each of them need be "
                         "recorded)", answer.message)
        self.assertEqual(3, answer.step)

    def test_its_pace_is_in_steps_a_second(self):
        self.jump(step=0)
        answer = self.pace(rate_hz=40)
        self.assertTrue(answer.ok)
        self.assertAlmostEqual(40, answer.rate_hz, places=3)
        self.pause(paused=False)
        self.ranch.wait_for(lambda: self.states[-1].step >= 20, LIMIT_S)
        self.pause(paused=True)
        answer = self.pace(pace="lockstep")
        self.assertFalse(answer.ok)
        self.assertEqual("pace: got lockstep, a replay is paced", answer.message)
        self.assertIn("rate_hz: got -1.000000, expected [0, ", self.pace(rate_hz=-1).message)

    def test_without_a_display_there_is_a_line_with_the_way_out(self):
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = subprocess.run([SCRIPTS / "with_display", "rviz"], env=environment, text=True,
                              stderr=subprocess.PIPE, timeout=LIMIT_S, check=False)
        self.assertEqual(3, done.returncode)
        self.assertEqual("rviz: there is no display (DISPLAY is empty): give headless:=true or "
                         "rviz:=false and look at the topic image, or draw a bag with './aquafarm "
                         "render'\n", done.stderr)
        done = subprocess.run([SCRIPTS / "with_display", "true"],
                              env=dict(environment, DISPLAY=":1"), timeout=LIMIT_S, check=False)
        self.assertEqual(0, done.returncode)

    def test_a_bag_or_policy_that_cannot_be_used_ends_the_launch_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = pathlib.Path(folder) / "x.bag"
            broken.write_text("no bag\n")
            for arguments, words in (
                    ((), "x.bag: damaged or no bag: "),
                    (("policy:=random",), "x.bag: damaged or no bag: "),
                    (("policy:=/no/run",), "/no/run")):
                with self.subTest(arguments=arguments):
                    with Ranch("replay", f"bag:={broken}", "headless:=true", "viz:=false",
                               *arguments) as ranch:
                        self.assertEqual(2, ranch.exit_code(60), ranch.words())
                        self.assertIn(words, ranch.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "replay", ReplayTest, sys.argv)
