# SPDX-License-Identifier: BSD-3-Clause
"""./aquafarm test: builds and runs every test."""
import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import tomllib

from .progress import Progress
from .workspace import (PYTHON, ROOT, WS, bootstrap, build_core, enter_ros, run_bootstrap, run_child,
                        say, use_ccache, wait_for)

RESULTS = WS / "results"
CORES = ("aquafarm_sim", "aquafarm_agents")
# What some tests need and the suite does not: packages, and what is left out without them.
EXTRAS = {"the tests of HTML pages are skipped": ("chromium", "chromium-driver", "python3-selenium"),
          "the check of locks is skipped": ("clang-14",),
          "the check of clang-tidy is skipped": ("clang-tidy-14",)}
SLURM = {"the tests of batch files are skipped": ("munge", "slurmctld", "slurmd", "slurm-client")}
BROKEN = """<testsuite tests="1" failures="1"><testcase classname="stage" name="{}"><failure/>\
</testcase></testsuite>
"""
LAST_LINES = 20
NEXT_TO_TESTS = ("nice", "-n", "15")  # a build in parallel with tests leaves them the processors
# CI ends the test command after 90 minutes. Checks of the wheel that begin later than this after the
# start are skipped, and one that has begun may take a quarter of an hour more.
WHEEL_END_S = 55 * 60


class Stages:
    """The stages of a test run: when each begins, and which broke off."""

    def __init__(self):
        self._began = time.monotonic()
        self.has_failed = False

    def seconds(self):
        """Returns the time since the start."""
        return int(time.monotonic() - self._began)

    def begin(self, what):
        seconds = self.seconds()
        say(f"{seconds // 60:2d}:{seconds % 60:02d} {what}")

    def run(self, command, log=None, stdout=None, **variables):
        """Runs a command that exits with 0 if all its tests pass."""
        environment = dict(os.environ, **variables)
        if log is None:
            code = run_child(command, env=environment, stdout=stdout)
        else:
            with open(log, "w", encoding="utf-8") as words:
                code = run_child(command, env=environment, stdout=words, stderr=words)
        self.has_failed |= code != 0

    def break_off(self, name, log):
        """A stage that breaks off counts as a failed test; otherwise its missing cases would not be
        reported."""
        path = RESULTS / f"stage-{name.replace(' ', '_')}.xml"
        path.write_text(BROKEN.format(name), encoding="utf-8")
        lines = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        print(f"aquafarm: the stage '{name}' broke off; the end of {log}:", file=sys.stderr)
        print("\n".join(lines.splitlines()[-LAST_LINES:]), file=sys.stderr, flush=True)


class Background:
    """A command in the background of the stages. It ends with its block, also if a stage breaks
    off."""

    END_S = 60  # for the command to end its own children

    def __init__(self, command, log=None, environment=None):
        with contextlib.ExitStack() as stack:
            words = None if log is None else stack.enter_context(open(log, "w", encoding="utf-8"))
            self._child = subprocess.Popen([str(word) for word in command], env=environment,
                                           stdout=words, stderr=words, start_new_session=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for number in (signal.SIGTERM, signal.SIGKILL):
            if self._child.poll() is None:
                os.killpg(self._child.pid, number)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._child.wait(self.END_S)

    def wait(self):
        """Returns the exit code."""
        return wait_for(self._child)


def cores():
    return len(os.sched_getaffinity(0))


def is_empty(path):
    return not path.is_file() or path.stat().st_size == 0


def extras():
    """Returns what only tests need: packages by what is left out without them."""
    return {**EXTRAS, **(SLURM if os.environ.get("AQUAFARM_TEST_SLURM") == "1" else {})}


def build_workspace(stages):
    """Builds the workspace. In the background it installs what only tests need."""
    stages.begin("installing what is missing")
    bootstrap("setup")
    WS.mkdir(parents=True, exist_ok=True)
    every = ["bash", ROOT / "aquafarm", "--install", *(one for packages in extras().values()
                                                       for one in packages)]
    with Background(every, WS / "install_extras.log") as install:
        stages.begin("building the workspace")
        bootstrap("build")
        install.wait()
    # A group that cannot be installed does not take the others with it.
    for left_out, packages in extras().items():
        if run_bootstrap("--install", *packages) != 0:
            say(f"{', '.join(packages)} cannot be installed: {left_out}")


def build(stages):
    """Builds the workspace and its tests; removes results of earlier runs."""
    build_workspace(stages)
    use_ccache()
    for folder in (RESULTS, WS / "build/test_results", *WS.glob("core/*/test_results")):
        shutil.rmtree(folder, ignore_errors=True)
    RESULTS.mkdir(parents=True)
    log = RESULTS / "build_tests.log"
    stages.begin(f"building the tests through ROS (log: {log})")
    if run_bootstrap("--build-tests", log) != 0:
        stages.break_off("build of the tests through ROS", log)


def ros_variables():
    """Returns the environment of the built workspace; this process stays outside."""
    before = dict(os.environ)
    enter_ros()
    inside = dict(os.environ)
    os.environ.clear()
    os.environ.update(before)
    return inside


def begin_ros_tests(stages, fast):
    """Starts the tests through ROS. They wait for most of their time, so other stages go on."""
    log = RESULTS / "run_tests.log"
    stages.begin(f"testing through ROS, in parallel with the next stages (log: {log})")
    # Two at a time is what has been tried on two cores.
    jobs = os.environ.get("AQUAFARM_TEST_JOBS") or str(min(2, cores()))
    return Background([ROOT / "tools/run_ros_tests", WS / "build", log, "--jobs", jobs,
                   *(["--fast"] if fast else [])],
                  environment=dict(ros_variables(), CTEST_OUTPUT_ON_FAILURE="1",
                                   ROS_TEST_RESULTS_DIR=str(WS / "build/test_results")))


def end_ros_tests(stages, ros_tests):
    """Failed tests are found in the results; an exit code other than 0 means that it broke off."""
    if ros_tests.wait() != 0:
        stages.break_off("tests through ROS", RESULTS / "run_tests.log")


def build_cores(stages):
    stages.begin("building the cores with plain cmake")
    for core in CORES:
        build_core(core, before=NEXT_TO_TESTS)


def show_ended(lines, ended, progress, log=None):
    """Shows the tests whose end is in the lines that a test program prints; copies them to a log."""
    for line in lines:
        if log is not None:
            log.write(line)
        found = ended.match(line)
        if found:
            progress.end(found.group(1))


def run_shown(stages, command, ended, progress, log=None, **variables):
    """Runs a test program and shows the tests that end."""
    read, write = os.pipe()
    with contextlib.ExitStack() as stack:
        lines = stack.enter_context(open(read, encoding="utf-8", errors="replace"))
        copy = None if log is None else stack.enter_context(open(log, "w", encoding="utf-8"))
        shown = threading.Thread(target=show_ended, args=(lines, ended, progress, copy))
        shown.start()
        try:
            stages.run(command, stdout=write, **variables)
        finally:
            os.close(write)
            shown.join()


def names_in(command, pattern):
    """Returns the names of the tests that a program lists."""
    listed = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                            check=False).stdout
    return re.findall(pattern, listed, re.MULTILINE)


def test_tools(stages, fast):
    stages.begin("testing the tools")
    xml, log = RESULTS / "tools.xml", RESULTS / "tools.log"
    chosen = [*(["-m", "not slow"] if fast else []), *sorted(ROOT.glob("tools/test/*_test.py"))]
    pytest = [PYTHON, "-m", "pytest", "-p", "no:cacheprovider", f"--rootdir={ROOT}"]
    names = names_in([*pytest, "--collect-only", "-q", *chosen], r"^(?:\S+/)?([^/\s]+::.+)$")
    run_shown(stages, [*pytest, "-v", f"--junitxml={xml}", *chosen],
              re.compile(r"(?:\S+/)?([^/\s]+::.+?) (?:PASSED|FAILED|SKIPPED|ERROR)\b"),
              Progress("tools", names), log, AQUAFARM_CAMPAIGNS=str(WS),
              PYTHONUNBUFFERED="1")
    if is_empty(xml):
        stages.break_off("tools", log)


def test_core(stages, core, fast):
    xml, log = RESULTS / f"ctest-{core}.xml", RESULTS / f"{core}.log"
    jobs = os.environ.get("AQUAFARM_JOBS") or str(cores())
    ctest = ["ctest", "--test-dir", WS / "core" / core, *(["-LE", "slow"] if fast else [])]
    names = names_in([*ctest, "-N"], r"Test +#\d+: (\S+)")
    run_shown(stages, [*ctest, "-j", jobs, "--timeout", "900", "--output-on-failure", "--output-log",
                       log, "--output-junit", xml],
              re.compile(r" *\d+/\d+ Test +#\d+: (\S+) "), Progress(f"{core}/core", names))
    if is_empty(xml):
        stages.break_off(f"{core} core", log)


def test_cores(stages, fast):
    for core in CORES:
        stages.begin(f"testing {core}/core without ROS")
        test_core(stages, core, fast)


def test_other_builds(stages):
    """The other kinds of workspace and, in parallel, the wheel, which waits for downloads."""
    log = RESULTS / "python.log"
    stages.begin("building and running in the other kinds of workspace; testing the wheel with tools "
                 f"from PyPI, as far as there is time (log: {log})")
    wheel = [ROOT / "tools/check_python", WS / "python", "--short", "--limit",
             max(1, WHEEL_END_S - stages.seconds()), "--xml", RESULTS / "python.xml"]
    with Background(wheel, log) as background:
        stages.run([ROOT / "tools/check_workspaces", WS / "workspaces", RESULTS / "workspaces.xml"])
        stages.has_failed |= background.wait() != 0
    if is_empty(RESULTS / "python.xml"):
        stages.break_off("wheel", log)


def say_what_is_left_out():
    slow = tomllib.loads((ROOT / "tools/slow_tests.toml").read_text(encoding="utf-8"))
    say("left out: the other kinds of workspace, the wheel, and slow tests: through ROS "
        f"{', '.join(name for tests in slow.values() for name in tests)}; of the cores those of "
        "'ctest -N -L slow'; of the tools those of 'pytest -m slow'. ./aquafarm test runs all of "
        "them; tools/slow_tests.toml names quick tests of the same parts")


def run(fast):
    """Runs every test; `fast` leaves out slow tests and the builds in other kinds of workspace.
    Returns 1 if a test failed."""
    stages = Stages()
    build(stages)
    with begin_ros_tests(stages, fast) as ros_tests:
        build_cores(stages)
        test_tools(stages, fast)
        test_cores(stages, fast)
        if not fast:
            test_other_builds(stages)
        end_ros_tests(stages, ros_tests)
    stages.begin("adding up the results")
    if fast:
        say_what_is_left_out()
    stages.run([PYTHON, ROOT / "tools/sum_results.py", RESULTS, *WS.glob("core/*/test_results"),
                WS / "build/test_results"])
    return int(stages.has_failed)
