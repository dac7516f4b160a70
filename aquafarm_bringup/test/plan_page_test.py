#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The page of a plan, its GeoJSON and the command: contents and error messages."""
import copy
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import roslib.packages
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan_sample  # noqa: E402
from aquafarm_plan import document, geojson, page  # noqa: E402
from aquafarm_plan.geodesy import LocalPlane  # noqa: E402
from page_reader import Reader  # noqa: E402

COMMAND = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "make_plan"


def bulletin():
    """Returns a bulletin of 2021-07-24 00:00 UTC: a typhoon passes over the ranch a day later."""

    def point(clock, latitude, **more):
        return {"time": clock, "lat": latitude, "lng": 122.7, "strong": "台风(TY)", "speed": 38,
                "radius7": 250, "radius10": 100, "radius12": 40, **more}

    ahead = [{"sets": "CMA", "points": [point("2021-07-25T08:00:00", 30.0),
                                        point("2021-07-26T08:00:00", 32.0)]}]
    return json.dumps([{"tfbh": "202106", "ename": "In-Fa", "points": [
        point("2021-07-24T08:00:00", 28.0, move_dir="北", move_speed=10, forecast=ahead)]}])


def words_of(plan):
    return re.sub(r"\s+", " ", Reader(page.render(plan)).words)


class FormatTest(unittest.TestCase):

    def test_shares_of_a_sample_are_never_certain(self):
        self.assertEqual(["> 99 %", "> 99 %", "99 %", "50 %", "1 %", "< 1 %", "< 1 %", "–"],
                         [document.percent(p) for p in (1, .996, .994, .5, .006, .004, 0, None)])

    def test_amounts_have_three_digits_and_their_currency(self):
        self.assertEqual([
            "CNY 5.68 M", "366,000", "CNY 920", "12.3 M", "−92,000", "+118,000", "0", "1.00 M", "–"
        ], [
            document.amount(5680000, "CNY"),
            document.amount(366123.4, None),
            document.amount(920.4, "CNY"),
            document.amount(12345678, None),
            document.amount(-92000, None),
            document.amount(118000, None, True),
            document.amount(-0.2, None),
            document.amount(999999, None),
            document.amount(None, "CNY")
        ])

    def test_times_are_local_with_the_weekday_on_another_day(self):
        clock = document.Clock({
            "start": "2021-07-24T00:00:00Z", "end": "2021-07-26T00:00:00Z", "zone": "UTC+8",
            "utc_offset_min": 480
        })
        self.assertEqual("08:05", clock.time("2021-07-24T00:05:00Z"))
        self.assertEqual("Sun 00:00", clock.time("2021-07-24T16:00:00Z"))
        self.assertEqual("Sat 24 Jul 08:05", clock.day_time("2021-07-24T00:05:00Z"))
        self.assertEqual("24 00:05", clock.utc("2021-07-24T00:05:00Z"))

    def test_the_plane_agrees_with_geographiclib(self):
        # GeographicLib computed this origin in `aquafarm scenario --center 30.2,122.7 --size 25x25
        # --cell 600m`: the centre of the south-west cell on the plane at the ranch's middle.
        latitude, longitude = LocalPlane(30.2, 122.7).to_geo(-12 * 600, -12 * 600)
        self.assertAlmostEqual(30.135029, latitude, 5)
        self.assertAlmostEqual(122.625277, longitude, 5)
        plane = LocalPlane(30.135029, 122.625277)
        for point in ((0.0, 0.0), (15000.0, -9000.0), (-250000.0, 180000.0)):
            back = plane.to_plane(*plane.to_geo(*point))
            self.assertLess(max(abs(a - b) for a, b in zip(point, back)), 1e-3)


class PageTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.plan = plan_sample.sample()
        cls.text = page.render(cls.plan)
        cls.reader = Reader(cls.text)
        cls.words = words_of(cls.plan)

    def test_it_is_one_file_without_addresses(self):
        self.assertEqual([], self.reader.addresses)
        found = set(re.findall(r"(?:https?:)?//[\w.]+[^\s\"'<]*", self.text))
        self.assertEqual({"http://www.w3.org/2000/svg"}, found)
        self.assertNotIn("@import", self.text)
        self.assertEqual(re.findall(r"url\((?!#)", self.text), [])

    def test_it_answers_the_five_questions_with_the_plan_s_numbers(self):
        for part in ("What do I fetch first? F3 with Puhai 2 (14:35); F2 with Puhai 1 (14:51)",
                     "When must the ships leave? Every ship at Sat 24 Jul 14:00.",
                     "Do not leave after Sat 24 Jul 21:30.", "What do I lose? CNY",
                     "What does one more ship bring? CNY 92,000 less loss"):
            self.assertIn(part, self.words)
        loss = self.plan["loss"]
        self.assertIn(
            f"{document.amount(loss['with_plan']['mean'], 'CNY')} of CNY 5.68 M on average",
            self.words)
        self.assertIn(document.amount(loss["idle"]["mean"], "CNY"), self.words)
        worst = min((d for d in self.plan["devices"] if d["order"]),
                    key=lambda d: d["odds"]["home"])
        self.assertIn(
            f"Each fetched device comes home in {document.percent(worst['odds']['home'])} "
            f"({worst['name']})", self.words)

    def test_each_order_is_listed_in_local_time_and_utc(self):
        for part in ("14:00 24 06:00 leave port A", "14:51 24 06:51 fetch F2 6.4",
                     "15:39 24 07:39 deliver F2 at port C 5.9"):
            self.assertIn(part, self.words)

    def test_each_device_has_its_odds_and_deadlines(self):
        for device in self.plan["devices"]:
            home = document.percent(device["odds"]["home"]) if device["order"] else "–"
            self.assertRegex(self.words, rf"{device['name']} [^F]*{re.escape(home)}")
        self.assertIn("F6 temporary cage (15 % damaged) 480,000 left behind – – – –", self.words)

    def test_changes_assumptions_and_provenance_are_listed(self):
        for part in ("one ship more 274,000", "port D closed not possible", "+118,000",
                     "a ship stops work wind of 34 kt at its cell given by you --abort-wind 34",
                     "recorded CMA bulletin 202106.json",
                     "average. Mean value saved: 512.3; no plan saves more than 520.1. Made ",
                     "aquafarm_plan dongji.yaml --bulletin 202106.json --ships 2 --depart +6h"):
            self.assertIn(part, self.words)

    def test_warnings_come_before_everything_else(self):
        self.assertLess(self.words.index("F6 is left behind: no ship"),
                        self.words.index("What do I fetch first?"))
        self.assertIn("recorded until 2021-07-24 00:00 UTC", self.words)

    def test_recorded_and_forecast_positions_look_different(self):
        self.assertIn('class="track recorded"', self.text)
        self.assertIn('class="track forecast"', self.text)

    def test_a_hindcast_is_called_one(self):
        plan = copy.deepcopy(self.plan)
        plan["storm"]["hindcast"] = True
        self.assertIn("hindcast from the recorded track (CMA)", words_of(plan))

    def test_names_cannot_inject_elements(self):
        plan = copy.deepcopy(self.plan)
        plan["devices"][0]["name"] = "</script><script>alert(1)</script>"
        plan["rings"][0]["name"] = "</script><b>"
        plan["what_if"][1]["text"] = "<img src=x>"
        reader = Reader(page.render(plan))
        self.assertEqual(self.reader.scripts, reader.scripts)
        self.assertEqual([], reader.addresses)
        self.assertIn("<script>alert(1)</script>", reader.words)

    def test_nothing_to_save_is_said_first(self):
        words = words_of(plan_sample.nothing_to_save())
        self.assertLess(words.index("Stop. Nothing can be saved"), words.index("What do I fetch"))
        for part in ("Keep all ships in port", "What do I fetch first? Nothing.",
                     "No ship should leave.", "No device is fetched.", "has this chance"):
            self.assertIn(part, words)

    def test_a_storm_that_stays_away_gives_no_all_clear(self):
        words = words_of(plan_sample.storm_stays_away())
        for part in ("That is not an all-clear", "No ship needs to leave now.",
                     "No ring reaches the ranch before Mon 26 Jul 02:00",
                     "Nothing is known after Mon 26 Jul 14:00", "stays in place",
                     "Nothing in these 200 futures."):
            self.assertIn(part, words)
        self.assertNotIn("left behind", words)

    def test_a_storm_without_known_winds_is_unknown_and_not_harmless(self):
        for plan in (plan_sample.storm_unknown(), plan_sample.storm_unknown_of_before()):
            self.check_unknown(words_of(plan))
            for feature in geojson.feature_collection(plan)["features"]:
                one = feature["properties"]
                if one["layer"] == "device":
                    self.assertIn("winds are unknown", one["left_behind"])
                    self.assertIn("unknown", one["unknown"])
                    self.assertEqual((None, None), (one["probability_home"], one["expected_loss"]))

    def test_an_ended_forecast_is_unknown_and_an_old_one_gives_no_all_clear(self):
        plan = plan_sample.storm_unknown()
        plan["warnings"][0]["code"], plan["storm"]["age_h"] = "forecast_ended", 46633.0
        words = words_of(plan)
        self.check_unknown(words)
        self.assertIn("because the bulletin's forecast has ended", words)
        plan = plan_sample.storm_stays_away()
        plan["outcome"]["exit_code"] = 13
        self.assertIn("When must the ships leave? Unknown: the bulletin is old.", words_of(plan))

    def test_a_loss_that_is_rare_is_not_called_more_than_zero(self):
        plan = copy.deepcopy(self.plan)
        plan["loss"]["with_plan"].update(q95=0.0, cvar05=89000.0)
        self.assertIn("In 19 of 20 futures nothing; CNY 89,000 on average in the worst twentieth",
                      words_of(plan))

    def check_unknown(self, words):
        for part in ("Stop. It is unknown whether the storm reaches the devices",
                     "When must the ships leave? Unknown.", "What do I lose? Unknown.",
                     "How sure is it? Not at all.",
                     "Odds, deadlines, comparisons and losses are unknown"):
            self.assertIn(part, words)
        for part in ("stays in place", "Nothing in these", "o ring reaches", "has this chance"):
            self.assertNotIn(part, words)

    def test_orders_of_a_ship_with_a_device_aboard_promise_nothing_without_known_winds(self):
        for share in (None, 1.0):  # files of earlier versions contain 1.0
            plan = plan_sample.storm_unknown_aboard(share)
            words = words_of(plan)
            self.assertRegex(words, r"deliver F1 at port A\s+0\.6\s+unknown")
            self.assertIn("F1, deep-water cage: chance to come home: unknown", words)
            self.assertIn("F1 unknown", words)
            for part in ("99 %", "No gain", "No device is left behind", "Every ship"):
                self.assertNotIn(part, words)
            for feature in geojson.feature_collection(plan)["features"]:
                one = feature["properties"]
                if one["layer"] in ("order", "device"):
                    key = "probability" if one["layer"] == "order" else "probability_home"
                    self.assertIsNone(one[key], one)

    def test_equal_chances_are_said_once(self):
        plan = copy.deepcopy(self.plan)
        for device in plan["devices"]:
            device["odds"]["home"] = 1.0
        self.assertIn("Each fetched device comes home in > 99 % of the futures.", words_of(plan))

    def test_an_unknown_end_of_the_departures_is_said(self):
        plan = copy.deepcopy(self.plan)
        plan["deadlines"].update(no_departure_after=None, not_known_beyond="2021-07-25T18:00:00Z")
        words = words_of(plan)
        said = ("Ships may leave at least until Mon 26 Jul 02:00. What follows is not known: plan "
                "again at the next bulletin.")
        self.assertEqual(2, words.count(said), "in the answer and below the deadlines")
        self.assertNotIn("do not leave after", words.lower())

    def test_a_deadline_that_the_known_time_ends_does_not_limit(self):
        plan = copy.deepcopy(self.plan)
        plan["devices"][1]["deadlines"][2].update(open=True, leave="2021-07-25T18:00:00Z")
        self.assertIn("not known beyond Mon 26 Jul 02:00", words_of(plan))

    def test_plans_without_energy_prices_rings_or_forecast_are_shown(self):
        plan = copy.deepcopy(self.plan)
        plan["plan"]["objective"] = "least mean loss of the worst 5 % of the futures"
        plan["storm"].update(points=[], closest_approach=None, issued=None, age_h=None)
        plan["loss"]["operating_cost"], plan["ensemble"]["errors"] = None, []
        for route in plan["plan"]["routes"]:
            for one in (route, *route["orders"]):
                one["kwh"] = None
        words = words_of(plan)
        self.assertIn("No position of the storm is known.", words)
        self.assertNotIn("kWh", words)
        self.assertIn("5 % of the futures. Mean value saved: 512.3. Made ", words)


class GeoJsonTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.plan = plan_sample.sample(members=100)
        cls.features = json.loads(geojson.text(cls.plan))
        cls.layers = {}
        for one in cls.features["features"]:
            cls.layers.setdefault(one["properties"]["layer"], []).append(one)

    def test_it_has_the_form_of_rfc_7946(self):
        self.assertEqual({"type", "features"}, set(self.features))
        for one in self.features["features"]:
            self.assertEqual({"type", "geometry", "properties"}, set(one))
            kind, coordinates = one["geometry"]["type"], one["geometry"]["coordinates"]
            points = {
                "Point": [coordinates], "LineString": coordinates,
                "Polygon": coordinates[0] if kind == "Polygon" else []
            }[kind]
            for longitude, latitude in points:
                self.assertTrue(105 < longitude < 140 and 15 < latitude < 45, (longitude, latitude))
            if kind == "Polygon":
                self.assertEqual(points[0], points[-1])
                area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:]))
                self.assertGreater(area, 0)  # counter-clockwise
            if kind == "LineString":
                self.assertGreater(len(points), 1)

    def test_every_layer_is_complete(self):
        counts = {name: len(found) for name, found in self.layers.items()}
        rings = sum(1 for p in self.plan["storm"]["points"] for r in p["radii_km"] if r)
        self.assertEqual(
            {
                "port": 4, "device": 6, "route": 2, "order": 12, "storm_track": 2, "ring": rings,
                "storm_position": len(self.plan["storm"]["points"]), "forecast_error": len(
                    self.plan["ensemble"]["errors"])
            }, counts)

    def test_a_route_ends_in_its_port_at_its_time(self):
        for route, feature in zip(self.plan["plan"]["routes"], self.layers["route"]):
            last = route["orders"][-1]
            port = self.plan["ports"][last["port"]]["position"]
            longitude, latitude = feature["geometry"]["coordinates"][-1]
            self.assertAlmostEqual(port["longitude"], longitude, 4)
            self.assertAlmostEqual(port["latitude"], latitude, 4)
            times = feature["properties"]["times"]
            self.assertEqual(len(feature["geometry"]["coordinates"]), len(times))
            self.assertEqual(last["time"], times[-1])

    def test_a_ring_has_its_radius(self):
        ring = self.layers["ring"][0]
        at = self.plan["storm"]["points"][0]["position"]
        plane = LocalPlane(at["latitude"], at["longitude"])
        for longitude, latitude in ring["geometry"]["coordinates"][0][::9]:
            x, y = plane.to_plane(latitude, longitude)
            self.assertAlmostEqual(ring["properties"]["radius_km"], (x * x + y * y)**.5 / 1000,
                                   delta=2)

    def test_devices_carry_their_odds_and_the_reason_to_stay(self):
        left = self.layers["device"][5]["properties"]
        self.assertEqual("no ship is free before the gale", left["left_behind"])
        first = self.layers["device"][0]["properties"]
        self.assertEqual(self.plan["devices"][0]["odds"]["home"], first["probability_home"])
        self.assertEqual("Puhai 1", first["ship"])


class CommandTest(unittest.TestCase):
    """Replaces aquafarm_plan by a script. plan_program_test tests the real program."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_plan_test_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        (self.folder / "sample.json").write_text(json.dumps(plan_sample.sample(members=50)))

    def run_command(self, *arguments, body="exit 0"):
        program = self.folder / "program"
        program.write_text(f"#!/bin/sh\nfor last; do :; done\n{body}\n")
        program.chmod(0o755)
        done = subprocess.run([COMMAND, *map(str, arguments)],
                              cwd=self.folder,
                              timeout=60,
                              text=True,
                              stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT,
                              check=False,
                              env=dict(os.environ, AQUAFARM_PLAN=str(program)))
        return done.returncode, done.stdout

    def test_page_geojson_and_plan_file_are_written_with_the_program_s_exit_code(self):
        code, words = self.run_command("ranch.yaml",
                                       "--ships",
                                       2,
                                       "-o",
                                       "a.html",
                                       body='echo "got $@"; cp sample.json "$last"; exit 4')
        self.assertEqual(4, code, words)
        self.assertIn("got ranch.yaml --ships 2 --json a.json", words)
        self.assertIn(f"page       {(self.folder / 'a.html').as_uri()}", words)
        self.assertIn("Rescue plan: dongji", (self.folder / "a.html").read_text())
        self.assertEqual("FeatureCollection",
                         json.loads((self.folder / "a.geojson").read_text())["type"])

    def test_refused_input_leaves_an_older_page_as_it_is(self):
        (self.folder / "a.html").write_text("old")
        (self.folder / "a.json").write_text("old")
        code, words = self.run_command("ranch.yaml",
                                       "-o",
                                       "a.html",
                                       body="echo refused >&2; exit 2")
        self.assertEqual((2, "refused\n"), (code, words))
        self.assertEqual("old", (self.folder / "a.html").read_text())
        self.assertFalse((self.folder / "a.geojson").exists())

    def test_a_program_that_writes_nothing_is_an_error(self):
        self.assertEqual(2, self.run_command("ranch.yaml")[0])

    def test_a_plan_file_becomes_a_page_without_the_program(self):
        code, words = self.run_command("--from",
                                       "sample.json",
                                       "-o",
                                       "b",
                                       body="echo called; exit 9")
        self.assertEqual(0, code, words)
        self.assertNotIn("called", words)
        self.assertTrue((self.folder / "b.html").is_file())

    def test_bad_arguments_are_refused_in_one_line(self):
        for arguments, expected in ((("--from", "none.json"),
                                     "none.json: No such file or directory; expected a plan file"),
                                    (("--from", "sample.json", "--ships", "3"),
                                     "--from: got also --ships 3, expected no other"),
                                    (("r.yaml", "-o", "x/a.html"), "x; make it first"),
                                    (("r.yaml", "-o", "."),
                                     "-o: got ., expected the name of the page"),
                                    (("r.yaml", "-o", ".."),
                                     "-o: got .., expected the name of the page"),
                                    (("r.yaml", "-o", "a.json"),
                                     "-o: got a.json, expected the name of the page")):
            code, words = self.run_command(*arguments)
            self.assertEqual(2, code, words)
            self.assertIn(expected, words)
            self.assertEqual(1, len(words.strip().splitlines()), words)

    def test_the_real_program_makes_a_plan_that_fits_the_schema(self):
        program = os.environ.get("AQUAFARM_PLAN") or next(
            iter(roslib.packages.find_node("aquafarm_agents", "aquafarm_plan")), None)
        if not program:
            self.skipTest("aquafarm_plan is not built")
        (self.folder / "bulletin.json").write_text(bulletin(), encoding="utf-8")
        done = subprocess.run(
            [COMMAND, "zhoushan_infa_2021", "--bulletin", "bulletin.json", "--at",
             "2021-07-24T00:00:00Z", "--ships", "2", "--members", "200", "-o", "real.html"], cwd=self.folder, timeout=120,
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
            env=dict(os.environ, AQUAFARM_PLAN=program))
        self.assertEqual(0, done.returncode, done.stdout)
        plan = document.load(self.folder / "real.json")
        words = words_of(plan)
        for device in plan["devices"]:
            self.assertIn(device["name"], words)
        for route in plan["plan"]["routes"]:
            self.assertIn(f"{route['km']:.1f} km", words)
            times = [order["time"] for order in route["orders"]]
            self.assertEqual(sorted(times), times)
            self.assertEqual("leave", route["orders"][0]["action"])

    def test_help_shows_that_of_the_program_too(self):
        code, words = self.run_command("--help", body='echo "program $1"')
        self.assertEqual(0, code)
        self.assertIn("usage: ./aquafarm plan RANCH.yaml", words)
        self.assertIn("program --help", words)

    def test_no_arguments_at_all_show_the_help(self):
        code, words = self.run_command()
        self.assertEqual(2, code)
        self.assertIn("usage: ./aquafarm plan", words)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "plan_page", "plan_page_test", sys.argv)
