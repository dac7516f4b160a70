# SPDX-License-Identifier: BSD-3-Clause
"""Compares a plan file with a RescuePlan message, key by key."""
import datetime
import math
import time

from aquafarm_msgs.msg import RescueOrder

LIMIT_S = 60


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
        self.same("outcome.unknown", plan["outcome"]["unknown"] or "", message.unknown)
        for one, got in self.each(plan["warnings"], message.warnings):
            self.fields("warnings[]", one, got, code=None, severity=None, text=None, advice=None)
            self.ids("warnings[]", one, got, "ship")
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
                    no_departure_after=None, not_known_beyond=None, rule="no_departure_rule")

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
            self.same("ships[].aboard", one["aboard"], list(got.aboard))
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
