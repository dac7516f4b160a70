# SPDX-License-Identifier: BSD-3-Clause
"""The Dask workers that execute runs: in this process, of a Dask scheduler, or as jobs of Slurm."""
import contextlib
import logging
import re
import shutil
import subprocess
import time

LOCAL, SLURM = "local", "slurm"
HELP = ("where runs execute: local (this machine's cores), slurm (jobs of Slurm, made by "
        "dask-jobqueue), or the address of a Dask scheduler such as host:8786, which needs the same "
        "files under the same paths (default: local)")

_CONNECT_S = 25.0  # max duration of one attempt to connect, and of sinfo
_SUBMIT_S = 120.0  # max wait for sbatch
_RETURN_S = 600.0  # max wait for a scheduler that was lost
_ADDRESS = re.compile(r"(?:(?:tcp|tls)://)?[^/:\s]+:\d{1,5}")


class BadScheduler(ValueError):
    """The scheduler cannot be used. The message is one line."""


class Lost(RuntimeError):
    """The scheduler was lost and did not return. The message is one line."""


def check(scheduler):
    """Raises BadScheduler if the text is neither local, slurm nor an address."""
    if scheduler not in (LOCAL, SLURM) and not _ADDRESS.fullmatch(scheduler):
        raise BadScheduler(f"scheduler: got '{scheduler}', expected local, slurm or an address such "
                           "as host:8786")


class Cluster:
    """A connection to the workers, and a context manager that closes it."""

    def __init__(self, scheduler=LOCAL, jobs=1):
        """Connects to the workers. jobs is the number of parallel runs for local and slurm; it is
        ignored for the address of a scheduler, which has its own workers. Raises BadScheduler."""
        self._scheduler = scheduler
        self._made = None
        self.client = None
        self._identity = None
        logging.disable(logging.ERROR)  # runs.py reports each lost worker and scheduler in one line
        address = self._make(jobs)
        try:
            self._connect(address)
        except (OSError, ValueError) as error:
            self.close()
            raise BadScheduler(
                f"scheduler: got '{scheduler}', which does not answer within {_CONNECT_S:.0f} s; "
                f"check its address, and that 'dask scheduler' runs there ({_first_line(error)})"
            ) from None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    @property
    def is_local(self):
        return self._scheduler == LOCAL

    def _make(self, jobs):
        if self._scheduler == LOCAL:
            from dask import config
            from distributed import LocalCluster
            # Dask always opens its HTTP servers. Here they are on the loopback address and serve no
            # page.
            place = "127.0.0.1:0"
            with config.set({"distributed.scheduler.http.routes": [],
                             "distributed.worker.http.routes": []}):
                self._made = LocalCluster(n_workers=1, threads_per_worker=jobs, processes=False,
                                          dashboard_address=place, worker_dashboard_address=place,
                                          memory_limit=0)
            return self._made
        if self._scheduler == SLURM:
            return self._make_slurm(jobs)
        return self._scheduler if "//" in self._scheduler else "tcp://" + self._scheduler

    def _make_slurm(self, jobs):
        _check_slurm()
        try:
            from dask_jobqueue import SLURMCluster
        except ImportError:
            raise BadScheduler("scheduler: got 'slurm', but Python's package dask_jobqueue is "
                               "missing; install it with 'pip install dask-jobqueue==0.8.1', or "
                               "use docs/scale/dask.sbatch") from None
        from dask import config
        chosen = {"cores": 1, "processes": 1, "memory": "1GB"}
        chosen.update({name: value for name, value in config.get("jobqueue.slurm", {}).items()
                       if name in chosen and value is not None})
        try:
            self._made = SLURMCluster(**chosen,
                                      scheduler_options={"dashboard_address": "127.0.0.1:0"})
            self._made.scale(jobs=jobs)
            # scale() submits the jobs in Dask's thread, which only logs an error of sbatch.
            self._made.sync(self._made._correct_state, callback_timeout=_SUBMIT_S)
        except (OSError, ValueError, RuntimeError) as error:
            with contextlib.suppress(AssertionError):  # Dask asserts that workers were submitted
                self.close()
            raise BadScheduler(f"scheduler: got 'slurm', which does not accept a job: "
                               f"{_refusal(error)}; check queue and limits in "
                               "~/.config/dask/jobqueue.yaml") from None
        return self._made

    def _connect(self, address):
        from distributed import Client
        self.client = Client(address, timeout=_CONNECT_S, set_as_default=False)
        self._identity = self._ask_identity()

    def _ask(self, question, **arguments):
        """Returns the answer of the scheduler. Raises TimeoutError (an OSError) after 10 s."""
        return self.client.sync(question, **arguments, callback_timeout=10.0)

    def _ask_identity(self):
        return self._ask(self.client.scheduler.identity)["id"]

    def is_alive(self):
        """Returns whether the scheduler to which the runs were submitted still answers."""
        try:
            return self.client.status == "running" and self._ask_identity() == self._identity
        except OSError:
            return False

    def reconnect(self, report):
        """Waits for a scheduler that was lost, and connects again. Raises Lost."""
        if self._made is not None:
            raise Lost(f"the scheduler '{self._scheduler}' of this process ended")
        report(f"the scheduler {self._scheduler} was lost; waiting up to {_RETURN_S:.0f} s for it")
        self._close_client()
        end = time.monotonic() + _RETURN_S
        while True:
            try:
                self._connect(self._make(0))
                report(f"the scheduler {self._scheduler} answers again")
                return
            except (OSError, ValueError):
                self._close_client()  # Client() may succeed before the scheduler is lost again
                if time.monotonic() > end:
                    raise Lost(f"the scheduler {self._scheduler} did not come back within "
                               f"{_RETURN_S:.0f} s; the same command resumes") from None
                time.sleep(1.0)

    def workers(self):
        """Returns the number of runs that the workers can execute in parallel; 0 if unknown."""
        try:
            return sum(self._ask(self.client.scheduler.ncores, workers=None).values())
        except OSError:  # the scheduler was just lost
            return 0

    def cancel(self, futures):
        """Ends the programs of these futures. Does nothing if the scheduler was just lost: its
        programs then end by themselves."""
        try:
            if self.client is not None:
                self._ask(self.client._cancel, futures=list(futures))  # cancel() has no timeout
        except OSError:
            pass

    def _close_client(self):
        if self.client is not None:
            client, self.client = self.client, None
            client.close(timeout=5.0)

    def close(self):
        """Closes the connection, and ends the workers that this object started."""
        self._close_client()
        if self._made is not None:
            made, self._made = self._made, None
            made.close(timeout=20.0)
        logging.disable(logging.NOTSET)


def _check_slurm():
    """Raises BadScheduler if this host cannot submit jobs to Slurm."""
    if shutil.which("sbatch") is None:
        raise BadScheduler("scheduler: got 'slurm', but this host has no sbatch; start it on a host "
                           "that submits jobs to Slurm (Debian's package slurm-client), or use local "
                           "or the address of a Dask scheduler")
    try:
        done = subprocess.run(["sinfo", "--noheader"], capture_output=True, text=True, check=False,
                              timeout=_CONNECT_S)
        fault = "" if done.returncode == 0 else done.stderr.strip() or f"exit code {done.returncode}"
    except subprocess.TimeoutExpired:
        fault = f"no answer within {_CONNECT_S:.0f} s"
    except OSError as error:
        fault = str(error)
    if fault:
        raise BadScheduler("scheduler: got 'slurm', whose controller does not answer; check "
                           f"SLURM_CONF and the output of sinfo ({fault.splitlines()[0]})")


def _refusal(error):
    """Returns the message of sbatch in an error of dask-jobqueue. If the error contains no such
    message, returns its first line."""
    found = re.search(r"^sbatch: (?:error: )?(.+)$", str(error), re.MULTILINE)
    return found[1] if found else _first_line(error)


def _first_line(error):
    return (str(error).splitlines() or [type(error).__name__])[0]
