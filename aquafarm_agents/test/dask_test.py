#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of runs on the workers of a Dask scheduler, which are killed and started again."""
import contextlib
import csv
import io
import os
import pathlib
import signal
import sys
import tempfile
import time
import unittest
import unittest.mock
import warnings

import rostest

from aquafarm_benchmark import cli, cluster, many, runs, sweep, worker

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from processes import DATA, Program, free_port, program  # noqa: E402

LIMIT_S = 240.0
ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLES = ("runs.csv", "table.csv", "table.md")


class Scheduler:
    """A scheduler of Dask with workers as processes of this machine."""

    def __init__(self, test, folder):
        self._test = test
        self._folder = folder
        self._port = free_port()
        self.address = f"127.0.0.1:{self._port}"
        self._scheduler = None
        self.start()

    def start(self):
        self._scheduler = Program(self._test, "/usr/bin/dask-scheduler", "--host", "127.0.0.1",
                                  "--port", self._port, "--no-dashboard")

    def add_worker(self):
        """Starts a worker without a nanny, so that a killed one is not started again."""
        folder = tempfile.mkdtemp(dir=self._folder)
        return Program(self._test, "/usr/bin/dask-worker", f"tcp://{self.address}", "--nthreads", "1",
                       "--no-nanny", "--no-dashboard", "--local-directory", folder)

    def kill(self):
        self._scheduler.kill()


class DaskTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="aquafarm_dask_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, output, *arguments):
        train = program("aquafarm_agents", "aquafarm_train")
        return Program(self, program("aquafarm_agents", "aquafarm_benchmark"), DATA / "tiny.yaml",
                       "--algorithms", "q_learning", "--runs", "2", "--episodes", "400000",
                       "--evaluation-episodes", "30", "--programs", pathlib.Path(train).parent,
                       "--tables-only", "--output", self.folder / output, *arguments)

    def under_way(self, output):
        """Whether both trainings have completed some episodes."""
        found = list(self.folder.glob(f"{output}/runs/q_learning/*/metrics.csv"))
        return len(found) == 2 and all(path.stat().st_size > 4096 for path in found)

    def test_a_benchmark_outlives_its_workers_and_its_scheduler(self):
        whole = self.start("whole")
        self.assertEqual(0, whole.code(LIMIT_S), whole.words())
        scheduler = Scheduler(self, self.folder)
        workers = [scheduler.add_worker(), scheduler.add_worker()]
        part = self.start("parts", "--scheduler", scheduler.address)
        part.wait_for(lambda: self.under_way("parts"), "two trainings", LIMIT_S)
        workers.pop().kill()
        part.wait_for(lambda: "worker or the scheduler was lost; it runs again on" in part.words(),
                      "the run of the lost worker", LIMIT_S)
        scheduler.kill()
        part.wait_for(lambda: f"the scheduler {scheduler.address} was lost" in part.words(),
                      "the loss of the scheduler", LIMIT_S)
        back = f"the scheduler {scheduler.address} answers again"
        scheduler.start()
        part.wait_for(lambda: back in part.words(), "the new connection", LIMIT_S)
        scheduler.kill()  # while the client submits the runs again, or soon after
        part.wait_for(lambda: part.words().count("was lost; waiting") == 2, "the second loss", LIMIT_S)
        scheduler.start()
        scheduler.add_worker()
        self.assertEqual(0, part.code(LIMIT_S), part.words())
        self.assertEqual(2, part.words().count(back), part.words())
        self.assertNotIn("Traceback", part.words())
        for name in TABLES:
            self.assertEqual((self.folder / "whole" / name).read_text(),
                             (self.folder / "parts" / name).read_text(), name)

    def test_an_interrupt_ends_the_programs_of_the_workers(self):
        scheduler = Scheduler(self, self.folder)
        scheduler.add_worker()
        one = self.start("out", "--episodes", "10000000", "--scheduler", scheduler.address)
        trainings = self.folder / "out/runs/q_learning"
        one.wait_for(lambda: list(trainings.glob("*/metrics.csv")), "a training", LIMIT_S)
        one.send(signal.SIGINT)
        self.assertEqual(130, one.code(LIMIT_S), one.words())
        self.assertIn("the same command resumes it", one.words())
        self.assertTrue(list(trainings.glob("*/checkpoints/step_*.ckpt")))
        self.assertFalse([path for path in trainings.glob("*.log") if runs.is_written(path)])

    def test_the_programs_of_a_killed_client_end(self):
        scheduler = Scheduler(self, self.folder)
        scheduler.add_worker()
        one = self.start("out", "--episodes", "10000000", "--scheduler", scheduler.address)
        trainings = self.folder / "out/runs/q_learning"
        one.wait_for(lambda: list(trainings.glob("*/metrics.csv")), "a training", LIMIT_S)
        one.kill()
        end = time.monotonic() + LIMIT_S
        while any(runs.is_written(path) for path in trainings.glob("*.log")):
            self.assertLess(time.monotonic(), end, "the trainings outlive the benchmark")
            time.sleep(0.1)

    def test_a_sweep_gives_the_same_table(self):
        train = pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent
        scheduler = Scheduler(self, self.folder)
        scheduler.add_worker()
        for output, where in (("here", "local"), ("there", scheduler.address)):
            with contextlib.redirect_stdout(io.StringIO()) as said:
                code = sweep.main([str(DATA / "tiny.yaml"), "q_learning", "--set", "gamma=0.9,0.97",
                                   "--seeds", "1-2", "--steps", "20000", "--episodes", "10",
                                   "--output", str(self.folder / output), "--programs", str(train),
                                   "--scheduler", where])
            self.assertEqual(0, code, said.getvalue())
        self.assertEqual((self.folder / "here/table.csv").read_text(),
                         (self.folder / "there/table.csv").read_text())

    def many(self, *words):
        """Runs the command; returns (exit code, what it said)."""
        programs = pathlib.Path(program("aquafarm_agents", "aquafarm_evaluate")).parent
        with contextlib.redirect_stdout(io.StringIO()) as said, contextlib.redirect_stderr(said):
            code = many.main([words[0], "--programs", str(programs), *map(str, words[1:])])
        return code, said.getvalue()

    def test_many_evaluations_give_the_same_table(self):
        scheduler = Scheduler(self, self.folder)
        scheduler.add_worker()
        for output, where in (("here", "local"), ("there", scheduler.address)):
            code, said = self.many("evaluate", DATA / "tiny.yaml", DATA / "pair.yaml", "--policy",
                                   "planner", "--policy", "random", "--output",
                                   self.folder / output, "--scheduler", where, "--", "-e", "20")
            self.assertEqual(0, code, said)
        table = (self.folder / "here/table.csv").read_text()
        self.assertEqual(5, len(table.splitlines()))
        self.assertEqual(table, (self.folder / "there/table.csv").read_text())

    def test_many_plans_are_a_table_and_a_bad_ranch_is_named(self):
        storm = ROOT / "aquafarm_sim/scenarios/archives/zhoushan_cma.txt"
        words = ("plan", "zhoushan_infa_2021", "zhoushan_mitag_2019", "paper", "--output",
                 self.folder / "out", "--", "--storm", storm, "--storm-name", "In-fa", "--members",
                 "20", "--scenarios", ROOT / "aquafarm_sim/scenarios", "--at")
        code, said = self.many(*words, "2021-07-24T00:00:00Z")
        self.assertEqual(4, code, said)
        self.assertRegex(said, r"refused: 0002_paper: .*expected")
        with open(self.folder / "out/table.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(["zhoushan_infa_2021", "zhoushan_mitag_2019"], [row["ranch"] for row in rows])
        for row in rows:
            self.assertEqual("plan", row["outcome"])
            self.assertLess(float(row["mean_loss"]), float(row["mean_loss_without_plan"]))
        code, said = self.many(*words, "2021-07-24T06:00:00Z")
        self.assertEqual(2, code, said)
        self.assertIn("which compares something else (many.json), expected a new folder", said)

    def test_workers_of_this_process_listen_on_the_loopback_address_alone(self):
        def ports():
            own = {os.readlink(path) for path in pathlib.Path("/proc/self/fd").glob("*")
                   if path.is_symlink() and os.path.lexists(path)}
            for name in ("tcp", "tcp6"):
                for line in pathlib.Path("/proc/net", name).read_text().splitlines()[1:]:
                    words = line.split()
                    if words[3] == "0A" and f"socket:[{words[9]}]" in own:  # it listens
                        yield words[1].split(":")[0]
        before = len(list(ports()))
        with cluster.Cluster(jobs=2):
            found = list(ports())
        self.assertGreaterEqual(len(found), before)
        self.assertLessEqual(set(found), {"0100007F"}, "hexadecimal addresses; 0100007F: 127.0.0.1")

    def test_a_scheduler_that_does_not_answer_is_named_in_one_line(self):
        address = f"127.0.0.1:{free_port()}"
        before, cluster._CONNECT_S = cluster._CONNECT_S, 1.0
        self.addCleanup(setattr, cluster, "_CONNECT_S", before)
        self.assertLessEqual(before, 30.0)
        warnings.simplefilter("ignore")  # tornado's, which python3 -m unittest shows
        with contextlib.redirect_stderr(io.StringIO()) as said, \
                contextlib.redirect_stdout(io.StringIO()):
            code = cli.main([str(DATA / "tiny.yaml"), "--algorithms", "random", "--output",
                             str(self.folder / "out"), "--scheduler", address, "--programs",
                             str(pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent)])
        self.assertEqual(2, code)
        self.assertRegex(said.getvalue(), f"^scheduler: got '{address}', which does not answer within")
        self.assertEqual(1, said.getvalue().count("\n"), said.getvalue())

    def refusal_of_slurm(self, **programs):
        """Returns the line for scheduler slurm on a host with these programs alone."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        for name, script in programs.items():
            (folder / name).write_text("#!/bin/sh\n" + script + "\n")
            (folder / name).chmod(0o755)
        with unittest.mock.patch.dict(os.environ, PATH=str(folder)), \
                self.assertRaises(cluster.BadScheduler) as refused:
            cluster.Cluster("slurm")
        return str(refused.exception)

    def test_slurm_is_refused_at_once_where_it_is_missing_or_does_not_answer(self):
        self.assertRegex(self.refusal_of_slurm(),
                         "^scheduler: got 'slurm', but this host has no sbatch; start it on")
        words = self.refusal_of_slurm(sbatch="exit 1", sinfo="echo 'sinfo: no controller' >&2; exit 1")
        self.assertRegex(words, "whose controller does not answer; .* [(]sinfo: no controller[)]$")
        self.assertIn("sinfo'", self.refusal_of_slurm(sbatch="exit 1"))

    def test_a_scheduler_that_is_lost_again_and_again_ends_the_benchmark(self):
        class Dying:
            """A cluster that is lost whenever runs are submitted."""
            is_local = False
            client = unittest.mock.Mock()
            client.submit.side_effect = RuntimeError("Tried sending message after closing")
            connections = 0

            def workers(self):
                return 1

            def is_alive(self):
                return False

            def reconnect(self, _):
                self.connections += 1

        job = runs.Job("c", "c_1", self.folder / "c_1", self.folder / "c_1.json", [["true"]], 1.0)
        here = Dying()
        one = runs._Runs([], here, lambda _: None, lambda _: False)
        one._futures = {"future": job}
        with self.assertRaisesRegex(cluster.Lost, "^the scheduler was lost 20 times and no run "
                                                  "completed in between; .* the same command resumes"):
            one._recover()
        self.assertEqual(20, here.connections)

    def test_a_run_has_one_thread_unless_the_user_asks_for_more(self):
        commands = [["/bin/sh", "-c", "echo threads $OMP_NUM_THREADS"]]
        kept = {name: value for name, value in os.environ.items() if name != "OMP_NUM_THREADS"}
        with unittest.mock.patch.dict(os.environ, kept, clear=True), cluster.Cluster() as here:
            for environment, words in (({}, "threads 1"), ({"OMP_NUM_THREADS": "3"}, "threads 3")):
                outcome = here.client.submit(worker.perform, str(self.folder), commands, False,
                                             str(self.folder), environment).result()
                self.assertEqual(words, outcome["words"])

    def test_a_worker_without_the_clients_files_is_named(self):
        commands = [[str(self.folder / "train")]]
        for folder, words in ((self.folder / "none", "there is no folder .*/none; expected"),
                              (self.folder, "No such file or directory: .*/train; expected")):
            with cluster.Cluster() as here:
                future = here.client.submit(worker.perform, str(folder), commands, False,
                                            str(self.folder), {})
                with self.assertRaisesRegex(RuntimeError, f"^worker on .*: {words}"):
                    future.result()


if __name__ == "__main__":
    rostest.rosrun("aquafarm_agents", "dask", DaskTest, sys.argv)
