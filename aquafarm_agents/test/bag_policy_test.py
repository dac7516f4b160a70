#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Queries saved policies at the states of a bag: agreement, values, and clear error messages."""
import pathlib
import re
import shutil
import struct
import sys
import tempfile
import unittest

import rosbag
import rostest
from aquafarm_msgs.msg import PolicyChoice

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from processes import DATA, Program, program  # noqa: E402

TINY = DATA / "tiny.yaml"
PAIR = DATA / "pair.yaml"


class BagPolicyTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_bag_policy_"))
        cls.addClassCleanup(lambda: shutil.rmtree(cls.folder))

    def run_well(self, *command):
        run = Program(self, *command)
        self.assertEqual(0, run.code(), run.words())
        return run.words()

    def trained(self, scenario=TINY):
        """Run folder of a trained policy, which solves the tiny farm; trained once."""
        folder = self.folder / f"trained_{scenario.stem}"
        if not folder.exists():
            self.run_well(program("aquafarm_agents", "aquafarm_train"), scenario, "--steps",
                          "200000", "--run-dir", folder)
        return folder

    def bag_of(self, policy, scenario):
        """A bag of an episode played by a policy; made once."""
        bag = self.folder / f"{pathlib.Path(str(policy)).name}_{scenario.stem}.bag"
        if not bag.exists():
            route = bag.with_suffix(".json")
            self.run_well(program("aquafarm_agents", "aquafarm_evaluate"), policy, scenario,
                          "--episodes", "1", "--route", route)
            self.run_well(program("aquafarm_sim", "episode_bag"), scenario, route, "-o", bag)
        return bag

    def changed(self, bag, change):
        """A copy of a bag; change(topic, message) returns the message to write, or None to skip."""
        path = self.folder / "changed.bag"
        with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(path), "w") as copy:
            for topic, message, time in source.read_messages():
                message = change(topic, message)
                if message is not None:
                    copy.write(topic, message, time)
        return path

    def ask(self, *arguments):
        return Program(self, program("aquafarm_agents", "bag_policy"), *arguments)

    def refused(self, words, code, *arguments):
        run = self.ask(*arguments)
        self.assertEqual(code, run.code(), run.words())
        self.assertIn(words, run.words())

    def test_the_policy_that_played_agrees_with_itself_and_others_do_not(self):
        bag = self.bag_of(self.trained(), TINY)
        words = self.run_well(program("aquafarm_agents", "bag_policy"), bag, self.trained())
        agreed, choices = map(int, re.search(r"(\d+) of (\d+) choices agree", words).groups())
        self.assertEqual(choices, agreed, words)
        self.assertGreater(choices, 2)
        row = words.splitlines()[1].split()
        self.assertEqual("100.0", row[3], words)
        self.assertGreater(float(row[5]), 20.0, words)  # expected return at the start
        words = self.run_well(program("aquafarm_agents", "bag_policy"), bag, "random")
        agreed, choices = map(int, re.search(r"(\d+) of (\d+) choices agree", words).groups())
        self.assertLess(agreed, choices, words)
        self.assertEqual("-", words.splitlines()[1].split()[5])  # RANDOM has no values

    def test_a_policy_with_whole_farms_is_asked_too(self):
        words = self.run_well(program("aquafarm_agents", "bag_policy"),
                              self.bag_of("clairvoyant", TINY), "clairvoyant")
        self.assertIn(" 100.0 % ", words)

    def test_several_ships_are_asked_each(self):
        bag = self.bag_of("random", PAIR)
        words = self.run_well(program("aquafarm_agents", "bag_policy"), bag, "random")
        steps = int(words.splitlines()[1].split()[2])
        self.assertIn(f"of {2 * steps} choices", words)

    def test_each_of_several_agents_is_asked_what_it_would_do_itself(self):
        policy, out = self.trained(PAIR), self.folder / "pair_asked.bag"
        bag = self.bag_of(policy, PAIR)
        words = self.run_well(program("aquafarm_agents", "bag_policy"), bag, policy, "-o", out)
        agreed, choices = map(int, re.search(r"(\d+) of (\d+) choices agree", words).groups())
        self.assertEqual((choices, 0), (agreed, choices % 2), words)
        with rosbag.Bag(str(out)) as asked:
            told = [m for _, m, _ in asked.read_messages("/aquafarm/choice")]
            done = [[ship.action for ship in m.ships]
                    for _, m, _ in asked.read_messages("/aquafarm/state")]
        self.assertEqual(done[1:], [list(choice.actions) for choice in told])
        self.assertTrue(any(first != second for first, second in done[1:]))  # ships differ
        self.assertEqual({2}, {len(choice.values) for choice in told})

    def test_the_bag_that_is_written_holds_all_of_the_old_one_and_what_it_would_do(self):
        bag, out = self.bag_of("clairvoyant", TINY), self.folder / "asked.bag"
        self.run_well(program("aquafarm_agents", "bag_policy"), bag, self.trained(), "-o", out,
                      "--values-every", "2")
        self.assertFalse(list(self.folder.glob("*.active")))
        with rosbag.Bag(str(bag)) as old, rosbag.Bag(str(out)) as new:
            before = old.get_type_and_topic_info().topics
            after = new.get_type_and_topic_info().topics
            for topic, info in before.items():
                self.assertEqual(info.message_count, after[topic].message_count, topic)
            states = [m for _, m, _ in new.read_messages("/aquafarm/state")]
            choices = [m for _, m, _ in new.read_messages("/aquafarm/choice")]
            grids = [m for _, m, _ in new.read_messages("/aquafarm/values")]
            clouds = [m for _, m, _ in new.read_messages("/aquafarm/values/points")]
            order = [topic for topic, _, _ in new.read_messages(
                ["/aquafarm/state", "/aquafarm/choice"])]
        self.assertEqual(list(range(len(states) - 1)), [choice.step for choice in choices])
        self.assertEqual({"q_learning"}, {choice.policy for choice in choices})
        self.assertEqual("/aquafarm/choice", order[0])  # available when its state is shown
        self.assertEqual((len(states)) // 2, len(clouds))
        self.assertEqual((0, 100), (min(v for v in grids[0].data if v >= 0), max(grids[0].data)))
        self.assertIn(-1, grids[0].data)  # rocks and islands have no value
        cloud = clouds[0]
        self.assertEqual(["x", "y", "z", "value", "action"], [f.name for f in cloud.fields])
        points = [struct.unpack_from("<4fB", cloud.data, i * cloud.point_step)
                  for i in range(cloud.width * cloud.height)]
        ship = states[0].ships[0]
        here = [p for p in points if (p[0], p[1]) == (ship.x * 1000.0, ship.y * 1000.0)]
        self.assertEqual(1, len(here))
        self.assertAlmostEqual(choices[0].values[0], here[0][3], places=4)
        self.assertEqual(choices[0].actions[0], here[0][4])
        self.run_well(program("aquafarm_sim", "verify_bag"), out)

    def test_states_that_are_not_what_the_actions_give_are_no_ground_to_judge_on(self):
        bag = self.bag_of("clairvoyant", TINY)

        def other_action(topic, message):
            if topic.endswith("/state") and message.step == 2:
                message.ships[0].action = (message.ships[0].action + 1) % 8
            return message

        run = self.ask(self.changed(bag, other_action), self.trained(), "-o",
                       self.folder / "never.bag")
        self.assertEqual(1, run.code(), run.words())
        self.assertRegex(run.words(), r"differs: episode 0 step 2: state.hash: got \d+, simulated")
        self.assertFalse(list(self.folder.glob("never*")))
        without = self.changed(bag, lambda topic, message: None if topic.endswith(
            "/state") and message.step == 2 else message)
        self.refused("differs: episode 0 step 3: step 2 is missing", 1, without, self.trained())
        without = self.changed(bag, lambda topic, message: None if topic.endswith(
            "/state") and message.step == 0 else message)
        run = self.ask(without, self.trained())
        self.assertEqual(1, run.code(), run.words())
        self.assertIn("differs: episode 0 step 1: step 0 is missing", run.words())
        self.assertNotIn("choices agree", run.words())  # nothing was compared

    def test_what_cannot_be_asked_has_its_line(self):
        bag, policy = self.bag_of("clairvoyant", TINY), self.trained()
        self.refused("q_learning of scenario tiny does not fit scenario pair: width: the policy has 6", 2,
                     self.bag_of("random", PAIR), policy)
        self.refused("/no/such/folder", 2, bag, "/no/such/folder")
        self.refused("damaged or not a bag", 2, TINY, policy)
        self.refused("/nowhere/x.bag: no such file", 2, "/nowhere/x.bag", policy)
        data = bytearray(bag.read_bytes())
        place = data.index(b"ver=\x01\0\0\0") + 8 + 4 + 8  # of an index's first entry
        data[place:place + 4] = struct.pack("<I", 0x7ffffff0)
        damaged = self.folder / "damaged.bag"
        damaged.write_bytes(data)
        self.refused(f"bag_policy: {damaged}: damaged: an index that does not match its chunk", 2,
                     damaged, policy)
        self.refused("no topic spec, so it is unknown what was played", 2, self.changed(
            bag, lambda topic, message: None if topic.endswith("/spec") else message), policy)

        def with_spec(field, value):
            def change(topic, message):
                if topic.endswith("/spec"):
                    setattr(message, field, value)
                return message
            return self.changed(bag, change)

        self.refused("recorded by version 0.0.9, this is ", 2, with_spec("version", "0.0.9"),
                     policy)
        self.refused(": recorded by an unnamed version, this is ", 2, with_spec("version", ""),
                     policy)
        self.refused("changed.bag: spec.scenario_yaml:", 2, with_spec("scenario_yaml", "name: {"),
                     policy)
        self.refused("changed.bag: topic /aquafarm/spec: got type aquafarm_msgs/PolicyChoice, "
                     "expected aquafarm_msgs/FarmSpec; ", 2, self.changed(
                         bag, lambda topic, message: PolicyChoice() if topic.endswith("/spec")
                         else message), policy)
        self.refused("got no episode with a spec and states", 2, self.changed(
            bag, lambda topic, message: None if topic.endswith("/state") else message), policy)
        self.refused("no ranch /other/, there is: /aquafarm/", 2, bag, policy, "--ns", "/other")
        self.refused("is the input bag, expected another file", 2, bag, policy, "-o", bag)
        self.refused("/nowhere/x.bag.active", 3, bag, policy, "-o", "/nowhere/x.bag")


if __name__ == "__main__":
    rostest.rosrun("aquafarm_agents", "bag_policy", BagPolicyTest, sys.argv)
