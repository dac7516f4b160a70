#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""plan_node plans again at every bulletin and state change, and reports every fault in the plan.

The ranch is a publisher of this test: the node uses nothing but its topics and one service. The
published plan is compared field by field with plan.json of aquafarm_plan.
"""
import datetime
import json
import math
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


def leaves(schema, root, path=""):
    """Yields the path of each leaf of a JSON schema, such as devices[].odds.home."""
    if "$ref" in schema:
        name = schema["$ref"].rsplit("/", 1)[1]
        if name in ("position", "loss"):
            yield from leaves(root["$defs"][name], root, path)
        else:
            yield path
    elif "properties" in schema:
        for key, value in schema["properties"].items():
            yield from leaves(value, root, f"{path}.{key}" if path else key)
    elif schema.get("type") == "array" and "properties" in schema.get("items", {}):
        yield from leaves(schema["items"], root, path + "[]")
    else:
        yield path


def stamp(text):
    """UTC text of plan.json as seconds; 0 for null."""
    if text is None:
        return 0
    moment = datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%SZ")
    return moment.replace(tzinfo=datetime.timezone.utc).timestamp()


class Comparison:
    """Compares a plan file with a message and notes which keys were compared."""

    def __init__(self, test):
        self.test, self.seen = test, set()

    def same(self, path, expected, got):
        self.seen.add(path)
        if isinstance(expected, float) or isinstance(got, float):
            if expected is None:
                self.test.assertTrue(math.isnan(got), f"{path}: got {got}, expected NaN")
            else:
                self.test.assertAlmostEqual(expected, got, delta=1e-6 * max(1, abs(expected)),
                                            msg=path)
        elif hasattr(got, "to_sec"):
            self.test.assertEqual(stamp(expected), got.to_sec(), path)
        else:
            self.test.assertEqual(expected, got, path)

    def position(self, path, expected, got):
        self.same(f"{path}.latitude", float(expected["latitude"]), got.latitude_deg)
        self.same(f"{path}.longitude", float(expected["longitude"]), got.longitude_deg)

    def fields(self, where, expected, got, **names):
        """Compares keys with fields: key=field, or key=None for a field of the same name."""
        for key, field in names.items():
            value = expected.get(key)
            attribute = getattr(got, field or key)
            if isinstance(attribute, float) and isinstance(value, int):
                value = float(value)
            self.same(f"{where}.{key}", value, attribute)

    def ids(self, where, expected, got, *names):
        for name in names:
            value = expected.get(name)
            self.same(f"{where}.{name}", -1 if value is None else value, getattr(got, name))

    def numbers(self, path, expected, got):
        self.seen.add(path)
        self.test.assertEqual(len(expected), len(got), path)
        for value, number in zip(expected, got):
            if value is None:
                self.test.assertTrue(math.isnan(number), path)
            else:
                self.test.assertAlmostEqual(value, number, delta=1e-5 * max(1, abs(value)),
                                            msg=path)

    def each(self, expected, got):
        self.test.assertEqual(len(expected), len(got))
        return zip(expected, got)

    def loss(self, path, expected, got):
        self.fields(path, expected, got, mean=None, standard_error=None, q05=None, q50=None,
                    q95=None, cvar05=None)
        points = expected["exceedance"]
        self.numbers(f"{path}.exceedance", [p[0] for p in points], got.exceedance_loss)
        self.numbers(f"{path}.exceedance", [p[1] for p in points], got.exceedance_probability)

    def whole(self, plan, message):
        self.words(plan, message)
        self.storm(plan, message)
        self.fleet(plan, message)
        self.routes(plan, message)

    def words(self, plan, message):
        made = plan["provenance"]
        self.fields("provenance", made, message, program_version="version", seed=None,
                    scenario_name=None)
        self.same("provenance.scenario_hash", int(made["scenario_hash"], 16),
                  message.scenario_hash)
        self.seen |= {"provenance.command", "provenance.computed_at", "provenance.compute_s"}
        self.test.assertIn("plan_node _", message.command)
        self.test.assertAlmostEqual(time.time(), message.computed_at.to_sec(), delta=LIMIT_S)
        self.test.assertGreater(message.compute_s, 0)
        inputs = [one for one in made["inputs"] if one["role"] != "ranch"]
        for one, got in self.each(inputs, message.inputs):
            self.fields("provenance.inputs[]", one, got, role=None, path=None, hash=None)
        self.same("outcome.exit_code", plan["outcome"]["exit_code"], message.result)
        self.same("outcome.text", plan["outcome"]["text"], message.text)
        for one, got in self.each(plan["warnings"], message.warnings):
            self.fields("warnings[]", one, got, code=None, severity=None, text=None, advice=None)
        for one, got in self.each(plan["assumptions"], message.assumptions):
            self.fields("assumptions[]", one, got, what=None, value=None, basis=None, source=None)
        self.fields("clock", plan["clock"], message, start=None, end=None, step_s=None,
                    utc_offset_min=None)
        ranch = plan["ranch"]
        self.fields("ranch", ranch, message, width=None, height=None, cell_size_m=None)
        self.same("ranch.origin.latitude", ranch["origin"]["latitude"],
                  message.origin_latitude_deg)
        self.same("ranch.origin.longitude", ranch["origin"]["longitude"],
                  message.origin_longitude_deg)
        self.fields("deadlines", plan["deadlines"], message, first_departure=None,
                    no_departure_after=None, rule="no_departure_rule")

    def storm(self, plan, message):
        storm = plan["storm"]
        self.fields("storm", storm, message, name="storm_name", agency=None, file="storm_file",
                    issued=None, hindcast=None, recorded_until=None, forecast_until=None)
        self.numbers("storm.age_h", [storm["age_h"]], [message.age_h])
        closest = storm["closest_approach"]
        self.same("storm.closest_approach.time", closest["time"], message.closest_stamp)
        self.numbers("storm.closest_approach.distance_km", [closest["distance_km"]],
                     [message.closest_km])
        self.numbers("storm.closest_approach.bearing_deg", [closest["bearing_deg"]],
                     [message.closest_bearing_deg])
        for one, got in self.each(plan["rings"], message.rings):
            self.fields("rings[]", one, got, id=None, name=None, wind_kt=None, risk=None)
        sources = ["recorded", "forecast", "assumed"]
        for one, got in self.each(storm["points"], message.storm):
            self.same("storm.points[].time", one["time"], got.stamp)
            self.same("storm.points[].source", sources.index(one["source"]), got.source)
            self.position("storm.points[].position", one["position"], got)
            self.numbers("storm.points[].at", one["at"], [got.x, got.y])
            self.numbers("storm.points[].wind_mps", [one["wind_mps"]], [got.wind_mps])
            self.numbers("storm.points[].pressure_hpa", [one["pressure_hpa"]], [got.pressure_hpa])
            self.same("storm.points[].grade", one["grade"] or 0, got.grade)
            self.numbers("storm.points[].radii_km", one["radii_km"], got.radii_km)
            self.same("storm.points[].radii_source", one["radii_source"] == "estimated",
                      bool(got.radii_estimated))
        self.same("ensemble.members", plan["ensemble"]["members"], message.members)
        names = ("lead_h", "along_km", "across_km", "radius70_km", "wind_mps", "size_log")
        for one, got in self.each(plan["ensemble"]["errors"], message.forecast_error):
            self.same("ensemble.errors[].time", one["time"], got.stamp)
            self.numbers("ensemble.errors[].centre", one["centre"], [got.x, got.y])
            for name in names:
                self.numbers(f"ensemble.errors[].{name}", [one[name]], [getattr(got, name)])
        for one, got in self.each(plan["hazard"]["timeline"], message.hazard):
            self.same("hazard.timeline[].time", one["time"], got.stamp)
            self.numbers("hazard.timeline[].probability", one["probability"], got.probability)

    def place(self, path, expected, got):
        self.same(f"{path}.cell", expected["cell"], [got.cell.x, got.cell.y])
        self.position(f"{path}.position", expected["position"], got)

    def fleet(self, plan, message):
        for one, got in self.each(plan["ports"], message.ports):
            self.fields("ports[]", one, got, id=None, name=None)
            self.place("ports[]", one, got)
        for one, got in self.each(plan["ships"], message.ships):
            self.fields("ships[]", one, got, id=None, name=None, capacity=None, ready=None)
            self.numbers("ships[].speed_kn", [one["speed_kn"]], [got.speed_kn])
            self.ids("ships[]", one, got, "port")
            self.place("ships[]", one, got)
        for one, got in self.each(plan["devices"], message.devices):
            self.device(one, got)
        for left in plan["plan"]["left_behind"]:
            self.same("plan.left_behind[].device", left["device"],
                      message.devices[left["device"]].id)
            self.same("plan.left_behind[].reason", left["reason"],
                      message.devices[left["device"]].left_reason)
            self.same("plan.left_behind[].text", left["text"],
                      message.devices[left["device"]].left_text)

    def device(self, one, got):
        self.fields("devices[]", one, got, id=None, name=None, kind=None, value=None,
                    expected_loss=None, expected_loss_idle=None)
        self.place("devices[]", one, got)
        for name in ("damage_before", "expected_damage"):
            self.numbers(f"devices[].{name}", [one[name]], [getattr(got, name)])
        order = one["order"] or {}
        self.ids("devices[].order", order, got, "ship", "port")
        self.fields("devices[].order", order, got, fetch=None, deliver=None)
        self.numbers("devices[].odds.home", [one["odds"]["home"]], [got.home])
        self.numbers("devices[].odds.home_before", one["odds"]["home_before"], got.home_before)
        for arrival, came in self.each(one["arrival"], got.arrival):
            self.numbers("devices[].arrival[].probability", [arrival["probability"]],
                         [came.probability])
            self.fields("devices[].arrival[]", arrival, came, q05=None, q50=None, q95=None)
        for deadline, by in self.each(one["deadlines"], got.deadlines):
            self.numbers("devices[].deadlines[].probability", [deadline["probability"]],
                         [by.probability])
            self.fields("devices[].deadlines[]", deadline, by, leave=None)
            self.same("devices[].deadlines[].open", deadline["open"], bool(by.open))
            self.ids("devices[].deadlines[]", deadline, by, "ship")
            self.test.assertEqual(deadline["leave"] is not None, bool(by.possible))

    def routes(self, plan, message):
        self.fields("plan", plan["plan"], message, objective=None, method=None,
                    expected_value=None, bound=None)
        actions = {"leave": RescueOrder.LEAVE, "fetch": RescueOrder.FETCH,
                   "deliver": RescueOrder.DELIVER, "wait": RescueOrder.WAIT}
        for route, got in self.each(plan["plan"]["routes"], message.routes):
            self.ids("plan.routes[]", route, got, "ship")
            for name in ("km", "kwh"):
                self.numbers(f"plan.routes[].{name}", [route[name]], [getattr(got, name)])
            cells = [[cell.x, cell.y] for cell in got.path]
            self.same("plan.routes[].path", [at[:2] for at in route["path"]], cells)
            self.numbers("plan.routes[].path", [at[2] for at in route["path"]],
                         [(s - message.start).to_sec() for s in got.path_stamps])
            for order, told in self.each(route["orders"], got.orders):
                self.same("plan.routes[].orders[].action", actions[order["action"]], told.action)
                self.same("plan.routes[].orders[].time", order["time"], told.stamp)
                self.place("plan.routes[].orders[]", order, told)
                self.ids("plan.routes[].orders[]", order, told, "device", "port")
                self.same("plan.routes[].orders[].devices", order.get("devices", []),
                          list(told.devices))
                for name in ("km", "kwh", "probability"):
                    self.numbers(f"plan.routes[].orders[].{name}", [order[name]],
                                 [getattr(told, name)])
        loss = plan["loss"]
        self.same("loss.currency", loss["currency"] or "", message.currency)
        self.fields("loss", loss, message, insured=None, operating_cost=None)
        self.loss("loss.with_plan", loss["with_plan"], message.loss)
        self.loss("loss.idle", loss["idle"], message.loss_idle)
        for one, got in self.each(plan["what_if"], message.what_if):
            self.fields("what_if[]", one, got, change=None, text=None, mean_loss=None, q95=None)
            self.same("what_if[].possible", one["possible"], bool(got.possible))
            for name in ("devices_home", "all_home"):
                self.numbers(f"what_if[].{name}", [one[name]], [getattr(got, name)])
            difference = one["difference"] or {}
            for key, field in (("mean", "difference"), ("low", "difference_low"),
                               ("high", "difference_high")):
                self.numbers(f"what_if[].difference.{key}", [difference.get(key)],
                             [getattr(got, field)])


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
        self.assertEqual(20 * 14, len(charts[-1].data))
        self.assertEqual({0, 100}, set(charts[-1].data))

    def test_a_new_bulletin_is_planned_with_within_two_seconds(self):
        """The bar of issue 22: 1,000 possible storms. Prints what it measured."""
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
        self.assertRegex(plan.fault, r"b\.json.*; this plan is of \S+a\.json")
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
        self.assertEqual(["D1", "D3", "D4"], [device.name for device in plan.devices])
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
        plan = self.wait(lambda one: "the ranch is gone" in one.fault, "the fault")
        self.assertIn("the last state is of step 0: start it again", plan.fault)
        self.assertEqual("First", plan.storm_name)
        self.plans.clear()
        state.step = 1
        states.publish(state)
        self.assertEqual("", self.wait(lambda one: one.step == 1, "the ranch").fault)

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
