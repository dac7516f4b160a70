# SPDX-License-Identifier: BSD-3-Clause
"""./aquafarm test: builds and runs every test."""
import contextlib
import dataclasses
import itertools
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from .slow_tests import SLOW
from .workspace import (PYTHON, ROOT, WS, bootstrap, build_core, enter_ros, run_bootstrap, run_child,
                        run_children, say, use_ccache)

RESULTS = WS / "results"
CORES = ("aquafarm_sim", "aquafarm_agents")
# Packages that only some tests need. The key states what happens without them.
EXTRAS = {"the tests of HTML pages are skipped": ("chromium", "chromium-driver", "python3-selenium"),
          "the check of locks is skipped, and the isolated workspace is built with g++":
          ("clang-14",),
          "the check of clang-tidy is skipped": ("clang-tidy-14",)}
SLURM = {"the tests of batch files are skipped": ("munge", "slurmctld", "slurmd", "slurm-client")}
BROKEN = """<testsuite tests="1" failures="1"><testcase classname="stage" name="{}"><failure/>\
</testcase></testsuite>
"""
LAST_LINES = 20
# Checks of the wheel that have not begun within WHEEL_END_S seconds of the start are skipped,
# because CI ends the test command after 90 minutes. Checks that have begun may take 15 min longer.
WHEEL_END_S = 55 * 60
# Command prefix of a step that gets only the processor time that other processes leave.
IDLE = ["chrt", "--idle", "0"]
END_S = 20  # time for such a step to end after SIGTERM, and again after SIGKILL [s]


@dataclasses.dataclass
class Step:
    """A command that runs tests."""
    name: str
    command: list
    log: pathlib.Path
    xml: pathlib.Path | None = None  # results that it writes; None: only its exit code counts
    is_shown: bool = False  # False: its output goes to the log
    variables: dict = dataclasses.field(default_factory=dict)  # environment variables to set


class Stages:
    """Prints when each stage of a test run begins, and records whether one failed."""

    def __init__(self):
        self._began = time.monotonic()
        self.has_failed = False

    def seconds(self):
        """Returns the time since the start [s]."""
        return int(time.monotonic() - self._began)

    def begin(self, what):
        seconds = self.seconds()
        say(f"{seconds // 60:2d}:{seconds % 60:02d} {what}")

    def run(self, *steps):
        """Runs steps at the same time and waits for them. Each exits with 0 if all its tests
        pass."""
        with contextlib.ExitStack() as stack:
            commands = []
            for step in steps:
                commands.append((step.command, options_of(step, stack)))
            codes = run_children(commands)
        for step, code in zip(steps, codes):
            self.judge(step, code)

    @contextlib.contextmanager
    def next_to(self, *steps):
        """Runs steps with low priority while the `with` block runs. Then waits for the steps. Ends
        them if the block raises or a signal ends this process."""
        with contextlib.ExitStack() as stack:
            for number in (signal.SIGTERM, signal.SIGHUP):
                stack.callback(signal.signal, number, signal.signal(number, exit_by_signal))
            children = []
            for step in steps:
                child = stack.enter_context(subprocess.Popen(
                    [*IDLE, *map(str, step.command)], start_new_session=True,
                    **options_of(step, stack)))
                stack.callback(end_session, child)
                lower_weight(child.pid)
                children.append(child)
            yield
            for step, child in zip(steps, children):
                if child.poll() is None:
                    self.begin(f"waiting for: {step.name} (log: {step.log})")
                self.judge(step, child.wait())

    def judge(self, step, code):
        self.has_failed |= code != 0
        if code != 0 if step.xml is None else is_empty(step.xml):
            self.break_off(step.name, step.log)

    def break_off(self, name, log):
        """Writes a failed test for a stage that broke off, because its missing cases would not be
        reported. Prints the end of the log."""
        path = RESULTS / f"stage-{name.replace(' ', '_')}.xml"
        path.write_text(BROKEN.format(name), encoding="utf-8")
        lines = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
        print(f"aquafarm: the stage '{name}' broke off; the end of {log}:", file=sys.stderr)
        print("\n".join(lines.splitlines()[-LAST_LINES:]), file=sys.stderr, flush=True)


def options_of(step, stack):
    """Returns the options of Popen for a step. `stack` closes the log of the step."""
    options = {"env": dict(os.environ, **step.variables)}
    if not step.is_shown:
        words = stack.enter_context(open(step.log, "w", encoding="utf-8"))
        options.update(stdout=words, stderr=words)
    return options


def lower_weight(session):
    """Gives the processes of a session the lowest weight among sessions. Linux first divides the
    processor time among sessions ("autogroup", sched(7)), then within each session by class. With
    the idle class alone, a step would therefore get a quarter of a busy core. Without privileges,
    Linux refuses a change shortly after another one (EAGAIN). A refused change is tried again."""
    for _ in range(10):
        try:
            pathlib.Path(f"/proc/{session}/autogroup").write_text("19", encoding="ascii")
            return
        except BlockingIOError:
            time.sleep(0.1)
        except OSError:  # there are no autogroups, or the step has ended
            return


def end_session(child):
    """Ends the remaining processes of the process group that a child leads."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        with contextlib.suppress(ProcessLookupError, subprocess.TimeoutExpired):
            os.killpg(child.pid, number)
            child.wait(END_S)
            return


def exit_by_signal(number, _):
    sys.exit(128 + number)


def is_empty(path):
    return not path.is_file() or path.stat().st_size == 0


def run_bootstraps(*steps):
    """Runs several steps of ./aquafarm at the same time; returns their exit codes."""
    return run_children([(["bash", ROOT / "aquafarm", *words], {}) for words in steps])


def build_workspace(stages):
    extras = {**EXTRAS, **(SLURM if os.environ.get("AQUAFARM_TEST_SLURM") == "1" else {})}
    stages.begin("installing what is missing")
    bootstrap("setup")
    stages.begin("building the workspace, and installing what only tests need")
    built, _ = run_bootstraps(["build"], ["--install", *itertools.chain(*extras.values())])
    if built != 0:
        sys.exit(built)
    for left_out, packages in extras.items():  # installs nothing if all packages are present
        if run_bootstrap("--install", *packages) != 0:
            say(f"{', '.join(packages)} cannot be installed: {left_out}")
    use_ccache()
    for folder in (RESULTS, WS / "build/test_results", *WS.glob("core/*/test_results")):
        shutil.rmtree(folder, ignore_errors=True)
    RESULTS.mkdir(parents=True)


def build_tests(stages):
    stages.begin("building the cores with plain cmake")
    for core in CORES:
        build_core(core)
    log = RESULTS / "build_tests.log"
    stages.begin(f"building the tests through ROS (log: {log})")
    if run_bootstrap("--build-tests", log) != 0:
        stages.break_off("build of the tests through ROS", log)


def pytest_step(name, files, variables):
    xml = RESULTS / f"{name}.xml"
    return Step(name, [PYTHON, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={xml}",
                       *files],
                RESULTS / f"{name}.log", xml, variables=variables)


def tools_steps(fast):
    """Returns two steps that take about the same time: campaigns and other tests of tools/. With
    `fast` returns only the other tests, without those that need a built workspace."""
    campaigns = ROOT / "tools/test/campaign_test.py"
    others = sorted({*ROOT.glob("tools/test/*_test.py")} - {campaigns})
    if fast:
        return [pytest_step("tools", others, {})]
    variables = {"AQUAFARM_CAMPAIGNS": str(WS)}
    return [pytest_step("campaigns", [campaigns], variables), pytest_step("tools", others, variables)]


# Prints a line for each test that ended; sed removes the other output of ctest.
CTEST = """ctest "$@" | sed -unE \
"s#^ *([0-9]+)/([0-9]+) Test +\\#[0-9]+: ([^ ]+) .*#aquafarm: $0/core test \\1 of \\2: \\3#p"
"""


def core_step(core, fast):
    left_out = ["-E", f"^({'|'.join(SLOW)})$"] if fast else []
    jobs = os.environ.get("AQUAFARM_JOBS") or str(len(os.sched_getaffinity(0)))
    xml, log = RESULTS / f"ctest-{core}.xml", RESULTS / f"{core}.log"
    return Step(f"{core} core",
                ["bash", "-o", "pipefail", "-c", CTEST, core, "--test-dir", WS / "core" / core,
                 "-j", jobs, *left_out, "--timeout", "900", "--output-on-failure", "--output-log", log,
                 "--output-junit", xml],
                log, xml, is_shown=True)


def ros_step(log, fast):
    # At most two at a time, because only this was measured (on two cores). A rostest mostly waits.
    jobs = min(2, len(os.sched_getaffinity(0)))
    return Step("tests through ROS",
                [ROOT / "tools/run_ros_tests", WS / "build", log, "--jobs",
                 os.environ.get("AQUAFARM_TEST_JOBS") or str(jobs), *(["--fast"] if fast else [])],
                log, is_shown=True,
                variables={"CTEST_OUTPUT_ON_FAILURE": "1",
                           "ROS_TEST_RESULTS_DIR": str(WS / "build/test_results")})


def workspaces_step():
    xml = RESULTS / "workspaces.xml"
    return Step("another kind of workspace",
                [ROOT / "tools/check_workspaces", WS / "workspaces", xml],
                RESULTS / "workspaces.log", xml)


def wheel_step(stages):
    xml = RESULTS / "python.xml"
    return Step("wheel with tools from PyPI",
                [ROOT / "tools/check_python", WS / "python", "--short", "--limit",
                 max(1, WHEEL_END_S - stages.seconds()), "--xml", xml], RESULTS / "python.log", xml)


def test_all(stages, fast):
    stages.begin("testing the cores without ROS, and the tools, which mostly wait")
    stages.run(*tools_steps(fast), *(core_step(core, fast) for core in CORES))
    log = RESULTS / "run_tests.log"
    stages.begin(f"testing through ROS (log: {log})")
    enter_ros()
    stages.run(ros_step(log, fast))


def run(fast):
    """Runs every test. `fast` leaves out slow tests, campaigns, checks with clang, the builds in
    other kinds of workspace and the wheel. Returns 1 if a test failed."""
    stages = Stages()
    build_workspace(stages)
    if fast:
        say("--fast leaves out tests that take more than 20 s, campaigns, checks with clang, and other "
            "kinds of workspace")
    others = [] if fast else [workspaces_step(), wheel_step(stages)]
    with stages.next_to(*others):
        build_tests(stages)
        test_all(stages, fast)
    stages.begin("adding up the results")
    code = run_child([PYTHON, ROOT / "tools/sum_results.py", RESULTS,
                      *WS.glob("core/*/test_results"), WS / "build/test_results"])
    return int(stages.has_failed or code != 0)
