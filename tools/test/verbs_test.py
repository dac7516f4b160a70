#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The stages of ./aquafarm test, the end of a launch, and child processes of tools/verbs."""
import contextlib
import importlib.machinery
import io
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
import xmlrpc.server
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from verbs import bench, launch, ranks, tests, workspace  # noqa: E402


class TestRun(unittest.TestCase):
    """Runs the stages with programs that are replaced: nothing is built."""

    def run_with(self, fast, **codes):
        """Returns (exit code, commands, results) of a run. codes: exit codes of programs by name"""
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder, "results")
            commands = []

            def run_children(commands, **_):
                return [run_child(command) for command, _ in commands]

            def run_child(command):
                words = [str(word) for word in command]
                commands.append(" ".join(words))
                name = pathlib.Path(words[0]).name
                code = codes.get(name, 0)
                for word in words:
                    path = pathlib.Path(word.split("=")[-1])
                    if path.suffix == ".xml" and code < 2:
                        path.write_text("<testsuite/>", encoding="utf-8")
                return code

            def popen(command, **_):
                code = run_child(command[len(tests.IDLE):])
                child = mock.MagicMock(poll=lambda: None, wait=lambda: code)
                child.__enter__.return_value = child
                return child

            with mock.patch.object(tests.subprocess, "Popen", popen), \
                    mock.patch.multiple(tests, RESULTS=results, WS=pathlib.Path(folder),
                                     run_child=run_child, run_children=run_children,
                                     enter_ros=lambda: False, end_session=lambda child: None,
                                     build_core=lambda name: None, bootstrap=lambda *words: None,
                                     run_bootstrap=lambda *words: codes.get(words[0], 0),
                                     run_bootstraps=lambda *steps: [codes.get(words[0], 0)
                                                                    for words in steps]), \
                    contextlib.redirect_stdout(io.StringIO()) as out, \
                    contextlib.redirect_stderr(out):
                code = tests.run(fast)
            return code, commands, {path.name for path in results.iterdir()}, out.getvalue()

    def test_every_stage_passes(self):
        code, commands, results, _ = self.run_with(fast=False)
        self.assertEqual(0, code)
        self.assertEqual(["check_workspaces", "check_python", "python3", "python3", "bash", "bash",
                          "run_ros_tests", "python3"],
                         [pathlib.Path(line.split()[0]).name for line in commands])
        self.assertFalse({name for name in results if name.startswith("stage-")})

    def test_fast_leaves_out_the_other_workspaces(self):
        _, commands, _, _ = self.run_with(fast=True)
        self.assertFalse([line for line in commands
                          if "check_workspaces" in line or "check_python" in line])

    def test_a_failed_stage_fails_the_whole(self):
        self.assertEqual(1, self.run_with(fast=True, bash=1)[0])

    def test_a_failure_in_another_workspace_fails_the_whole(self):
        code, _, results, words = self.run_with(fast=False, check_workspaces=2)
        self.assertEqual(1, code)
        self.assertIn("stage-another_kind_of_workspace.xml", results)
        self.assertIn("waiting for: another kind of workspace (log: ", words)

    def test_a_step_next_to_others_ends_with_them_if_they_raise(self):
        with tempfile.TemporaryDirectory() as folder:
            script = ("sleep 60 & sleep 0.5; cat /proc/self/autogroup >group; chrt -p $$ >class; "
                      "echo $! >part; mv part sleep; wait")
            step = tests.Step("sleep", ["bash", "-c", f"cd {folder}; {script}"],
                              pathlib.Path(folder, "log"))
            pid = pathlib.Path(folder, "sleep")
            started = time.monotonic()
            with self.assertRaises(SystemExit), tests.Stages().next_to(step):
                while not pid.exists() and time.monotonic() - started < 20:
                    time.sleep(0.05)
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(30)
            self.assertLess(time.monotonic() - started, 20)
            self.assertIn("SCHED_IDLE", pathlib.Path(folder, "class").read_text())
            group = pathlib.Path(folder, "group").read_text()
            self.assertTrue("nice 19" in group or not group, group)  # empty without autogroups
            self.wait_for_end(int(pid.read_text()))
        self.assertIs(signal.SIG_DFL, signal.getsignal(signal.SIGTERM))

    def wait_for_end(self, pid):
        """Waits for a signalled process, which has the idle class and may have to wait for a core."""
        end = time.monotonic() + 20
        while time.monotonic() < end:
            try:
                if pathlib.Path(f"/proc/{pid}/stat").read_text().split()[2] == "Z":
                    return
            except (FileNotFoundError, ProcessLookupError):
                return
            time.sleep(0.05)
        self.fail(f"process {pid} has not ended within 20 s")

    def test_a_stage_without_results_counts_as_a_failed_test(self):
        code, _, results, words = self.run_with(fast=True, bash=2)
        self.assertEqual(1, code)
        self.assertLessEqual({"stage-aquafarm_sim_core.xml", "stage-aquafarm_agents_core.xml"}, results)
        self.assertIn("the stage 'aquafarm_sim core' broke off; the end of ", words)
        _, _, results, _ = self.run_with(fast=True, run_ros_tests=1)
        self.assertIn("stage-tests_through_ROS.xml", results)

    def test_a_failed_build_ends_the_whole_at_once(self):
        with self.assertRaises(SystemExit) as end:
            self.run_with(fast=True, build=7)
        self.assertEqual(7, end.exception.code)

    def test_what_cannot_be_installed_is_left_out_with_a_word(self):
        code, _, _, words = self.run_with(fast=True, **{"--install": 3})
        self.assertEqual(0, code)
        self.assertIn("clang-14 cannot be installed: the check of locks is skipped", words)


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


def load(path):
    """Returns the module of a program whose name has no suffix."""
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    module = types.ModuleType(loader.name)
    loader.exec_module(module)
    return module


class TestSecondRanch(unittest.TestCase):
    """A master that has one node, /ours/sim."""

    def setUp(self):
        self.node = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(self.node.close)
        self.answer = (1, "", f"http://127.0.0.1:{self.node.getsockname()[1]}/")
        master = xmlrpc.server.SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
        master.register_function(
            lambda _, name: self.answer if name == "/ours/sim" else (-1, "unknown node", ""),
            "lookupNode")
        threading.Thread(target=master.serve_forever, daemon=True).start()
        self.addCleanup(master.server_close)
        self.addCleanup(master.shutdown)
        self.use_master(f"http://127.0.0.1:{master.server_address[1]}")

    def use_master(self, uri):
        environment = mock.patch.dict(os.environ, {"ROS_MASTER_URI": uri})
        environment.start()
        self.addCleanup(environment.stop)

    def expect_doubt(self, pattern):
        with self.assertRaisesRegex(workspace.Refused, f"^/ours/sim may already run on .*{pattern}.*; "
                                    "give ns:=another_name or another master$"):
            launch.refuse_a_second_ranch(["ns:=ours"])

    def test_it_is_refused_while_the_first_one_runs(self):
        with self.assertRaisesRegex(workspace.Refused, "^/ours/sim already runs on http://127"):
            launch.refuse_a_second_ranch(["ns:=ours"])

    def test_it_may_start_with_another_name_or_after_the_first_one_was_killed(self):
        launch.refuse_a_second_ranch([])
        self.node.close()
        launch.refuse_a_second_ranch(["ns:=ours"])

    def test_it_is_refused_if_the_first_one_cannot_be_reached(self):
        for answer, reason in (((1, "", "http://no-such-host.invalid:7/"), "known|resolution"),
                               ((1, "", "http://127.0.0.1:seven/"), "seven"),
                               ((1, "", ""), ""), ((0, "internal error", ""), "internal error"),
                               ("text", ""), (7, "")):
            self.answer = answer
            self.expect_doubt(f"({reason})")

    def test_it_is_refused_if_the_host_of_the_first_one_does_not_answer(self):
        with mock.patch.object(launch.socket, "create_connection",
                               side_effect=TimeoutError("timed out")) as connect:
            with mock.patch.object(launch.xmlrpc.client, "ServerProxy") as proxy:
                proxy.return_value.lookupNode.return_value = self.answer
                self.expect_doubt("'timed out'")
        self.assertEqual({"timeout": launch.MASTER_LIMIT_S}, connect.call_args.kwargs)

    def test_it_is_refused_if_the_master_does_not_answer_in_time(self):
        self.assertEqual(load(workspace.CHECK_ARGUMENTS).MASTER_LIMIT_S, launch.MASTER_LIMIT_S)
        silent = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(silent.close)
        self.use_master(f"http://127.0.0.1:{silent.getsockname()[1]}")
        with mock.patch.object(launch, "MASTER_LIMIT_S", 0.2):
            begin = time.monotonic()
            self.expect_doubt("'timed out'")
        self.assertLess(time.monotonic() - begin, launch.MASTER_LIMIT_S)

    def test_it_is_refused_if_the_master_answers_with_something_else(self):
        for answer in (b"SSH-2.0-OpenSSH\r\n", b"HTTP/1.0 200 OK\r\nContent-Length: 5\r\n\r\nhello",
                       b"HTTP/1.0 404 Not Found\r\n\r\n"):
            with socket.create_server(("127.0.0.1", 0)) as broken:
                self.use_master(f"http://127.0.0.1:{broken.getsockname()[1]}")
                thread = threading.Thread(target=answer_once, args=(broken, answer))
                thread.start()
                self.expect_doubt("expected a running node or a refused connection")
                thread.join()

    def test_it_may_start_where_no_master_runs(self):
        with socket.create_server(("127.0.0.1", 0)) as port:
            self.use_master(f"http://127.0.0.1:{port.getsockname()[1]}")
        launch.refuse_a_second_ranch(["ns:=ours"])


def answer_once(server, answer):
    """Sends `answer` to one client after its request."""
    connection, _ = server.accept()
    with connection:
        connection.recv(65536)
        connection.sendall(answer)


class TestRanks(unittest.TestCase):

    def test_a_training_in_ranks_creates_a_run_folder_if_it_is_auto(self):
        self.assertEqual((["paper", "--ranks", "2"], None),
                         ranks.program_arguments(["ranks:=2", "run_dir:=auto"]))
        self.assertEqual((["paper", "--run-dir", os.path.realpath("here")], None),
                         ranks.program_arguments(["run_dir:=here"]))


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

    def test_a_signal_reaches_all_children(self):
        threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGTERM)).start()
        loop = "for i in {1..600}; do sleep 0.1; done"
        codes = workspace.run_children(
            [(["bash", "-c", f"trap 'exit {code}' TERM; {loop}"], {}) for code in (4, 5)],
            goes_on=True)
        self.assertEqual([4, 5], codes)

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


class TimeLeftTest(unittest.TestCase):
    """The estimate of tools/run_ros_tests."""

    def test_slow_tests_weigh_more_and_running_ones_are_half_done(self):
        runner = load(ROOT / "tools/run_ros_tests")
        short = [f"_run_tests_p_gtest_{letter}" for letter in "abc"]
        slow = "_run_tests_p_rostest_test_benchmark.test"
        self.assertEqual(0.0, runner.left_s(short, set(short), 2, 60.0))
        self.assertAlmostEqual(60.0 * 9 / 9, runner.left_s(short, {short[0]}, 1, 60.0))
        self.assertGreater(runner.left_s([slow, *short], {short[0]}, 0, 60.0), 600.0)
        self.assertLess(runner.left_s([slow, *short], {slow}, 0, 60.0), 60.0)


if __name__ == "__main__":
    unittest.main()
