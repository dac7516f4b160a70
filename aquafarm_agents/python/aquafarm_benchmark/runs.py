# SPDX-License-Identifier: BSD-3-Clause
"""Trainings and evaluations as processes: in parallel, each resumable, all ended in time."""
import ctypes
import dataclasses
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import typing

_REFUSED = 2  # exit code of a program whose input does not fit
_LINGER_S = 60.0  # that a process is given to save after Ctrl-C
_DONE = re.compile(r"(steps|episodes) ([\d,]+) / ([\d,]+)")


_LIBC = ctypes.CDLL(None, use_errno=True)
_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>


def _end_with_parent():
    """In a child: should this program be killed, the child saves and ends as at Ctrl-C."""
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGINT)


class RunFailed(RuntimeError):
    """Some runs failed; the text says which and why."""


class Interrupted(RuntimeError):
    """Ctrl-C; what was finished is kept."""


@dataclasses.dataclass
class Job:
    """Commands that run one after the other and leave `result` behind."""
    contestant: str
    name: str
    folder: pathlib.Path
    result: pathlib.Path
    commands: typing.List[typing.List[str]]
    cost: float
    next_command: int = 0
    process: typing.Optional[subprocess.Popen] = None
    started: float = 0.0

    @property
    def log(self):
        return self.folder.with_name(self.folder.name + ".log")

    def start_next(self):
        """Starts the next command; its words are appended to the log."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(self.commands[self.next_command], stdout=log,
                                            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                            start_new_session=True,
                                            preexec_fn=_end_with_parent)
        self.next_command += 1

    def last_words(self):
        """Last line of the log."""
        text = self.log.read_text(errors="replace") if self.log.exists() else ""
        lines = text.strip().splitlines()
        return lines[-1] if lines else "it said nothing"

    def done(self):
        """Share of the training that is over, as its last line says; 0 before, 1 after it."""
        if self.next_command > 1:
            return 1.0
        found = [(int(done.replace(",", "")) / max(1, int(limit.replace(",", ""))))
                 for _, done, limit in _DONE.findall(self.last_words())]
        return min(1.0, max(found, default=0.0))


def is_complete(result):
    """Whether an evaluation was written and not cut short."""
    try:
        return bool(json.loads(result.read_text())["complete"])
    except (OSError, ValueError, KeyError):
        return False


def run_all(jobs, at_once, report, period_s=10.0):
    """Runs the jobs that have no result yet, the longest first, `at_once` side by side.

    report(text) is told what is going on every period_s. Returns {name of contestant: reason} of
    those who refused to take part (exit code 2, such as a table on a farm with too many states).
    Raises RunFailed when some failed (the others are run all the same), Interrupted on Ctrl-C after
    every process has saved and ended.
    """
    waiting = sorted((job for job in jobs if not is_complete(job.result)),
                     key=lambda job: -job.cost)
    over = len(jobs) - len(waiting)
    if over:
        report(f"{over} of {len(jobs)} runs are there already")
    progress = _Progress(jobs, over, waiting, at_once)
    running, failures, declined, told = [], [], {}, time.monotonic()
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                job = waiting.pop(0)
                job.started = time.monotonic()
                job.start_next()
                running.append(job)
            time.sleep(0.05)
            for job in list(running):
                code = job.process.poll()
                if code is None:
                    continue
                if code == 0 and job.next_command < len(job.commands):
                    job.start_next()
                    continue
                running.remove(job)
                if code == 0 and is_complete(job.result):
                    progress.finish(job)
                    shutil.rmtree(job.folder / "checkpoints", ignore_errors=True)
                elif code == _REFUSED:
                    declined.setdefault(job.contestant, job.last_words())
                    waiting = [one for one in waiting if one.contestant != job.contestant]
                else:
                    failures.append(f"{job.name}: exit code {code}: {job.last_words()} ({job.log})")
                    report("failed: " + failures[-1])
            if time.monotonic() - told >= period_s and running:
                told = time.monotonic()
                report(progress.describe(running, waiting))
    except BaseException as error:
        _end(running)
        if isinstance(error, KeyboardInterrupt):
            raise Interrupted("interrupted; the same command goes on from here") from None
        raise
    if failures:
        raise RunFailed("\n".join(failures))
    return declined


def _end(running):
    for job in running:
        job.process.send_signal(signal.SIGINT)
    end = time.monotonic() + _LINGER_S
    for job in running:
        try:
            job.process.wait(max(0.0, end - time.monotonic()))
        except subprocess.TimeoutExpired:
            os.killpg(job.process.pid, signal.SIGKILL)
            job.process.wait()


class _Progress:
    """How far all runs are, and how long they still take by what finished ones took."""

    def __init__(self, jobs, over, waiting, at_once):
        self._count = len(jobs)
        self._over = over
        self._at_once = min(at_once, max(1, len(waiting)))
        self._took = {}  # seconds of finished jobs by cost

    def finish(self, job):
        self._over += 1
        self._took.setdefault(job.cost, []).append(time.monotonic() - job.started)

    def describe(self, running, waiting):
        now = time.monotonic()
        seconds = {cost: sum(took) / len(took) for cost, took in self._took.items()}
        for job in running:
            if job.cost not in seconds and job.done() > 0.02:
                seconds[job.cost] = (now - job.started) / job.done()
        words = ", ".join(f"{job.name} {100.0 * job.done():.0f} %" for job in running)
        text = f"{self._over} of {self._count} runs over; {words}"
        if seconds:
            rate = max(took / cost for cost, took in seconds.items() if cost > 0)
            left = sum(seconds.get(job.cost, rate * job.cost) for job in waiting)
            left += sum(seconds.get(job.cost, rate * job.cost) * (1.0 - job.done())
                        for job in running)
            text += f"; about {describe_seconds(left / self._at_once)} left"
        return text


def describe_seconds(seconds):
    """'45 s', '7 min', '2 h 05 min'."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"
