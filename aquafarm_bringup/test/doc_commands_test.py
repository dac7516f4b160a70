#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the printed commands of all pages as they stand there. Commands that take long, need a
screen or download something are not run: NOT_RUN and NOT_RUN_ELSEWHERE state the reasons. Their
launch arguments and options are checked instead."""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import load_script  # noqa: E402
from script_test import LIMIT_S, PACKAGE, SCRIPT, built_tree  # noqa: E402

check_arguments = load_script("check_arguments")

REPOSITORY = SCRIPT.parent
DOCS = REPOSITORY / "docs"
PAGES = [DOCS / "operators.md", DOCS / "researchers.md", DOCS / "ros_engineers.md",
         REPOSITORY / "README.md"]
OTHER_PAGES = sorted(set(DOCS.rglob("*.md")) - set(PAGES))
DATA = REPOSITORY / "aquafarm_sim" / "core" / "test" / "data"

# Commands of PAGES that are not run, by their first words, with the reason.
NOT_RUN = {
    "./aquafarm train": "a training takes minutes; train_launch_test runs one",
    "./aquafarm benchmark": "a benchmark takes hours; benchmark_test runs one",
    "./aquafarm sim": "runs until Ctrl-C, in rviz; launch_files_test starts it",
    "./aquafarm evaluate": "1,000 episodes; script_test and report_test evaluate",
    "./aquafarm test": "this is one of its tests",
    "pip install": "PyPI; tools/check_python installs the package",
    "python aquafarm_gym/examples/train_sb3.py": "needs Stable-Baselines3 from PyPI; "
                                                 "tools/python_checks/sb3_learn.py trains with it",
    "rostopic": "needs the master of ./aquafarm sim; the server tests echo the state",
    "rosservice call": "needs the ranch of ./aquafarm sim; the server tests move ships",
    "roslaunch aquafarm_bringup": "runs until Ctrl-C; its arguments are checked",
}
# Commands of OTHER_PAGES that are not run, by their first words, with the reason.
NOT_RUN_ELSEWHERE = {
    "aquafarm_train": "a training of minutes to hours; its options are checked",
    "rosrun aquafarm_agents aquafarm_train": "a training of minutes; its options are checked",
    "aquafarm_evaluate": "1,000 episodes; its options are checked",
    "rosrun aquafarm_agents aquafarm_evaluate RUN_FOLDER": "an optimum of 500 episodes; its "
                                                           "options are checked",
    "aquafarm_benchmark": "a benchmark takes hours; its options are checked",
    "./aquafarm play": "needs a keyboard; play_launch_test steers a ship",
    "./aquafarm record": "its arguments are checked; launch_files_test records",
    "./aquafarm replay": "runs until Ctrl-C, in rviz; its arguments are checked",
    "./aquafarm sweep": "many trainings; its options are checked",
    "./aquafarm many evaluate": "many evaluations; its options are checked",
    "./aquafarm values": "needs the master of a running ranch; its options are checked",
    "source": "an empty environment; the tests have it",
    "cp -r aquafarm_agents/examples/expected_sarsa": "benchmark_test builds this example",
    "cmake -S aquafarm_sim/core -B fuzz": "needs clang; tools/campaign fuzzes",
    "cmake --build fuzz": "needs clang; tools/campaign fuzzes",
    "cmake -S tsan": "a build with ThreadSanitizer takes long",
    "make -C tsan": "a build with ThreadSanitizer takes long",
    "rostest tsan": "needs the build with ThreadSanitizer",
    "pip install": "PyPI; tools/check_python installs the package",
    "python -m aquafarm_gym": "needs packages from PyPI; tools/check_python runs them",
    "python aquafarm_gym/examples": "needs packages from PyPI; its options are checked",
    "sudo apt-get": "changes the machine",
    "python3 -m venv": "tools/check_python makes one",
    "tools/energy_curve.py": "1,000 episodes of a planner",
    "tools/evaluate_coasts.py": "needs the chart of a coast; evaluate_coasts_test runs it",
    "tools/energy_of_learners.py": "trainings of minutes",
    "tools/make_image": "needs a container engine",
    "podman": "needs a container engine",
    "rosservice call": "needs the ranch of ./aquafarm sim; the server tests call it",
}
PLAN_CODES = (0, 10, 11, 12, 13)  # outcomes of a plan (docs/plan.md)
LAUNCHES = re.compile(r"^(?:\w+=\S+ )?\./aquafarm (train|sim|evaluate|benchmark|play|record|replay)"
                      r"\b(.*)")
ROSLAUNCH = re.compile(r"^roslaunch aquafarm_bringup (\w+)\.launch\b(.*)")

COAST = """{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
 [[[122.68, 30.19], [122.72, 30.19], [122.72, 30.21], [122.68, 30.21], [122.68, 30.19]]]}}
"""


def commands_of(page):
    """Returns the commands in the sh blocks of a page, in order. A backslash continues a line."""
    found = []
    for block in re.findall(r"^ *```sh\n(.*?)^ *```", page.read_text(encoding="utf-8"),
                            re.S | re.M):
        for line in block.replace("\\\n", " ").splitlines():
            command = " ".join(shlex.split(line, comments=True, posix=False))
            if command:
                found.append(command)
    return found


def reason_not_to_run(command, reasons=None):
    bare = re.sub(r"^(\w+=\S+ )+", "", command)  # without variables
    return next((reason for words, reason in (reasons or NOT_RUN).items()
                 if bare == words or bare.startswith((words + " ", words + "/", words + "."))), "")


def options_of(command):
    """Returns the options in a command, such as -e and --episodes, without their values."""
    words = [word.partition("=")[0] for word in shlex.split(command.partition(" -- ")[0])]
    return [word for word in words if re.match(r"^--?[a-z]", word)]


def help_of(command, place, environment):
    """Returns the help text of the program of a command; "" if the program is not one of ours."""
    words = shlex.split(re.sub(r"^(\w+=\S+ )+", "", command))
    if words[0].startswith("aquafarm_"):
        words = ["rosrun", "aquafarm_agents", *words]
    if words[0] == "python" and words[1].startswith("aquafarm_gym/examples/"):
        return (REPOSITORY / words[1]).read_text(encoding="utf-8")
    if words[0] == "rosrun":
        asked = [*words[:3], "--help"]
    elif words[0] == "./aquafarm" and words[1] in ("sweep", "many", "values"):
        mode = words[2:3] if words[1] == "many" else []
        asked = [*words[:2], *mode, "--help"]
    else:
        return ""
    return subprocess.run(asked, cwd=place, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=LIMIT_S, check=True).stdout


@unittest.skipUnless(DOCS.exists(), f"no pages at {DOCS}: the package stands alone")
class DocCommandsTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_doc_commands_"))
        script, cls.environment = built_tree(cls.folder)
        devel = cls.folder / "ws" / "devel"
        shutil.rmtree(devel)
        devel.symlink_to(os.environ["CMAKE_PREFIX_PATH"].split(":")[0])
        (script.parent / ".ws").symlink_to(cls.folder / "ws")
        # The reader's folder: the files that the pages name, next to ./aquafarm.
        cls.place = script.parent
        (cls.place / "aquafarm_sim").symlink_to(REPOSITORY / "aquafarm_sim")
        (cls.place / "coast.json").write_text(COAST)
        (cls.place / "devices.csv").write_text("name,latitude,longitude,kind,value\n"
                                               "F1,30.16,122.66,monitoring,45000\n")
        storms = json.loads((DATA / "bulletin.json").read_text(encoding="utf-8-sig"))
        (cls.place / "bulletin.json").write_text(json.dumps(storms[:1]), encoding="utf-8")
        shutil.copy(DATA / "cma.txt", cls.place / "CH2021BST.txt")
        shutil.copy(REPOSITORY / "aquafarm_sim/scenarios/zhoushan_infa_2021.yaml",
                    cls.place / "my_ranch.yaml")
        (cls.folder / "ws" / "built").touch()  # after the link to aquafarm_sim

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def prepare_runs(self):
        """Makes the files that the other pages assume: two runs, a bag and a folder of ranches."""
        train = roslib.packages.find_node("aquafarm_agents", "aquafarm_train")[0]
        runs = self.place / "runs"
        for day in ("20260101-120000", "20260102-120000"):
            subprocess.run([train, "paper", "--algorithm", "q_learning", "--episodes", "300",
                            "--max-steps", "400", "--run-dir", runs / day, "--evaluate", "10",
                            "--random", "0"], env=self.environment, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, timeout=LIMIT_S, check=True)
        for name in ("RUN", "RUN_FOLDER", "runs/…"):  # as the pages write them
            (self.place / name).symlink_to(runs / "20260101-120000")
        for command in ("rosrun aquafarm_agents aquafarm_evaluate do_nothing paper -e 1 "
                        "--route x.json",
                        "rosrun aquafarm_sim episode_bag "
                        "aquafarm_sim/scenarios/paper.yaml x.json -o x.bag"):
            self.assertEqual("", self.run_as_printed(command))
        episodes = runs / "20260101-120000" / "episodes"
        episodes.mkdir(exist_ok=True)
        shutil.copy(self.place / "x.bag", episodes / "episode_00000042_seed_1_return_+187.0.bag")
        (self.place / "ranches").mkdir()
        shutil.copy(self.place / "my_ranch.yaml", self.place / "ranches" / "one.yaml")
        shutil.copy(DATA / "bulletin.json", self.place / "202106.json")

    def run_as_printed(self, command):
        """Runs a command; returns its output if it fails, else an empty text."""
        done = subprocess.run(["bash", "-c", command], cwd=self.place, env=self.environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=2 * LIMIT_S, check=False)
        good = PLAN_CODES if command.startswith("./aquafarm plan") else (0,)
        return "" if done.returncode in good else f"{command}\n{done.stdout}{done.returncode}"

    def check_launch(self, verb, words):
        """Checks the launch arguments of a command that is not run; returns what is wrong."""
        arguments = [word for word in shlex.split(words) if ":=" in word]
        fault = check_arguments.fault(PACKAGE / "launch" / f"{verb}.launch", arguments)
        return "" if fault is None else f"{verb} {words}\n{fault}"

    def test_every_command_of_the_start_pages_runs_or_has_a_reason(self):
        done, faults = set(), []
        for page in PAGES:
            commands = commands_of(page)
            self.assertTrue(commands, page)
            for command in commands:
                if command in done:
                    continue
                done.add(command)
                launch = LAUNCHES.match(command) or ROSLAUNCH.match(command)
                if not reason_not_to_run(command):
                    faults.append(self.run_as_printed(command))
                elif launch:
                    faults.append(self.check_launch(*launch.groups()))
        self.assertEqual([], [fault for fault in faults if fault])
        ran = [one for one in done if not reason_not_to_run(one)]
        self.assertGreater(len(ran), 3, ran)
        self.assertTrue((self.place / "plan.html").exists())

    def test_every_command_of_the_other_pages_runs_or_is_checked(self):
        self.prepare_runs()
        helps, ran, faults = {}, [], []
        commands = dict.fromkeys(one for page in OTHER_PAGES for one in commands_of(page))
        for command in commands:
            launch = LAUNCHES.match(command) or ROSLAUNCH.match(command)
            if launch:
                faults.append(self.check_launch(*launch.groups()))
            elif not reason_not_to_run(command, NOT_RUN_ELSEWHERE):
                faults.append(self.run_as_printed(command))
                ran.append(command)
            elif options_of(command):
                program = tuple(shlex.split(command)[:3])
                if program not in helps:
                    helps[program] = help_of(command, self.place, self.environment)
                faults += [f"{command}\nthere is no option {option}"
                           for option in options_of(command)
                           if helps[program] and not re.search(
                               rf"(?<![\w-]){re.escape(option)}(?![\w-])", helps[program])]
        self.assertEqual([], [fault for fault in faults if fault])
        self.assertGreater(len(ran), 12, ran)
        self.assertGreater(len([text for text in helps.values() if text]), 8)
        for words in NOT_RUN_ELSEWHERE:
            self.assertTrue([one for one in commands
                             if reason_not_to_run(one, {words: "needed"})], words)

    def test_every_reason_is_needed(self):
        commands = [one for page in PAGES for one in commands_of(page)]
        for words in NOT_RUN:
            if words.startswith("roslaunch"):
                continue  # pages contain it outside of sh blocks
            self.assertTrue([one for one in commands if one.startswith(words)], words)

    def test_every_program_that_pages_call_is_found(self):
        called = set()
        for page in [*DOCS.glob("*.md"), REPOSITORY / "README.md"]:
            called |= set(re.findall(r"rosrun (aquafarm_\w+) (\w+)", page.read_text()))
        self.assertIn(("aquafarm_agents", "aquafarm_train"), called)
        for package, name in sorted(called):
            self.assertTrue(roslib.packages.find_node(package, name), f"rosrun {package} {name}")


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "doc_commands", DocCommandsTest, sys.argv)
