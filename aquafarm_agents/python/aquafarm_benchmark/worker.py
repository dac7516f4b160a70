# SPDX-License-Identifier: BSD-3-Clause
"""The part of a run that executes on a Dask worker: its commands, one after the other.

The client sends this module to the workers by value. Workers need no workspace. They need Debian's
python3-distributed, and the programs and run folders under the same paths as on the client.
"""
import ctypes
import fcntl
import os
import pathlib
import re
import signal
import socket
import subprocess
import time


TOPIC = "aquafarm"  # Dask topic of the events that report each started command

_LINGER_S = 10.0  # time for a program to save after it was interrupted
_LOCK_LIMIT_S = 60.0  # time for the programs of a lost worker to end
_POLL_S = 0.05
# Launchers (torchrun, mpirun, srun) set these variables for the worker. Its programs do not get
# them: a training with these variables would train in ranks.
_OF_LAUNCHERS = re.compile(r"RANK|WORLD_SIZE|MASTER_\w+|OMPI_\w+|PMIX?_\w+|SLURM_PROCID|SLURM_STEP_\w+")
_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>
# A run has one core. Without this variable, PyTorch would use several threads in a learner of
# another package. Threads wait actively for each other, so parallel runs would be slower by orders
# of magnitude.
_ONE_CORE = {"OMP_NUM_THREADS": "1"}


def has_begun(folder):
    """Returns whether a run folder contains a run that can be resumed."""
    return ((folder / "run.json").exists() or
            any((folder / "checkpoints").glob("step_*.ckpt")))


def last_line(log):
    """Returns the last line of a log; "no output" if it is empty or does not exist."""
    text = log.read_text(errors="replace") if log.exists() else ""
    lines = text.strip().splitlines()
    return lines[-1] if lines else "no output"


def _started(command, log, cwd, environment):
    """Starts a program. If this worker is killed, the program receives SIGINT, saves and exits."""
    libc, parent = ctypes.CDLL(None), os.getpid()
    own = {name: value for name, value in os.environ.items() if not _OF_LAUNCHERS.fullmatch(name)}

    def end_with_the_worker():
        libc.prctl(_PR_SET_PDEATHSIG, signal.SIGINT)
        if os.getppid() != parent:
            os._exit(1)  # the worker was killed before prctl

    return subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT,
                            stdin=subprocess.DEVNULL, start_new_session=True, cwd=cwd,
                            env={**_ONE_CORE, **own, **environment}, preexec_fn=end_with_the_worker)


def _end(process):
    process.send_signal(signal.SIGINT)
    try:
        process.wait(_LINGER_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _lock(log, is_wanted):
    """Locks the log of a run. The programs of the run keep the log locked until they end. Waits
    while other programs lock it; raises RuntimeError after _LOCK_LIMIT_S. Returns False if the run
    is no longer wanted."""
    end = time.monotonic() + _LOCK_LIMIT_S
    while is_wanted():
        try:
            fcntl.flock(log, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except BlockingIOError:
            if time.monotonic() > end:
                raise RuntimeError(f"{log.name}: another program still writes this run after "
                                   f"{_LOCK_LIMIT_S:.0f} s; end it, then start again") from None
            time.sleep(_POLL_S)
    return False


def perform(folder, commands, resumable, cwd, environment):
    """Executes the commands of a run until one fails. The run folder must exist.

    If the run is resumable and its folder contains a run, the first command gets --resume. Returns
    {code: exit code of the last started command, commands: number of started commands, resumes:
    whether the first command got --resume, words: last line of the log}. Returns None if no client
    wants the run any more or this worker is closing. Raises RuntimeError, with a message of one
    line, if this worker cannot execute the run.
    """
    from distributed import get_worker  # takes a third of a second to load

    worker, host = get_worker(), socket.gethostname()
    key = worker.get_current_task()
    folder = pathlib.Path(folder)
    log_path = folder.with_name(folder.name + ".log")

    def is_wanted():
        task = worker.state.tasks.get(key)
        return (worker.status.name in ("running", "paused", "closing_gracefully") and
                task is not None and task.state == "executing")

    if not folder.is_dir():
        raise RuntimeError(f"worker on {host}: there is no folder {folder}; expected a folder that "
                           "the client and all workers share under this path")
    with open(log_path, "ab") as log:
        if not _lock(log, is_wanted):
            return None
        resumes = resumable and has_begun(folder)
        for number, command in enumerate(commands, 1):
            worker.log_event(TOPIC, {"key": key, "command": number, "resumes": resumes,
                                     "host": host})
            extra = ["--resume"] if resumes and number == 1 else []
            try:
                process = _started([*command, *extra], log, cwd, environment)
            except OSError as error:
                raise RuntimeError(
                    f"worker on {host}: {error.strerror}: {error.filename}; expected the client's "
                    "programs and folders under the same path on every worker") from None
            while process.poll() is None:
                if not is_wanted():
                    _end(process)
                    return None
                time.sleep(_POLL_S)
            if process.returncode != 0:
                break
    return {"code": process.returncode, "commands": number, "resumes": resumes,
            "words": last_line(log_path)}
