#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The sim node with one ship and three farms, tested through services and topics."""
import math
import os
import sys
import unittest

import rospy
import rostest
from aquafarm_msgs.msg import (DisasterInfo, DisasterWaypoint, EpisodeSummary, FarmSpec, FarmState,
                               Outcome, StepResult)
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import Recorder, call, message, state, states  # noqa: E402

NORTH, SOUTH, EAST = 0, 1, 3


def bulletin(**fields):
    """Returns a valid bulletin with some fields changed."""
    values = dict(kind=0, grade=2, radii=[1.0, 2.0], risks=[-20.0, -10.0], speed=0.5, duration=100,
                  has_start=True, x=0.0, y=4.0)
    values.update(fields)
    return DisasterInfo(**values)


class SimNodeTest(unittest.TestCase):

    def setUp(self):
        self.assertTrue(call("reset", has_seed=True, seed=5).ok)

    def assert_refused(self, code, result, before):
        self.assertFalse(result.ok)
        self.assertEqual(code, result.code, result.message)
        self.assertTrue(result.message)
        self.assertEqual(before, state().hash)

    def test_a_device_is_fetched_and_delivered(self):
        for name, fields in (("move", {"direction": NORTH}), ("move", {"direction": NORTH}),
                             ("pickup", {}), ("move", {"direction": SOUTH}),
                             ("move", {"direction": SOUTH})):
            result = call(f"ship_0/{name}", **fields).result
            self.assertEqual(Outcome.OK, result.code, result.message)
        result = call("ship_0/drop_off").result
        self.assertTrue(result.terminated)
        self.assertFalse(result.truncated)
        self.assertEqual(FarmState.ALL_RETRIEVED, result.reason)
        # The disaster has a radius of 2 cells and is always at least 2.8 away: health stays 1.
        self.assertAlmostEqual(100.0, result.reward, places=4)
        over = call("ship_0/move", direction=NORTH).result
        self.assertEqual(Outcome.EPISODE_OVER, over.code)

    def test_a_repeated_request_moves_once(self):
        call("ship_0/move", direction=NORTH)
        first = call("ship_0/move", direction=NORTH, episode=0, step=1).result
        again = call("ship_0/move", direction=NORTH, episode=0, step=1).result
        self.assertEqual(first, again)
        self.assertEqual(2, state().step)

    def test_a_repeated_pickup_and_drop_off_count_once(self):
        call("ship_0/move", direction=NORTH)
        call("ship_0/move", direction=NORTH)
        first = call("ship_0/pickup", episode=0, step=2).result
        self.assertEqual(Outcome.OK, first.code, first.message)
        self.assertEqual(first, call("ship_0/pickup", episode=0, step=2).result)
        self.assertEqual(3, state().step)
        call("ship_0/move", direction=SOUTH)
        call("ship_0/move", direction=SOUTH)
        last = call("ship_0/drop_off", episode=0, step=5).result
        self.assertEqual(FarmState.ALL_RETRIEVED, last.reason)
        joint_return = state().joint_return
        # The episode has ended: a retry returns the first response and adds no reward.
        self.assertEqual(last, call("ship_0/drop_off", episode=0, step=5).result)
        self.assertEqual(joint_return, state().joint_return)
        self.assertEqual(6, state().step)

    def test_another_step_is_stale(self):
        call("ship_0/move", direction=NORTH)
        call("ship_0/move", direction=NORTH)
        before = state().hash
        for episode, step in ((0, 1), (0, 3), (1, 2), (2**64 - 1, 2**64 - 1)):
            result = call("ship_0/move", direction=EAST, episode=episode, step=step).result
            self.assert_refused(Outcome.STALE, result, before)

    def test_an_unknown_ship_and_direction_get_a_code(self):
        before = state().hash
        self.assert_refused(Outcome.UNKNOWN_SHIP, call("command", ship=7, action=0).result, before)
        self.assert_refused(Outcome.BAD_ACTION, call("command", ship=0, action=99).result, before)
        self.assert_refused(Outcome.BAD_DIRECTION, call("ship_0/move", direction=250).result,
                            before)

    def test_a_wrong_length_gets_a_code(self):
        before = state().hash
        for actions in (b"", b"\0", b"\0" * 4, b"\0" * 1000000):
            self.assert_refused(Outcome.BAD_LENGTH, call("step", actions=actions), before)
        self.assert_refused(Outcome.BAD_ACTION, call("step", actions=b"\0\0\xff"), before)

    def test_hostile_bulletins_get_a_code(self):
        before = state().hash
        hostile = [bulletin(x=math.nan), bulletin(radii=[1.0, math.nan]),
                   bulletin(risks=[-math.inf, -5.0]), bulletin(speed=math.nan),
                   bulletin(radii=[1.0] * 1000000), bulletin(risks=[-5.0] * 1000000),
                   bulletin(radii=[2.0, 1.0]), bulletin(risks=[-20.0]), bulletin(grade=0),
                   bulletin(track=[DisasterWaypoint()] * 100000), bulletin(kind=200)]
        for info in hostile:
            answer = call("set_disaster", farm=0, id=0, info=info)
            self.assert_refused(Outcome.BAD_VALUE, answer, before)
        self.assert_refused(Outcome.BAD_VALUE, call("set_disaster", id=9, info=bulletin()), before)
        self.assert_refused(Outcome.UNKNOWN_FARM, call("set_disaster", farm=3, info=bulletin()),
                            before)

    def test_a_bulletin_counts(self):
        answer = call("set_disaster", farm=0, id=0, info=bulletin(x=1.0, y=3.0))
        self.assertTrue(answer.ok, answer.message)
        now = state()
        self.assertEqual(answer.hash, now.hash)
        self.assertEqual((1.0, 3.0), (now.disasters[0].x, now.disasters[0].y))

    def test_a_saved_state_resumes_with_equal_hashes(self):
        def play():
            return [call("step", actions=[direction, NORTH, EAST],
                         observation_types=StepResult.HASHES).result.hashes
                    for direction in range(8)]
        play()
        saved = call("save_state")
        self.assertTrue(saved.ok, saved.message)
        expected = play()
        loaded = call("load_state", data=saved.data)
        self.assertTrue(loaded.ok, loaded.message)
        self.assertEqual(saved.hash, loaded.hash)
        self.assertEqual(expected, play())

    def test_states_that_nest_a_million_deep_get_a_code(self):
        answer = call("load_state", data=b"\x81" * 1000000)
        self.assertFalse(answer.ok)
        self.assertIn("nested too deeply", answer.message)

    def test_damaged_bytes_get_a_code(self):
        saved = call("save_state").data
        before = state().hash
        for data in (b"", b"\xff" * 100000, saved[:-3], saved[:40] + b"\0\0" + saved[42:]):
            self.assert_refused(Outcome.BAD_DATA, call("load_state", data=data), before)

    def test_a_seed_reproduces_the_hashes(self):
        def play():
            return [call("ship_0/move", direction=d % 8).result.hash for d in range(30)]
        first = play()
        call("reset", has_seed=True, seed=5)
        self.assertEqual(first, play())
        following = call("reset")
        self.assertEqual((5, 3), (following.seed, following.episode))

    def test_a_joint_step_is_repeated_by_its_sequence(self):
        first = call("step", actions=[0, 0, 0], sequence=77, observation_types=31)
        self.assertTrue(first.ok, first.message)
        self.assertEqual(first, call("step", actions=[0, 0, 0], sequence=77, observation_types=31))
        self.assertEqual(1, state().step)
        self.assertEqual(24, len(first.result.terms))
        self.assertEqual(3, len(first.result.energy))
        self.assertEqual(3, len(first.result.distance))

    def test_spec_and_chart_are_latched_and_again_at_each_episode(self):
        spec = message("spec", FarmSpec)
        self.assertEqual("lone", spec.scenario_name)
        self.assertIn('name: "lone"', spec.scenario_yaml)
        self.assertEqual((5, 5, 3, 1), (spec.width, spec.height, spec.farms, spec.agents))
        self.assertEqual(-4.0, spec.rocks[0].reward)
        self.assertTrue(spec.has_origin and spec.has_start_time)
        chart = message("chart", OccupancyGrid)
        self.assertEqual((100, 0), (chart.data[0], chart.data[2]))
        specs = Recorder("spec", FarmSpec)
        charts = Recorder("chart", OccupancyGrid)
        specs.wait(len, "the latched spec")
        call("reset", has_seed=True, seed=6, has_episode=True, episode=4)
        specs.wait(lambda m: (m[-1].seed, m[-1].episode) == (6, 4), "the new episode's spec")
        charts.wait(lambda m: len(m) >= 2, "the chart again")

    def test_state_observation_and_risk_follow_the_farm(self):
        # Listens before it moves: with another subscriber in this process no connection is new, so
        # the farm does not send its last state again.
        states = Recorder("state", FarmState)
        self.addCleanup(states.subscriber.unregister)
        call("ship_0/move", direction=NORTH)
        states.wait(lambda m: any(one.step == 1 for one in m), "the state after the move")
        got = next(one for one in states.messages if one.step == 1)
        self.assertEqual(state().hash, got.hash)
        self.assertEqual("map", got.header.frame_id)
        self.assertEqual(1627084860, got.world_time.secs)
        seen = message("ship_0/observation", FarmState, lambda m: m.step == 1)
        self.assertEqual(0, seen.observer)
        risk = message("risk", OccupancyGrid)
        self.assertEqual((100, 50, 0), (risk.data[20], risk.data[22], risk.data[0]))

    def test_frames_clock_and_diagnostics_are_there(self):
        frames = Recorder("/tf", TFMessage)
        static = message("/tf_static", TFMessage).transforms[0]
        self.assertEqual(("earth", "map"), (static.header.frame_id, static.child_frame_id))
        clock = Recorder("/clock", Clock)
        for _ in range(5):
            call("ship_0/move", direction=NORTH)
        call("reset")
        frames.wait(len, "a frame")
        names = {t.child_frame_id for m in frames.messages for t in m.transforms}
        self.assertEqual({"ship_0", "disaster_0"}, names)
        clock.wait(len, "the clock")  # several steps may share a message
        call("ship_0/move", direction=NORTH)
        clock.wait(lambda m: len(m) >= 2, "the next time")
        times = [m.clock.to_nsec() for m in clock.messages]
        self.assertEqual(sorted(times), times)
        status = message("/diagnostics", DiagnosticArray).status[0]
        told = {value.key: value.value for value in status.values}
        for key in ("farm steps per second", "late ships", "dropped clients", "memory [MiB]"):
            self.assertGreaterEqual(float(told[key]), 0.0, key)
        self.assertGreater(float(told["memory [MiB]"]), 1.0)

    def test_each_end_of_an_episode_is_summed_up(self):
        episodes = Recorder("episode", EpisodeSummary)
        recorder = states()
        while episodes.subscriber.get_num_connections() == 0:
            rospy.rostime.wallsleep(0.02)
        for _ in range(200):
            call("step", actions=[NORTH, SOUTH, EAST])
        episodes.wait(lambda m: len(m) >= 3, "three summaries")
        self.assertEqual({0, 1, 2}, {m.farm for m in episodes.messages[:3]})
        self.assertTrue(all(m.truncated and m.steps == 200 for m in episodes.messages[:3]))
        recorder.wait(lambda m: m[-1].truncated, "the last state")


if __name__ == "__main__":
    rospy.init_node("sim_node_test")
    rostest.rosrun("aquafarm_sim", "sim_node", SimNodeTest, sys.argv)
