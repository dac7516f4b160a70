#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of a small benchmark: its results, kill and resume, interrupt, rejected input."""
import csv
import dataclasses
import fcntl
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import numpy as np
import rosbag
import rostest

from aquafarm_benchmark import (cli, cluster, error_figure, evaluation_figure, figures, human,
                                measures, protocol, runs)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import DATA, Program, program  # noqa: E402

FIGURES = {"rewards", "average_rewards", "mean_square_error", "mean_score", "repeated_trainings",
           "evaluation", "route_random", "route_q_learning", "route_planner", "route_clairvoyant"}


def running(words):
    """Returns the ids of processes whose command line contains `words`."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if words in path.read_bytes().decode(errors="replace"):
                found.append(int(path.parent.name))
        except OSError:
            continue  # it has just ended
    return found


def send_all(words, sent):
    """Sends a signal to all processes whose command line contains `words`; returns their number."""
    reached = 0
    for number in running(words):
        try:
            os.kill(number, sent)
            reached += 1
        except ProcessLookupError:
            continue  # it has just ended
    return reached


def stop_once_under_way(trainings):
    """Stops (SIGSTOP) the trainings of these run folders that have completed some episodes; returns
    whether all of them are stopped."""
    stopped = 0
    for folder in trainings:
        if (folder / "evaluation.json").exists():
            raise AssertionError(f"{folder}: was over before it could be stopped")
        metrics = folder / "metrics.csv"
        if metrics.exists() and metrics.stat().st_size > 4096:
            stopped += send_all(str(folder), signal.SIGSTOP)
    return stopped == len(trainings)


def run_all(jobs, report=lambda text: None):
    """Runs jobs, two in parallel, on this machine."""
    with cluster.Cluster(jobs=2) as workers:
        return runs.run_all(jobs, workers, report)


class BenchmarkTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="aquafarm_benchmark_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def wait_until_saved(self, trainings):
        """Waits for the trainings of a killed benchmark, which save and end by themselves."""
        end = time.monotonic() + 60.0
        for folder in trainings:
            while running(str(folder)):
                self.assertLess(time.monotonic(), end, f"{folder}: outlives the benchmark")
                time.sleep(0.05)
            self.assertTrue(list(folder.glob("checkpoints/step_*.ckpt")), f"{folder}: did not save")

    def start(self, output, *arguments, episodes=150, scenario=DATA / "tiny.yaml", draws=False):
        """Starts a benchmark. draws: whether it draws figures, which takes some seconds"""
        return Program(self, program("aquafarm_agents", "aquafarm_benchmark"), scenario,
                       *([] if draws else ["--tables-only"]),
                       "--output", self.folder / output, "--runs", "2", "--episodes", episodes,
                       "--evaluation-episodes", "30", "--programs",
                       pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent,
                       *arguments)

    def test_it_ends_in_tables_and_figures(self):
        one = self.start("out", "--algorithms", "random,q_learning,planner", episodes=400,
                         draws=True)
        self.assertEqual(0, one.code(180), one.words())
        everything = json.loads((self.folder / "out/results.json").read_text())
        rows = {row["name"]: row for row in everything["table"]}
        self.assertEqual(["random", "q_learning", "planner", "clairvoyant"], list(rows))
        self.assertAlmostEqual(1.0, rows["clairvoyant"]["share_of_optimum"], places=5)
        self.assertEqual(1.0, rows["q_learning"]["success_rate"])
        self.assertGreater(rows["q_learning"]["share_of_optimum"], 0.9)
        self.assertEqual(1.0, rows["q_learning"]["stability"])
        self.assertLess(rows["random"]["ea_paper"], rows["q_learning"]["ea_paper"])
        self.assertEqual([1, 2], [run["seed"] for run in everything["runs"]["q_learning"]])
        random = [run["return_per_step"] for run in everything["runs"]["random"]]
        self.assertEqual(2, len(set(random)), "each run of RANDOM draws actions of its own")
        options = (self.folder / "out/runs/random/seed_1/run.json").read_text()
        self.assertIn("actions=reachable", options)
        self.assertEqual(0.0, rows["random"]["crashes_per_episode"])
        self.assertEqual("tiny", everything["settings"]["scenario"])
        self.assertTrue(everything["settings"]["scenario_hash"])
        with open(self.folder / "out/table.csv", newline="") as file:
            self.assertEqual(len(rows), len(list(csv.DictReader(file))))
        self.assertIn("| *Q-learning, paper* | −1.21 | 0.7 | ≤500 (3) | 0.7 | – | 0.97 |",
                      one.words())
        table = (self.folder / "out/table.md").read_text()
        self.assertIn("Its unit of\nconvergence is timesteps", table)
        pictures = {path.stem: path for path in (self.folder / "out/figures").glob("*.png")}
        self.assertEqual(FIGURES, set(pictures))
        self.check_evaluation_figure(everything, rows)

    def test_with_money_it_reports_losses_and_their_references(self):
        scenario = self.folder / "insured.yaml"
        scenario.write_text((DATA / "tiny.yaml").read_text() + "money:\n  device_values: "
                            "{monitoring: 1000.01, temporary_breeding: 500.5}\n  ship_hour: 7\n")
        one = self.start("out", "--algorithms", "random", episodes=50, scenario=scenario,
                         draws=True)
        self.assertEqual(0, one.code(180), one.words())
        rows = {row["name"]: row["money"] for row in
                json.loads((self.folder / "out/results.json").read_text())["table"]}
        self.assertEqual({"random", "do_nothing", "fetch_by_value", "clairvoyant"}, set(rows))
        self.assertEqual(rows["do_nothing"]["insured"], rows["do_nothing"]["loss"])
        self.assertEqual(0.0, rows["do_nothing"]["operating_cost"])
        self.assertLess(rows["fetch_by_value"]["loss"], rows["do_nothing"]["loss"])
        # The evaluation program has an implementation of its own.
        for name in ("do_nothing", "fetch_by_value"):
            path = self.folder / f"out/runs/{name}/seed_1/evaluation.json"
            other = json.loads(path.read_text())["money"]
            for key, same in (("loss", other["loss_per_episode"]), ("var", other["var"]["value"]),
                              ("cvar", other["cvar"]["value"]),
                              ("distinct_episodes", other["distinct_episodes"])):
                self.assertAlmostEqual(same, rows[name][key], places=6, msg=f"{name} {key}")
        for name in ("losses.csv", "losses.md", "exceedance.csv", "figures/losses.png"):
            self.assertTrue((self.folder / "out" / name).exists(), name)
        self.assertIn("Losses per episode in CNY", one.words())

    def check_evaluation_figure(self, everything, rows):
        """Compares the bars of the evaluation figure with results.json."""
        shown = [one for one in (*protocol.CONTESTANTS, protocol.OPTIMUM) if one.name in rows]
        drawn = [dict(rows[one.name], return_interval=[
            math.nan if bound is None else bound for bound in rows[one.name]["return_interval"]])
            for one in shown]
        _, axes = figures.plt.subplots()
        evaluation_figure.plot_evaluation(axes, shown, drawn)
        self.assertEqual([row["return_iqm"] for row in drawn],
                         [bar.get_height() for bar in axes.patches])
        played = [run["return_per_episode"] for run in everything["runs"]["q_learning"]]
        bar = axes.patches[[one.name for one in shown].index("q_learning")]
        self.assertAlmostEqual(sum(played) / 2.0, bar.get_height(), places=9)

    def test_the_square_error_shows_median_and_range(self):
        rng = np.random.default_rng(1)
        shown = [one for one in protocol.CONTESTANTS if one.name in ("q_learning", "sarsa")]
        errors = {"q_learning": 10.0 * np.exp(rng.normal(0.0, 0.5, (3, 400))),
                  "sarsa": np.full((1, 400), 40.0)}
        errors["q_learning"][:, :7] = math.nan  # nothing was learnt yet
        runs = {name: [{"curve": {"loss": row}} for row in rows] for name, rows in errors.items()}
        _, axes = figures.plt.subplots()
        error_figure.plot_square_error(axes, shown, runs)
        noisy, steady = axes.lines
        self.assertEqual(351, len(noisy.get_xdata()))
        self.assertLess(np.ptp(np.log(noisy.get_ydata())), 0.5)
        each = [measures.known_moving_mean(row) for row in errors["q_learning"]]
        np.testing.assert_allclose(noisy.get_ydata(), np.median(each, axis=0))
        np.testing.assert_allclose(steady.get_ydata(), 40.0)
        self.assertEqual(1, len(axes.collections), "a band for a learner with several runs")

    def played(self, name, *episodes, policy="clairvoyant", scenario=DATA / "tiny.yaml"):
        """Makes bags of evaluation episodes of seed 1000 in a folder, as if a person had played
        them."""
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        for episode in episodes:
            route = self.folder / "route.json"
            for command in (
                    (program("aquafarm_agents", "aquafarm_evaluate"), policy, scenario, "--seed",
                     "1000", "--episodes", "1", "--route", route, "--route-episode", episode),
                    (program("aquafarm_sim", "episode_bag"), scenario, route, "-o",
                     folder / f"{policy}_{episode}.bag")):
                one = Program(self, *command)
                self.assertEqual(0, one.code(), one.words())
        return folder

    def test_bags_of_a_person_are_a_row(self):
        folder = self.played("play", 0, 3, 4)
        self.played("play", 7, policy="random")
        one = self.start("out", "--algorithms", "random", "--human", folder, episodes=20)
        self.assertEqual(0, one.code(), one.words())
        self.assertRegex(one.words(), "; tables are in ")
        self.assertFalse((self.folder / "out/figures").exists())
        everything = json.loads((self.folder / "out/results.json").read_text())
        rows = {row["name"]: row for row in everything["table"]}
        self.assertEqual(["random", "human", "clairvoyant"], list(rows))
        row = rows["human"]
        self.assertEqual("human, 4 episodes", row["label"])
        self.assertEqual((4, 1), (row["evaluation_episodes"], row["runs"]))
        with open(self.folder / "out/runs/human/seed_1/evaluation.csv", newline="") as file:
            played = {int(line["episode"]): line for line in csv.DictReader(file)}
        self.assertEqual({0, 3, 4, 7}, set(played))
        with open(self.folder / "out/runs/clairvoyant/seed_1/evaluation.csv", newline="") as file:
            best = {int(line["episode"]): line for line in csv.DictReader(file)}
        for episode in (0, 3, 4):
            for name in human.COLUMNS:
                if name in ("reason", "success"):
                    self.assertEqual(best[episode][name], played[episode][name])
                elif name != "farm":
                    self.assertAlmostEqual(float(best[episode][name]),
                                           float(played[episode][name]), places=4, msg=name)
        returns = [float(line["return"]) for line in played.values()]
        optimum = sum(float(best[episode]["return"]) for episode in played)
        self.assertAlmostEqual(sum(returns) / 4.0, row["return_per_episode"], places=4)
        self.assertAlmostEqual(sum(returns) / optimum, row["share_of_optimum"], places=4)
        low, high = row["return_interval"]
        self.assertTrue(min(returns) <= low < row["return_per_episode"] < high <= max(returns))
        successes = sum(int(line["success"]) for line in played.values())
        self.assertEqual(successes / 4.0, row["success_rate"])
        self.assertLess(row["success_interval"][0], row["success_rate"])
        self.assertIsNone(row["ea_paper"])
        table = (self.folder / "out/table.md").read_text()
        self.assertRegex(table, r"\| human, 4 episodes \|.*\| 1 of 4 \|")
        self.assertIn("The row of human play", table)

    def test_each_folder_of_bags_is_one_person(self):
        self.played("play/ann", 0, 1)
        folder = self.played("play/bob", 2, policy="random").parent
        one = self.start("out", "--algorithms", "random", "--human", folder, episodes=20)
        self.assertEqual(0, one.code(), one.words())
        everything = json.loads((self.folder / "out/results.json").read_text())
        row = next(row for row in everything["table"] if row["name"] == "human")
        self.assertEqual(("human, 2 people, 3 episodes", 2), (row["label"], row["runs"]))
        means = [run["return_per_episode"] for run in everything["runs"]["human"]]
        self.assertAlmostEqual(sum(means) / 2.0, row["return_per_episode"], places=6)
        for mean, bound in zip(sorted(means), row["return_interval"]):
            self.assertAlmostEqual(mean, bound, places=6)

    def test_bags_that_do_not_fit_are_refused(self):
        other = self.played("other", 0, policy="random", scenario=DATA / "pair.yaml")
        changed = self.played("changed", 0)
        bag, = changed.glob("*.bag")
        copy = changed / "copy.bag"
        with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(copy), "w") as target:
            for topic, message, stamp in source.read_messages():
                if topic.endswith("episode"):
                    message.episode_return += 100.0
                target.write(topic, message, stamp)
        bag.unlink()
        (self.folder / "empty").mkdir()
        for folder, words in (
                (other, "expected the benchmark's"),
                (changed, "copy.bag: differs: "),
                (self.folder / "empty", "contain no *.bag"),
                (self.folder / "none", "expected a folder with bags")):
            with self.subTest(folder=folder):
                one = self.start("out", "--algorithms", "random", "--human", folder, episodes=20)
                self.assertEqual(2, one.code(), one.words())
                self.assertIn(words, one.words())
        self.assertFalse((self.folder / "out").exists())

    def test_killed_it_resumes_and_ends_in_the_same_numbers(self):
        arguments = ("--algorithms", "q_learning", "--jobs", "2")
        whole = self.start("whole", *arguments, episodes=30000)
        self.assertEqual(0, whole.code(), whole.words())
        part = self.start("parts", *arguments, episodes=30000)
        trainings = self.folder / "parts/runs/q_learning"
        both = [trainings / "seed_1", trainings / "seed_2"]
        # Also after a failure, no process stays stopped.
        self.addCleanup(send_all, str(trainings), signal.SIGCONT)
        part.wait_for(lambda: stop_once_under_way(both), "two trainings")
        part.send(signal.SIGKILL)
        part.code()
        send_all(str(trainings), signal.SIGCONT)  # they continue, handle their SIGINT and save
        self.wait_until_saved(both)
        self.assertFalse(list(trainings.glob("*/evaluation.json")), "it was over already")
        rest = self.start("parts", *arguments, episodes=30000)
        self.assertEqual(0, rest.code(), rest.words())
        logs = [path.read_text() for path in trainings.glob("*.log")]
        self.assertEqual(2, sum("resuming from" in text for text in logs), "\n".join(logs))
        for name in ("runs.csv", "table.csv", "table.md"):
            self.assertEqual((self.folder / "whole" / name).read_text(),
                             (self.folder / "parts" / name).read_text(), name)
        # Complete runs are not repeated.
        before = {path: path.stat().st_mtime_ns for path in trainings.rglob("policy.ckpt")}
        self.assertEqual(2, len(before))
        again = self.start("parts", *arguments, episodes=30000)
        self.assertEqual(0, again.code(), again.words())
        self.assertIn("3 of 3 runs are already complete", again.words())
        self.assertEqual(before, {path: path.stat().st_mtime_ns
                                  for path in trainings.rglob("policy.ckpt")})

    def test_killed_its_trainings_save_and_end(self):
        one = self.start("out", "--algorithms", "q_learning", "--jobs", "2", episodes=10000000)
        trainings = [self.folder / f"out/runs/q_learning/seed_{seed}" for seed in (1, 2)]
        one.wait_for(lambda: all((folder / "metrics.csv").exists() for folder in trainings),
                     "two trainings")
        one.send(signal.SIGKILL)
        self.wait_until_saved(trainings)

    def test_a_folder_in_use_is_refused_once_it_was_waited_for(self):
        folder = self.folder / "out"
        folder.mkdir()
        (folder / "benchmark.json").write_text("{}")
        with open(folder / "lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            one = self.start("out")
            self.assertEqual(2, one.code(), one.words())
        self.assertIn("is in use; waiting up to 15 s", one.words())
        self.assertIn("is in use by another benchmark", one.words())

    def test_runs_that_learnt_otherwise_are_not_pooled(self):
        first = self.start("out", "--algorithms", "q_learning", episodes=40)
        self.assertEqual(0, first.code(), first.words())
        path = self.folder / "out/runs/q_learning/seed_2/run.json"
        path.write_text(path.read_text().replace("gamma=0.97", "gamma=0.5"))
        again = self.start("out", "--algorithms", "q_learning", episodes=40)
        self.assertEqual(2, again.code(), again.words())
        self.assertIn("q_learning: its runs were made with different options", again.words())

    def test_a_run_that_cannot_be_resumed_fails_and_is_not_left_out(self):
        job = runs.Job("dqn", "dqn 1", self.folder / "dqn", self.folder / "dqn/evaluation.json",
                       [["sh", "-c", "echo damaged $0; exit 2"]], 1.0, resumable=True)
        job.folder.mkdir()
        (job.folder / "run.json").write_text("{}")
        with self.assertRaisesRegex(runs.RunFailed, "^dqn 1: exit code 2: damaged --resume"):
            run_all([job])

    def test_a_policy_that_is_refused_after_its_training_fails_and_is_not_left_out(self):
        job = runs.Job("dqn", "dqn 1", self.folder / "dqn", self.folder / "dqn/evaluation.json",
                       [["true"], ["sh", "-c", "echo of another version; exit 2"]], 1.0)
        with self.assertRaisesRegex(runs.RunFailed, "^dqn 1: exit code 2: of another version"):
            run_all([job])

    def test_networks_take_part_with_the_settings_of_the_protocol(self):
        one = self.start("out", "--algorithms", "dqn,lstm_dqn", episodes=20, draws=True)
        self.assertEqual(0, one.code(180), one.words())
        everything = json.loads((self.folder / "out/results.json").read_text())
        for name in ("dqn", "lstm_dqn"):
            self.assertEqual(2, len(everything["runs"][name]), name)
            for run in everything["runs"][name]:
                self.assertRegex(run["libraries"], r"^libtorch \d")
            options = (self.folder / f"out/runs/{name}/seed_1/run.json").read_text()
            self.assertIn("mask_blocked=true", options)
            self.assertIn("device=cpu", options)

    def test_a_library_of_another_package_is_a_row(self):
        example = pathlib.Path(__file__).resolve().parents[1] / "examples/expected_sarsa"
        build = self.folder / "build"
        for command in (["-S", example, "-B", build], ["--build", build]):
            done = subprocess.run(["cmake", *command], capture_output=True, text=True, check=False)
            self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        library = build / "libexpected_sarsa.so"
        one = self.start("out", "--algorithms", "q_learning", "--learner",
                         f"expected_sarsa={library}", episodes=800)
        self.assertEqual(0, one.code(240), one.words())
        everything = json.loads((self.folder / "out/results.json").read_text())
        rows = {row["name"]: row for row in everything["table"]}
        self.assertEqual(["q_learning", "expected_sarsa", "clairvoyant"], list(rows))
        self.assertEqual(1.0, rows["expected_sarsa"]["success_rate"])
        self.assertIn("expected_sarsa", (self.folder / "out/table.md").read_text())
        report = Program(self, program("aquafarm_bringup", "make_report"), self.folder / "out")
        self.assertEqual(0, report.code(), report.words())
        self.assertIn("expected_sarsa", (self.folder / "out/report.html").read_text())
        absent = self.start("out", "--learner", "mine=/none/mine.so")
        self.assertEqual(2, absent.code(), absent.words())
        self.assertIn("there is no file /none/mine.so", absent.words())

    def test_a_virtual_environment_with_the_package_does_not_see_that_of_the_workspace(self):
        home = self.folder / "venv"
        (home / "lib/python3.12/site-packages/aquafarm_core").mkdir(parents=True)
        (home / "bin").mkdir()
        with mock.patch.dict(os.environ, PYTHONPATH="/ws/lib/python3/dist-packages:/mine"):
            self.assertEqual([], cli._own_packages(str(home / "bin/python")))
            (home / "pyvenv.cfg").touch()
            self.assertEqual(["env", "PYTHONPATH=/mine"], cli._own_packages(str(home / "bin/python")))
            self.assertEqual([], cli._own_packages("python3"))

    def test_interrupted_it_prints_how_to_resume(self):
        one = self.start("out", "--algorithms", "q_learning", episodes=10000000)
        one.wait_for(lambda: list(self.folder.glob("out/runs/q_learning/*/metrics.csv")),
                     "a training")
        one.send(signal.SIGINT)
        self.assertEqual(130, one.code(), one.words())
        self.assertIn("the same command resumes it", one.words())
        self.assertTrue(list(self.folder.glob("out/runs/q_learning/*/checkpoints/step_*.ckpt")))

    def test_a_failed_run_is_reported_and_the_others_are_kept(self):
        jobs = [runs.Job(name, name, self.folder / name, self.folder / name / "evaluation.json",
                         [["sh", "-c", command]], 1.0)
                for name, command in (
                    ("good", f"echo '{{\"complete\": true}}' >{self.folder}/good/evaluation.json"),
                    ("bad", "echo the disk is full; exit 3"), ("unfit", "echo too large; exit 2"))]
        words = []
        with self.assertRaisesRegex(runs.RunFailed, "^bad: exit code 3: the disk is full"):
            run_all(jobs, words.append)
        self.assertIn("failed: bad: exit code 3", words[0])
        self.assertTrue(runs.is_complete(jobs[0].result))
        unfit = dataclasses.replace(jobs[2], command=0, started=None)
        self.assertEqual({"unfit": "too large"}, run_all([unfit], words.append))

    def test_the_command_line_loads_no_library_of_trainings_or_figures(self):
        loaded = subprocess.run(
            [sys.executable, "-c", "import sys, aquafarm_benchmark.cli; print(*sys.modules)"],
            capture_output=True, text=True, check=True, timeout=60).stdout.split()
        self.assertIn("aquafarm_benchmark.runs", loaded)
        self.assertFalse({"distributed", "matplotlib", "scipy.stats"} & set(loaded))

    def test_arguments_are_refused_with_what_is_allowed(self):
        (self.folder / "full").mkdir()
        (self.folder / "full/thesis.txt").write_text("dear")
        for arguments, words in (
                (("--algorithms", "dqm"), "algorithms: got 'dqm', expected some of: random"),
                (("--profile", "long"), "profile: got 'long', expected one of: full, quick, paper"),
                (("--runs", "-1"), "runs: got -1, expected 1 or more"),
                (("--runs", "1e1"), "argument --runs: invalid int value: '1e1'"),
                (("--output", self.folder / "full"), "is not empty and holds no benchmark"),
                (("--scheduler", "cloud"), "scheduler: got 'cloud', expected local, slurm or an "),
                (("--programs", self.folder), "there is no aquafarm_evaluate in")):
            with self.subTest(arguments=arguments):
                one = self.start("out", *arguments)
                self.assertEqual(2, one.code(), one.words())
                self.assertIn(words, one.words())
        unknown = Program(self, program("aquafarm_agents", "aquafarm_benchmark"), "atlantis",
                          "--output", self.folder / "out", "--programs",
                          pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent)
        self.assertEqual(2, unknown.code(), unknown.words())
        self.assertIn("scenario: got 'atlantis', expected a file or one of: four_squads, ",
                      unknown.words())
        first = self.start("out", "--algorithms", "random", episodes=5)
        self.assertEqual(0, first.code(), first.words())
        other = self.start("out", "--algorithms", "random", episodes=6)
        self.assertEqual(2, other.code(), other.words())
        self.assertIn("holds a benchmark with episodes 5, got 6", other.words())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_agents", "benchmark", BenchmarkTest, sys.argv)
