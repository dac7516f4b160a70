#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program aquafarm_plan: exit codes, text on the screen, and the plan file.

plan_program_test.py PROGRAM SCHEMA SCENARIO
"""
import datetime
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import jsonschema

PROGRAM, SCHEMA, SCENARIO = sys.argv[1:4]
LIMIT_S = 120
START = "2021-07-24T00:00:00Z"


def bulletin(latitude=28.0, towards=2.0, **winds):
    """A typhoon of 2021-07-24 00:00 UTC at 122.7 E that moves north (zjwater layout).

    @param towards degrees of latitude in 24 hours
    """
    winds = winds or {"strong": "台风(TY)", "speed": 38, "radius7": 250, "radius10": 100,
                      "radius12": 40}

    def point(clock, lat, **more):
        return {"time": clock, "lat": lat, "lng": 122.7, **winds, **more}

    ahead = [{"sets": "CMA", "points": [point("2021-07-25T08:00:00", latitude + towards),
                                        point("2021-07-26T08:00:00", latitude + 2 * towards)]}]
    return json.dumps([{"tfbh": "202106", "ename": "In-Fa", "points": [
        point("2021-07-24T08:00:00", latitude, move_dir="北", move_speed=10, forecast=ahead)]}])


def local_clock(plan, time):
    """A time as the program prints it: 07-24 20:30 (12:30Z)."""
    utc = datetime.datetime.strptime(time, "%Y-%m-%dT%H:%M:%SZ")
    local = utc + datetime.timedelta(minutes=plan["clock"]["utc_offset_min"])
    return f"{local:%m-%d %H:%M} ({utc:%H:%M}Z)"


class PlanProgram(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="plan_program."))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def run_plan(self, *arguments, ranch=(SCENARIO,)):
        """Returns exit code, text and the plan file (None if there is none)."""
        file = self.folder / "plan.json"
        file.unlink(missing_ok=True)
        if "--json" not in arguments:
            arguments += ("--json", file)
        done = subprocess.run(
            [PROGRAM, *ranch, "--members", "60", *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT_S,
            check=False)
        plan = json.loads(file.read_text(encoding="utf-8")) if file.exists() else None
        return done.returncode, done.stdout, plan

    def plan_of(self, text, *arguments, at=START):
        path = self.write("bulletin.json", text)
        start = ("--at", at) if at else ()
        return self.run_plan("--bulletin", path, *start, *arguments)

    def check_file(self, plan, code):
        """The file fits its published schema and states the exit code."""
        schema = json.loads(pathlib.Path(SCHEMA).read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(schema)
        errors = [f"{list(one.absolute_path)}: {one.message[:200]}"
                  for one in jsonschema.Draft202012Validator(schema).iter_errors(plan)]
        self.assertEqual([], errors)
        self.assertEqual(code, plan["outcome"]["exit_code"])

    def check_warned(self, plan, words, code, severity):
        """The warning is in the file and on the screen, with its advice."""
        found = [one for one in plan["warnings"] if one["code"] == code]
        self.assertEqual([severity], [one["severity"] for one in found], plan["warnings"])
        if found[0]["text"] != plan["outcome"]["text"]:
            self.assertIn(f"{severity}: {found[0]['text']} {found[0]['advice']}\n", words)
        self.assertTrue(found[0]["advice"])

    def refused(self, *arguments, ranch=(SCENARIO,)):
        """The one line of a refusal."""
        code, words, plan = self.run_plan(*arguments, ranch=ranch)
        self.assertEqual(2, code, words)
        self.assertIsNone(plan)
        self.assertEqual(1, len(words.strip().splitlines()), words)
        return words.strip()

    def test_a_useful_plan_ends_with_zero_and_prints_every_order(self):
        code, words, plan = self.plan_of(bulletin(), "--ships", 2, "--speed", 12)
        self.assertEqual(0, code, words)
        self.check_file(plan, 0)
        self.assertEqual("plan", plan["outcome"]["kind"])
        self.assertIsNone(plan["outcome"]["unknown"])
        self.assertTrue(words.startswith(plan["outcome"]["text"] + "\n"))
        self.assertRegex(words.splitlines()[0], r"^\d of 2 ships leave and save [\d.]+ of [\d.]+ ")
        self.assertTrue(plan["plan"]["routes"])
        for route in plan["plan"]["routes"]:
            for order in route["orders"]:
                place = ("port", "ports") if order["action"] != "fetch" else ("device", "devices")
                name = plan[place[1]][order[place[0]]]["name"]
                what = {"leave": "leave ", "fetch": "fetch ", "deliver": "deliver at "}
                share = order["probability"] * 100
                line = rf"  {re.escape(local_clock(plan, order['time']))}  " + \
                    rf"{what[order['action']]}{name}  \[([<>]? ?)(\d+) %\]\n"
                found = re.search(line, words)
                self.assertTrue(found, (line, words))
                self.assertLessEqual(abs(int(found[2]) - share), 1 if found[1] else 0.51)
                self.assertLess(int(found[2]), 100, "a share of a sample is not certain")
        for device in plan["devices"]:
            self.assertIn(f"\n  {device['name']}: ", words)
        last = plan["deadlines"]["no_departure_after"]
        self.assertEqual(last is not None, "no ship should leave after" in words)
        if last:
            self.assertIn(f"no ship should leave after {local_clock(plan, last)}\n", words)
        beyond = plan["deadlines"]["not_known_beyond"]
        self.assertEqual(beyond is not None, "ships may leave at least until" in words)
        for row in plan["what_if"]:
            self.assertIn(f"  {row['text']}", words)
        self.assertIn("shares of 60 possible storms\n", words)
        self.assertIn(f"written: {self.folder / 'plan.json'}\n", words)

    def test_energy_and_costs(self):
        _, words, free = self.plan_of(bulletin(26.5), "--ships", 1, "--speed", 30,
                                      "--currency", "CNY")
        self.assertIsNone(free["loss"]["operating_cost"], "values of the ranch are no currency")
        for route in free["plan"]["routes"]:
            self.assertGreater(route["kwh"], 1.2 * route["km"], words)  # energy.per_km, and idle
            self.assertAlmostEqual(route["kwh"], sum(one["kwh"] for one in route["orders"]), 1)
        place = free["devices"][0]["position"]
        costs = []
        for value in (1_000_000, 10):
            devices = self.write("devices.csv", "name,latitude,longitude,kind,value\nF1,"
                                 f"{place['latitude']},{place['longitude']},monitoring,{value}\n")
            _, words, plan = self.plan_of(bulletin(26.5), "--ships", 1, "--speed", 30, "--currency",
                                          "CNY", "--devices", devices)
            self.check_file(plan, plan["outcome"]["exit_code"])
            costs.append(plan["loss"]["operating_cost"])
            self.assertIn("cost of energy and ship-hours", plan["plan"]["objective"])
        self.assertGreater(costs[0], 100, "CNY 2 per kWh, CNY 1,200 per ship-hour")
        self.assertEqual(0, costs[1], "the trip costs more than the device is worth")
        self.assertEqual(["not_worth_it"], [one["reason"] for one in plan["plan"]["left_behind"]])

    def test_ten_if_nothing_can_be_saved(self):
        code, words, plan = self.plan_of(bulletin(30.0, 0.1), "--ships", 2, "--speed", 0.5)
        self.assertEqual(10, code, words)
        self.check_file(plan, 10)
        self.assertEqual("nothing_can_be_saved", plan["outcome"]["kind"])
        self.check_warned(plan, words, "nothing_can_be_saved", "stop")
        self.assertIn("nothing can be saved", words.splitlines()[0])
        self.assertEqual([], plan["plan"]["routes"])
        self.assertEqual(0, plan["plan"]["expected_value"])

    def test_ten_without_a_ship(self):
        code, words, plan = self.plan_of(bulletin(), "--ships", 0)
        self.assertEqual(10, code, words)
        self.check_file(plan, 10)
        self.assertIn("There is no ship, so nothing can be saved.", words)

    def test_eleven_if_the_storm_never_comes_and_no_all_clear(self):
        code, words, plan = self.plan_of(bulletin(8.0, -2.0), "--ships", 2)
        self.assertEqual(11, code, words)
        self.check_file(plan, 11)
        self.assertEqual("storm_stays_away", plan["outcome"]["kind"])
        self.check_warned(plan, words, "storm_stays_away", "warning")
        self.assertIn("What follows is unknown: plan again with the next bulletin.", words)
        self.assertNotIn("no ship should leave", words)
        self.assertIsNone(plan["deadlines"]["no_departure_after"])

    def test_departures_may_follow_the_end_of_the_known_time(self):
        code, words, plan = self.plan_of(bulletin(26.0, 0.5), "--ships", 2, "--speed", 12)
        self.assertEqual(0, code, words)
        opens = [one for device in plan["devices"] for one in device["deadlines"]
                 if one["probability"] == 0.5 and one["open"]]
        self.assertTrue(opens, words)
        last = plan["deadlines"]
        self.assertIsNone(last["no_departure_after"])
        self.assertEqual(max(one["leave"] for one in opens), last["not_known_beyond"])
        self.assertIn("ships may leave at least until "
                      f"{local_clock(plan, last['not_known_beyond'])}; what follows is not known: "
                      "plan again", words)
        self.assertNotIn("no ship should leave after", words)

    def test_twelve_if_the_winds_are_unknown(self):
        code, words, plan = self.plan_of(bulletin(30.0, 0.2, strong=""), "--ships", 2)
        self.assertEqual(12, code, words)
        self.check_file(plan, 12)
        self.assertEqual("storm_unknown", plan["outcome"]["kind"])
        self.check_warned(plan, words, "storm_unknown", "stop")
        self.assertIn("It is unknown whether the storm reaches the devices", words.splitlines()[0])
        self.assertIn("Deadlines, losses and comparisons are unknown.\n", words)
        for device in plan["devices"]:
            self.assertIn(f"\n  {device['name']}: unknown\n", words)
        self.check_nothing_is_known(plan)

    def check_nothing_is_known(self, plan):
        """No number looks harmless: chances, arrivals, hazard, losses and deadlines are null."""
        self.assertRegex(plan["outcome"]["unknown"],
                         r"^The storm's winds are unknown from 2021-07-24T\S+Z on: chances, ")
        for device in plan["devices"]:
            known = [device["odds"]["home"], *device["odds"]["home_before"],
                     device["expected_damage"], device["expected_loss"],
                     device["expected_loss_idle"]]
            known += [value for one in device["arrival"] for value in one.values()]
            known += [one[key] for one in device["deadlines"] for key in ("leave", "ship")]
            self.assertEqual({None}, set(known), device["name"])
            self.assertEqual({False}, {one["open"] for one in device["deadlines"]})
        times = plan["hazard"]["timeline"]
        self.assertEqual({None}, {share for one in times for share in one["probability"]})
        self.assertEqual([], plan["hazard"]["frames"])
        for name in ("with_plan", "idle"):
            loss = dict(plan["loss"][name])
            self.assertEqual([], loss.pop("exceedance"))
            self.assertEqual({None}, set(loss.values()))
        for row in plan["what_if"]:
            keys = ("mean_loss", "q95", "devices_home", "all_home", "difference")
            self.assertEqual({None}, {row[key] for key in keys}, row)
        self.assertEqual({"winds_unknown"}, {one["reason"] for one in plan["plan"]["left_behind"]})
        self.assertEqual((None, None), (plan["plan"]["expected_value"], plan["plan"]["bound"]))
        self.assertIsNone(plan["deadlines"]["no_departure_after"])
        self.assertIsNone(plan["deadlines"]["not_known_beyond"])
        self.assertIsNone(plan["loss"]["operating_cost"])
        spreads = {one[key] for one in plan["ensemble"]["errors"] for key in ("wind_mps", "size_log")}
        self.assertEqual({None}, spreads)
        self.assertEqual({None}, {one["grade"] for one in plan["storm"]["points"]})

    def test_thirteen_if_the_bulletin_is_older_than_twelve_hours(self):
        code, words, plan = self.plan_of(bulletin(), "--ships", 2, "--speed", 12, at=None)
        self.assertEqual(13, code, words)  # it is of 2021
        self.check_file(plan, 13)
        self.check_warned(plan, words, "bulletin_old", "stop")
        self.assertRegex(words, r"\nstop: The bulletin is \d+ days old: its last report is of "
                                r"2021-07-24T00:00:00Z. Get a newer bulletin before any ship")
        code, words, plan = self.plan_of(bulletin(), "--ships", 2, "--speed", 12,
                                         at="2021-07-24T12:30:00Z")
        self.assertEqual(13, code, words)
        code, words, plan = self.plan_of(bulletin(), "--ships", 2, "--speed", 12,
                                         at="2021-07-24T11:30:00Z")
        self.assertEqual(0, code, words)

    def test_thirteen_if_the_bulletin_is_old_and_its_storm_stays_away(self):
        code, words, plan = self.plan_of(bulletin(8.0, -2.0), "--ships", 2,
                                         at="2021-07-24T13:00:00Z")
        self.assertEqual(13, code, words)
        self.check_file(plan, 13)
        self.assertEqual("storm_stays_away", plan["outcome"]["kind"])
        self.check_warned(plan, words, "bulletin_old", "stop")

    def test_twelve_if_the_forecast_has_ended(self):
        code, words, plan = self.plan_of(bulletin(8.0, -2.0), "--ships", 2, at=None)
        self.assertEqual(12, code, words)  # it is of 2021
        self.check_file(plan, 12)
        self.assertTrue(words.startswith(
            "It is unknown whether the storm reaches the devices: the bulletin's forecast ended at "
            "2021-07-26T00:00:00Z, before the present time.\n"), words)
        self.check_warned(plan, words, "forecast_ended", "stop")
        self.check_warned(plan, words, "bulletin_old", "stop")
        self.assertIn("forecast ended at 2021-07-26T00:00:00Z: chances", plan["outcome"]["unknown"])
        self.assertEqual({None}, {one["odds"]["home"] for one in plan["devices"]})
        self.assertEqual({None, 0}, {plan["loss"]["idle"]["mean"], len(plan["plan"]["routes"])})

    def test_assumptions_list_what_is_given(self):
        place = self.plan_of(bulletin())[2]["ports"][0]["position"]
        at = f"{place['latitude']},{place['longitude']}"
        ships = self.write("ships.csv", "name,latitude,longitude,speed_kn\n"
                                        f"Hai,{at},6\nDong,{at},5\n")
        _, words, plan = self.plan_of(bulletin(), "--ships-file", ships)
        rows = {one["what"]: one for one in plan["assumptions"]}
        speed = rows["Speed of the ships"]
        self.assertEqual(("5.0 to 6.0 kn", "given"), (speed["value"], speed["basis"]), words)
        limit = rows["A ship stops work for good when winds of this force have reached its cell"]
        self.assertEqual("assumed", limit["basis"])

    def test_three_if_the_file_cannot_be_written(self):
        path = self.write("bulletin.json", bulletin())
        code, words, _ = self.run_plan("--bulletin", path, "--at", START, "--json",
                                       self.folder / "none" / "plan.json")
        self.assertEqual(3, code, words)
        self.assertIn(str(self.folder / "none"), words)

    def test_a_device_off_the_chart_or_on_land_is_refused_by_name(self):
        path = self.write("bulletin.json", bulletin())
        head = "name,latitude,longitude,kind,value\n"
        off = "expected a place on the chart of the ranch"
        for row, words in (
                ("F1,35.0,122.7,monitoring,5", f"F1: got 35.0000 N 122.7000 E, {off}"),
                ("F1,-35.0,-122.7,monitoring,5", f"F1: got 35.0000 S 122.7000 W, {off}"),
                ("F1,30.13,122.69,whale,5", "kind: got 'whale', expected one of: ")):
            devices = self.write("devices.csv", head + row + "\n")
            said = self.refused("--bulletin", path, "--at", START, "--devices", devices)
            self.assertIn(f"{devices}:2: {words}", said)

    def test_a_coast_with_a_port_on_land_and_a_device_on_land(self):
        ring = [[122.6, 30.1], [122.7, 30.1], [122.7, 30.2], [122.6, 30.2], [122.6, 30.1]]
        coast = self.write("coast.geojson", json.dumps({
            "type": "FeatureCollection", "features": [{
                "type": "Feature", "properties": {},
                "geometry": {"type": "Polygon", "coordinates": [ring]}}]}))
        path = self.write("bulletin.json", bulletin())
        head = "name,latitude,longitude,kind,value\n"
        devices = self.write("devices.csv", head + "F1,30.25,122.75,monitoring,5\n")
        given = ("--coast", coast, "--place", "30.2,122.7", "--bulletin", path, "--at", START,
                 "--speed", 12, "--ships", 1)
        ports = ("--ports", "30.15,122.65")  # in the middle of the island
        said = self.refused(*given, *ports, "--devices", devices, ranch=())
        found = re.fullmatch(
            r"port: got 30.1500,122.6500, which is land, expected water; the nearest shore of the "
            r"ranch is at ([\d.]+,[\d.]+): give that place, or another one", said)
        self.assertTrue(found, said)
        code, words, plan = self.run_plan(*given, "--ports", found[1], "--devices", devices,
                                          ranch=())
        self.assertEqual(0, code, words)
        self.check_file(plan, 0)
        self.assertNotIn(plan["ports"][0]["cell"], plan["ranch"]["land"])
        said = self.refused(*given, "--ports", "31.5,122.65", "--devices", devices, ranch=())
        self.assertRegex(said, r"^port: got 31.5000,122.6500, expected a place in the ranch at .*; "
                               r"the nearest shore of the ranch is at [\d.]+,[\d.]+: give that")
        _, words, plan = self.run_plan(*given, "--devices", devices, ranch=())
        self.check_warned(plan, words, "ports_chosen", "note")
        place = plan["ports"][0]["position"]
        self.assertIn(f"port A at {place['latitude']:.4f},{place['longitude']:.4f};", words)
        inland = self.write("inland.csv", head + "F2,30.15,122.65,monitoring,5\n")
        said = self.refused(*given, "--devices", inland, ranch=())
        self.assertIn(f"{inland}:2: F2: got 30.1500 N 122.6500 E, which is land or rock", said)
        water = re.search(r"the nearest water is at ([\d.]+) N ([\d.]+) E$", said)
        self.assertTrue(water, said)
        moved = self.write("moved.csv", head + f"F2,{water[1]},{water[2]},monitoring,5\n")
        code, words, _ = self.run_plan(*given, "--devices", moved, ranch=())
        self.assertEqual(0, code, words)

    def test_a_ranch_with_a_coast_a_place_or_ports_is_refused(self):
        path = self.write("bulletin.json", bulletin())
        for given in (("--coast", path), ("--place", "30.2,122.7"), ("--ports", "30.15,122.65")):
            self.assertEqual(
                f"ranch: got {SCENARIO} with --coast, --place or --ports, expected either a ranch "
                "or a chart: the ranch has its own coast and ports; leave out one of them",
                self.refused("--bulletin", path, "--at", START, *given))

    def test_bad_arguments_are_refused_in_one_line(self):
        path = self.write("bulletin.json", bulletin())
        self.assertIn("expected one of --bulletin FILE and --storm FILE",
                      self.refused("--ships", 2))
        self.assertIn("got 'soon', expected a time such as +6h",
                      self.refused("--bulletin", path, "--depart", "soon"))
        self.assertIn("nowhere.json", self.refused("--bulletin", self.folder / "nowhere.json"))
        self.assertIn("2021-07-20T00:00:00Z; give a later --at",
                      self.refused("--bulletin", path, "--at", "2021-07-20T00:00:00Z"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
