#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Training through ROS: bit-identity with training in process, kills, losses and rejected input."""
import os
import pathlib
import signal
import sys
import tempfile
import unittest
import unittest.mock

import rospy
import rostest
from aquafarm_msgs.msg import TrainingStatus
from aquafarm_msgs.srv import Claim
from sensor_msgs.msg import PointCloud2

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import (DATA, Program, free_port, newest_checkpoint, program,  # noqa: E402
                       start_agent, start_sim)

TINY = DATA / "tiny.yaml"
BUSY_S = 240.0  # limit of a training on a busy machine
PPO = "hidden_size=16 rollout_size=512 batch_size=128"
# No schedules: the limit of steps changes nothing.
CONSTANT = "learning_rate=0.001 clip_range=0.2 teacher=0"
CONSTANT_EXPLORATION = "entropy:0.01"


def newest_step(run):
    """The step of the newest checkpoint in a run folder."""
    return int(newest_checkpoint(run)[len("step_"):-len(".ckpt")])


def as_arguments(options):
    """Options of a learner, separated by spaces, as arguments of aquafarm_train."""
    return [word for one in options.split() for word in ("--set", one)]


class TrainNodeTest(unittest.TestCase):

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="aquafarm_train_")
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)
        self.namespace = "/" + self.id().rsplit(".", maxsplit=1)[-1]

    def train(self, run, *parameters, wait_s=10):
        return start_agent(self, "train_node", self.namespace, f"_run_dir:={self.folder / run}",
                           "_evaluation_episodes:=50", "_random_episodes:=10",
                           f"_sim_timeout_s:={wait_s}", *parameters)

    def in_process(self, run, *arguments):
        return Program(self, program("aquafarm_agents", "aquafarm_train"), TINY, "--run-dir",
                       self.folder / run, "--evaluate", "50", "--random", "10", *arguments)

    def assert_same_files(self, a, b, names):
        for name in names:
            self.assertEqual((self.folder / a / name).read_bytes(),
                             (self.folder / b / name).read_bytes(), name)

    def test_a_training_is_that_of_the_same_seed_in_process(self):
        start_sim(self, self.namespace, TINY)
        for algorithm in ("q_learning", "sarsa"):
            ros = self.train(f"{algorithm}_ros", f"_algorithm:={algorithm}", "_steps:=60000",
                             "_farms:=8", "_seed:=3")
            self.assertEqual(0, ros.code(), ros.words())
            local = self.in_process(f"{algorithm}_local", "--algorithm", algorithm, "--steps",
                                    "60000", "--farms", "8", "--seed", "3")
            self.assertEqual(0, local.code(), local.words())
            self.assert_same_files(
                f"{algorithm}_ros", f"{algorithm}_local",
                ["policy.ckpt", "metrics.csv", "scenario.yaml", "evaluation.csv",
                 "evaluation_random.csv"])
            self.assertIn("success 100.0 %", ros.words())

    def test_the_planner_teaches_as_in_process(self):
        start_sim(self, self.namespace, TINY)
        options = f"{PPO} teacher=4 teacher_policy=planner teacher_interval=4"
        ros = self.train("ros", "_algorithm:=ppo", "_steps:=4000", "_farms:=8", "_seed:=3",
                         f"_options:={options}")
        self.assertEqual(0, ros.code(BUSY_S), ros.words())
        local = self.in_process("local", "--algorithm", "ppo", "--steps", "4000", "--farms", "8",
                                "--seed", "3", *as_arguments(options))
        self.assertEqual(0, local.code(BUSY_S), local.words())
        self.assert_same_files("ros", "local", ["policy.ckpt", "metrics.csv", "evaluation.csv"])

    def ranks(self, run, *parameters):
        """Starts two ranks. Each has the sim node of its own namespace."""
        port, started = str(free_port()), []
        for rank in range(2):
            variables = {"RANK": str(rank), "WORLD_SIZE": "2", "MASTER_PORT": port,
                         "OMP_NUM_THREADS": "1"}
            with unittest.mock.patch.dict(os.environ, variables):
                started.append(start_agent(
                    self, "train_node", f"{self.namespace}/rank_{rank}",
                    f"_run_dir:={self.folder / run}", "_algorithm:=ppo", "_farms:=16",
                    "_evaluation_episodes:=50", "_random_episodes:=10", "_rank_start_s:=120",
                    "_rank_answer_s:=120", *parameters))
        return started

    def start_sims(self):
        for rank in range(2):
            start_sim(self, f"{self.namespace}/rank_{rank}", TINY)

    def test_ranks_with_sim_nodes_of_their_own_train_as_in_process(self):
        self.start_sims()
        first, second = self.ranks("ros", "_steps:=20000", "_seed:=3", f"_options:={PPO}")
        self.assertEqual(0, first.code(BUSY_S), first.words() + second.words())
        self.assertEqual(0, second.code(BUSY_S), second.words())
        self.assertIn("ranks      2, ", first.words())
        self.assertNotIn("trained", second.words())
        for ranks in ("1", "2"):
            local = self.in_process(f"local_{ranks}", "--algorithm", "ppo", "--steps", "20000",
                                    "--farms", "16", "--seed", "3", "--ranks", ranks,
                                    *as_arguments(PPO))
            self.assertEqual(0, local.code(BUSY_S), local.words())
            newest = newest_checkpoint(self.folder / "ros")
            self.assert_same_files(
                "ros", f"local_{ranks}",
                ["policy.ckpt", "metrics.csv", "scenario.yaml", "evaluation.csv",
                 "evaluation_random.csv", f"checkpoints/{newest}"])

    def test_a_killed_rank_ends_the_other_and_both_resume_in_the_same_bits(self):
        self.start_sims()
        options = (f"_options:={PPO} {CONSTANT}", f"_exploration:={CONSTANT_EXPLORATION}")
        first, second = self.ranks("parts", "_steps:=1e12", "_checkpoint_period_s:=0", *options)
        first.wait_for(lambda: newest_checkpoint(self.folder / "parts"), "a checkpoint",
                       BUSY_S)
        second.send(signal.SIGKILL)
        self.assertEqual(6, first.code(BUSY_S), first.words())
        self.assertIn("ranks: rank 1 of 2 has ended or does not answer", first.words())
        self.assertRegex(first.words(), "resume     roslaunch aquafarm_bringup ranks.launch .*"
                                        f" resume:=true run_dir:={self.folder / 'parts'} ranks:=2")
        limit = 10000 + newest_step(self.folder / "parts")
        first, second = self.ranks("parts", f"_steps:={limit}", "_resume:=true", *options)
        self.assertEqual(0, first.code(BUSY_S), first.words() + second.words())
        self.assertIn("resuming from", first.words())
        whole = self.in_process("whole", "--algorithm", "ppo", "--steps", str(limit), "--farms",
                                "16", "--ranks", "1", "--exploration", CONSTANT_EXPLORATION,
                                *as_arguments(f"{PPO} {CONSTANT}"))
        self.assertEqual(0, whole.code(BUSY_S), whole.words())
        newest = newest_checkpoint(self.folder / "whole")
        self.assert_same_files("whole", "parts",
                               ["policy.ckpt", "metrics.csv", f"checkpoints/{newest}"])

    def test_subscribers_of_its_values_change_no_bit(self):
        start_sim(self, self.namespace, TINY)
        constant = "learning_rate=0.0005"  # no schedules, as CONSTANT
        for algorithm, chosen in (("q_learning", constant),
                                  ("dqn", f"{constant} priority_exponent=0")):
            run, clouds = f"{algorithm}_watched", []
            options = (f"_algorithm:={algorithm}", "_farms:=8", f"_options:={chosen}",
                       "_exploration:=epsilon_greedy:0.1")
            subscriber = rospy.Subscriber(f"{self.namespace}/values/points", PointCloud2,
                                          clouds.append)
            watched = self.train(run, "_steps:=1e12", "_values_period_s:=0.1", *options)
            watched.wait_for(lambda found=clouds: len(found) > 1, "two clouds of values", BUSY_S)
            watched.interrupt(BUSY_S)
            subscriber.unregister()
            limit = 1000 + newest_step(self.folder / run)
            rest = self.train(run, f"_steps:={limit}", "_resume:=true", *options)
            self.assertEqual(0, rest.code(BUSY_S), rest.words())
            local = self.in_process(f"{algorithm}_alone", "--algorithm", algorithm, "--steps",
                                    str(limit), "--farms", "8", "--exploration",
                                    "epsilon_greedy:0.1", *as_arguments(chosen))
            self.assertEqual(0, local.code(BUSY_S), local.words())
            newest = newest_checkpoint(self.folder / f"{algorithm}_alone")
            self.assert_same_files(run, f"{algorithm}_alone",
                                   ["policy.ckpt", f"checkpoints/{newest}"])

    def test_killed_and_resumed_it_ends_in_the_same_bits(self):
        start_sim(self, self.namespace, TINY)
        parameters = ("_steps:=150000", "_farms:=8", "_checkpoint_period_s:=0.05")
        whole = self.train("whole", *parameters)
        self.assertEqual(0, whole.code(), whole.words())
        for resume in ("false", "true"):
            before = newest_checkpoint(self.folder / "parts")
            part = self.train("parts", *parameters, f"_resume:={resume}")
            part.wait_for(lambda b=before: newest_checkpoint(self.folder / "parts") != b,
                          "a checkpoint")
            part.send(signal.SIGKILL)
            self.assertEqual(-signal.SIGKILL, part.code())
        rest = self.train("parts", *parameters, "_resume:=true")
        self.assertEqual(0, rest.code(), rest.words())
        self.assertIn("resuming from", rest.words())
        newest = newest_checkpoint(self.folder / "whole")
        self.assert_same_files("whole", "parts",
                               ["policy.ckpt", "metrics.csv", f"checkpoints/{newest}"])

    def test_a_frozen_sim_node_ends_the_training_after_its_limits(self):
        sim = start_sim(self, self.namespace, TINY)
        run = self.train("run", "_steps:=1e9", "_checkpoint_period_s:=0.05", "_call_limit_s:=1",
                         wait_s=2)
        run.wait_for(lambda: newest_checkpoint(self.folder / "run"), "a checkpoint")
        sim.send(signal.SIGSTOP)
        self.assertEqual(4, run.code(), run.words())
        self.assertIn("the sim node is gone; waiting up to 2 s", run.words())
        self.assertIn(f"saved in {self.folder / 'run'}", run.words())

    def test_a_training_continues_with_a_sim_node_that_returns(self):
        sim = start_sim(self, self.namespace, TINY)
        run = self.train("run", "_steps:=200000", "_farms:=8")
        metrics = self.folder / "run" / "metrics.csv"
        run.wait_for(lambda: metrics.exists() and metrics.stat().st_size > 4096, "episodes")
        sim.send(signal.SIGKILL)
        sim.process.wait()
        run.wait_for(lambda: "the sim node is gone" in run.words(), "a word of the loss")
        start_sim(self, self.namespace, TINY)
        self.assertEqual(0, run.code(), run.words())
        self.assertIn("continuing with new episodes", run.words())
        lines = metrics.read_text().splitlines()
        column = lines[0].split(",").index("episode")
        episodes = [int(line.split(",")[column]) for line in lines[1:]]
        self.assertEqual(len(episodes), len(set(episodes)), "an episode was trained on twice")

    def test_it_waits_while_a_ship_is_held_by_another(self):
        start_sim(self, self.namespace, TINY, "_claim_timeout_s:=3600")
        rospy.wait_for_service(f"{self.namespace}/ship_0/claim", 60)
        claim = rospy.ServiceProxy(f"{self.namespace}/ship_0/claim", Claim)
        self.assertTrue(claim(release=False).ok)
        run = self.train("run", "_steps:=1000")
        words = f"for the sim node: ship 0 is held by {rospy.get_name()}"
        run.wait_for(lambda: words in run.words(), "a word of the holder")
        self.assertTrue(claim(release=True).ok)
        self.assertEqual(0, run.code(), run.words())

    def test_status_goes_to_a_topic(self):
        start_sim(self, self.namespace, TINY)
        statuses = []
        rospy.Subscriber(f"{self.namespace}/training", TrainingStatus, statuses.append)
        run = self.train("run", "_steps:=200000", "_farms:=8")
        self.assertEqual(0, run.code(), run.words())
        phases = [status.phase for status in statuses]
        self.assertIn(TrainingStatus.TRAINING, phases)
        self.assertEqual(TrainingStatus.DONE, phases[-1])
        last = statuses[-1]
        self.assertTrue(200000 <= last.steps < 400000, last.steps)
        self.assertEqual(str(self.folder / "run"), last.run_dir)
        self.assertGreaterEqual(last.evaluation_success, 0.99)

    def test_auto_asks_the_farm_who_decides_and_says_what_it_chose(self):
        start_sim(self, self.namespace, TINY)
        run = self.train("run", "_algorithm:=auto", "_steps:=200", "_options:=hidden_size=8")
        self.assertEqual(0, run.code(), run.words())
        self.assertIn("auto: one rescue squad decides, so a single-agent learner: lstm_dqn",
                      run.words())
        self.assertIn('"algorithm": "lstm_dqn"', (self.folder / "run/run.json").read_text())

    def test_a_run_folder_in_use_is_refused(self):
        start_sim(self, self.namespace, TINY)
        first = self.train("run", "_steps:=1e9", "_checkpoint_period_s:=0.05")
        first.wait_for(lambda: newest_checkpoint(self.folder / "run"), "a checkpoint")
        second = self.train("run", "_resume:=true")
        self.assertEqual(3, second.code(), second.words())
        self.assertIn(f"is in use by another training (process {first.process.pid})",
                      second.words())
        first.send(signal.SIGINT)
        self.assertEqual(130, first.code(), first.words())

    def test_arguments_are_refused_with_what_is_allowed(self):
        for argument, words in (
                ("_algorithm:=dqm",
                 "algorithm: got 'dqm' (did you mean 'dqn'?), expected one of: random, q_learning"),
                ("_episodes:=-1", "~episodes: got -1, expected [0, 2147483647]"),
                ("_seed:=1.5", "~seed: got 1.5, expected a whole number"),
                ("_episodes:=many", "~episodes: got another type, expected a whole number"),
                ("_epsiodes:=5", "~epsiodes: unknown parameter (did you mean 'episodes'?), expected one of: "),
                ("_exploration:=greedy", "exploration: got 'greedy'"),
                ("_options:=discuont=0.9", "discuont"),
                ("_options:=gamma=1.5", "gamma: got 1.5, expected [0, 1]")):
            with self.subTest(argument=argument):
                run = self.train("run", argument)
                self.assertEqual(2, run.code(), run.words())
                self.assertIn(words, run.words())

    def test_ranks_that_cannot_train_are_refused(self):
        for parameters, words in (
                ((), "WORLD_SIZE: got 2 with algorithm q_learning, which learns in one process"),
                (("_algorithm:=ppo",), "~farms: got 0 with 2 ranks, expected the number of farms")):
            with unittest.mock.patch.dict(os.environ, {"RANK": "1", "WORLD_SIZE": "2"}):
                run = self.train("run", *parameters)
            self.assertEqual(2, run.code(), run.words())
            self.assertIn(words, run.words())

    def test_a_second_node_of_the_same_name_is_refused(self):
        start_sim(self, self.namespace, TINY)
        first = self.train("run", "_steps:=1e9", "_checkpoint_period_s:=0.05", "__name:=twin")
        first.wait_for(lambda: newest_checkpoint(self.folder / "run"), "a checkpoint")
        second = self.train("other", "__name:=twin")
        self.assertEqual(2, second.code(), second.words())
        self.assertIn(f"node {self.namespace}/twin is already running at", second.words())
        first.send(signal.SIGINT)
        self.assertEqual(130, first.code(), first.words())

    def test_without_a_sim_node_it_says_so_and_ends(self):
        run = self.train("run", wait_s=2)
        self.assertEqual(4, run.code(), run.words())
        self.assertIn(f"no response from service {self.namespace}/get_state for 2 s", run.words())


if __name__ == "__main__":
    rospy.init_node("train_node_test")
    rostest.rosrun("aquafarm_agents", "train_node", TrainNodeTest, sys.argv)
