#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Saved policies through ROS: evaluated as in process, driving ships, rejected with a reason."""
import csv
import json
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from aquafarm_msgs.srv import Command, GetState, Pause, Reset
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import PointCloud2

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import DATA, Program, program, start_agent, start_sim  # noqa: E402

TINY = DATA / "tiny.yaml"
PAIR = DATA / "pair.yaml"


class PolicyNodeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_policy_"))
        cls.addClassCleanup(lambda: __import__("shutil").rmtree(cls.folder))

    def setUp(self):
        self.namespace = "/" + self.id().rsplit(".", maxsplit=1)[-1]

    def trained(self):
        """Run folder of a policy that always solves the tiny farm; trained once."""
        folder = self.folder / "trained"
        if not folder.exists():
            run = Program(self, program("aquafarm_agents", "aquafarm_train"), TINY, "--steps",
                          "200000", "--run-dir", folder, "--evaluate", "100")
            self.assertEqual(0, run.code(), run.words())
            self.assertIn("success 100.0 %", run.words())
        return folder

    def play(self, *parameters, wait_s=10):
        return start_agent(self, "policy_node", self.namespace, f"_sim_timeout_s:={wait_s}",
                           *parameters)

    def test_an_evaluation_is_that_of_this_process(self):
        python = self.folder / "mine.py"
        python.write_text("def act(observations, masks):\n"
                          "    return (masks * [3, 1, 4, 1, 5, 9, 2, 6, 5, 3]).argmax(axis=1)\n")
        places = {"trained": self.trained(), "python": python}
        start_sim(self, self.namespace, TINY, "_farms:=4")
        for name in ("trained", "random", "planner", "python"):
            where = places.get(name, name)
            ros = self.play(f"_policy:={where}", "_episodes:=40", "_seed:=9",
                            f"_output:={self.folder / name}_ros")
            self.assertEqual(0, ros.code(), ros.words())
            local = Program(self, program("aquafarm_agents", "aquafarm_evaluate"), where, TINY,
                            "--episodes", "40", "--seed", "9", "--farms", "4", "--write",
                            self.folder / f"{name}_local")
            self.assertEqual(0, local.code(), local.words())
            with open(self.folder / f"{name}_ros.csv", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual([str(k) for k in range(40)], [row["episode"] for row in rows])
            self.assertEqual((self.folder / f"{name}_local.csv").read_text(),
                             (self.folder / f"{name}_ros.csv").read_text())
        results = {name: json.loads((self.folder / f"{name}_ros.json").read_text())
                   for name in ("trained", "random")}
        self.assertEqual(1.0, results["trained"]["success_rate"])
        self.assertGreater(results["trained"]["return_per_episode"],
                           results["random"]["return_per_episode"] + 50)

    def drive(self, *parameters):
        return self.play("_mode:=act", *parameters)

    def test_it_drives_a_ship_step_by_step(self):
        start_sim(self, self.namespace, TINY)
        run = self.drive(f"_policy:={self.trained()}", "_episodes:=3")
        self.assertEqual(0, run.code(), run.words())
        self.assertIn("3 of 3 episodes ended with every device delivered", run.words())

    def test_it_drives_a_ship_that_does_not_wait(self):
        start_sim(self, self.namespace, TINY, "_pace:=paced", "_rate_hz:=20")
        run = self.drive(f"_policy:={self.trained()}", "_episodes:=2")
        self.assertEqual(0, run.code(), run.words())
        self.assertIn("2 of 2 episodes ended with every device delivered", run.words())

    def test_it_drives_all_ships_of_a_farm_or_one(self):
        start_sim(self, self.namespace, PAIR)
        run = self.drive("_policy:=random", "_episodes:=2")
        self.assertEqual(0, run.code(), run.words())
        one = self.drive("_policy:=random", "_ship:=1", "_episodes:=1")
        other = self.drive("_policy:=random", "_ship:=0", "_episodes:=1")
        self.assertEqual(0, one.code(), one.words())
        self.assertEqual(0, other.code(), other.words())

    def test_values_and_best_moves_are_published_while_somebody_looks(self):
        start_sim(self, self.namespace, TINY, "_pace:=paced", "_rate_hz:=50")
        grids, clouds = [], []
        rospy.Subscriber(f"{self.namespace}/values", OccupancyGrid, grids.append)
        rospy.Subscriber(f"{self.namespace}/values/points", PointCloud2, clouds.append)
        run = self.drive(f"_policy:={self.trained()}", "_values_period_s:=0.1")
        run.wait_for(lambda: len(grids) > 2 and len(clouds) > 2, "values")
        self.assertEqual((6, 6), (grids[-1].info.width, grids[-1].info.height))
        self.assertEqual(100, max(grids[-1].data))
        self.assertEqual(0, min(value for value in grids[-1].data if value >= 0))
        self.assertEqual(sum(value >= 0 for value in grids[-1].data), clouds[-1].width)
        run.send(signal.SIGINT)
        self.assertEqual(0, run.code(), run.words())

    def test_paused_and_resumed_it_drives_on(self):
        start_sim(self, self.namespace, PAIR)
        pause = rospy.ServiceProxy(f"{self.namespace}/pause", Pause)
        pause.wait_for_service(60)
        run = self.drive("_policy:=random", "_episodes:=200")
        run.wait_for(lambda: "episode 1" in run.words(), "an episode")
        self.assertTrue(pause(paused=True).ok)
        run.wait_for(lambda: "is paused" in run.words(), "a word of the pause")
        self.assertTrue(pause(paused=False).ok)
        self.assertEqual(0, run.code(), run.words())

    def test_drivers_whose_barrier_timed_out_continue(self):
        start_sim(self, self.namespace, PAIR, "_barrier_timeout_s:=0.3")
        one = self.drive("_policy:=random", "_ship:=1", "_episodes:=2")
        one.wait_for(lambda: "no command from other ships within" in one.words(), "a timeout")
        other = self.drive("_policy:=random", "_ship:=0", "_episodes:=2")
        self.assertEqual(0, one.code(), one.words())
        self.assertEqual(0, other.code(), other.words())

    def test_a_driver_continues_after_a_reset_to_the_step_of_its_waiting_command(self):
        start_sim(self, self.namespace, PAIR, "_barrier_timeout_s:=5")
        one = self.drive("_policy:=planner", "_ship:=1", "_episodes:=1")
        one.wait_for(lambda: "no command from other ships within" in one.words(), "a timeout")
        time.sleep(1)  # its next command waits for the other ship
        reset = rospy.ServiceProxy(f"{self.namespace}/reset", Reset)
        self.assertTrue(reset(has_seed=True, seed=5).ok)
        other = self.drive("_policy:=planner", "_ship:=0", "_episodes:=1")
        self.assertEqual(0, one.code(), one.words())
        self.assertEqual(0, other.code(), other.words())

    def test_drivers_count_an_episode_whose_successor_another_driver_has_started(self):
        hold = 10
        for policy, last, word in (  # number of the last step if ship 0 holds
                ("planner", 48, "episode 0: all_retrieved"),  # ShipDriver
                ("random", 49, "episode 0: over")):  # AgentDriver
            space = f"{self.namespace}/{policy}"
            start_sim(self, space, PAIR, "_barrier_timeout_s:=20")
            services = {name: rospy.ServiceProxy(f"{space}/{name}", kind) for name, kind in
                        (("command", Command), ("get_state", GetState), ("reset", Reset))}
            services["get_state"].wait_for_service(60)
            driver = start_agent(self, "policy_node", space, f"_policy:={policy}", "_mode:=act",
                                 "_ship:=1", "_episodes:=1")
            for step in range(last):
                self.assertTrue(services["command"](ship=0, action=hold, step=step).result.ok)
            time.sleep(1)  # the driver's last command waits for ship 0
            driver.send(signal.SIGSTOP)
            end = services["command"](ship=0, action=hold, step=last).result
            self.assertTrue(end.terminated or end.truncated, end)
            self.assertTrue(services["reset"](only_if_over=True).ok)
            driver.send(signal.SIGCONT)
            self.assertEqual(0, driver.code(15), driver.words())
            self.assertIn(word, driver.words())
            self.assertEqual(0, services["get_state"]().state.step)

    def test_interrupted_while_a_call_has_no_response_it_ends_well(self):
        space = self.namespace
        for ship in (-1, 0):  # ShipDriver, AgentDriver
            with self.subTest(ship=ship):
                self.namespace = f"{space}_{ship + 1}"
                sim = start_sim(self, self.namespace, TINY)
                run = self.play("_mode:=act", "_policy:=random", f"_ship:={ship}", wait_s=60)
                run.wait_for(lambda: "episode 1" in run.words(), "an episode")
                sim.kill()
                time.sleep(4)  # AgentDriver repeats its command after 2 s without an observation
                run.send(signal.SIGINT)
                self.assertEqual(0, run.code(), run.words())

    def test_interrupted_while_driving_it_ends_well(self):
        start_sim(self, self.namespace, PAIR)
        run = self.drive("_policy:=random")
        run.wait_for(lambda: "episode 1" in run.words(), "an episode")
        run.send(signal.SIGINT)
        self.assertEqual(0, run.code(), run.words())

    def test_policies_that_do_not_fit_are_refused_with_the_reason(self):
        start_sim(self, self.namespace, PAIR)
        for parameters, words in (
                ((f"_policy:={self.trained()}",), "q_learning of scenario tiny does not fit scenario pair: width: the policy has 6"),
                (("_policy:=/no/such/folder",), "/no/such/folder"),
                ((f"_policy:={self.folder}",), "contains neither policy.ckpt nor a checkpoint"),
                ((f"_policy:={TINY}",), "not a checkpoint"),
                ((), "~policy: got nothing, expected a run folder"),
                (("_policy:=random", "_mode:=watch"), "expected evaluate or act"),
                (("_policy:=random", "_episodes:=0"), "~episodes: got 0, expected [1, 10000000]"),
                (("_policy:=random", "_mode:=act", "_ship:=2"), "~ship: got 2, expected -1")):
            with self.subTest(parameters=parameters):
                run = self.play(*parameters)
                self.assertEqual(2, run.code(), run.words())
                self.assertIn(words, run.words())

    def test_without_a_sim_node_it_says_so_and_ends(self):
        for mode in ("evaluate", "act"):
            run = self.play("_policy:=random", f"_mode:={mode}", wait_s=2)
            self.assertEqual(4, run.code(), run.words())
            self.assertIn(f"no response from service {self.namespace}/", run.words())


if __name__ == "__main__":
    rospy.init_node("policy_node_test")
    rostest.rosrun("aquafarm_agents", "policy_node", PolicyNodeTest, sys.argv)
