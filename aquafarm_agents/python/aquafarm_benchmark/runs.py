# SPDX-License-Identifier: BSD-3-Clause
"""Trainings and evaluations as processes: parallel, resumable, and terminated on an interrupt."""
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

_REFUSED = 2  # exit code of a program for invalid input
_LINGER_S = 10.0  # time for processes to save after Ctrl-C; roslaunch allows 15
_DONE = re.compile(r"(?:steps|episodes) ([\d,]+) / ([\d,]+)")

_LIBC = ctypes.CDLL(None, use_errno=True)
_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>


def _end_with(parent):
    """Called in a child: if its parent is killed, the child saves and exits as on Ctrl-C."""
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGINT)
    if os.getppid() != parent:
        os._exit(1)  # the parent was killed before the call


class RunFailed(RuntimeError):
    """Some runs failed; the text lists them with the reasons."""


class Interrupted(RuntimeError):
    """Ctrl-C; complete runs are kept."""


@dataclasses.dataclass
class Job:
    """Commands that run one after the other and write `result`."""
    contestant: str
    name: str
    folder: pathlib.Path
    result: pathlib.Path
    commands: typing.List[typing.List[str]]
    cost: float
    resumes: bool = False  # its folder already contains a run
    next_command: int = 0
    process: typing.Optional[subprocess.Popen] = None
    started: float = 0.0
    done_at_start: float = 0.0

    @property
    def log(self):
        return self.folder.with_name(self.folder.name + ".log")

    def start_next(self, lock):
        """Starts the next command, which appends its output to the log and keeps `lock` open."""
        self.folder.mkdir(parents=True, exist_ok=True)
        parent = os.getpid()
        with open(self.log, "ab") as log:
            self.process = subprocess.Popen(self.commands[self.next_command], stdout=log,
                                            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                            start_new_session=True,
                                            pass_fds=[] if lock is None else [lock],
                                            preexec_fn=lambda: _end_with(parent))
        self.next_command += 1

    def last_words(self):
        """Returns the last line of the log."""
        text = self.log.read_text(errors="replace") if self.log.exists() else ""
        lines = text.strip().splitlines()
        return lines[-1] if lines else "it said nothing"

    def done(self):
        """Returns the completed fraction of the training, read from the log's last line: 0 before
        the training, 1 after it."""
        if self.next_command > 1:
            return 1.0
        found = [(int(done.replace(",", "")) / max(1, int(limit.replace(",", ""))))
                 for done, limit in _DONE.findall(self.last_words())]
        return min(1.0, max(found, default=0.0))


def is_complete(result):
    """Returns whether an evaluation was written and is complete."""
    try:
        return bool(json.loads(result.read_text())["complete"])
    except (OSError, ValueError, KeyError):
        return False


def run_all(jobs, at_once, report, lock=None, period_s=10.0):
    """Runs the jobs without a result, the longest first, up to `at_once` in parallel.

    report(text) is called with the progress every period_s seconds. Returns {contestant: reason}
    for contestants whose first program rejects its input (exit code 2, such as a table on a farm
    with too many states). Such an exit after the first command, or after a complete run of the
    contestant, is a failure. lock is a file descriptor that every process keeps open until it ends.
    Raises RunFailed if some runs failed (the others run nevertheless), Interrupted on Ctrl-C after
    every process has saved and exited.
    """
    waiting = sorted((job for job in jobs if not is_complete(job.result)),
                     key=lambda job: -job.cost)
    over = len(jobs) - len(waiting)
    if over:
        report(f"{over} of {len(jobs)} runs are there already")
    progress = _Progress(jobs, over, waiting, at_once)
    took_part = {job.contestant for job in jobs if is_complete(job.result)}
    running, failures, declined, told = [], [], {}, time.monotonic()
    try:
        while waiting or running:
            while waiting and len(running) < at_once:
                job = waiting.pop(0)
                job.done_at_start = job.done() if job.resumes else 0.0
                job.started = time.monotonic()
                job.start_next(lock)
                running.append(job)
            time.sleep(0.05)
            for job in list(running):
                code = job.process.poll()
                if code is None:
                    continue
                if code == 0 and job.next_command < len(job.commands):
                    job.start_next(lock)
                    continue
                running.remove(job)
                if code == 0 and is_complete(job.result):
                    progress.finish(job)
                    took_part.add(job.contestant)
                    shutil.rmtree(job.folder / "checkpoints", ignore_errors=True)
                elif (code == _REFUSED and not job.resumes and job.next_command == 1 and
                      job.contestant not in took_part):
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
            raise Interrupted("interrupted; the same command resumes it") from None
        raise
    if failures:
        raise RunFailed("\n".join(failures))
    return declined


def _end(running):
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # ignore repeated interrupts: this ends soon
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
    """Progress of all runs, and an estimate of the remaining time from complete runs."""

    def __init__(self, jobs, over, waiting, at_once):
        self._count = len(jobs)
        self._costs = {job.contestant: job.cost for job in jobs}
        self._over = over
        self._at_once = min(at_once, max(1, len(waiting)))
        self._took = {}  # durations of complete jobs by contestant [s]

    def finish(self, job):
        self._over += 1
        if not job.resumes:
            self._took.setdefault(job.contestant, []).append(time.monotonic() - job.started)

    def describe(self, running, waiting):
        now = time.monotonic()
        seconds = {name: sum(took) / len(took) for name, took in self._took.items()}
        for job in running:
            done = job.done() - job.done_at_start
            if job.contestant not in seconds and done > 0.02:
                seconds[job.contestant] = (now - job.started) / done
        words = ", ".join(f"{job.name} {100.0 * job.done():.0f} %" for job in running)
        text = f"{self._over} of {self._count} runs over; {words}"
        if seconds:
            of_unit = max(took / self._costs[name] for name, took in seconds.items())
            left = sum(seconds.get(job.contestant, of_unit * job.cost) *
                       (1.0 - (job.done() if job in running else 0.0))
                       for job in [*running, *waiting])
            text += f"; about {describe_seconds(left / self._at_once)} left"
        return text


def describe_seconds(seconds):
    """Returns '45 s', '7 min', '2 h 05 min'."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"
