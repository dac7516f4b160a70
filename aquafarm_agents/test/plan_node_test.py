#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""plan_node plans again at every bulletin and state change, and reports every fault in the plan.

The ranch is a publisher of this test: the node uses nothing but its topics and one service. The
published plan is compared field by field with plan.json of aquafarm_plan.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import unittest

import roslib.packages
import rospkg
import rospy
import rostest
from aquafarm_msgs.msg import DeviceState, FarmSpec, FarmState, RescueOrder, RescuePlan, ShipState
from aquafarm_msgs.srv import GetState, GetStateResponse
from nav_msgs.msg import OccupancyGrid, Path
from plan_comparison import Comparison, leaves, stamp
from std_msgs.msg import Time
from visualization_msgs.msg import MarkerArray

LIMIT_S = 60
SCENARIO = pathlib.Path(rospkg.RosPack().get_path("aquafarm_sim"), "scenarios",
                        "zhoushan_infa_2021.yaml")
SCHEMA = (pathlib.Path(rospkg.RosPack().get_path("aquafarm_bringup")) / "python" /
          "aquafarm_plan" / "plan.schema.json")
START = "2021-07-24T00:00:00Z"
# Keys of plan.json that the message leaves out, and why: grids and shapes have topics of their own.
LEFT_OUT = {
    "format", "version",  # the message has its own type
    "outcome.kind",  # result
    "clock.zone",  # utc_offset_min
    "ranch.name", "ranch.description", "ranch.corners",  # scenario_name, and computed from the rest
    "ranch.land", "ranch.rocks",  # topic plan/chart
    "storm.kind", "storm.points[].wind_minutes",
    "ensemble.seed",  # equal to provenance.seed
    "hazard.frames[].time", "hazard.frames[].percent",  # 170,000 numbers: in plan.json
    "plan.routes[].orders[].until",
}


def bulletin(name, latitude=28.0, number="202106"):
    """A typhoon of 2021-07-24 00:00 UTC that moves over the ranch a day later."""

    def point(clock, lat, **more):
        return {"time": clock, "lat": lat, "lng": 122.7, "strong": "台风(TY)", "speed": 38,
                "radius7": 250, "radius10": 100, "radius12": 40, **more}

    ahead = [{"sets": "CMA", "points": [point("2021-07-25T08:00:00", latitude + 2),
                                        point("2021-07-26T08:00:00", latitude + 4)]}]
    return json.dumps([{"tfbh": number, "ename": name, "points": [
        point("2021-07-24T08:00:00", latitude, move_dir="北", move_speed=10, forecast=ahead)]}])


class PlanNodeTest(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="plan_node."))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.space = "/" + re.sub(r"\W", "", self._testMethodName[5:])
        self.plans, self.subscribers = [], []
        self.listen("plan", RescuePlan, self.plans.append)

    def listen(self, topic, kind, callback):
        self.subscribers.append(rospy.Subscriber(f"{self.space}/{topic}", kind, callback))

    def tearDown(self):
        for one in self.subscribers:
            one.unregister()

    def start(self, *parameters):
        """Starts the node in the namespace of this test; returns the process."""
        log = open(self.folder / "log", "ab")
        process = subprocess.Popen(
            [roslib.packages.find_node("aquafarm_agents", "plan_node")[0], f"__ns:={self.space}",
             *parameters], stdout=log, stderr=subprocess.STDOUT)
        log.close()

        def end():
            process.terminate()
            process.wait(LIMIT_S)

        self.addCleanup(end)
        return process

    def put(self, name, text):
        """Writes a temporary file and renames it, as writers should. The newest file wins."""
        part = self.folder / "bulletins" / (name + ".part")
        part.parent.mkdir(exist_ok=True)
        part.write_text(text, encoding="utf-8")
        os.replace(part, part.with_suffix(""))
        return part.with_suffix("")

    def wait(self, condition, what):
        end = time.monotonic() + LIMIT_S
        while time.monotonic() < end:
            for plan in list(self.plans):
                if condition(plan):
                    return plan
            time.sleep(0.02)
        last = self.plans[-1] if self.plans else None
        self.fail(f"no plan with {what}; the last: {last and (last.text, last.fault)}; log: "
                  f"{(self.folder / 'log').read_text()}")

    def plan_for(self, *parameters):
        return self.start(f"_scenario:={SCENARIO}", f"_bulletin:={self.folder / 'bulletins'}",
                          f"_at:={START}",
                          *(() if parameters[1:] else ("_ships:=2", "_speed_kn:=12.0")),
                          "_min_period_s:=0.2", "_period_s:=0.1", *parameters)

    def test_the_message_is_plan_json_field_by_field(self):
        comparison = Comparison(self)
        self.compare(comparison, 2, 12)
        self.plans.clear()
        self.compare(comparison, 1, 1)  # too slow for all devices
        schema = json.loads(SCHEMA.read_text())
        every = set(leaves(schema, schema)) - LEFT_OUT
        self.assertEqual(set(), every - comparison.seen, "keys of plan.json without a field")

    def compare(self, comparison, ships, speed):
        path = self.put("one.json", bulletin("In-Fa"))
        node = self.plan_for("_members:=60", f"_ships:={ships}", f"_speed_kn:={speed}.0")
        message = self.wait(lambda plan: plan.result != RescuePlan.NONE, "ships that leave")
        node.terminate()
        node.wait(LIMIT_S)
        self.assertEqual("", message.fault)
        self.assertFalse(message.follows_ranch)
        program = roslib.packages.find_node("aquafarm_agents", "aquafarm_plan")[0]
        done = subprocess.run(
            [program, SCENARIO, "--bulletin", path, "--at", START, "--ships", str(ships),
             "--speed", str(speed), "--members", "60", "--json", self.folder / "plan.json"],
            check=False, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT_S)
        self.assertIn(done.returncode, (0, 10), done.stdout)
        comparison.whole(json.loads((self.folder / "plan.json").read_text()), message)

    def test_paths_markers_and_chart_come_with_the_plan(self):
        paths, markers, charts = {}, [], []
        for ship in range(2):
            self.listen(f"ship_{ship}/plan", Path,
                        lambda path, ship=ship: paths.__setitem__(ship, path))
        self.listen("plan/markers", MarkerArray, markers.append)
        self.listen("plan/chart", OccupancyGrid, charts.append)
        self.put("one.json", bulletin("In-Fa"))
        self.plan_for("_members:=60")
        plan = self.wait(lambda one: one.result == RescuePlan.PLAN, "ships that leave")
        end = time.monotonic() + LIMIT_S
        while (len(paths) < 2 or not markers or not charts) and time.monotonic() < end:
            time.sleep(0.02)
        for route in plan.routes:
            path = paths[route.ship]
            self.assertEqual("map", path.header.frame_id)
            self.assertEqual([(cell.x * 1000.0, cell.y * 1000.0) for cell in route.path],
                             [(at.pose.position.x, at.pose.position.y) for at in path.poses])
            self.assertEqual(list(route.path_stamps), [at.header.stamp for at in path.poses])
        spaces = {marker.ns for marker in markers[-1].markers}
        self.assertLessEqual({"plan_route", "plan_cone", "plan_device", "plan_outcome"}, spaces)
        before = len(markers)
        while len(markers) == before and time.monotonic() < end:
            time.sleep(0.02)
        self.assertGreater(len(markers), before, "the markers are published again")
        self.assertTrue(markers[-1].markers)
        for marker in markers[-1].markers:
            self.assertEqual(marker.ADD, marker.action)
            self.assertGreaterEqual(marker.lifetime.to_sec(), 5.0, "they go if the node dies")
        self.assertEqual(20 * 14, len(charts[-1].data))
        self.assertEqual({0, 100}, set(charts[-1].data))

    def test_a_new_bulletin_is_planned_with_within_two_seconds(self):
        """The requirement of issue 22, for 1,000 possible storms. Prints what it measured."""
        self.put("a.json", bulletin("First"))
        self.plan_for()
        self.wait(lambda plan: plan.storm_name == "First", "the first bulletin")
        delays, computed = [], []
        for i in range(10):
            name = f"b{i}.json"
            began = time.monotonic()
            self.put(name, bulletin("First", 28.0 + 0.05 * i))
            plan = self.wait(lambda one, name=name: name in one.storm_file, name)
            delays.append(time.monotonic() - began)
            computed.append(plan.compute_s)
        computed.sort()
        delays.sort()
        print(f"planning again, 20 x 14 cells, 4 devices, 2 ships, 1,000 storms, n = 10: median "
              f"{computed[5]:.2f} s, max {computed[-1]:.2f} s; from file to message: median "
              f"{delays[5]:.2f} s, max {delays[-1]:.2f} s; load {os.getloadavg()[0]:.1f}")
        share = max(1.0, os.getloadavg()[0] / os.cpu_count())  # of a core, for this process
        self.assertLess(computed[5], 2.0 * share)

    def test_a_bad_bulletin_leaves_the_one_before_in_use(self):
        self.put("a.json", bulletin("First"))
        self.plan_for("_members:=60")
        self.wait(lambda plan: plan.storm_name == "First", "the first bulletin")
        self.put("b.json", '[{"tfbh": "202106", "points": [')
        plan = self.wait(lambda one: "b.json" in one.fault, "the fault")
        self.assertEqual("First", plan.storm_name)
        self.assertRegex(plan.fault, r"b\.json.*; this plan uses \S+a\.json")
        self.put("c.json", bulletin("First"))
        self.assertEqual("", self.wait(lambda one: "c.json" in one.storm_file, "the next").fault)

    def test_a_bulletin_of_another_storm_hides_none_that_comes(self):
        self.put("a.json", bulletin("First"))
        self.plan_for("_members:=60")
        self.wait(lambda plan: plan.storm_name == "First", "the first bulletin")
        self.put("b.json", bulletin("Far", 5.0, "202107"))  # it stays away from the ranch
        plan = self.wait(lambda one: "b.json" in one.fault, "the fault")
        self.assertEqual("First", plan.storm_name)
        self.assertEqual(RescuePlan.PLAN, plan.result)
        self.assertIn("got a bulletin of 'Far', expected 'First'", plan.fault)

    def test_without_a_bulletin_the_reason_is_published(self):
        (self.folder / "bulletins").mkdir()
        self.plan_for("_members:=60")
        plan = self.wait(lambda one: one.fault != "", "a fault")
        self.assertEqual(RescuePlan.NONE, plan.result)
        self.assertIn("bulletins: no bulletin yet", plan.fault)

    def test_a_bulletin_of_twelve_hours_ago_is_called_old(self):
        path = self.put("a.json", bulletin("First"))
        self.start(f"_scenario:={SCENARIO}", f"_bulletin:={path}", "_speed_kn:=12.0",
                   "_members:=60")
        plan = self.wait(lambda one: one.result != RescuePlan.NONE, "a plan")
        self.assertEqual(RescuePlan.BULLETIN_OLD, plan.result)  # it is of 2021
        self.assertEqual(("bulletin_old", "stop"),
                         (plan.warnings[0].code, plan.warnings[0].severity))

    def ranch(self):
        """Publishes a ranch at its start. Returns the state, its publisher and the service."""
        yaml = SCENARIO.read_text(encoding="utf-8")
        spec = FarmSpec(scenario_name="zhoushan_infa_2021", scenario_yaml=yaml, scenario_hash=1)
        specs = rospy.Publisher(f"{self.space}/spec", FarmSpec, latch=True, queue_size=2)
        states = rospy.Publisher(f"{self.space}/state", FarmState, latch=True, queue_size=2)
        service = rospy.Service(f"{self.space}/get_state", GetState,
                                lambda request: GetStateResponse())
        self.addCleanup(specs.unregister)
        self.addCleanup(states.unregister)
        state = FarmState(observer=-1, seed=1)
        state.world_time = rospy.Time(int(stamp("2021-07-24T01:00:00Z")))
        state.ships = [ShipState(id=0, x=10, y=5, visible=True, own_device=-1, capacity=1)]
        state.devices = [DeviceState(id=i, health=1.0, value=70, carrier=-1) for i in range(4)]
        specs.publish(spec)
        states.publish(state)
        return state, states, service

    def follow(self):
        return self.start(f"_bulletin:={self.folder / 'bulletins'}", "_members:=60",
                          "_speed_kn:=12.0", "_min_period_s:=0.1", "_period_s:=0.1",
                          "_state_timeout_s:=1.0")

    def test_each_state_of_a_ranch_is_planned_from(self):
        self.put("a.json", bulletin("First"))
        self.follow()
        plan = self.wait(lambda one: one.fault != "", "no ranch")
        self.assertIn("no ranch yet; start one there", plan.fault)
        state, states, service = self.ranch()
        plan = self.wait(lambda one: one.result != RescuePlan.NONE, "a plan of the ranch")
        self.assertTrue(plan.follows_ranch)
        self.assertEqual("", plan.fault)
        self.assertEqual(state.world_time, plan.start)
        self.assertEqual((10, 5), (plan.ships[0].cell.x, plan.ships[0].cell.y))
        state.step = 3
        state.world_time += rospy.Duration(3 * 480)
        state.ships[0].x = 11
        state.devices[1].status = DeviceState.DELIVERED
        state.devices[0].health = 0.5
        states.publish(state)
        plan = self.wait(lambda one: one.step == 3, "the third step")
        self.assertEqual(11, plan.ships[0].cell.x)
        self.assertEqual(state.world_time, plan.start)
        self.assertEqual(["F0", "F2", "F3"], [device.name for device in plan.devices])
        self.assertAlmostEqual(0.5, plan.devices[0].damage_before)
        service.shutdown()

    def test_a_ranch_that_is_gone_is_named_and_its_return_too(self):
        self.put("a.json", bulletin("First"))
        self.follow()
        state, states, service = self.ranch()
        self.wait(lambda one: one.result != RescuePlan.NONE, "a plan of the ranch")
        time.sleep(2.0)  # silent, as in lockstep, but there
        self.assertEqual("", self.plans[-1].fault)
        service.shutdown()
        plan = self.wait(lambda one: "the ranch has ended or hangs" in one.fault, "the fault")
        self.assertIn("(last state: step 0); start the ranch again", plan.fault)
        self.assertEqual("First", plan.storm_name)
        self.plans.clear()
        state.step = 1
        states.publish(state)
        self.assertEqual("", self.wait(lambda one: one.step == 1, "the ranch").fault)

    def test_another_ranch_is_not_planned_with_the_state_of_the_one_before(self):
        self.put("a.json", bulletin("First"))
        self.follow()
        _, states, service = self.ranch()
        self.wait(lambda one: one.result != RescuePlan.NONE, "a plan of the ranch")
        states.unregister()
        time.sleep(0.5)
        self.plans.clear()
        yaml = SCENARIO.read_text(encoding="utf-8").replace("name: ", "name: other_", 1)
        specs = rospy.Publisher(f"{self.space}/spec", FarmSpec, latch=True, queue_size=2)
        self.addCleanup(specs.unregister)
        specs.publish(FarmSpec(scenario_name="other", scenario_yaml=yaml, scenario_hash=2))
        plan = self.wait(lambda one: one.fault != "", "the fault")
        self.assertIn("no ranch yet", plan.fault)
        self.assertNotIn("other", plan.scenario_name)
        service.shutdown()

    def test_a_ship_with_a_device_aboard_is_ordered_to_deliver_it(self):
        self.put("a.json", bulletin("First"))
        self.follow()
        state, states, service = self.ranch()
        state.step = 1
        state.ships[0].aboard = [2]
        state.devices[2].status = DeviceState.ABOARD
        states.publish(state)
        plan = self.wait(lambda one: one.step == 1, "the device aboard")
        self.assertEqual([2], list(plan.ships[0].aboard))
        code = "devices_aboard" if plan.devices[2].home >= 0.5 else "winds_on_way_home"
        self.assertEqual([(0, code)], [(one.ship, one.code) for one in plan.warnings
                                       if one.code in ("devices_aboard", "winds_on_way_home")])
        orders = plan.routes[0].orders
        self.assertEqual(RescueOrder.LEAVE, orders[0].action)
        self.assertEqual(plan.start, orders[0].stamp)
        delivery = next(one for one in orders if one.action == RescueOrder.DELIVER)
        self.assertIn(2, delivery.devices)
        self.assertAlmostEqual(delivery.probability, plan.devices[2].home)
        service.shutdown()

    def test_the_heartbeat_ends_with_the_node(self):
        beats = []
        self.listen("plan/heartbeat", Time, lambda beat: beats.append(time.monotonic()))
        self.put("a.json", bulletin("First"))
        node = self.plan_for("_members:=60")
        end = time.monotonic() + LIMIT_S
        while len(beats) < 4 and time.monotonic() < end:
            time.sleep(0.05)
        self.assertGreaterEqual(len(beats), 4, "no heartbeat")
        node.terminate()
        node.wait(LIMIT_S)
        time.sleep(0.5)
        count = len(beats)
        time.sleep(2.5)
        self.assertEqual(count, len(beats))

    def test_bad_parameters_end_the_node_in_one_line(self):
        (self.folder / "bulletins").mkdir()
        good = {"scenario": SCENARIO, "bulletin": self.folder / "bulletins"}
        for change, words in (({"membrs": 5}, "~membrs: unknown parameter"),
                              ({"members": 5}, "~members: got 5, expected [10, 20000]"),
                              ({"bulletin": None}, "~bulletin: got nothing, expected one of"),
                              ({"bulletin": "/nowhere"}, "/nowhere: got No such file"),
                              ({"scenario": "nowhere"}, "~scenario: got 'nowhere', expected a "),
                              ({"scenario": None, "at": START}, "~at: got 2021-07-24T00:00:00Z, "),
                              ({"at": "noon"}, "~at: got")):
            given = {name: value for name, value in {**good, **change}.items() if value}
            done = subprocess.run(
                [roslib.packages.find_node("aquafarm_agents", "plan_node")[0],
                 f"__ns:={self.space}", *(f"_{name}:={value}" for name, value in given.items())],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT_S,
                check=False)
            for name in given:
                rospy.delete_param(f"{self.space}/plan/{name}")
            self.assertEqual(2, done.returncode, done.stdout)
            self.assertIn("plan_node: " + words, done.stdout)
            self.assertEqual(1, len(done.stdout.strip().splitlines()), done.stdout)


if __name__ == "__main__":
    rospy.init_node("plan_node_test")
    rostest.rosrun("aquafarm_agents", "plan_node_test", PlanNodeTest)
