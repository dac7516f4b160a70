# SPDX-License-Identifier: BSD-3-Clause
"""Executes trainings and evaluations as programs on Dask workers, in parallel. Runs can be resumed.
They are executed again if a worker or the scheduler is lost, and terminated by an interrupt."""
import dataclasses
import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import time
import typing
from asyncio import CancelledError, TimeoutError
from concurrent import futures

from aquafarm_benchmark.cluster import Lost
from aquafarm_benchmark.worker import has_begun, last_line

_REFUSED = 2  # exit code of a program for invalid input
_LINGER_S = 12.0  # time for programs to save after Ctrl-C; roslaunch allows 15 by default
_PERIOD_S = 5.0  # time between two checks of the scheduler, and max wait for the result of a run
_LOSSES = 5  # max number of times that a run is submitted again after Dask gave it up
_RECOVERIES = 20  # max number of losses of the scheduler without a completed run in between
_DONE = re.compile(r"(?:steps|episodes) ([\d,]+) / ([\d,]+)")
# Environment variables that change results or the output of programs. The programs on the workers
# get the values of this process.
_PASSED_ON = re.compile(r"OPENBLAS_\w+|OMP_\w+|AQUAFARM_\w+")


class RunFailed(RuntimeError):
    """Some runs failed. The message lists them with the reasons."""


class Interrupted(RuntimeError):
    """Ctrl-C was pressed. Complete runs are kept."""


@dataclasses.dataclass
class Job:
    """A run: commands that are executed one after the other and write `result`."""
    contestant: str  # runs of the same contestant differ only in the seed
    name: str
    folder: pathlib.Path
    result: pathlib.Path
    commands: typing.List[typing.List[str]]
    cost: float  # estimated duration, relative to the other runs
    resumable: bool = False  # the first command can resume a run, with --resume
    good_codes: typing.Tuple[int, ...] = (0,)  # exit codes of the last command that mean success
    resumes: bool = False  # True: the first command was started with --resume
    started: typing.Optional[float] = None  # time.monotonic of the start; None: not started
    command: int = 0  # number of the latest started command, from 1; 0: none
    losses: int = 0  # number of times that Dask gave the run up
    done_at_start: float = 0.0  # completed fraction when the run was resumed

    @property
    def log(self):
        return self.folder.with_name(self.folder.name + ".log")

    @property
    def has_begun(self):
        """True if the folder contains a run that this job will resume."""
        return self.resumable and has_begun(self.folder)

    def note_start(self, event):
        """Records that a worker has started a command. event: logged by worker.perform"""
        self.command, self.resumes = event["command"], event["resumes"]
        if self.command == 1:
            self.done_at_start = self.done() if self.resumes else 0.0
            self.started = time.monotonic()

    def done(self):
        """Returns the completed fraction of the first command, read from the last line of the log.
        Returns 1 after a later command has started."""
        if self.command > 1:
            return 1.0
        found = [(int(done.replace(",", "")) / max(1, int(limit.replace(",", ""))))
                 for done, limit in _DONE.findall(last_line(self.log))]
        return min(1.0, max(found, default=0.0))


def is_complete(result):
    """Returns whether an evaluation file exists and is complete."""
    try:
        return bool(json.loads(result.read_text())["complete"])
    except (OSError, ValueError, KeyError):
        return False


def run_all(jobs, cluster, report, period_s=10.0, complete=is_complete):
    """Executes jobs on the workers of a cluster.Cluster, the most costly first. Skips jobs with a
    complete result.

    report(text): called with the progress every period_s seconds, and with each event, such as a
        failure or the loss of a worker
    complete(path): returns whether a result is complete

    Returns {contestant: reason} for the contestants that are not suitable: their first command
    exits with code 2 (invalid input), for example that of a tabular learner on a farm with too many
    states. Exit code 2 is a failure if a later command or a resumed run returns it, or if the
    contestant has a complete run. If some runs failed, raises RunFailed after all others have
    ended. On Ctrl-C, waits until the programs have saved and exited, at most _LINGER_S, and raises
    Interrupted. Raises cluster.Lost if the scheduler does not return, or is lost too often.
    """
    return _Runs(jobs, cluster, report, complete).run(period_s)


class _Runs:
    """The state of run_all."""

    def __init__(self, jobs, cluster, report, complete):
        self._cluster = cluster
        self._report = report
        self._complete = complete
        self._waiting = sorted((job for job in jobs if not complete(job.result)),
                               key=lambda job: -job.cost)
        self._took_part = {job.contestant for job in jobs if complete(job.result)}
        self._over = len(jobs) - len(self._waiting)
        self._futures = {}  # submitted runs that have not ended: {future: job}
        self._jobs = {}  # {key of a future: job}, for events
        self._failures, self._declined = [], {}
        self._recoveries = 0
        self._progress = _Progress(jobs, self._over)
        if self._over:
            report(f"{self._over} of {len(jobs)} runs are already complete")

    def run(self, period_s):
        reported = checked = time.monotonic()
        try:
            self._submit_all(self._waiting)
            while self._futures:
                for future in [one for one in self._futures if one.done()]:
                    self._settle(future)
                now = time.monotonic()
                if now - checked >= _PERIOD_S and not self._cluster.is_local:
                    checked = now
                    if not self._cluster.is_alive():
                        self._recover()
                if now - reported >= period_s and self._futures:
                    reported = now
                    self._report(self._progress.describe(list(self._futures.values()),
                                                         self._cluster.workers()))
                time.sleep(0.05)
        except BaseException as error:
            self._end()
            if isinstance(error, KeyboardInterrupt):
                raise Interrupted("interrupted; the same command resumes it") from None
            raise
        if self._failures:
            raise RunFailed("\n".join(self._failures))
        return self._declined

    def _submit_all(self, jobs):
        if not jobs:
            return
        import cloudpickle
        from aquafarm_benchmark import worker
        cloudpickle.register_pickle_by_value(worker)  # remote workers do not have the module
        self._cluster.client.subscribe_topic(worker.TOPIC, self._note)
        if not self._cluster.workers():
            self._report("the scheduler has no worker yet; the runs wait for one")
        for number, job in enumerate(jobs):
            self._submit(job, -number)

    def _submit(self, job, priority=0):
        from aquafarm_benchmark import worker
        job.folder.mkdir(parents=True, exist_ok=True)
        environment = {name: value for name, value in os.environ.items()
                       if _PASSED_ON.fullmatch(name)}
        future = self._cluster.client.submit(
            worker.perform, str(job.folder), job.commands, job.resumable, os.getcwd(), environment,
            key=f"{job.name}-{os.urandom(8).hex()}", pure=False, priority=priority)
        self._jobs[future.key] = job
        self._futures[future] = job

    def _note(self, event):
        """Called in Dask's thread when a worker starts a command."""
        _, message = event
        job = self._jobs.get(message["key"])
        if job is None:
            return
        if job.started is not None and message["command"] == 1:
            self._report(f"{job.name}: its worker or the scheduler was lost; it runs again on "
                         f"{message['host']}")
        job.note_start(message)

    def _settle(self, future):
        """Processes the end of a run, or the loss of its worker."""
        job = self._futures.pop(future)
        if future.status == "cancelled":  # the scheduler was lost, or cancel() was called below
            if job.contestant not in self._declined:
                self._submit_again(future, job)
            return
        if future.status == "error":
            self._settle_error(future, job, future.exception())
            return
        try:
            outcome = future.result(timeout=_PERIOD_S)
        # The result was lost with the worker or the scheduler. Dask raises one of two exceptions
        # with the name CancelledError.
        except (OSError, TimeoutError, CancelledError, futures.CancelledError):
            self._futures[future] = job
            return
        if outcome is None:
            self._submit_again(future, job)
            return
        job.resumes, code = outcome["resumes"], outcome["code"]
        if code in job.good_codes and self._complete(job.result):
            self._progress.finish(job)
            self._recoveries = 0
            self._took_part.add(job.contestant)
            shutil.rmtree(job.folder / "checkpoints", ignore_errors=True)
        elif (code == _REFUSED and not job.resumes and outcome["commands"] == 1 and
              job.contestant not in self._took_part):
            self._declined.setdefault(job.contestant, outcome["words"])
            self._cluster.cancel([one for one, other in self._futures.items()
                                  if other.contestant == job.contestant])
        elif job.contestant not in self._declined:
            self._fail(f"{job.name}: exit code {code}: {outcome['words']} ({job.log})")

    def _submit_again(self, future, job):
        """Submits a job again. If the scheduler was lost, keeps the ended future for _recover."""
        try:
            self._submit(job)
        except Exception:  # Dask raises several types
            if self._cluster.is_local or self._cluster.is_alive():
                raise
            self._futures[future] = job

    def _settle_error(self, future, job, error):
        from distributed import KilledWorker
        job.losses += 1
        if isinstance(error, KilledWorker) and job.losses <= _LOSSES:
            self._submit_again(future, job)
            return
        self._fail(f"{job.name}: {str(error).splitlines()[0] if str(error) else repr(error)}")

    def _fail(self, text):
        self._failures.append(text)
        self._report("failed: " + text)

    def _recover(self):
        """Waits until the lost scheduler is back, and submits the remaining jobs to it."""
        left = list(self._futures.values())
        while True:
            self._recoveries += 1
            if self._recoveries > _RECOVERIES:
                raise Lost(f"the scheduler was lost {_RECOVERIES} times and no run completed in "
                           "between; check its output, then the same command resumes")
            self._cluster.reconnect(self._report)
            self._futures.clear()
            self._jobs.clear()
            try:
                self._submit_all([job for job in left if not self._complete(job.result)])
                return
            except Exception:  # Dask raises several types if the scheduler is lost again just now
                if self._cluster.is_alive():
                    raise

    def _end(self):
        """Ends all programs, and waits for at most _LINGER_S until they have saved."""
        numbers = (signal.SIGINT, signal.SIGTERM)
        # Repeated interrupts are ignored, because this function ends soon.
        before = [signal.signal(number, signal.SIG_IGN) for number in numbers]
        self._cluster.cancel(list(self._futures))
        end = time.monotonic() + _LINGER_S
        for job in self._futures.values():
            while job.started is not None and is_written(job.log) and time.monotonic() < end:
                time.sleep(0.05)
        for number, handler in zip(numbers, before):
            signal.signal(number, handler)


def is_written(log):
    """Returns whether a program of a run is still running. Such a program keeps the log locked."""
    try:
        with open(log, "rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        pass
    return False


class _Progress:
    """The progress of all runs, and an estimate of the remaining time."""

    def __init__(self, jobs, over):
        self._count = len(jobs)
        self._costs = {job.contestant: job.cost for job in jobs}
        self._over = over
        self._took = {}  # {contestant: [duration of each completed job that was not resumed [s]]}

    def finish(self, job):
        self._over += 1
        if not job.resumes and job.started is not None:
            self._took.setdefault(job.contestant, []).append(time.monotonic() - job.started)

    def describe(self, left, at_once):
        """Returns the progress in one line.

        left: jobs that have not ended
        at_once: number of jobs that the workers can execute in parallel
        """
        now = time.monotonic()
        seconds = {name: sum(took) / len(took) for name, took in self._took.items()}
        running = [job for job in left if job.started is not None]
        done_of = {id(job): job.done() for job in running}
        for job in running:
            done = done_of[id(job)] - job.done_at_start
            if job.contestant not in seconds and done > 0.02:
                seconds[job.contestant] = (now - job.started) / done
        words = ", ".join(f"{job.name} {100.0 * done_of[id(job)]:.0f} %" for job in running)
        text = f"{self._over} of {self._count} runs complete; {words or 'no run is executing'}"
        if seconds:
            of_unit = max(took / self._costs[name] for name, took in seconds.items())
            work = sum(seconds.get(job.contestant, of_unit * job.cost) *
                       (1.0 - done_of.get(id(job), 0.0)) for job in left)
            text += f"; about {describe_seconds(work / max(1, min(at_once, len(left))))} left"
        return text


def describe_seconds(seconds):
    """Returns a duration as text: '45 s', '7 min' or '2 h 05 min'."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"
