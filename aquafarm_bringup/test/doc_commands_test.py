#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the commands of the start pages as they stand there; commands that take long or need a
screen have a reason, and their launch arguments are checked instead."""
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
from script_test import LIMIT_S, PACKAGE, SCRIPT, built_tree  # noqa: E402

REPOSITORY = SCRIPT.parent
DOCS = REPOSITORY / "docs"
PAGES = [DOCS / "operators.md", DOCS / "researchers.md", DOCS / "ros_engineers.md",
         REPOSITORY / "README.md"]
DATA = REPOSITORY / "aquafarm_sim" / "core" / "test" / "data"

# Commands that are not run, by their first words, with the reason.
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
PLAN_CODES = (0, 10, 11, 12, 13)  # outcomes of a plan (docs/plan.md)
LAUNCHES = re.compile(r"^\./aquafarm (train|sim|evaluate|benchmark|play|record|replay)\b(.*)")
ROSLAUNCH = re.compile(r"^roslaunch aquafarm_bringup (\w+)\.launch\b(.*)")

COAST = """{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates":
 [[[122.68, 30.19], [122.72, 30.19], [122.72, 30.21], [122.68, 30.21], [122.68, 30.19]]]}}
"""


def commands_of(page):
    """Commands in the sh blocks of a page, in order; a backslash continues a line."""
    found = []
    for block in re.findall(r"^ *```sh\n(.*?)^ *```", page.read_text(encoding="utf-8"),
                            re.S | re.M):
        for line in block.replace("\\\n", " ").splitlines():
            command = " ".join(shlex.split(line, comments=True, posix=False))
            if command:
                found.append(command)
    return found


def reason_not_to_run(command):
    return next((reason for words, reason in NOT_RUN.items()
                 if command == words or command.startswith(words + " ")), "")


@unittest.skipUnless(DOCS.exists(), f"no pages at {DOCS}: the package stands alone")
class DocCommandsTest(unittest.TestCase):

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
        done = subprocess.run(
            [sys.executable, PACKAGE / "scripts" / "check_arguments",
             PACKAGE / "launch" / f"{verb}.launch", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT_S,
            check=False)
        return "" if done.returncode == 0 else f"{verb} {words}\n{done.stdout}"

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

    def test_every_reason_is_needed(self):
        commands = [one for page in PAGES for one in commands_of(page)]
        for words in NOT_RUN:
            if words.startswith("roslaunch"):
                continue  # in text, not in blocks
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
