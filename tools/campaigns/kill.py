# SPDX-License-Identifier: BSD-3-Clause
"""Kills programs (SIGKILL) at random moments and starts them again until they end by themselves. The
result must equal that of an uninterrupted run bit for bit, and no temporary file may be left.

tables, networks   kills a trainer that runs in one process
sim_node           kills the sim node of a training, either with its trainer or alone. If only the
                   sim node is killed, the trainer saves a checkpoint and ends. The resumed training
                   starts new episodes, so its result may differ, but its policy must be readable
recorder           kills a sim node that saves each episode as a bag; the bags must pass verify_bag
benchmark          kills a benchmark, alone or with its trainings
ranks, workers     see kill_cluster.py
"""
import os
import pathlib
import signal
import subprocess
import tempfile
import time

from campaigns import common, ros

# Scenario and arguments of each learner. Each training takes about a second.
TABLES = {name: ["paper", "-n", "400000"] for name in ("q_learning", "sarsa", "random")}
REPLAY = ["-n", "3000", "-o", "hidden_size=16", "-o", "learning_starts=200", "-o", "buffer_size=2000"]
ROLLOUT = ["-f", "16", "-o", "hidden_size=16", "-o", "rollout_size=512", "-o", "batch_size=128"]
NETWORKS = {"dqn": ["paper", *REPLAY],
            "lstm_dqn": ["paper", *REPLAY],
            "maddpg": ["two_squads", *REPLAY],
            "mappo": ["two_squads", "-n", "8000", *ROLLOUT],
            "ppo": ["paper", "-n", "8000", *ROLLOUT]}
MOST_KILLS = 30      # max kills of one run without --kills; then the run may finish undisturbed
LIMIT_S = 300
SIM_STEPS = 64_000   # length of a training through a sim node; each call steps 16 farms
SIM_KILLS = 5
RECORDER_KILLS = 4
TINY = common.ROOT / "aquafarm_agents" / "test" / "data" / "tiny.yaml"


def command(trainer, name, arguments, folder, resume):
    scenario, *others = arguments
    return [str(trainer), scenario, "-a", name, *others, "--checkpoint-period", "0.02",
            "--evaluate", "0", "--random", "0", "--scenarios", str(common.SCENARIOS), "-d",
            str(folder), *(["--resume"] if resume else [])]


def holds_run(folder):
    return (folder / "run.json").exists() or any(folder.glob("checkpoints/step_*.ckpt"))


def results(folder):
    """Returns {name: bytes} of the files that an interruption must not change."""
    return {name: (folder / name).read_bytes() for name in ("policy.ckpt", "metrics.csv")}


def compare(campaign, what, folder, expected, got):
    """Records a failure if a file differs from the uninterrupted run or a temporary file is left."""
    campaign.attempt(f"runs of {what} compared")
    for file, content in expected.items():
        campaign.check(got[file] == content,
                       f"{what}: {folder / file} differs from that of the uninterrupted run")
    campaign.check(not common.left_over(folder), f"{what}: left {common.left_over(folder)}")


def interrupted_run(campaign, what, arguments_of, longest_s, whole_group=False):
    """Starts a program, kills it at a random moment, and repeats this until it ends by itself.
    Returns whether it ended with exit code 0.
    @param arguments_of function that returns the command of the next start
    @param longest_s max time from a start to the kill [s]
    @param whole_group kill the whole process group, not only the process, in half of the cases"""
    most = campaign.kills or MOST_KILLS
    for kills in range(most + 1):
        with common.started(*arguments_of()) as process:
            wait_s = campaign.rng.uniform(0.0, longest_s) if kills < most else LIMIT_S
            try:
                words = process.communicate(timeout=wait_s)[0].decode(errors="replace")
                return campaign.check(process.returncode == 0, f"{what}: exit code "
                                      f"{process.returncode} after {kills} kills: {words[-600:]}")
            except subprocess.TimeoutExpired:
                if whole_group and campaign.rng.random() < 0.5:
                    os.killpg(process.pid, signal.SIGKILL)
                else:
                    process.kill()
                process.communicate()
                campaign.attempt(f"kills of {what}")
    return campaign.check(False, f"{what}: did not end within {LIMIT_S} s after {most} kills")


class Trainers:
    """Kills trainings of some learners, each of which runs in one process."""

    def __init__(self, campaign, place, what, learners):
        self.campaign = campaign
        self.place = place
        self.what = what
        self.learners = learners
        self.trainer = campaign.program("aquafarm_train")
        self.expected = {}  # learner -> (results of an uninterrupted run, its duration [s])

    def reference(self, name):
        if name not in self.expected:
            folder = self.place / f"{name}_whole"
            begin = time.monotonic()
            code, words = common.execute(
                *command(self.trainer, name, self.learners[name], folder, False), seconds=LIMIT_S)
            good = self.campaign.check(code == 0, f"{name}: uninterrupted: exit code {code}: {words}")
            self.expected[name] = (results(folder) if good else None, time.monotonic() - begin)
        return self.expected[name]

    def try_once(self, number):
        names = sorted(self.learners)
        name = names[number % len(names)]
        expected, seconds = self.reference(name)
        folder = self.place / f"{name}_{number}"
        if expected and interrupted_run(
                self.campaign, self.what,
                lambda: command(self.trainer, name, self.learners[name], folder, holds_run(folder)),
                0.7 * seconds):
            compare(self.campaign, f"{self.what}: {name}", folder, expected, results(folder))
        common.remove(folder)


class SimNode:
    """Kills the sim node of a training, with the trainer or alone, and starts both again."""

    def __init__(self, campaign, place):
        self.campaign = campaign
        self.place = place
        self.expected = None
        self.seconds = 0.0

    def reference(self):
        folder = self.place / "sim_whole"
        folder.mkdir()
        with ros.Ros(self.campaign, folder) as ranch:
            ranch.sim("aquafarm")
            begin = time.monotonic()
            code = ranch.train("aquafarm", "run", SIM_STEPS).wait(timeout=LIMIT_S)
            self.seconds = time.monotonic() - begin
            if self.campaign.check(code == 0, f"sim_node: uninterrupted: {ranch.log('run')[-600:]}"):
                self.expected = ranch.results("run")

    def attempt(self, ranch, alone, last):
        """Starts the sim node and the trainer. Kills the sim node, and the trainer unless `alone`,
        at a random moment. In the `last` attempt, waits for the end of the training first. Returns
        whether the training is complete, or None after a failure."""
        sim = ranch.sim("aquafarm")
        train = ranch.train("aquafarm", "run", SIM_STEPS, "_checkpoint_period_s:=0.05",
                            "_sim_timeout_s:=1",
                            f"_resume:={str(holds_run(ranch.folder / 'run')).lower()}")
        try:
            train.wait(timeout=LIMIT_S if last else self.campaign.rng.uniform(0.2, self.seconds))
        except subprocess.TimeoutExpired:
            self.campaign.attempt("kills of a sim node" if alone
                                  else "kills of a sim node with its trainer")
            if not alone:
                train.kill()
        sim.kill()
        sim.wait()
        code = train.wait(timeout=LIMIT_S)
        expected = (0,) if last else (0, ros.SIM_LOST) if alone else (0, -signal.SIGKILL)
        if not self.campaign.check(code in expected, f"sim_node: trainer: exit code {code}: "
                                   f"{ranch.log('run')[-600:]}"):
            return None
        return code == 0

    def judge(self, ranch, alone):
        run = ranch.folder / "run"
        if not alone:
            compare(self.campaign, "sim_node", run, self.expected, ranch.results("run"))
            return
        code, words = common.execute(self.campaign.program("aquafarm_evaluate"), run, "-e", "2",
                                     seconds=LIMIT_S)
        self.campaign.attempt("policies played after kills of a sim node")
        self.campaign.check(code == 0, f"sim_node: evaluate: exit code {code}: {words[-300:]}")
        self.campaign.check(not common.left_over(run), f"sim_node: left {common.left_over(run)}")

    def try_once(self, number):
        if self.expected is None:
            self.reference()
        if self.expected is None:
            return  # the failure is reported
        alone = number % 2 == 1
        folder = self.place / f"sim_{number}"
        folder.mkdir()
        with ros.Ros(self.campaign, folder) as ranch:
            done = False
            most = self.campaign.kills or SIM_KILLS
            for kills in range(most + 1):
                done = self.attempt(ranch, alone, kills == most)
                if done is not False:
                    break
            if done:
                self.judge(ranch, alone)
        common.remove(folder)


class Recorder:
    """Kills a sim node that saves each episode as a bag. A sample of up to 60 bags must pass
    verify_bag, which simulates their episodes again."""

    def __init__(self, campaign, place):
        self.campaign = campaign
        self.place = place
        self.verify = campaign.program("verify_bag")

    def session(self, ranch, kill):
        """Records a training until a new bag is complete. Then kills the sim node, or ends the
        trainer and the sim node with SIGTERM."""
        sim = ranch.sim("aquafarm", "_keep:=all", "_keep_dir:=episodes")
        train = ranch.train("aquafarm", f"run_{len(ranch.processes)}", 10**9, "_sim_timeout_s:=1")
        bags = ranch.folder / "episodes"
        before = len(list(bags.glob("*.bag")))
        ranch.wait_for(lambda: len(list(bags.glob("*.bag"))) > before, "a bag")
        time.sleep(self.campaign.rng.uniform(0.0, 1.0))
        if kill:
            sim.kill()
            self.campaign.attempt("kills of recorder")
        else:
            train.terminate()
            train.wait(timeout=LIMIT_S)
            sim.terminate()
        sim.wait(timeout=LIMIT_S)
        train.wait(timeout=LIMIT_S)

    def try_once(self, number):
        folder = self.place / f"recorder_{number}"
        folder.mkdir()
        with ros.Ros(self.campaign, folder) as ranch:
            for kill in [True] * (self.campaign.kills or RECORDER_KILLS) + [False]:
                self.session(ranch, kill)
        bags = sorted((folder / "episodes").glob("*.bag"))
        self.campaign.check(bags, "recorder: no bag was kept")
        chosen = self.campaign.rng.sample(bags, min(len(bags), 60))  # there may be thousands
        code, words = common.execute(self.verify, *chosen, seconds=LIMIT_S)
        self.campaign.attempt("bags of a killed recorder verified", len(chosen))
        self.campaign.check(code == 0, f"recorder: verify_bag: exit code {code}: {words[-600:]}")
        left = common.left_over(folder / "episodes")
        self.campaign.check(not left, f"recorder: left {left}")
        common.remove(folder)


class Benchmark:
    """Kills a benchmark of two trainings, and starts it again with the same command."""

    TABLES = ("runs.csv", "table.csv", "table.md")

    def __init__(self, campaign, place):
        self.campaign = campaign
        self.place = place
        self.words = [campaign.program("aquafarm_benchmark"), TINY, "--algorithms", "q_learning",
                      "--runs", "2", "--episodes", "20000", "--evaluation-episodes", "30",
                      "--tables-only", "--programs", campaign.program("aquafarm_train").parent]
        self.expected = None
        self.seconds = 0.0

    def command(self, folder):
        return [str(word) for word in [*self.words, "--output", folder]]

    def results(self, folder):
        return {name: (folder / name).read_bytes() for name in self.TABLES}

    def reference(self, name):
        folder = self.place / name
        begin = time.monotonic()
        code, words = common.execute(*self.command(folder), seconds=LIMIT_S)
        self.seconds = time.monotonic() - begin
        if self.campaign.check(code == 0, f"{name}: exit code {code}: {words[-600:]}"):
            self.expected = self.results(folder)

    def try_once(self, number):
        if self.expected is None:
            self.reference("benchmark_whole")
            if self.expected is None:
                return
        folder = self.place / f"benchmark_{number}"
        if interrupted_run(self.campaign, "benchmark", lambda: self.command(folder), self.seconds,
                           whole_group=True):
            compare(self.campaign, "benchmark", folder, self.expected, self.results(folder))
        common.remove(folder)


KINDS = {
    "tables": lambda campaign, place: Trainers(campaign, place, "tables", TABLES),
    "networks": lambda campaign, place: Trainers(campaign, place, "networks", NETWORKS),
    "sim_node": SimNode,
    "recorder": Recorder,
    "benchmark": Benchmark,
}


def run(campaign):
    """Makes campaign.count tries of the kinds in turn. If the count is 0, starts tries for
    campaign.seconds. Ends early after a failure."""
    from campaigns import kill_cluster  # imports this module
    made, all_kinds = {}, {**KINDS, "ranks": kill_cluster.Ranks, "workers": kill_cluster.Workers}
    with tempfile.TemporaryDirectory(prefix="aquafarm_kill_") as place:
        kinds = campaign.kinds(all_kinds)
        number = 0
        while campaign.more(number) and not campaign.failures:
            kind = kinds[number % len(kinds)]
            if kind not in made:
                made[kind] = all_kinds[kind](campaign, pathlib.Path(place))
            made[kind].try_once(number // len(kinds))
            number += 1
