# SPDX-License-Identifier: BSD-3-Clause
"""Runs a launch file as a user would, on its own port and in its own folders, with a time limit.
Loads programs of scripts/ as modules."""
import importlib.machinery
import importlib.util
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "aquafarm_agents" / "test"))
# Tests of this package import these from here.
from processes import DATA, Program, SecondHost, free_port, program  # noqa: E402, F401


def load_script(name):
    """Returns a program of scripts/ as a module."""
    sys.dont_write_bytecode = True  # a new file in scripts/ would count as a changed source
    path = pathlib.Path(__file__).resolve().parent.parent / "scripts" / name
    loader = importlib.machinery.SourceFileLoader(name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def verify(*bags):
    """Runs verify_bag as a user does; returns (exit code, output)."""
    done = subprocess.run(["rosrun", "aquafarm_bringup", "verify_bag", *map(str, bags)], timeout=60,
                          capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Ranch:
    """A launch in its own process group; leaving the context ends all its processes.

    reports: whether trainings write their report, which takes seconds
    """

    def __init__(self, launch, *arguments, port=None, stdin=subprocess.DEVNULL, reports=False):
        self._folder = tempfile.TemporaryDirectory(prefix="aquafarm_test_")
        self.folder = pathlib.Path(self._folder.name)
        self.log = self.folder / "launch.log"
        self._exit_file = self.folder / "exit_code"
        self.port = port or free_port()
        self.environment = dict(
            os.environ, ROS_HOME=str(self.folder), ROS_LOG_DIR=str(self.folder / "log"),
            ROS_IP="127.0.0.1", ROS_MASTER_URI=f"http://127.0.0.1:{self.port}")
        self._command = ["roslaunch", "aquafarm_bringup", f"{launch}.launch", *arguments]
        self._command.append(f"exit_file:={self._exit_file}")
        if launch in ("train", "record") and not reports:
            self._command.append("report:=none")
        self._stdin = stdin
        self._process = None

    def __enter__(self):
        with open(self.log, "wb") as log:
            self._process = subprocess.Popen(
                self._command, env=self.environment, stdin=self._stdin, stdout=log,
                stderr=subprocess.STDOUT, start_new_session=True,
                # A test that runs in the background inherits an ignored Ctrl-C; nodes that are still
                # starting would then miss it.
                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        return self

    def __exit__(self, *_):
        self.interrupt()
        try:
            self._process.wait(timeout=60)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._folder.cleanup()

    def words(self):
        """Returns everything the launch has printed so far."""
        return self.log.read_text(errors="replace")

    def interrupt(self):
        """Sends Ctrl-C unless the launch has ended."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)

    def is_running(self):
        return self._process.poll() is None

    def exit_code(self, limit_s):
        """Waits for the launch to end by itself; returns the exit code recorded by its nodes."""
        try:
            self._process.wait(timeout=limit_s)
        except subprocess.TimeoutExpired as error:
            raise AssertionError(f"still running: {error}\n{self.words()[-4000:]}") from None
        if not self._exit_file.exists():
            raise AssertionError(f"no exit code was left:\n{self.words()[-4000:]}")
        return int(self._exit_file.read_text().split()[0])

    def wait_for(self, what, limit_s):
        """Waits until what() is true; returns its value."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            value = what()
            if value:
                return value
            if not self.is_running():
                break
            time.sleep(0.05)
        value = what()
        if not value:
            raise AssertionError(f"did not come about within {limit_s} s:\n{self.words()[-4000:]}")
        return value

    def node_pid(self, name):
        """Returns the process id of a node by its executable's name, or None."""
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                command = (entry / "cmdline").read_bytes().split(b"\0")
                environment = (entry / "environ").read_bytes()
            except OSError:
                continue
            if (os.path.basename(command[0]) == name.encode()
                    and f"ROS_MASTER_URI=http://127.0.0.1:{self.port}".encode() in environment):
                return int(entry.name)
        return None
