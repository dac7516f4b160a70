#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""agents.launch and sim.launch as a user starts them: each ship's node does its work."""
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from aquafarm_msgs.msg import FarmState, Outcome
from aquafarm_msgs.srv import Claim, GetState, Pause

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import DATA, Ranch, free_port  # noqa: E402

START_LIMIT_S = 60
LIMIT_S = 60
HOLD = 10
CLAIM_TIMEOUT_S = 10
# A farm with a self-propelled device and a ship. With random actions, the ship cannot deliver all
# devices in one episode.
FERRY = """# SPDX-License-Identifier: BSD-3-Clause
name: ferry
grid: {width: 5, height: 5}
time: {step_limit: 3000}
layout:
  rocks: {count: [0, 0]}
  ports: {cells: [[0, 0]]}
  devices: {placement: random, count: 11, self_propelled: 1}
ships: {count: 1}
"""


def call(name, kind, **fields):
    """Calls a service of the ranch."""
    return rospy.ServiceProxy(f"/aquafarm/{name}", kind)(**fields)


def state():
    """Returns the current state of farm 0, or None while there is no sim node."""
    try:
        return call("get_state", GetState).state
    except (rospy.ServiceException, OSError):
        return None


def pid_of(node):
    """Returns the process id of a node, or 0 while the node does not run."""
    try:
        return xmlrpc.client.ServerProxy(
            rosgraph.Master("/started_launch").lookupNode(node)).getPid("/started_launch")[2]
    except (rosgraph.MasterException, OSError):
        return 0


class StartedLaunchTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.port = free_port()  # this process uses the masters that the launches start on it
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{cls.port}"

    def start(self, launch, *arguments):
        ranch = Ranch(launch, "viz:=false", *arguments, port=self.port)
        ranch.__enter__()
        self.addCleanup(ranch.__exit__)
        self.wait(ranch, lambda now: True, START_LIMIT_S)
        return ranch

    def wait(self, ranch, condition, limit_s=LIMIT_S):
        """Waits for a matching state of farm 0 and returns it."""
        def look():
            now = state()
            return now if now and condition(now) else None
        return ranch.wait_for(look, limit_s)

    def pause_with_the_device_home(self, ranch):
        """Pauses the farm in an episode in which the self-propelled device is delivered."""
        for _ in range(200):
            call("pause", Pause, paused=True, steps=100)
            now = self.wait(ranch, lambda now: now.paused)
            if now.reason == FarmState.NONE and not now.ships[1].active:
                return now
        raise AssertionError("the device did not come home")

    def test_the_node_of_a_device_that_is_home_waits_and_joins_the_next_episode(self):
        scenario = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()), "ferry.yaml")
        scenario.write_text(FERRY)
        ranch = self.start("agents", f"scenario:={scenario}", "late_s:=20")
        for silence_s in (CLAIM_TIMEOUT_S + 1, 0):
            home = self.pause_with_the_device_home(ranch)
            time.sleep(silence_s)  # the node of the device sends no commands meanwhile
            claim = call("ship_1/claim", Claim)
            self.assertEqual((Outcome.CLAIMED, "/aquafarm/agent_1"), (claim.code, claim.holder))
            call("pause", Pause, paused=False)
            self.wait(ranch, lambda now, home=home: now.episode > home.episode
                      and now.ships[1].active and now.ships[1].action != HOLD)
        self.assertNotIn("process has died", ranch.words())

    def test_an_agent_that_was_killed_is_started_again_and_joins(self):
        ranch = self.start("agents", f"scenario:={DATA / 'wide.yaml'}")
        before = self.wait(ranch, lambda now: now.step > 20 and now.ships[1].action != HOLD)
        killed = pid_of("/aquafarm/agent_1")
        os.kill(killed, signal.SIGKILL)
        self.wait(ranch, lambda now: now.ships[1].action == HOLD)
        after = self.wait(ranch, lambda now: now.ships[1].action != HOLD)
        self.assertNotIn(pid_of("/aquafarm/agent_1"), (0, killed))
        self.assertEqual(before.episode, after.episode)
        ranch.wait_for(lambda: "late ship 1 sends commands again" in ranch.words(), LIMIT_S)
        self.assertIn("no command from ship 1 within", ranch.words())

    def test_ships_for_which_no_node_was_started_are_named(self):
        ranch = self.start("agents", "scenario:=four_squads", "ships:=2", "late_s:=5")
        self.wait(ranch, lambda now: now.step > 20)
        ranch.wait_for(lambda: "no command from ship 2, 3 within" in ranch.words(), LIMIT_S)

    def test_a_policy_drives_the_ranch_of_sim_launch(self):
        ranch = self.start("sim", "headless:=true", "policy:=random", "rate_hz:=20")
        self.wait(ranch, lambda now: now.pace == FarmState.PACED and now.step > 20
                  and now.ships[0].action != HOLD)
        ranch.interrupt()
        ranch.wait_for(lambda: not ranch.is_running(), LIMIT_S)
        self.assertNotIn("Traceback", ranch.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "started_launch", StartedLaunchTest, sys.argv)
