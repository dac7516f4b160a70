# SPDX-License-Identifier: BSD-3-Clause
"""Starts programs in sessions of their own, and ends all processes of a session at the end of its
context."""
import contextlib
import os
import pathlib
import signal
import subprocess
import time

# Signals that end a session, each with the time until the next one [s].
AT_ONCE = ((signal.SIGKILL, 10), )
GENTLY = ((signal.SIGINT, 30), (signal.SIGTERM, 10), *AT_ONCE)


@contextlib.contextmanager
def started(words, signals=GENTLY, **options):
    """Starts a program in a session of its own; yields its process. Leaving the context ends all
    processes of the session, also after an error or Ctrl-C, and also if the program itself has
    already ended."""
    process = subprocess.Popen(words, start_new_session=True, **options)
    try:
        yield process
    finally:
        # Ignores a second Ctrl-C, which could leave programs running.
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
        for number, seconds in signals:
            for one in running(process.pid):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(one, number)
            end = time.monotonic() + seconds
            while running(process.pid) and time.monotonic() < end:
                time.sleep(0.1)
        process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe:
                pipe.close()
        signal.signal(signal.SIGINT, before)


def running(session):
    """Returns the ids of the running processes of a session."""
    found = []
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            state, _, _, of = stat.read_text().rpartition(")")[2].split()[:4]
            if int(of) == session and state not in "ZX":
                found.append(int(stat.parent.name))
    return found
