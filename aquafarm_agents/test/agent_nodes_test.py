#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One node per ship: the nodes solve a farm together, in lockstep and paced. If one dies, only its
ship holds until it rejoins. Each ship is claimed by one node."""
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest

import rosgraph
import rospy
import rostest
from aquafarm_msgs.msg import EpisodeSummary, FarmState, Outcome
from aquafarm_msgs.srv import Claim, GetState, LoadState, Pause, SaveState
from diagnostic_msgs.msg import DiagnosticArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import DATA, Program, SecondHost, free_port, program, start_sim  # noqa: E402

TEAM = DATA / "team.yaml"
WIDE = DATA / "wide.yaml"
HOLD = 10


class AgentNodesTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_agents_"))
        cls.addClassCleanup(lambda: __import__("shutil").rmtree(cls.folder))

    def setUp(self):
        self.namespace = "/" + self.id().rsplit(".", maxsplit=1)[-1]

    def trained(self):
        """Run folder of a policy that always solves the team's farm; trained once."""
        folder = self.folder / "trained"
        if not folder.exists():
            run = Program(self, program("aquafarm_agents", "aquafarm_train"), TEAM, "-a", "vdn",
                          "--steps", "40000", "--farms", "8", "--run-dir", folder, "--evaluate",
                          "100", "-o", "hidden_size=32", "-o", "batch_size=32", "-o",
                          "learning_starts=500", "-o", "buffer_size=5000", "-o",
                          "target_update_interval=50", "-o", "train_interval=4", "-o",
                          "learning_rate=linear:0.002:0.0001:1")
            self.assertEqual(0, run.code(), run.words())
            self.assertIn("success 100.0 %", run.words())
        return folder

    def sim(self, scenario, *parameters):
        self.ranch = start_sim(self, self.namespace, scenario, *parameters)
        self.get_state = rospy.ServiceProxy(f"{self.namespace}/get_state", GetState)
        self.get_state.wait_for_service(60)

    def agent(self, ship, policy, *parameters, name=None, before=()):
        return Program(self, *before, program("aquafarm_agents", "policy_node"),
                       f"__ns:={self.namespace}", f"__name:={name or f'agent_{ship}'}",
                       "_mode:=act", f"_ship:={ship}", f"_policy:={policy}", *parameters)

    def is_seen_by(self, name):
        """True if a node has subscribed to an observation, which it does after the claim."""
        subscribers = rosgraph.Master("/test").getSystemState()[1]
        return any(topic.startswith(self.namespace) and topic.endswith("/observation")
                   and f"{self.namespace}/{name}" in nodes for topic, nodes in subscribers)

    def call(self, name, kind, **fields):
        """Calls a service of the ranch; a rejected request fails the test."""
        answer = rospy.ServiceProxy(f"{self.namespace}/{name}", kind)(**fields)
        self.assertTrue(answer.ok, answer.message)
        return answer

    def state(self):
        return self.get_state().state

    def wait_until(self, condition, what, limit_s=60):
        end = time.monotonic() + limit_s
        while not condition(self.state()):
            self.assertLess(time.monotonic(), end, f"timed out waiting for {what}")
            time.sleep(0.02)

    def expect_solved(self, runs, episodes):
        for run in runs:
            self.assertEqual(0, run.code(), run.words())
            self.assertIn(f"{episodes} of {episodes} episodes ended with every device delivered",
                          run.words())

    def test_they_solve_a_farm_step_by_step(self):
        self.sim(TEAM)
        policy = self.trained()
        self.expect_solved([self.agent(ship, policy, "_episodes:=5") for ship in (0, 1)], 5)

    def test_a_policy_that_does_nothing_holds(self):
        self.sim(TEAM)
        for ship in (0, 1):
            self.agent(ship, "do_nothing")
        self.wait_until(lambda state: state.step > 5, "both ships at work")
        state = self.state()
        self.assertEqual([HOLD, HOLD], [ship.action for ship in state.ships])
        self.assertEqual([Outcome.HELD] * 2, [ship.outcome for ship in state.ships])

    def test_only_the_node_of_ship_0_publishes_values(self):
        self.sim(TEAM)
        policy = self.trained()
        agents = [self.agent(ship, policy) for ship in (0, 1)]
        for ship, run in enumerate(agents):
            run.wait_for(lambda ship=ship: self.is_seen_by(f"agent_{ship}"), "its ship")
        self.wait_until(lambda state: state.step > 5, "both ships at work")
        publishers = dict(rosgraph.Master("/test").getSystemState()[0])
        for topic in ("values", "values/points"):
            self.assertEqual([f"{self.namespace}/agent_0"],
                             publishers.get(f"{self.namespace}/{topic}"))

    def play_paced(self, policy, rate_hz):
        """Two agents play two episodes of a farm that does not wait. Returns the summaries, and the
        steps in which a ship held because its command was late."""
        self.namespace = f"{self.namespace.partition('_at_')[0]}_at_{rate_hz}"
        self.sim(TEAM, "_pace:=paced", f"_rate_hz:={rate_hz}", "_record:=true")
        states, summaries = [], []
        rospy.Subscriber(f"{self.namespace}/state", FarmState, states.append)
        rospy.Subscriber(f"{self.namespace}/episode", EpisodeSummary, summaries.append)
        runs = [self.agent(ship, policy) for ship in (0, 1)]
        for ship, run in enumerate(runs):
            run.wait_for(lambda ship=ship: self.is_seen_by(f"agent_{ship}"), "its ship")
        first = self.state().episode + 1  # both drive from its start
        self.wait_until(lambda state: state.episode > first + 1, "two episodes", 200)
        for run in runs:
            self.assertIsNone(run.process.poll(), run.words())
            run.interrupt()
        late = [(one.episode, one.step) for one in states if first <= one.episode <= first + 1 and
                one.step > 0 and any(ship.action == HOLD for ship in one.ships)]
        return [one for one in summaries if first <= one.episode <= first + 1], late

    def test_they_solve_a_farm_that_does_not_wait(self):
        policy = self.trained()
        for rate_hz in (20, 5, 2):  # a command may take longer than 50 ms on a busy machine
            summaries, late = self.play_paced(policy, rate_hz)
            self.assertEqual(2, len(summaries))
            if all(one.success for one in summaries):
                return
            self.assertTrue(late, f"not solved without a late command: {summaries}")
        self.fail(f"late commands at 2 Hz as well: episodes and steps {late}")

    def test_an_agent_may_live_at_another_address(self):
        self.sim(TEAM)
        policy = self.trained()
        runs = [self.agent(0, policy, "_episodes:=3"),
                self.agent(1, policy, "_episodes:=3", before=("env", "ROS_IP=127.0.0.2"))]
        self.expect_solved(runs, 3)

    def test_an_agent_may_live_on_another_host(self):
        host = SecondHost(self)
        policy = self.trained()
        port = free_port()
        here = host.environment(port, inside=False)
        Program(self, *here, "rosmaster", "--core", "-p", port, "__log:=/dev/null")
        Program(self, *here, program("aquafarm_sim", "sim_node"), f"__ns:={self.namespace}",
                "__name:=sim", f"_scenario:={TEAM}", "_publish_clock:=false")
        self.expect_solved([self.agent(0, policy, "_episodes:=3", before=here),
                            self.agent(1, policy, "_episodes:=3",
                                       before=host.environment(port, inside=True))], 3)

    def die_and_join_again(self, *parameters, warning=""):
        """Kills one of two ships, waits for the warning, if any, and lets the ship join again."""
        self.sim(WIDE, *parameters)
        self.agent(0, "random")
        victim = self.agent(1, "random")
        self.wait_until(lambda state: state.step > 20 and state.ships[1].action != HOLD,
                        "both ships at work")
        before = len(self.ranch.words())
        victim.send(signal.SIGKILL)
        self.wait_until(lambda state: state.ships[1].action == HOLD, "the ship to hold")
        died = self.state()
        self.wait_until(lambda state: state.step > died.step + 20 and state.ships[0].action != HOLD,
                        "the farm to continue, and the other ship with it")
        on = self.state()
        self.assertEqual(HOLD, on.ships[1].action)
        self.assertEqual(died.ships[1].x, on.ships[1].x)
        self.assertEqual(died.ships[1].y, on.ships[1].y)
        self.ranch.wait_for(lambda: warning in self.ranch.words()[before:], "the warning")
        self.agent(1, "random")
        self.wait_until(lambda state: state.ships[1].action != HOLD, "the ship to move again")
        self.assertEqual(on.episode, self.state().episode)
        return lambda: self.ranch.words()[before:]

    def test_one_that_dies_holds_its_ship_only_and_joins_again(self):
        told = []
        rospy.Subscriber("/diagnostics", DiagnosticArray,
                         lambda array: told.append(array.status[0].message))
        words = self.die_and_join_again("_late_ships_hold:=true", "_barrier_timeout_s:=0.5",
                                        warning="no command from ship 1")
        self.ranch.wait_for(lambda: "late ship 1 sends commands again" in words(),
                            "a word of its return")
        self.assertEqual(1, words().count(
            "no command from ship 1 within ~barrier_timeout_s, 0.5 s; it holds until its next "
            "command"))
        expected = {"late ships that the farm does not wait for until their next command: 1",
                    "late ships that have returned: 1"}
        self.ranch.wait_for(lambda: expected.intersection(told), "a diagnosis of its absence")

    def test_one_that_dies_holds_its_ship_only_and_joins_again_when_paced(self):
        self.die_and_join_again("_pace:=paced", "_rate_hz:=50")

    def be_late_and_back(self, *parameters):
        self.sim(WIDE, *parameters)
        self.agent(0, "random")
        late = self.agent(1, "random")
        self.wait_until(lambda state: state.step > 20, "both ships at work")
        late.send(signal.SIGSTOP)
        self.wait_until(lambda state: state.ships[1].action == HOLD, "the ship to hold")
        step = self.state().step
        self.wait_until(lambda state: state.step > step + 20 and state.ships[0].action != HOLD,
                        "the farm to continue, and the other ship with it")
        self.assertEqual(HOLD, self.state().ships[1].action)
        late.send(signal.SIGCONT)
        self.wait_until(lambda state: state.ships[1].action != HOLD, "the ship to move again")

    def test_one_that_is_late_holds_its_ship_until_it_is_back(self):
        self.be_late_and_back("_late_ships_hold:=true", "_barrier_timeout_s:=0.5")

    def test_one_that_is_late_holds_its_ship_until_it_is_back_when_paced(self):
        self.be_late_and_back("_pace:=paced", "_rate_hz:=50")

    def test_an_episode_that_is_played_again_and_ends_again_is_followed_by_the_next(self):
        self.sim(TEAM, "_seed:=7")
        agents = [self.agent(ship, "random") for ship in (0, 1)]
        self.wait_until(lambda state: state.episode > 0, "an episode to end")
        self.call("pause", Pause, paused=True)
        saved, state = self.call("save_state", SaveState), self.state()
        self.call("pause", Pause, paused=True, steps=60 - state.step + 10)
        self.wait_until(lambda now: now.paused and now.episode == state.episode + 1,
                        "a pause in the next episode")
        self.call("load_state", LoadState, data=saved.data)
        self.call("pause", Pause, paused=False)
        self.wait_until(lambda now: now.episode > state.episode + 1, "the episodes after it")
        for run in agents:
            self.assertIsNone(run.process.poll(), run.words())

    def test_one_that_waits_for_the_others_waits_as_long_as_the_farm_does(self):
        self.sim(WIDE, "_barrier_timeout_s:=3600")
        first = self.agent(0, "random", "_sim_timeout_s:=1")
        first.wait_for(lambda: self.is_seen_by("agent_0"), "its ship")
        time.sleep(32)  # longer than the limit of other calls
        self.assertIsNone(first.process.poll(), first.words())
        self.agent(1, "random")
        self.wait_until(lambda state: state.step > 20, "both ships at work")

    def test_a_barrier_timeout_is_reported_while_the_farms_clock_stands_still(self):
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        self.sim(WIDE, "_barrier_timeout_s:=0.2")
        run = self.agent(0, "random")
        run.wait_for(lambda: "ship 0: barrier timed out: no command from other ships within" in run.words(),
                     "a warning")

    def test_a_ship_of_a_policy_on_whole_farms_is_held_until_its_node_ends(self):
        self.sim(WIDE, "_pace:=paced", "_rate_hz:=0.02", "_claim_timeout_s:=5")
        rospy.wait_for_service(f"{self.namespace}/ship_1/claim", 60)
        claim = rospy.ServiceProxy(f"{self.namespace}/ship_1/claim", Claim)
        run = self.agent(1, "planner")
        run.wait_for(lambda: claim(release=True).holder == f"{self.namespace}/agent_1", "its ship")
        time.sleep(7)  # it sends no commands
        self.assertEqual(f"{self.namespace}/agent_1", claim(release=False).holder)
        run.interrupt()
        self.assertTrue(claim(release=False).ok, "it gave the ship back")

    def test_a_ship_that_another_holds_is_refused(self):
        self.sim(WIDE, "_barrier_timeout_s:=3600")
        first = self.agent(1, "random")
        first.wait_for(lambda: self.is_seen_by("agent_1"), "its ship")
        before = self.state().hash
        second = self.agent(1, "random", name="other")
        self.assertEqual(2, second.code(), second.words())
        self.assertIn(f"~ship: ship 1 is held by {self.namespace}/agent_1", second.words())
        self.assertEqual(before, self.state().hash)

    def test_a_second_node_of_the_same_name_is_refused(self):
        self.sim(WIDE, "_barrier_timeout_s:=3600")
        self.agent(0, "random")
        first = self.agent(1, "random")
        self.wait_until(lambda state: state.step > 5, "both ships at work")
        second = self.agent(1, "random")
        self.assertEqual(2, second.code(), second.words())
        self.assertIn(f"node {self.namespace}/agent_1 is already running at http://", second.words())
        step = self.state().step
        self.wait_until(lambda state: state.step > step + 20, "the first to drive on")
        first.send(signal.SIGKILL)  # its stale registration must not block the next node
        first.process.wait(20)
        step = self.state().step
        self.agent(1, "random")
        self.wait_until(lambda state: state.step > step + 5, "the one after it to drive on")

    def test_a_policy_for_another_number_of_ships_is_refused(self):
        self.sim("four_squads")
        self.call("ship_0/claim", Claim)  # a policy that does not fit must not claim it
        before = self.state().hash
        run = self.agent(0, self.trained())
        self.assertEqual(2, run.code(), run.words())
        self.assertIn("vdn of scenario team does not fit scenario four_squads: agents: the policy has 2, "
                      "the farm has 4", run.words())
        self.assertEqual(before, self.state().hash)

    def test_without_a_sim_node_it_says_so_and_ends(self):
        run = self.agent(0, "random", "_sim_timeout_s:=2")
        self.assertEqual(4, run.code(), run.words())
        self.assertIn(f"no response from service {self.namespace}/get_state", run.words())


if __name__ == "__main__":
    rospy.init_node("agent_nodes_test")
    rostest.rosrun("aquafarm_agents", "agent_nodes", AgentNodesTest, sys.argv)
