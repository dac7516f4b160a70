#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The script ./aquafarm rejects unknown arguments and reports what is missing."""
import fcntl
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import free_port  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
try:
    from verbs import arguments, ranks, render  # noqa: E402
except ImportError:  # the package stands alone; its tests are skipped
    arguments = ranks = render = None

PACKAGE = pathlib.Path(__file__).resolve().parent.parent
SCRIPT = PACKAGE.parent / "aquafarm"
TOOLS = SCRIPT.parent / "tools"
LIMIT_S = 120
INTERRUPTED = 130


def run(*command, **options):
    """Runs a command with a time limit and returns the finished process with its output."""
    return subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT_S,
                          check=False, **options)


def copy_script(tree, old, new):
    """Copies the script and its functions into a folder, with one text replaced; returns the copy.

    The text must occur exactly once.
    """
    count = 0
    for source in [SCRIPT, TOOLS / "run_verb", *TOOLS.glob("commands/*.sh"),
                   *TOOLS.glob("verbs/*.py")]:
        text = source.read_text()
        count += text.count(old)
        target = tree / source.relative_to(SCRIPT.parent)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text.replace(old, new))
        target.chmod(0o755)
    assert count == 1, f"{old!r}: got {count} places, expected 1"
    return tree / "aquafarm"


def built_tree(folder):
    """Makes a copy of the script with a workspace that counts as built; returns it and its
    environment."""
    ws, tree = folder / "ws", folder / "tree"
    for part in (ws / "src", ws / "build", ws / "devel", tree):
        part.mkdir(parents=True)
    copy = copy_script(tree, "catkin_make -C", "false -C")
    (tree / "aquafarm_bringup").symlink_to(PACKAGE)
    (ws / "src" / "aquafarm").symlink_to(tree)
    (ws / "build" / "CMakeCache.txt").write_text(
        f"CMAKE_BUILD_TYPE:STRING=Release\nCMAKE_HOME_DIRECTORY:INTERNAL={ws / 'src'}\n")
    (ws / "devel" / "setup.bash").touch()
    (ws / "built").touch()
    return copy, dict(os.environ, AQUAFARM_WS=str(ws), AQUAFARM_BUILD_TYPE="Release",
                      ROS_HOME=str(folder / "ros"), ROS_LOG_DIR=str(folder / "ros" / "log"))


@unittest.skipUnless(SCRIPT.exists(), f"no script at {SCRIPT}: the package stands alone")
class ScriptTest(unittest.TestCase):

    def test_an_unknown_verb_is_refused_with_the_list(self):
        done = run(SCRIPT, "trian")
        self.assertEqual(2, done.returncode)
        self.assertIn("got 'trian', expected setup, build, train,", done.stdout)

    def test_an_unknown_argument_is_refused_with_the_list(self):
        done = run(SCRIPT, "train", "algoritm:=sarsa")
        self.assertEqual(2, done.returncode)
        self.assertIn("train.launch has no argument 'algoritm' (did you mean 'algorithm'?); it has: "
                      "algorithm ", done.stdout)

    def test_an_argument_without_a_value_is_refused(self):
        done = run(SCRIPT, "train", "sarsa")
        self.assertEqual(2, done.returncode)
        self.assertIn("got 'sarsa', expected name:=value", done.stdout)

    def test_what_is_not_named_lies_in_the_folder_of_the_user(self):
        with tempfile.TemporaryDirectory() as folder:  # rejected after the defaults are printed
            done = run(SCRIPT, "train", "resume:=maybe", cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn(f"taking run_dir:={folder}/runs/", done.stdout)
            self.assertIn("resume: got 'maybe', expected true or false", done.stdout)
            done = run(SCRIPT, "record", "of:=foo", cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn(f"taking bag:={folder}/aquafarm_", done.stdout)
            self.assertIn("of: got 'foo', expected sim, train or evaluate", done.stdout)
            done = run(SCRIPT, "replay", "bag:=day.bag", cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn(f"there is no file {folder}/day.bag", done.stdout)
            pathlib.Path(folder, "day.bag").touch()
            done = run(SCRIPT, "replay", "bag:=day.bag", "policy:=runs/x", "paused:=perhaps",
                       cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn("paused: got 'perhaps', expected true or false", done.stdout)
            done = run(SCRIPT, "replay", "bag:=day.bag", "start_step:=first", cwd=folder)
            self.assertIn("start_step: got 'first', expected a number", done.stdout)

    def test_what_is_missing_is_asked_for_and_not_replaced(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run(SCRIPT, "replay", cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn("replay: got no bag, expected bag:=FILE", done.stdout)

    def test_without_a_policy_the_generalist_plays(self):
        with tempfile.TemporaryDirectory() as folder:
            done = run(SCRIPT, "evaluate", "viz:=perhaps", cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn("aquafarm: taking policy:=generalist\n", done.stdout)
        def named(verb, *words):
            return arguments.name_the_ranch(verb, words)

        for verb in ("evaluate", "sim"):
            self.assertEqual(["scenario:=my ranch.yaml", "seed:=3", "policy:=generalist"],
                             named(verb, "my ranch.yaml", "seed:=3"))
            self.assertEqual(["scenario:=a.yaml", "policy:=planner"],
                             named(verb, "a.yaml", "policy:=planner"))
            self.assertEqual(["scenario:=a.yaml"], named(verb, "scenario:=a.yaml"))
        self.assertEqual(["a.yaml"], named("train", "a.yaml"))
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual([folder], named("evaluate", folder), "no run folder")
            pathlib.Path(folder, "run.json").touch()
            self.assertEqual([f"policy:={folder}"], named("evaluate", folder))
        scenarios = SCRIPT.parent / "aquafarm_sim" / "scenarios"
        for ranch, policy in (("two_squads", "planner"), ("paper", "generalist")):
            self.assertEqual(f"policy:={policy}", named("sim", f"{scenarios}/{ranch}.yaml")[-1])

    def test_a_fraction_is_not_a_whole_number(self):
        with tempfile.TemporaryDirectory() as folder:
            for argument in ("seed:=1.5", "farms:=2.25", "episodes:=0.5", "random_episodes:=7.5"):
                done = run(SCRIPT, "train", argument, cwd=folder)
                self.assertEqual(2, done.returncode, done.stdout)
                name, value = argument.split(":=")
                self.assertIn(f"{name}: got '{value}', expected a whole number", done.stdout)
            self.assertEqual([], os.listdir(folder))

    def test_ranks_pass_on_the_initial_policy(self):
        for given, expected in (("/runs/a b", ["paper", "--init", "/runs/a b"]), ("none", ["paper"]),
                                ("generalist", ["paper", "--init", "generalist"])):
            self.assertEqual((expected, None), ranks.program_arguments([f"init:={given}"]))

    def test_ranks_pass_on_each_option_and_name_the_report(self):
        self.assertEqual(
            (["two_squads", "--set", "gamma=0.9", "--set", "hidden_size=32", "--resume"], "/r/1"),
            ranks.program_arguments(["options:=gamma=0.9 hidden_size=32", "scenario:=two_squads",
                                     "exploration:=auto", "resume:=true", "report:=/r/1"]))

    def test_ranks_refuse_what_needs_ros(self):
        for arguments, expected in ((["viz:=true"], "viz: got this argument with ranks, expected"),
                                    (["ranks:=1.5"], "ranks: got '1.5', expected a whole number")):
            done = run(SCRIPT, "train", "ranks:=2", "steps:=10", *arguments, cwd="/tmp")
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn(expected, done.stdout)

    def test_a_program_in_place_of_the_master_is_named(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket() as silent:
            silent.bind(("127.0.0.1", 0))
            silent.listen()
            uri = f"http://127.0.0.1:{silent.getsockname()[1]}"
            copy, env = built_tree(pathlib.Path(folder).resolve())
            done = run("bash", copy, "sim", "headless:=true", cwd=folder,
                       env=dict(env, ROS_MASTER_URI=uri))
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn(f"ROS_MASTER_URI: got {uri}, where a program listens and does not answer",
                          done.stdout)

    def test_a_node_that_was_killed_has_not_ended_well(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            copy, env = built_tree(folder)
            tools = folder / "bin"
            tools.mkdir()
            (tools / "roslaunch").write_text("#!/bin/sh\nexit 0\n")  # its nodes left no exit code
            (tools / "roslaunch").chmod(0o755)
            copy.write_text(copy.read_text().replace("export PATH=/usr/bin:/bin:$PATH\n", ""))
            done = run("bash", copy, "train", "verbose:=true", cwd=folder,
                       env=dict(env, PATH=f"{tools}:{env['PATH']}",
                                ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}"))
            self.assertEqual(137, done.returncode, done.stdout)
            self.assertIn("train ended with exit code 137: its node was killed before it ended; "
                          "resume:=true continues from the last checkpoint", done.stdout)
            self.assertNotIn("ended well", done.stdout)

    def test_a_resumed_run_takes_what_is_not_given_from_its_folder(self):
        def taken(folder, *arguments):  # rejected after the defaults are printed
            done = run(SCRIPT, "train", "resume:=true", "viz:=perhaps", *arguments, cwd=folder)
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn("viz: got 'perhaps', expected true or false", done.stdout)
            start = "aquafarm: taking "
            return {line[len(start):].split(":=")[0]: line.split(":=", maxsplit=1)[1]
                    for line in done.stdout.splitlines() if line.startswith(start)}

        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            newest = folder / "runs" / "newest"
            (newest / "checkpoints").mkdir(parents=True)
            (newest / "checkpoints" / "step_7.ckpt").touch()
            (newest / "scenario.yaml").touch()
            (newest / "run.json").write_text(json.dumps({
                "algorithm": "sarsa", "credit": "shared", "episodes": 9, "farms": 8, "seed": 3,
                "options": "gamma=0.9 exploration=boltzmann:5 mask_illegal=true"}))
            of_run = {"scenario": f"{newest}/scenario.yaml", "algorithm": "sarsa", "credit": "shared",
                      "farms": "8", "seed": "3", "exploration": "boltzmann:5",
                      "options": "gamma=0.9 mask_illegal=true"}
            self.assertEqual({"run_dir": str(newest), "report": str(newest), **of_run},
                             taken(folder))
            self.assertEqual({"report": str(newest), **of_run},
                             taken(folder, "run_dir:=runs/newest"))
            with self.subTest("what is given wins"):
                mine = taken(folder, "algorithm:=q_learning", "seed:=4", "report:=none",
                             "options:=exploration=boltzmann:1")
                self.assertEqual({"run_dir", "scenario", "farms", "credit"}, set(mine))
            with self.subTest("the options of another algorithm are of no use"):
                self.assertFalse({"options", "exploration"} &
                                 set(taken(folder, "algorithm:=q_learning")))
                self.assertEqual("gamma=0.9 mask_illegal=true",
                                 taken(folder, "algorithm:=sarsa")["options"])
            with self.subTest("a learner without options"):
                words = json.loads((newest / "run.json").read_text())
                (newest / "run.json").write_text(json.dumps(dict(words, options="")))
                self.assertFalse({"options", "exploration"} & set(taken(folder)))
            with self.subTest("a new run"):
                self.assertEqual({"run_dir", "report"}, set(taken(folder, "resume:=false")))
            with self.subTest("arguments of a stranger"):
                for theirs in ({"algorithm": "sarsa\nreport:=/tmp/theirs"},
                               {"options": "discount=$(env HOME)"},
                               {"credit": "own' sh -c 'id"}):
                    (newest / "run.json").write_text(json.dumps(dict(words, **theirs)))
                    done = run(SCRIPT, "train", "resume:=true", "viz:=perhaps", cwd=folder)
                    self.assertIn(f"{newest}/run.json: damaged: ValueError(", done.stdout)
                    self.assertNotIn("theirs\n", done.stdout)
            with self.subTest("damaged"):
                (newest / "run.json").write_text("{")
                done = run(SCRIPT, "train", "resume:=true", "viz:=perhaps", cwd=folder)
                self.assertIn(f"{newest}/run.json: damaged: ", done.stdout)

    def test_an_interrupted_training_continues_with_resume_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            copy, env = built_tree(folder)

            def train(*arguments):
                process = subprocess.Popen(
                    ["bash", copy, "train", "viz:=false", "report:=none", "evaluation_episodes:=0",
                     *arguments], cwd=folder,
                    env=dict(env, ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}"), stdin=subprocess.DEVNULL, text=True,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.addCleanup(process.stdout.close)
                self.addCleanup(process.wait)
                self.addCleanup(process.terminate)  # the script shuts its nodes down
                return process

            first = train("scenario:=zhoushan_infa_2021", "algorithm:=sarsa", "farms:=8", "seed:=3",
                          "options:=gamma=0.9", "exploration:=boltzmann:5", "steps:=300000")
            end = time.monotonic() + LIMIT_S
            while not any(path.read_text().count("\n") > 1
                          for path in folder.glob("runs/*/metrics.csv")):
                self.assertIsNone(first.poll(), "ended before it trained")
                self.assertLess(time.monotonic(), end, "does not train")
                time.sleep(0.05)
            first.send_signal(signal.SIGINT)
            words, _ = first.communicate(timeout=LIMIT_S)
            self.assertEqual(INTERRUPTED, first.returncode, words)
            self.assertIn(f"resume     {copy} train resume:=true run_dir:={folder}/runs/", words)
            rest = train("resume:=true")
            words, _ = rest.communicate(timeout=2 * LIMIT_S)
            self.assertEqual(0, rest.returncode, words)
            self.assertIn("resuming from ", words)
            self.assertIn("trained    sarsa, 300,00", words)

    def test_a_wrong_word_for_test_or_bench_is_refused_with_what_there_is(self):
        done = run(SCRIPT, "test", "--quick")
        self.assertEqual(2, done.returncode, done.stdout)
        self.assertIn("test: got '--quick', expected --fast or nothing", done.stdout)
        done = run(SCRIPT, "bench", "simulator")
        self.assertEqual(2, done.returncode, done.stdout)
        self.assertIn("bench: got 'simulator', expected sim, import, tabular,", done.stdout)

    def test_a_picture_with_a_policy_wants_the_bag_first(self):
        done = run(SCRIPT, "render", "-o", "x.png", "--policy", "runs/x")
        self.assertEqual(2, done.returncode, done.stdout)
        self.assertIn("render: got '-o', expected the bag first: render BAG -o FILE --policy P",
                      done.stdout)
        done = run(SCRIPT, "render", "day.bag", "--policy")
        self.assertEqual(2, done.returncode, done.stdout)
        self.assertIn("--policy: got nothing, expected a run folder or checkpoint", done.stdout)

    def test_only_the_maps_that_are_drawn_are_computed(self):
        for words, expected in (("-o x.png", "--values-every 0"),
                                ("-o x.png --layers risk,values", "--values-at 0"),
                                ("-o x.png --layers=values --step 3 5", "--values-at 3 5"),
                                ("-o x.png --layers values --end", "--values-every 1"),
                                ("-o x.MP4 --layers values --every 3", "--values-every 3"),
                                ("-o x.mp4 --layers moves --every 4", "--values-every 4")):
            self.assertEqual(expected.split(), render.maps_of_values(words.split()))
        self.assertEqual(("runs/x", ["day.bag", "-o", "x.png", "--step", "-1"]), render.without_policy(
            "day.bag -o x.png --policy runs/x --step -1".split()))

    def test_every_verb_has_help(self):
        for verb in ("setup", "build", "train", "evaluate", "sim", "play", "record", "replay",
                     "test", "bench"):
            with self.subTest(verb=verb):
                done = run(SCRIPT, verb, "--help")
                self.assertEqual(0, done.returncode, done.stdout)
                self.assertIn(f"usage: ./aquafarm {verb}", done.stdout)

    def test_what_another_tree_or_type_has_built_is_rebuilt(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            ws, tree = folder / "ws", folder / "tree"
            for part in ("src", "build", "devel"):
                (ws / part).mkdir(parents=True)
            (tree / "aquafarm_x").mkdir(parents=True)
            copy = copy_script(tree, "catkin_make -C", "echo -C")
            cache = ws / "build" / "CMakeCache.txt"

            def words(root, home=ws / "src", build_type="Release"):
                (ws / "build").mkdir(exist_ok=True)
                cache.write_text(f"CMAKE_BUILD_TYPE:STRING={build_type}\n"
                                 f"CMAKE_HOME_DIRECTORY:INTERNAL={home}\n")
                (ws / "src" / "aquafarm").unlink(missing_ok=True)
                (ws / "src" / "aquafarm").symlink_to(root)
                (ws / "built").touch()
                done = run("bash", copy, "ask", "--help", env=dict(os.environ, AQUAFARM_WS=str(ws)))
                self.assertEqual(str(tree), os.readlink(ws / "src" / "aquafarm"), done.stdout)
                return done.stdout

            self.assertNotIn("building in", words(tree))
            self.assertIn("building in", words(tree, build_type="Debug"))
            self.assertTrue(cache.exists(), "another type is compiled in place")
            for other in ((folder / "other",), (tree, folder / "moved" / "src")):
                self.assertIn("was built from another checkout; rebuilding", words(*other))
                self.assertFalse(cache.exists())

    def test_a_second_build_waits_for_the_first_and_takes_what_it_made(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder).resolve()
            ws, copy = folder / "ws", folder / "tree" / "aquafarm"
            for part in ("ws/src", "ws/build", "tree/aquafarm_x"):
                (folder / part).mkdir(parents=True)
            copy_script(copy.parent, "catkin_make -C", "echo -C")
            (copy.parent / "aquafarm_bringup").symlink_to(PACKAGE)
            (ws / "src" / "aquafarm").symlink_to(copy.parent)
            (ws / "build" / "CMakeCache.txt").write_text(
                f"CMAKE_BUILD_TYPE:STRING=Release\nCMAKE_HOME_DIRECTORY:INTERNAL={ws / 'src'}\n")
            program = ws / "devel/lib/aquafarm_agents/bag_policy"
            program.parent.mkdir(parents=True)
            program.write_text("#!/bin/sh\necho asked\n")
            program.chmod(0o755)
            (ws / "devel/setup.bash").touch()
            lock = os.open(ws, os.O_RDONLY)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX)
                second = subprocess.Popen(["bash", copy, "ask", "--help"], text=True,
                                          env=dict(os.environ, AQUAFARM_WS=str(ws)),
                                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.addCleanup(second.kill)
                self.assertIn("another process is building in", second.stdout.readline())
                (ws / "built").touch()  # as the first build does at its end
            finally:
                os.close(lock)
            words, _ = second.communicate(timeout=LIMIT_S)
            self.assertEqual(0, second.returncode, words)
            self.assertTrue(words.endswith("asked\n"), words)
            self.assertNotIn("building in", words)

    def test_a_workspace_of_somebody_else_is_left_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            ws = pathlib.Path(folder).resolve()
            (ws / "build").mkdir()
            (ws / "build" / "theirs").touch()
            (ws / "src").mkdir()
            for place, words in ((ws / "src", "got a build that ./aquafarm has not made"),
                                 (ws / "src" / "aquafarm", "got a folder, expected this checkout")):
                place.mkdir(exist_ok=True)
                done = run(SCRIPT, "build", env=dict(os.environ, AQUAFARM_WS=str(ws)))
                self.assertEqual(2, done.returncode, done.stdout)
                self.assertIn(words, done.stdout)
                self.assertTrue((ws / "build" / "theirs").exists())

    @unittest.skipUnless(os.geteuid() == 0 and shutil.which("setpriv"), "needs root and setpriv")
    def test_without_root_setup_says_what_to_install_and_ends(self):
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o755)
            copy = copy_script(pathlib.Path(folder), "\npackages=(", "\npackages=(\n  no-such-thing")
            done = run("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", copy, "setup")
        self.assertEqual(3, done.returncode, done.stdout)
        self.assertIn("apt-get install --no-install-recommends no-such-thing\n", done.stdout)

    @unittest.skipUnless(os.geteuid() == 0, "needs root, as setup does")
    def test_without_apt_setup_says_what_to_install_and_ends(self):
        with tempfile.TemporaryDirectory() as folder:
            tools = pathlib.Path(folder, "bin")
            tools.mkdir()
            for tool in ("bash", "dirname", "realpath", "nproc", "dpkg-query", "comm", "sed", "sort",
                         "id", "cat", "mkdir"):
                os.symlink(shutil.which(tool), tools / tool)
            copy = copy_script(pathlib.Path(folder), "\npackages=(", "\npackages=(\n  no-such-thing")
            text = copy.read_text()
            self.assertIn("export PATH=/usr/bin:/bin:$PATH\n", text)
            copy.write_text(text.replace("export PATH=/usr/bin:/bin:$PATH\n", ""))
            done = run(tools / "bash", copy, "setup", env={"PATH": str(tools)})
            self.assertEqual(3, done.returncode, done.stdout)
            self.assertIn("there is no apt-get; install these packages by hand: no-such-thing\n",
                          done.stdout)
            os.remove(tools / "dpkg-query")
            done = run(tools / "bash", copy, "setup", env={"PATH": str(tools)})
            self.assertEqual(3, done.returncode, done.stdout)
            self.assertIn("there is no dpkg (setup is made for Debian 12); install the equivalents of: ",
                          done.stdout)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "script", ScriptTest, sys.argv)
