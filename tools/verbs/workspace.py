# SPDX-License-Identifier: BSD-3-Clause
"""Folders, build and ROS environment of the workspace, and child processes."""
import contextlib
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WS = pathlib.Path(os.path.realpath(os.environ.get("AQUAFARM_WS") or ROOT / ".ws"))
PYTHON = "/usr/bin/python3"  # the one for which Debian's ROS packages are built
CHECK_ARGUMENTS = ROOT / "aquafarm_bringup" / "scripts" / "check_arguments"
WRONG_ARGUMENT = 2
INTERRUPTED = 130
ENDING_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Refused(Exception):
    """A verb cannot run. Contains a line for the user and the exit code."""

    def __init__(self, line, code=WRONG_ARGUMENT):
        super().__init__(line)
        self.code = code


def say(line):
    print(f"aquafarm: {line}", flush=True)


def run_children(commands, goes_on=False):
    """Runs commands at the same time, waits for them and returns their exit codes; 128 + N for a
    command that signal N ended.

    commands: pairs of a command and the options of Popen. After SIGINT, SIGTERM or SIGHUP, this
    process sends SIGTERM to each command and waits, because a command may need time to save. It
    then exits with 128 + the signal's number; with `goes_on` it returns the exit codes instead.
    """
    received, children = [], []

    def end(number, _):
        received.append(number)
        for child in children:
            child.send_signal(signal.SIGTERM)

    before = {number: signal.signal(number, end) for number in ENDING_SIGNALS}
    try:
        with contextlib.ExitStack() as stack:
            for command, options in commands:
                words = [str(word) for word in command]
                children.append(stack.enter_context(subprocess.Popen(words, **options)))
                if received:  # before `children` contained this child
                    children[-1].send_signal(signal.SIGTERM)
            codes = [child.wait() for child in children]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    if received and not goes_on:
        sys.exit(128 + received[0])
    return [code if code >= 0 else 128 - code for code in codes]


def run_child(command, goes_on=False, **options):
    """Runs one command as run_children does; returns its exit code."""
    return run_children([(command, options)], goes_on)[0]


def run_bootstrap(*words):
    """Runs a step of ./aquafarm; returns its exit code."""
    return run_child(["bash", ROOT / "aquafarm", *words])


def bootstrap(*words):
    """Runs a step of ./aquafarm; ends this process if it fails."""
    code = run_bootstrap(*words)
    if code != 0:
        sys.exit(code)


def ensure_built():
    bootstrap("--ensure-built")


def build_core(name):
    """Builds a ROS-free core alone with plain cmake."""
    bootstrap("--core", name)


def use_ccache():
    """Makes CMake compile through ccache if it is installed: several kinds of workspace compile the
    same sources, and ccache reuses the results of the first."""
    if shutil.which("ccache") is not None:
        os.environ.setdefault("CCACHE_DIR", str(WS / "ccache"))
        os.environ.setdefault("CCACHE_MAXSIZE", "2G")
        os.environ.setdefault("CMAKE_CXX_COMPILER_LAUNCHER", "ccache")


def program(name):
    """Returns the path of a program: of a core's build if it has one, else of the workspace."""
    for folder in (WS / "core", WS / "devel" / "lib"):
        for path in sorted(folder.rglob(name)):
            if path.is_file() and os.access(path, os.X_OK):
                return path
    raise Refused(f"the build contains no program {name}; run ./aquafarm build", code=1)


def is_port_open(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def enter_ros():
    """Adds the ROS environment of the built workspace to that of this process. Returns True if
    ROS_MASTER_URI is set, because a master may already run there. Else sets it to an address with a
    free port and returns False."""
    sourced = subprocess.run(["bash", "-c", 'source "$0" && exec env -0', WS / "devel/setup.bash"],
                             stdout=subprocess.PIPE, check=False)
    if sourced.returncode != 0:
        raise Refused(f"{WS}/devel/setup.bash: cannot be sourced; ./aquafarm build makes it", code=1)
    words = (word.split("=", maxsplit=1) for word in os.fsdecode(sourced.stdout).split("\0") if word)
    os.environ.update({name: value for name, value in words if name != "_"})
    os.environ.setdefault("ROS_HOME", str(WS / "ros"))
    os.environ.setdefault("ROS_LOG_DIR", f"{os.environ['ROS_HOME']}/log")
    if not os.environ.get("ROS_HOSTNAME"):
        os.environ.setdefault("ROS_IP", "127.0.0.1")
    os.makedirs(os.environ["ROS_LOG_DIR"], exist_ok=True)
    uri = os.environ.get("ROS_MASTER_URI")
    if uri:
        code = run_child([CHECK_ARGUMENTS, "--master", uri])
        if code != 0:
            sys.exit(WRONG_ARGUMENT)
        return True
    port = 11311
    while is_port_open(port):
        port = random.randint(11312, 12311)
    if port != 11311:
        say(f"port 11311 is taken, using {port}; set ROS_MASTER_URI to share a running master")
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    return False


def replace_by(*command):
    """Replaces this process with a command."""
    sys.stdout.flush()
    try:
        os.execvp(command[0], [str(word) for word in command])
    except OSError as error:
        raise Refused(f"{command[0]}: {error.strerror}; ./aquafarm build makes it", code=1) from None
