# SPDX-License-Identifier: BSD-3-Clause
"""The verbs that start a launch file of aquafarm_bringup. Their exit code is that of the node that
ended the launch."""
import importlib.util
import os
import socket
import subprocess
import urllib.parse
import xmlrpc.client

from . import arguments
from .workspace import (CHECK_ARGUMENTS, INTERRUPTED, PYTHON, ROOT, WRONG_ARGUMENT, WS, Refused,
                        bootstrap, ensure_built, enter_ros, run_child, say)

LAUNCH_FILES = ROOT / "aquafarm_bringup" / "launch"
QUIET_ROSLAUNCH = ROOT / "aquafarm_bringup" / "scripts" / "quiet_roslaunch"
# By default, roslaunch kills a node 15 s after Ctrl-C. Writing a large checkpoint can take longer.
SIGINT_LIMIT_S = 120
KILLED = 137
MASTER_LIMIT_S = 15  # that of check_arguments
UNKNOWN_NODE = -1  # status code of lookupNode for a node that is not registered


def without_verbose(words):
    """Returns the words without verbose:=…, and whether roslaunch shows its own messages."""
    kept, verbose = [], False
    for word in words:
        name, is_set, value = word.partition(":=")
        if name == "verbose" and is_set:
            if not arguments.FLAG.fullmatch(value):
                raise Refused(f"verbose: got '{value}', expected true or false")
            verbose = bool(arguments.TRUE.fullmatch(value))
        else:
            kept.append(word)
    return kept, verbose


def refuse_unknown(launch, words):
    """Ends this process if the launch file lacks one of the arguments. check_arguments prints the
    reason. (roslaunch ignores unknown arguments.)"""
    code = run_child([PYTHON, CHECK_ARGUMENTS, LAUNCH_FILES / f"{launch}.launch", *words],
                     stdout=subprocess.DEVNULL)
    if code != 0:
        raise SystemExit(WRONG_ARGUMENT)


class _Transport(xmlrpc.client.Transport):
    """Requests to a master that does not answer end after MASTER_LIMIT_S."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = MASTER_LIMIT_S
        return connection


def running_fault(node):
    """Returns an error message if a node runs, or may run, on the master; None if it does not run.
    The master also keeps the address of a killed node. Only a refused connection
    to this address proves that the node was killed."""
    master = os.environ["ROS_MASTER_URI"]
    asked = f"the master {master}"
    try:
        proxy = xmlrpc.client.ServerProxy(master, transport=_Transport())
        code, answer, uri = proxy.lookupNode("/aquafarm", node)
        if code == UNKNOWN_NODE:
            return None
        if code != 1:
            raise ValueError(answer)
        asked = f"its address {uri}"
        address = urllib.parse.urlparse(uri)
        socket.create_connection((address.hostname, address.port), timeout=MASTER_LIMIT_S).close()
    except ConnectionRefusedError:  # of the node; or of the master, which roslaunch then starts
        return None
    except Exception as error:  # a program at these addresses may answer anything
        reason = " ".join(str(error).split()) or type(error).__name__
        return (f"{node} may already run on {master}: the call to {asked} failed with '{reason}', "
                "expected a running node or a refused connection")
    return f"{node} already runs on {master}"


def refuse_a_second_ranch(words):
    """Raises Refused if a ranch with the same namespace runs on a shared master or may run there,
    because starting a second one would end the first."""
    ns = dict(map(arguments.split, words)).get("ns", "aquafarm")
    fault = running_fault(f"/{ns}/sim")
    if fault:
        raise Refused(f"{fault}; give ns:=another_name or another master")


def complete(launch, words):
    """Returns the options for roslaunch, and the checked arguments with defaults for missing
    ones."""
    options = [word for word in words if word.startswith("-")]
    given = [arguments.with_full_path(word) for word in words if not word.startswith("-")]
    refuse_unknown(launch, given)
    given = arguments.with_defaults(launch, given, words)
    arguments.check_values(launch, given)
    return options, given


def read_end(exit_file, code, launch):
    """Returns (exit code, reason) of a launch. The first node that ended has written both to
    `exit_file`, because roslaunch itself returns 0 even if a required node failed."""
    lines = exit_file.read_text(encoding="utf-8").splitlines() if exit_file.is_file() else []
    exit_file.unlink(missing_ok=True)
    if lines:
        return int(lines[0]), "".join(lines[1:2])
    if code != 0:  # for example an interruption before any node was started
        return code, ""
    reason = "its node was killed before it ended"
    if launch == "train":
        reason += "; resume:=true continues from the last checkpoint"
    return KILLED, reason


def report_end(what, code, reason=""):
    """Prints how a verb ended; returns its exit code."""
    if code == 0:
        say(f"{what} ended well")
    elif code == INTERRUPTED:
        say(f"{what} was interrupted (exit code {INTERRUPTED})")
    else:
        say(f"{what} ended with exit code {code}: {reason or 'see above'}")
    return code


def launch(script, name, words):
    if importlib.util.find_spec("roslaunch") is None:
        bootstrap("setup")  # installs roslaunch, which reads the launch file
    words, verbose = without_verbose(arguments.name_the_ranch(name, words))
    options, given = complete(name, words)
    ensure_built()
    shares_master = enter_ros()
    if shares_master and name not in ("replay", "benchmark"):
        refuse_a_second_ranch(given)
    os.environ["AQUAFARM_LAUNCHER"] = script  # nodes name it in the next steps that they print
    if not verbose:
        os.environ.setdefault("ROSCONSOLE_FORMAT", "[${severity}] ${message}")
        say(f"starting {name}; Ctrl-C ends it, verbose:=true shows roslaunch's own messages")
    exit_file = WS / f"exit.{os.getpid()}"
    exit_file.unlink(missing_ok=True)
    # After a signal, run_child also ends roslaunch, which lets its nodes save. A shell starts its
    # background jobs with SIGINT ignored; without `env` the nodes would inherit this.
    code = run_child(["env", "--default-signal=INT,QUIT",
                      "roslaunch" if verbose else QUIET_ROSLAUNCH, *options,
                      f"--sigint-timeout={SIGINT_LIMIT_S}", "aquafarm_bringup", f"{name}.launch",
                      *given, f"exit_file:={exit_file}"], goes_on=True)
    return report_end(name, *read_end(exit_file, code, name))


def describe(name, about):
    """Prints the help of a launch file: every argument with its meaning and default."""
    print(f"usage: ./aquafarm {name} [name:=value…]\n\n{about}\n")
    try:
        from roslaunch.arg_dump import dump_args  # ./aquafarm setup installs it
    except ImportError:
        print("Run ./aquafarm setup; then this help lists every argument with meaning and default.")
        return 0
    dump_args([str(LAUNCH_FILES / f"{name}.launch")])
    print('  verbose (default "false"): true shows the messages of roslaunch itself.')
    return 0
