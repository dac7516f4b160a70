# SPDX-License-Identifier: BSD-3-Clause
"""Kinds of the campaign `kill` for programs that consist of several processes.

ranks      kills one rank (process) of a training in several ranks. The training must then end with
           exit code 6. It is resumed with 2, 4 or 8 ranks
workers    kills and replaces a worker or the scheduler of a benchmark on two Dask workers while the
           benchmark continues. The tables must equal those of an undisturbed benchmark
"""
import os
import signal
import subprocess
import time

from campaigns import common, kill, ros

RANK_LOST = 6        # exit code
BAD_INPUT = 2        # exit code
NO_SCHEDULER = "which does not answer within"  # error of a client that never reached its scheduler
KILLS = 5            # max kills of one run without --kills; then the run may finish undisturbed
STOP_S = 30.0        # longer stops of the other ranks are counted: the max on an idle machine
BUSY_STOP_S = 180.0  # longer stops are failures: a busy machine starts processes more slowly
STARTS = 5           # max starts of a benchmark whose scheduler is killed before the first contact
LIMIT_S = 600
ARGUMENTS = ["paper", "-n", "40000", *kill.ROLLOUT, "-o", "shards=8"]


def children(pid):
    """Returns the process ids of the children of a process."""
    try:
        with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
            return list(map(int, file.read().split()))
    except OSError:
        return []


class Ranks:
    """Kills a random rank of a training in two, four or eight ranks."""

    def __init__(self, campaign, place):
        self.campaign = campaign
        self.place = place
        self.trainer = campaign.program("aquafarm_train")
        self.expected, self.seconds = None, 0.0

    def command(self, folder, ranks):
        return [*kill.command(self.trainer, "ppo", ARGUMENTS, folder, kill.holds_run(folder)),
                *(["--ranks", str(ranks)] if ranks else [])]

    def reference(self):
        folder = self.place / "ranks_whole"
        begin = time.monotonic()
        code, words = common.execute(*self.command(folder, 0), seconds=LIMIT_S)
        self.seconds = time.monotonic() - begin
        if self.campaign.check(code == 0, f"ranks: uninterrupted: exit code {code}: {words}"):
            self.expected = kill.results(folder)

    def attempt(self, folder, is_last):
        """Starts the training and kills a rank unless this is the last attempt. Returns whether the
        training is complete, or None after a failure."""
        ranks = self.campaign.rng.choice((2, 4, 8))
        victim, begin = None, time.monotonic()
        with common.started(*self.command(folder, ranks)) as process:
            try:
                words = process.communicate(timeout=LIMIT_S if is_last else
                                            self.campaign.rng.uniform(0.1, 2.0 * self.seconds))[0]
            except subprocess.TimeoutExpired:
                found = children(process.pid)
                if found and not is_last:
                    victim, begin = self.campaign.rng.choice(found), time.monotonic()
                    os.kill(victim, signal.SIGKILL)
                words = process.communicate(timeout=LIMIT_S)[0]
        took, words = time.monotonic() - begin, words.decode(errors="replace")
        if victim is None:
            good = self.campaign.check(process.returncode == 0,
                                       f"ranks: exit code {process.returncode}: {words[-600:]}")
            return True if good else None
        self.campaign.attempt("kills of one of several ranks")
        if took > STOP_S:
            self.campaign.attempt(f"stops that took more than {STOP_S:.0f} s")
        self.campaign.check(took < BUSY_STOP_S, f"ranks: the others ended after {took:.0f} s")
        if process.returncode == 0:
            return True  # the rank had just ended
        good = self.campaign.check(process.returncode == RANK_LOST,
                                   f"ranks: exit code {process.returncode}: {words[-600:]}")
        return False if good else None

    def try_once(self, number):
        if self.expected is None:
            self.reference()
        folder = self.place / f"ranks_{number}"
        done = False
        most = self.campaign.kills or KILLS
        for kills in range(most + 1):
            done = self.attempt(folder, kills == most)
            if done is not False:
                break
        if done and self.expected:
            kill.compare(self.campaign, "ranks", folder, self.expected, kill.results(folder))
        common.remove(folder)


class Workers(kill.Benchmark):
    """Kills and replaces the workers and the Dask scheduler of a benchmark."""

    def __init__(self, campaign, place):
        super().__init__(campaign, place)
        self.port = 0
        self.processes = []  # the scheduler, then its workers

    def start(self, number):
        """Starts the scheduler (`number` 0) or a worker; returns the process."""
        words = (["scheduler", "--host", "127.0.0.1", "--port", str(self.port)] if number == 0 else
                 ["worker", f"tcp://127.0.0.1:{self.port}", "--nthreads", "1", "--no-nanny",
                  "--local-directory", str(self.place)])
        return subprocess.Popen(["/usr/bin/dask", *words, "--no-dashboard"],
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL)

    def end(self, number):
        self.processes[number].kill()
        self.processes[number].wait()

    def disturb(self, process):
        """Kills and replaces random workers and the scheduler, then waits until the benchmark ends;
        returns its output."""
        for _ in range(self.campaign.kills or KILLS):
            try:
                return process.communicate(timeout=self.campaign.rng.uniform(1.0, self.seconds))[0]
            except subprocess.TimeoutExpired:
                number = self.campaign.rng.choice((0, 1, 1, 2, 2))
                self.end(number)
                self.campaign.attempt("kills of a Dask worker" if number else
                                      "kills of a Dask scheduler")
                time.sleep(self.campaign.rng.uniform(0.0, 2.0))
                self.processes[number] = self.start(number)
                for other in range(1, len(self.processes)):
                    if self.processes[other].poll() is not None:  # it ended with the scheduler
                        self.processes[other] = self.start(other)
        return self.outlast(process)

    def outlast(self, process):
        """Waits until the benchmark ends; returns its output. Replaces workers that ended because
        their scheduler was killed. Kills the benchmark after LIMIT_S."""
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            try:
                return process.communicate(timeout=2.0)[0]
            except subprocess.TimeoutExpired:
                for other in range(1, len(self.processes)):
                    if self.processes[other].poll() is not None:
                        self.processes[other] = self.start(other)
        process.kill()
        self.campaign.fail(f"workers: the benchmark did not end within {LIMIT_S} s")
        return process.communicate()[0]

    def play(self, folder):
        """Starts or resumes the benchmark and disturbs it; returns its exit code and output."""
        with common.started(*self.command(folder), "--scheduler",
                            f"127.0.0.1:{self.port}") as process:
            words = self.disturb(process).decode(errors="replace")
        return process.returncode, words

    def try_once(self, number):
        if self.expected is None:
            self.reference("workers_whole")
        self.port = ros.free_port()
        folder = self.place / f"workers_{number}"
        self.processes = [self.start(0), self.start(1), self.start(2)]
        try:
            for _ in range(STARTS):
                code, words = self.play(folder)
                if code != BAD_INPUT or NO_SCHEDULER not in words:
                    break
                self.campaign.attempt("starts that found no scheduler and said so")
        finally:
            for other in range(len(self.processes)):
                self.end(other)
        if self.campaign.check(code == 0, f"workers: exit code {code}: {words[-800:]}"):
            kill.compare(self.campaign, "workers", folder, self.expected, self.results(folder))
        common.remove(folder)
