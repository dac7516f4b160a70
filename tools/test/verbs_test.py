#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The stages of ./aquafarm test, the end of a launch, and child processes of tools/verbs."""
import contextlib
import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import tomllib
import unittest
import unittest.mock
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from verbs import bench, launch, tests, workspace  # noqa: E402
from verbs.progress import Progress  # noqa: E402


class TestRun(unittest.TestCase):
    """Runs the stages with programs that are replaced: nothing is built."""

    def run_with(self, fast, **codes):
        """Returns the exit code, the commands and the results; codes: of programs by name."""
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder, "results")
            commands = []

            def run_child(command, **_):
                words = [str(word) for word in command]
                commands.append(" ".join(words))
                name = pathlib.Path(words[0]).name
                code = codes.get(name, 0)
                for word in words:
                    path = pathlib.Path(word.split("=")[-1])
                    if path.suffix == ".xml" and code < 2:
                        path.write_text("<testsuite/>", encoding="utf-8")
                return code

            class Background(contextlib.nullcontext):
                def __init__(self, command, *_, **__):
                    super().__init__(self)
                    self.wait = lambda: run_child(command)

            with mock.patch.multiple(tests, RESULTS=results, WS=pathlib.Path(folder), Background=Background,
                                     run_child=run_child, enter_ros=lambda: False,
                                     names_in=lambda *words: ["one_test"],
                                     build_core=lambda *words, **_: None,
                                     bootstrap=lambda *words: None,
                                     run_bootstrap=lambda *words: codes.get(words[0], 0)), \
                    contextlib.redirect_stdout(io.StringIO()) as out, \
                    contextlib.redirect_stderr(out):
                code = tests.run(fast)
            return code, commands, {path.name for path in results.iterdir()}, out.getvalue()

    def test_every_stage_passes(self):
        code, commands, results, _ = self.run_with(fast=False)
        self.assertEqual(0, code)
        self.assertEqual(["bash", "python3", "ctest", "ctest", "check_workspaces", "check_python",
                          "run_ros_tests", "python3"],
                         [pathlib.Path(line.split()[0]).name for line in commands])
        self.assertFalse({name for name in results if name.startswith("stage-")})

    def test_fast_leaves_out_the_other_workspaces_and_slow_tests_and_says_so(self):
        _, commands, _, words = self.run_with(fast=True)
        self.assertFalse([line for line in commands
                          if "check_workspaces" in line or "check_python" in line])
        for program, option in (("pytest", " -m not slow"), ("ctest ", " -LE slow"),
                                ("run_ros_tests", " --fast")):
            for fast in (True, False):
                commands = self.run_with(fast)[1]
                self.assertEqual({fast}, {option in line for line in commands if program in line})
        self.assertIn("left out: the other kinds of workspace, the wheel, and slow tests: through ROS "
                      "agent_nodes, ", words)

    def test_a_failed_stage_fails_the_whole(self):
        self.assertEqual(1, self.run_with(fast=True, ctest=1)[0])

    def test_a_stage_without_results_counts_as_a_failed_test(self):
        code, _, results, words = self.run_with(fast=True, ctest=2)
        self.assertEqual(1, code)
        self.assertLessEqual({"stage-aquafarm_sim_core.xml", "stage-aquafarm_agents_core.xml"}, results)
        self.assertIn("the stage 'aquafarm_sim core' broke off; the end of ", words)
        _, _, results, _ = self.run_with(fast=True, run_ros_tests=1)
        self.assertIn("stage-tests_through_ROS.xml", results)

    def test_what_cannot_be_installed_is_left_out_with_a_word(self):
        code, _, _, words = self.run_with(fast=True, **{"--install": 3})
        self.assertEqual(0, code)
        self.assertIn("clang-14 cannot be installed: the check of locks is skipped", words)


class TestBackground(unittest.TestCase):

    def test_its_exit_code_is_returned(self):
        with tests.Background(["bash", "-c", "exit 3"]) as background:
            self.assertEqual(3, background.wait())

    def test_it_ends_with_its_block(self):
        with tests.Background(["sleep", "60"]) as background:
            child = background._child
        self.assertEqual(-signal.SIGTERM, child.returncode)


class TestProgress(unittest.TestCase):

    def ends(self, progress, *names):
        with contextlib.redirect_stdout(io.StringIO()) as shown:
            for name in names:
                progress.end(name)
        return shown.getvalue()

    def test_each_test_is_shown_once(self):
        progress = Progress("ROS", ["a", "b", "c"])
        self.assertEqual("aquafarm: ROS: test 1 of 3: b; about 0 min left\n"
                         "aquafarm: ROS: test 2 of 3: a; about 0 min left\n",
                         self.ends(progress, "b", "a", "b", "dog"))
        self.assertEqual(["c"], progress.waited_for())

    def test_the_time_left_counts_slow_tests_by_their_usual_time(self):
        with mock.patch("time.monotonic", side_effect=[0, 60, 60]):
            progress = Progress("ROS", ["slow", "quick"], {"slow": 4 * Progress.USUAL_S})
            self.assertIn("about 4 min left", self.ends(progress, "quick"))


class TestShown(unittest.TestCase):
    """The tests of a program are shown when they end, and its output is kept."""

    def test_pytest(self):
        with tempfile.TemporaryDirectory() as folder, \
                mock.patch.multiple(tests, RESULTS=pathlib.Path(folder), ROOT=pathlib.Path(folder)), \
                contextlib.redirect_stdout(io.StringIO()) as shown:
            one = pathlib.Path(folder, "tools/test/one_test.py")
            one.parent.mkdir(parents=True)
            one.write_text("import pytest\n@pytest.mark.parametrize('x', ['a b', 'c'])\n"
                           "def test_that(x):\n    assert x == 'c'\n", encoding="utf-8")
            stages = tests.Stages()
            tests.test_tools(stages, fast=False)
            self.assertTrue(stages.has_failed)
            self.assertIn("1 failed, 1 passed", pathlib.Path(folder, "tools.log").read_text())
        self.assertIn("test 1 of 2: one_test.py::test_that[a b]; about 0 min left",
                      shown.getvalue())
        self.assertIn("test 2 of 2: ", shown.getvalue())


class RunRosTestsTest(unittest.TestCase):

    def run_on(self, folder, names, *words):
        """Runs it on a makefile with one rule for each test."""
        rules = {name: f"aquafarm/{name.split()[0]}/CMakeFiles/_run_tests_{name.split()[0]}_rostest_"
                       f"test_{name.split()[1]}.test" for name in names}
        made = pathlib.Path(folder, "CMakeFiles/Makefile2")
        made.parent.mkdir()
        made.write_text("".join(
            f"{rule}.dir/all:\n\t@echo 'Built target {pathlib.Path(rule).name}'\n"
            for rule in rules.values()), encoding="utf-8")
        done = subprocess.run([ROOT / "tools/run_ros_tests", folder, pathlib.Path(folder, "log"), *words],
                              capture_output=True, text=True, timeout=60, check=False)
        return done.returncode, done.stdout.splitlines(), done.stderr

    def slow(self):
        listed = tomllib.loads((ROOT / "tools/slow_tests.toml").read_text(encoding="utf-8"))
        return [f"{package} {name}" for package, all_of in listed.items() for name in all_of]

    def test_slow_tests_begin_first_and_fast_leaves_them_out(self):
        names = ["aquafarm_a quick", *self.slow()]
        with tempfile.TemporaryDirectory() as folder:
            code, shown, _ = self.run_on(folder, names)
        self.assertEqual((0, len(names)), (code, len(shown)))
        self.assertIn("aquafarm_a quick", shown[-1])
        with tempfile.TemporaryDirectory() as folder:
            code, shown, _ = self.run_on(folder, names, "--fast")
        self.assertEqual((0, ["aquafarm: ROS: test 1 of 1: aquafarm_a quick; about 0 min left"]),
                         (code, shown))

    def test_a_listed_test_that_is_not_there_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            code, _, err = self.run_on(folder, ["aquafarm_a quick", *self.slow()[1:]])
        self.assertEqual(1, code)
        self.assertIn(f"slow_tests.toml: got {self.slow()[0]}, expected tests of the workspace", err)

    def test_a_folder_without_tests_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            code, _, err = self.run_on(folder, [])
        self.assertEqual(1, code)
        self.assertIn(f"{folder}: found no test", err)


class TestEnd(unittest.TestCase):

    def end(self, text, code, name="train"):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "exit")
            if text is not None:
                path.write_text(text, encoding="utf-8")
            end = launch.read_end(path, code, name)
            self.assertFalse(path.exists())
            return end

    def test_the_first_node_to_end_decides(self):
        self.assertEqual((4, "the sim node is lost"), self.end("4\nthe sim node is lost\n", 0))
        self.assertEqual((0, ""), self.end("0\n", 1))

    def test_roslaunch_decides_if_no_node_has_left_a_code(self):
        self.assertEqual((1, ""), self.end(None, 1))
        self.assertEqual((137, "its node was killed before it ended"), self.end(None, 0, "sim"))


class TestChild(unittest.TestCase):

    def test_a_signal_reaches_the_child_which_ends_in_its_own_way(self):
        before = signal.getsignal(signal.SIGINT)
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        code = workspace.run_child(
            ["bash", "-c", "trap 'exit 9' TERM; for i in {1..600}; do sleep 0.1; done"], goes_on=True)
        self.assertEqual(9, code)
        self.assertIs(before, signal.getsignal(signal.SIGINT))

    def test_a_signal_ends_the_verb_too(self):
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(SystemExit) as ended:
            workspace.run_child(["sleep", "60"])
        self.assertEqual(130, ended.exception.code)

    def test_a_killed_child_has_the_code_of_a_shell(self):
        self.assertEqual(137, workspace.run_child(["bash", "-c", "kill -9 $$"]))

    def test_a_benchmark_shows_and_keeps_its_figures(self):
        with tempfile.TemporaryDirectory() as folder, \
                contextlib.redirect_stdout(io.StringIO()) as shown:
            out = pathlib.Path(folder, "figures.txt")
            lines = bench.show(["printf", "a_rate 3 1/s\\nwords\\n"], out)
            self.assertEqual("a_rate 3 1/s\nwords\n", out.read_text(encoding="utf-8"))
        self.assertEqual("a_rate 3 1/s\nwords\n", shown.getvalue())
        self.assertEqual(["a_rate 3 1/s\n"], [line for line in lines if bench.FIGURE.match(line)])
        with self.assertRaises(SystemExit) as ended:
            bench.show(["false"])
        self.assertEqual(1, ended.exception.code)

    def test_the_figures_before_a_benchmark_that_fails_are_kept(self):
        benches = {"good": lambda: bench.show(["echo", "a_rate 3 1/s"]),
                   "bad": lambda: bench.show(["false"])}
        with tempfile.TemporaryDirectory() as folder, \
                unittest.mock.patch.multiple(bench, WS=pathlib.Path(folder), BENCHES=benches,
                                             bootstrap=lambda verb: None), \
                contextlib.redirect_stdout(io.StringIO()), self.assertRaises(SystemExit):
            try:
                bench.bench(None)
            finally:
                self.assertEqual("a_rate 3 1/s\n",
                                 pathlib.Path(folder, "bench_all.txt").read_text(encoding="utf-8"))


class CiRunTest(unittest.TestCase):
    """.ci/run answers its arguments before it checks or builds anything."""

    def run_with(self, *words):
        done = subprocess.run([ROOT / ".ci/run", *words], capture_output=True, text=True,
                              timeout=20, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_help_describes_it(self):
        for word in ("-h", "--help"):
            code, out, err = self.run_with(word)
            self.assertEqual((0, ""), (code, err))
            self.assertEqual("usage: .ci/run", out.splitlines()[0])

    def test_other_arguments_are_refused_in_one_line(self):
        for word in ("--halp", "test", ""):
            self.assertEqual((2, "", f"ci: got '{word}', expected no argument or --help\n"),
                             self.run_with(word))


if __name__ == "__main__":
    unittest.main()
