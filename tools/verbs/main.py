# SPDX-License-Identifier: BSD-3-Clause
"""Runs a verb of ./aquafarm. Contains the help texts of the verbs."""
import argparse
import signal
import sys

from . import bench, launch, ranks, render, tests
from .workspace import WS, Refused, ensure_built, enter_ros, replace_by

LAUNCHES = {
    "train": """Trains an agent on the ranch: sim node, train node, viz. Ends by itself with a summary.
Exit code 0: trained; another code: the last lines name the reason. Ctrl-C saves; resume:=true
continues the newest run, or that of run_dir:=…, with its scenario, algorithm and other arguments.
ranks:=N trains ppo in N processes of this machine, without ROS; docs/scale.md describes several
hosts.""",
    "evaluate": """Plays a policy greedily over many episodes and reports return and success. Without policy:=… it plays
the newest run under ./runs, or the shipped policy generalist if there is no run.
./aquafarm evaluate RANCH.yaml plays generalist on that ranch, without a training (planner, if it
has several ships or self-propelled devices);
./aquafarm evaluate RUN plays the policy of that run folder.""",
    "benchmark": """Trains every learner several times, measures them as the paper does (§4.2), and writes figures and a
table with the paper's Table 1 next to the results. After Ctrl-C or a kill the same command resumes.""",
    "sim": """Runs the ranch at rate_hz steps per second and shows it in rviz (headless:=true: no rviz). The policy
planner steers the ships; policy:=none: they wait for commands. In ./aquafarm sim RANCH.yaml the shipped
policy generalist steers a single ship, and planner steers several.""",
    "play": """Drives ship 0 from this terminal; the keys are shown at the start. Finished episodes are kept as
bags in ./played, which ./aquafarm benchmark human:=played compares with the learners.""",
    "record": """Records the topics of a ranch to a bag, while a policy drives it (of:=sim), is
trained (of:=train) or is evaluated (of:=evaluate).""",
    "replay": """Shows a recorded bag: only the player, viz and rviz run. policy:=… shows its choices as well.""",
}

# Verbs that run a program of the workspace, which has its own arguments and --help.
PROGRAMS = {
    "ask": [WS / "devel/lib/aquafarm_agents/bag_policy"],
    "many": ["rosrun", "aquafarm_agents", "aquafarm_many"],
    "plan": ["rosrun", "aquafarm_bringup", "make_plan"],
    "report": ["rosrun", "aquafarm_bringup", "make_report"],
    "scenario": [WS / "devel/lib/aquafarm_sim/aquafarm_scenario"],
    "sweep": ["rosrun", "aquafarm_agents", "aquafarm_sweep"],
    "values": ["rosrun", "aquafarm_bringup", "compare_values"],
    "verify": ["rosrun", "aquafarm_bringup", "verify_bag"],
}
TAKE_ARGUMENTS_AS_THEY_ARE = ("many", "plan", "scenario")
HELP = ("-h", "--help", "--ros-args")
ALL = """setup, build, train, plan, evaluate, benchmark, sweep, many, scenario, sim, play, record, replay, render, \
report, values, ask, verify, test, bench or --help"""


class Parser(argparse.ArgumentParser):
    """A parser that refuses wrong arguments with one line and without the usage."""

    def __init__(self, verb, expected, description):
        super().__init__(prog=f"./aquafarm {verb}", description=description, allow_abbrev=False)
        self._verb, self._expected = verb, expected

    def error(self, message):
        raise Refused(f"{self._verb}: {message}, expected {self._expected}")

    def parse(self, words):
        known, others = self.parse_known_args(words)
        if others:
            self.error(f"got '{others[0]}'")
        return known


def run_tests(words):
    parser = Parser("test", "--fast or nothing", "Builds and runs every test; the last line is "
                    "'N passed, N failed, N skipped'.")
    parser.add_argument("--fast", action="store_true",
                        help="leave out tests that take more than 20 s, campaigns, checks with clang, "
                             "other kinds of workspace and the wheel")
    return tests.run(parser.parse(words).fast)


def run_bench(words):
    names = ", ".join(bench.BENCHES)
    parser = Parser("bench", f"{names} or nothing for all",
                    "Measures speed; ends with lines 'metric value unit'.")
    parser.add_argument("name", nargs="?", metavar="NAME",
                        help=f"one of {names}; without it: all, and then every figure once more")
    name = parser.parse(words).name
    if name is not None and name not in (*bench.BENCHES, "all"):
        parser.error(f"got '{name}'")
    return bench.bench(None if name == "all" else name)


def run_program(verb, words):
    ensure_built()
    if verb not in TAKE_ARGUMENTS_AS_THEY_ARE and set(words) & set(HELP):
        words = ["--help"]
    if verb != "scenario":
        enter_ros()
    return replace_by(*PROGRAMS[verb], *words)


def run(script, verb, words):
    """Runs a verb and returns its exit code."""
    wants_help = bool(set(words) & set(HELP))
    if verb in LAUNCHES:
        if wants_help:
            return launch.describe(verb, LAUNCHES[verb])
        if verb == "train" and any(word.startswith("ranks:=") for word in words):
            return ranks.train(words)
        return launch.launch(script, verb, words)
    if verb in PROGRAMS:
        return run_program(verb, words)
    if verb == "render":
        return render.render(["--help"] if wants_help else words)
    if verb in ("test", "bench"):
        words = ["--help"] if wants_help else words
        return run_tests(words) if verb == "test" else run_bench(words)
    raise Refused(f"got '{verb}', expected {ALL}")


def main(script, verb, words):
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # for ./aquafarm train --help | head
    try:
        return run(script, verb, words)
    except Refused as refusal:
        print(f"aquafarm: {refusal}", file=sys.stderr)
        return refusal.code
    except KeyboardInterrupt:
        return 130
