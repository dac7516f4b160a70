# SPDX-License-Identifier: BSD-3-Clause
"""Common code of the campaigns: limits, counts, programs and processes."""
import collections
import os
import pathlib
import random
import shutil
import subprocess
import sys
import time

import sessions

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "aquafarm_sim" / "scenarios"
MOST_SHOWN = 20  # max number of failures that are printed; further ones are only counted


class NotBuilt(Exception):
    """A program that the campaign needs is missing."""


class WrongKind(Exception):
    """--only names a kind that the campaign does not have."""


class Campaign:
    """Limits, random numbers and counts of one run of a campaign."""

    def __init__(self, name, seconds, count, seed, workspace, only=(), stop_s=5.0,
                 kills=0):
        self.name = name
        self.seconds = seconds
        self.count = count
        self.workspace = workspace
        self.only = list(only)
        self.stop_s = stop_s
        self.kills = kills
        self.rng = random.Random(seed)
        self.seed = seed
        self.tried = collections.Counter()
        self.failures = []
        self._begin = time.monotonic()

    def elapsed(self):
        return time.monotonic() - self._begin

    def more(self, done):
        """Returns whether to start another try after `done` tries."""
        return done < self.count if self.count else self.elapsed() < self.seconds

    def kinds(self, all_kinds):
        """Returns the kinds of tries to make: those of --only, or all. @raises WrongKind"""
        for kind in self.only:
            if kind not in all_kinds:
                raise WrongKind(f"--only: got '{kind}', expected one of: {', '.join(all_kinds)}")
        return self.only or list(all_kinds)

    def attempt(self, what, number=1):
        """Adds `number` to the count of `what`."""
        self.tried[what] += number

    def fail(self, what):
        """Records a failure. The text must contain what is needed to repeat it, such as a seed."""
        self.failures.append(what)
        if len(self.failures) <= MOST_SHOWN:
            print(f"FAILED {what}", file=sys.stderr, flush=True)

    def check(self, holds, what):
        """Records a failure unless `holds`; returns `holds`."""
        if not holds:
            self.fail(what)
        return holds

    def program(self, name):
        """Returns the path of a program built by a core or by the workspace. @raises NotBuilt"""
        for place in ("core/aquafarm_sim", "core/aquafarm_agents", "devel/lib/aquafarm_sim",
                      "devel/lib/aquafarm_agents"):
            path = self.workspace / place / name
            if path.is_file() and os.access(path, os.X_OK):
                return path
        raise NotBuilt(f"no program {name} in {self.workspace}; build it with ./aquafarm test --fast "
                       "or ./aquafarm build, or give --workspace")

    def report(self):
        """Prints the counts and the number of failures; returns the exit code."""
        for what, number in sorted(self.tried.items()):
            print(f"{self.name}: {number:,} {what}")
        hidden = len(self.failures) - MOST_SHOWN
        if hidden > 0:
            print(f"{self.name}: {hidden} more failures are not shown")
        print(f"{self.name}: {len(self.failures)} failures in {self.elapsed():.0f} s, seed {self.seed}")
        if not self.tried:
            print(f"{self.name}: nothing was tried", file=sys.stderr)
            return 1
        return 1 if self.failures else 0


def execute(*command, seconds=60, **options):
    """Runs a command for at most `seconds`; returns (exit code, output). The exit code is None if
    the time limit ended the command, and -N if signal N ended it."""
    try:
        done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=seconds,
                              check=False, **options)
    except subprocess.TimeoutExpired as error:
        return None, (error.stdout or b"").decode(errors="replace")
    return done.returncode, done.stdout.decode(errors="replace")


def started(*command, **options):
    """Starts a program as sessions.started does, with its output in a pipe. Leaving the context
    kills the remaining processes of the session, for example after Ctrl-C."""
    return sessions.started([str(word) for word in command], sessions.AT_ONCE,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, **options)


def left_over(folder):
    """Returns the paths of the temporary files in a folder and its subfolders."""
    return sorted(str(path) for path in pathlib.Path(folder).rglob("*")
                  if path.name.endswith((".tmp", ".active", ".part", ".partial", ".swp")))


def remove(folder):
    """Removes a folder, if it exists."""
    shutil.rmtree(folder, ignore_errors=True)
