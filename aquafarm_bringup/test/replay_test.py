#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A replay can be paused, stepped, paced and sent to a step, and shows another policy's choices."""
import os
import pathlib
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import rosbag
import rosgraph
import roslib.packages
import rospy
import rostest
from aquafarm_msgs.msg import FarmState, PolicyChoice
from aquafarm_msgs.srv import Jump, Pause, SetPace
from nav_msgs.msg import Path

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import Ranch, free_port  # noqa: E402

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
SCRIPT = SCRIPTS.parent.parent / "aquafarm"
LIMIT_S = 60
DEAD_DISPLAY = ":65432"
DEAD = f"cannot connect to display {DEAD_DISPLAY}"
WAY_OUT = (": set headless:=true or rviz:=false and view the topic image, or draw a bag with "
           "'./aquafarm render'")


def make_bag(folder):
    """Makes a bag of one episode with about fifty steps; returns its path."""
    def run(package, name, *arguments):
        subprocess.run([roslib.packages.find_node(package, name)[0], *map(str, arguments)],
                       check=True, stdout=subprocess.DEVNULL, timeout=60)
    scenario = roslib.packages.get_pkg_dir("aquafarm_sim") + "/scenarios/paper.yaml"
    run("aquafarm_agents", "aquafarm_evaluate", "clairvoyant", scenario, "--episodes", 1, "--route",
        folder / "r.json")
    run("aquafarm_sim", "episode_bag", scenario, folder / "r.json", "-o", folder / "x.bag")
    return folder / "x.bag"


class ReplayTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_replay_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.bag = make_bag(cls.folder)
        cls.ranch = Ranch("replay", f"bag:={cls.bag}", "headless:=true", "policy:=random",
                          "paused:=true", "start_step:=7", port=free_port())
        cls.ranch.__enter__()
        cls.addClassCleanup(lambda: cls.ranch.__exit__())
        os.environ.update(cls.ranch.environment)
        cls.ranch.wait_for(rosgraph.is_master_online, LIMIT_S)
        rospy.init_node("replay_test", disable_signals=True)
        cls.states, cls.choices, cls.players = [], [], []
        rospy.Subscriber("/aquafarm/state", FarmState, cls.states.append, queue_size=1000)
        rospy.Subscriber("/aquafarm/choice", PolicyChoice, cls.choices.append)
        for name in ("pause", "set_pace", "jump"):
            rospy.wait_for_service(f"/aquafarm/{name}", LIMIT_S)
        cls.pause = rospy.ServiceProxy("/aquafarm/pause", Pause)
        cls.pace = rospy.ServiceProxy("/aquafarm/set_pace", SetPace)
        cls.jump = rospy.ServiceProxy("/aquafarm/jump", Jump)

    def shown(self, step):
        """Waits until `step` is the last step shown."""
        self.ranch.wait_for(lambda: self.states and self.states[-1].step == step, LIMIT_S)

    def test_a_jump_comes_with_the_choice_of_the_policy(self):
        self.jump(step=7)
        self.shown(7)
        self.ranch.wait_for(lambda: self.choices and self.choices[-1].step == 7, LIMIT_S)
        self.assertEqual("random", self.choices[-1].policy)
        self.assertIn("choices agree with the recorded actions", self.ranch.words())

    def play(self, *parameters):
        """Starts a separate player; returns its process and the list of states."""
        space = f"/alone_{len(self.players)}"
        states = []
        rospy.Subscriber(space + "/state", FarmState, states.append, queue_size=1000)
        process = subprocess.Popen(
            [roslib.packages.find_node("aquafarm_viz", "replay_node")[0], f"__ns:={space}",
             "__name:=player", *parameters], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            text=True)
        self.players.append(process)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait, LIMIT_S)
        self.addCleanup(process.kill)
        return process, states

    def moved_bag(self):
        """Makes a bag with the topics /state and /spec; returns its path. Its episodes 4 and 5 both
        contain the states of the recorded bag."""
        path = self.folder / "two.bag"
        with rosbag.Bag(str(self.bag)) as source, rosbag.Bag(str(path), "w") as copy:
            for i, episode in enumerate((4, 5)):
                for topic, message, time in source.read_messages(
                        ["/aquafarm/spec", "/aquafarm/state"]):
                    message.episode = episode
                    copy.write(topic.rsplit("/", 1)[1], message, time + rospy.Duration(100 * i))
        return path

    def test_it_begins_at_the_episode_and_step_asked_for(self):
        _, states = self.play(f"_bag:={self.moved_bag()}", "_start_episode:=5", "_start_step:=9",
                              "_paused:=true", "_delay_s:=2")
        self.ranch.wait_for(lambda: states and states[-1].step == 9, LIMIT_S)
        self.assertEqual({5}, {state.episode for state in states})
        self.assertGreaterEqual(9, max(state.step for state in states))

    def test_it_can_be_stepped_before_it_starts(self):
        _, states = self.play(f"_bag:={self.moved_bag()}", "_start_step:=9", "_delay_s:=3600")
        space = f"/alone_{len(self.players) - 1}"
        rospy.wait_for_service(space + "/pause", LIMIT_S)
        subscriber = rospy.Subscriber(space + "/state", FarmState)
        self.ranch.wait_for(subscriber.get_num_connections, LIMIT_S)
        pause = rospy.ServiceProxy(space + "/pause", Pause)
        for steps, step in ((1, 10), (2, 12)):
            pause(paused=True, steps=steps)
            self.ranch.wait_for(lambda: states and states[-1].step == step, LIMIT_S)

    def test_in_a_loop_it_restarts_at_the_end(self):
        _, states = self.play(f"_bag:={self.moved_bag()}", "_loop:=true", "_speed:=1000",
                              "_delay_s:=2")

        def begins_anew():
            episodes = [state.episode for state in list(states)]
            return 5 in episodes and 4 in episodes[episodes.index(5):]

        self.ranch.wait_for(begins_anew, LIMIT_S)

    def test_a_parameter_of_another_type_than_bool_ends_the_player_with_its_line(self):
        for name in ("paused", "loop", "keep_alive"):
            process, _ = self.play(f"_bag:={self.bag}", f"_{name}:=maybe")
            self.assertEqual(2, process.wait(LIMIT_S))
            self.assertRegex(process.stderr.read(),
                             f"~{name}: got another type, expected true or false\n")

    def test_paused_it_goes_step_by_step(self):
        self.assertEqual(20, self.jump(step=20).step)
        self.shown(20)
        answer = self.pause(paused=True, steps=1)
        self.assertTrue(answer.ok and answer.paused)
        self.shown(21)
        self.pause(paused=True, steps=3)
        self.shown(24)
        self.assertEqual(list(range(20, 25)),
                         [state.step for state in self.states if state.step >= 20][-5:])

    def test_after_a_jump_the_route_is_that_of_playing_through(self):
        routes = []
        rospy.Subscriber("/aquafarm/ship_0/route", Path, routes.append)
        self.ranch.wait_for(lambda: routes, LIMIT_S)
        with rosbag.Bag(str(self.bag)) as bag:
            states = [message for _, message, _ in bag.read_messages("/aquafarm/state")]
        for step in (45, 38):
            way = []
            for state in states[:step + 1]:
                place = state.ships[0].x, state.ships[0].y
                if not way or way[-1] != place:
                    way.append(place)
            self.assertGreater(len(way), 25)  # longer than the trail
            self.assertEqual(step, self.jump(step=step).step)
            self.ranch.wait_for(lambda: way == [
                (round(pose.pose.position.x / 1000), round(pose.pose.position.y / 1000))
                for pose in routes[-1].poses], LIMIT_S)

    def test_it_jumps_back_and_forth_and_says_what_there_is_not(self):
        answer = self.jump(step=1000000)
        self.assertTrue(answer.ok)
        with rosbag.Bag(str(self.bag)) as bag:
            last = max(m.step for _, m, _ in bag.read_messages("/aquafarm/state"))
        self.assertEqual(last, answer.step)
        self.shown(last)
        self.assertEqual(3, self.jump(step=3).step)
        self.shown(3)
        answer = self.jump(has_episode=True, episode=99)
        self.assertFalse(answer.ok)
        self.assertEqual("episode: got 99, the bag has episodes 0 to 0 (some of them may not "
                         "be recorded)", answer.message)
        self.assertEqual(3, answer.step)

    def test_its_pace_is_in_steps_a_second(self):
        self.jump(step=0)
        answer = self.pace(rate_hz=40)
        self.assertTrue(answer.ok)
        self.assertAlmostEqual(40, answer.rate_hz, places=3)
        self.pause(paused=False)
        self.ranch.wait_for(lambda: self.states[-1].step >= 20, LIMIT_S)
        self.pause(paused=True)
        answer = self.pace(pace="lockstep")
        self.assertFalse(answer.ok)
        self.assertEqual("pace: got lockstep, expected paced: a replay has no other pace",
                         answer.message)
        self.assertIn("rate_hz: got -1.000000, expected 0 or [0.01", self.pace(rate_hz=-1).message)

    def test_render_draws_the_values_of_the_step_that_is_drawn(self):
        find = roslib.packages.find_node
        render, ask = find("aquafarm_viz", "render")[0], find("aquafarm_agents", "bag_policy")[0]
        devel = pathlib.Path(render).parents[2]
        if not SCRIPT.exists() or devel.name != "devel":
            self.skipTest("the package stands alone")
        workspace = self.folder / "ws"  # an already built workspace
        workspace.mkdir()
        (workspace / "devel").symlink_to(devel)
        (workspace / "src").mkdir()
        (workspace / "src" / "aquafarm").symlink_to(SCRIPT.resolve().parent)
        (workspace / "build").mkdir()
        (workspace / "build" / "CMakeCache.txt").write_text(
            f"CMAKE_BUILD_TYPE:STRING={os.environ.get('AQUAFARM_BUILD_TYPE', 'Release')}\n"
            f"CMAKE_HOME_DIRECTORY:INTERNAL={workspace.resolve()}/src\n")
        (workspace / "built").touch()
        os.utime(workspace / "built", (4e9, 4e9))
        scenario = roslib.packages.get_pkg_dir("aquafarm_sim") + "/scenarios/paper.yaml"
        policy = self.folder / "run"

        def run(*command):
            done = subprocess.run([str(word) for word in command], text=True, timeout=120,
                                  env=dict(os.environ, AQUAFARM_WS=str(workspace)), check=False,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(0, done.returncode, done.stdout)
            return done.stdout

        run(find("aquafarm_agents", "aquafarm_train")[0], scenario, "--steps", 20000,
            "--run-dir", policy)
        layers = ("--layers", "values,moves")
        one, other, asked = (self.folder / name for name in ("one.png", "other.png", "asked.bag"))
        words = run(SCRIPT, "render", self.bag, "--policy", policy, "--step", 17, *layers, "-o",
                    one)
        self.assertNotIn("left out", words)
        run(ask, self.bag, policy, "-o", asked, "--values-at", 17)
        run(render, asked, "--step", 17, *layers, "-o", other)
        self.assertEqual(other.read_bytes(), one.read_bytes())
        run(ask, self.bag, policy, "-o", asked)  # one map per ten steps: that of step 10
        run(render, asked, "--step", 17, *layers, "-o", other)
        self.assertNotEqual(other.read_bytes(), one.read_bytes())
        words = run(SCRIPT, "render", self.bag, "--policy", "clairvoyant", *layers, "-o", one)
        self.assertIn(f"bag_policy: {self.bag}: no maps of values are written: clairvoyant reads "
                      "whole farms", words)
        self.assertIn(f"render: {self.bag}: got choices of a policy but no values/points", words)

    def test_without_a_display_there_is_a_line_with_the_way_out(self):
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        done = subprocess.run([SCRIPTS / "with_display", "rviz"], env=environment, text=True,
                              stderr=subprocess.PIPE, timeout=LIMIT_S, check=False)
        self.assertEqual(3, done.returncode)
        self.assertEqual(f"rviz: there is no display (DISPLAY is empty){WAY_OUT}\n", done.stderr)
        done = subprocess.run([SCRIPTS / "with_display", "rviz"], text=True,
                              env=dict(environment, DISPLAY=DEAD_DISPLAY), stderr=subprocess.PIPE,
                              timeout=LIMIT_S, check=False)
        self.assertEqual((3, f"rviz: {DEAD}{WAY_OUT}\n"), (done.returncode, done.stderr))

    def test_with_a_display_the_program_runs(self):
        read, write = os.pipe()
        with open(read) as number:
            screen = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-nolisten", "tcp"],
                                      pass_fds=[write], stderr=subprocess.DEVNULL)
            os.close(write)
            self.addCleanup(screen.wait, LIMIT_S)
            self.addCleanup(screen.terminate)
            self.assertTrue(select.select([number], [], [], LIMIT_S)[0], "Xvfb says no number")
            display = ":" + number.readline().strip()
        done = subprocess.run([SCRIPTS / "with_display", "echo", "shown"], timeout=LIMIT_S,
                              env=dict(os.environ, DISPLAY=display), text=True, check=False,
                              stdout=subprocess.PIPE)
        self.assertEqual((0, "shown\n"), (done.returncode, done.stdout))

    def test_a_ranch_or_replay_at_a_dead_display_says_so(self):
        with mock.patch.dict(os.environ, DISPLAY=DEAD_DISPLAY):
            with Ranch("sim", "viz:=false", "headless:=false") as ranch:
                ranch.wait_for(lambda: f"rviz: {DEAD}{WAY_OUT}" in ranch.words(), 60)
            with Ranch("replay", f"bag:={self.bag}") as ranch:
                self.assertEqual(3, ranch.exit_code(60), ranch.words())
                self.assertIn(f"rviz: {DEAD}{WAY_OUT}", ranch.words())

    def test_a_bag_or_policy_that_cannot_be_used_ends_the_launch_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            broken = pathlib.Path(folder) / "x.bag"
            cut = self.bag.read_bytes()[:-10]
            for content, arguments, words in (
                    (b"no bag\n", (), "x.bag: damaged or not a bag: "),
                    (cut, (), "x.bag: damaged: a length beyond its end at byte "),
                    (cut, ("policy:=random",), "x.bag: damaged: a length beyond its end at byte "),
                    (cut, ("policy:=/no/run",), "/no/run")):
                broken.write_bytes(content)
                with self.subTest(words=words, arguments=arguments):
                    with Ranch("replay", f"bag:={broken}", "headless:=true", *arguments) as ranch:
                        self.assertEqual(2, ranch.exit_code(60), ranch.words())
                        self.assertIn(words, ranch.words())

    def test_a_policy_of_another_farm_has_its_line_with_the_way_out(self):
        other = self.folder / "other"
        farm = self.folder / "cove.yaml"
        farm.write_text("name: cove\ngrid: {width: 6, height: 6}\n"
                        "layout: {rocks: {count: [2, 2]}, devices: {count: 1}}\n")
        subprocess.run([roslib.packages.find_node("aquafarm_agents", "aquafarm_train")[0], farm,
                        "--algorithm", "q_learning", "--episodes", "1", "--evaluate", "0",
                        "--random", "0", "--run-dir", other],
                       check=True, stdout=subprocess.DEVNULL, timeout=60)
        with Ranch("replay", f"bag:={self.bag}", "headless:=true", f"policy:={other}") as ranch:
            self.assertEqual(2, ranch.exit_code(60), ranch.words())
            self.assertRegex(ranch.words(), "does not fit scenario .*: the policy has .*; give a policy "
                             "that was trained on a farm like the bag's, or none\n")

    def test_a_planner_in_the_midst_of_its_plan_ends_with_the_launch(self):
        with Ranch("replay", f"bag:={self.bag}", "headless:=true", "policy:=clairvoyant") as ranch:
            pid = ranch.wait_for(lambda: ranch.node_pid("bag_policy"), 60)
            os.kill(pid, signal.SIGSTOP)  # a stopped process handles no signals except SIGKILL
            ranch.interrupt()
            ranch.exit_code(60)
            self.assertFalse(pathlib.Path(f"/proc/{pid}").exists())


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "replay", ReplayTest, sys.argv)
