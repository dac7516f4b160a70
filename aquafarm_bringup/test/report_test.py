#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run and of a benchmark: required contents and error messages."""
import contextlib
import csv
import html
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

import cv2
import numpy as np
import roslib.packages
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from aquafarm_report import intervals, outcomes, report, videos  # noqa: E402
from aquafarm_report.blocks import page as make_page, tiles  # noqa: E402
from page_reader import Page  # noqa: E402
from ranch import Ranch, load_script  # noqa: E402

SCENARIO = """
name: cove
grid: {width: 6, height: 6}
time: {step_limit: 60}
layout: {rocks: {count: [2, 2]}, ports: {count: 1}, devices: {count: 1}}
"""

# Shows a page in a window of 390 pixels and lists the elements that overflow the window or their
# box. Tables and preformatted texts may scroll in their own box.
PHONE = """<!DOCTYPE html><iframe width="390" height="844" frameborder="0" srcdoc="PAGE"></iframe>
<script>
onload = () => {
  const inside = document.querySelector("iframe").contentDocument;
  inside.querySelectorAll("details").forEach(one => one.open = true);
  const wide = [...inside.querySelectorAll("body, body *")].filter(one => !one.closest(
    "pre, .wide, svg *") && (one.getBoundingClientRect().right > 390 ||
                             one.clientWidth > 0 && one.scrollWidth > one.clientWidth + 1));
  document.body.innerHTML = "<p>too wide:" + wide.map(one => one.outerHTML.slice(0, 60)
    .replaceAll("<", "&lt;")).join("; ") + "</p>";
};
</script>
"""


def program(package, name):
    """Returns the path of a program of aquafarm."""
    return roslib.packages.find_node(package, name)[0]


def run(package, name, *arguments, **options):
    """Runs a program of aquafarm; returns (exit code, output)."""
    done = subprocess.run([program(package, name), *map(str, arguments)], timeout=120, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **options)
    return done.returncode, done.stdout


class ReportTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_report_test_"))
        cls.scenario = cls.folder / "cove.yaml"
        cls.scenario.write_text(SCENARIO)
        cls.trained = cls.folder / "run"
        code, words = run("aquafarm_agents", "aquafarm_train", cls.scenario, "--algorithm",
                          "q_learning", "--episodes", 300, "--seed", 7, "--run-dir", cls.trained,
                          "--evaluate", 0, "--random", 0)
        assert code == 0, words
        code, cls.words = run("aquafarm_bringup", "make_report", cls.trained)
        assert code == 0, cls.words
        cls.page = Page(cls.trained / "report.html")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def test_the_last_line_is_its_address(self):
        self.assertEqual(f"report     {(self.trained / 'report.html').as_uri()}",
                         self.words.splitlines()[-1])

    def test_it_is_opened_where_there_is_a_display_and_a_missing_browser_does_not_fail(self):
        browser = self.folder / "bin" / "xdg-open"
        opened = self.folder / "opened"
        browser.parent.mkdir()
        browser.write_text(f"#!/bin/sh\necho \"$1\" >{opened}.part && mv {opened}.part {opened}\n")
        browser.chmod(0o755)
        without = ":".join(folder for folder in os.environ["PATH"].split(":")
                           if not pathlib.Path(folder, "xdg-open").exists())
        page = self.trained / "report.html"
        with_browser = f"{browser.parent}:{os.environ['PATH']}"
        self.assertEqual("", self.open_page(page, PATH=with_browser, DISPLAY=""))
        self.assertFalse(opened.exists())  # there is no display
        self.assertEqual("", self.open_page(page, PATH=with_browser, DISPLAY=":7"))
        end = time.monotonic() + 60
        while not opened.exists() and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(f"{page}\n", opened.read_text())
        self.assertIn("make_report: not opened: ", self.open_page(page, PATH=without, DISPLAY=":7"))

    def open_page(self, page, **environment):
        """Runs make_report --open, as if it had made this page; returns its errors."""
        module = load_script("make_report")
        with mock.patch.object(module, "make", return_value=page), \
                mock.patch.object(sys, "argv", ["make_report", "--open", str(self.trained)]), \
                mock.patch.dict(os.environ, WAYLAND_DISPLAY="", **environment), \
                contextlib.redirect_stderr(io.StringIO()) as errors:
            self.assertEqual(0, module.main())
        return errors.getvalue()

    def test_it_loads_nothing_from_anywhere(self):
        for address in self.page.addresses:
            self.assertTrue(address.startswith(("data:", "#")), address[:80])
        self.assertNotIn("<script src", self.page.text)
        self.assertNotIn("@import", self.page.text)
        self.assertFalse([one for one in re.findall(r"url\(([^)]*)\)", self.page.text)
                          if not one.startswith(("#", "data:"))])

    def too_wide(self, text):
        """Description of the elements that overflow a phone's window."""
        browser = shutil.which("chromium") or shutil.which("google-chrome")
        if browser is None:
            self.skipTest("chromium is not installed")
        path = self.folder / "phone.html"
        path.write_text(PHONE.replace("PAGE", html.escape(text)))
        done = subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
             f"--user-data-dir={self.folder / 'browser'}", path.as_uri()],
            capture_output=True, text=True, timeout=60, check=False)
        return re.findall(r"<p>too wide:(.*?)</p>", done.stdout, re.S)

    def test_nothing_in_it_is_wider_than_a_phone(self):
        self.assertEqual("width=device-width, initial-scale=1", self.page.meta["viewport"])
        for rule in ("img,video,svg{max-width:100%", ".wide{overflow-x:auto", "pre{overflow-x:auto",
                     "overflow-wrap:anywhere", "repeat(auto-fit,"):
            self.assertTrue(rule in self.page.text, rule)
        self.assertEqual([""], self.too_wide(self.page.text))
        words = "clairvoyant_planner_on_zhoushan_mitag_2019_with_floats"
        self.assertEqual([""], self.too_wide(make_page(words, tiles([(words, words)]))))

    def test_it_lists_learner_scenario_seeds_and_version(self):
        settings = json.loads((self.trained / "run.json").read_text())
        for word in ("q_learning on the scenario cove", settings["version"],
                     "layout:", settings["options"]):
            self.assertIn(word, self.page.words)
        count = len((self.trained / "metrics.csv").read_text().splitlines()) - 1
        self.assertIn(f"Trained for {count} episodes with seed 7, version ", self.page.words)

    def test_it_has_the_figure_of_aquafarm_evaluate(self):
        prefix = self.folder / "evaluated"
        code, words = run("aquafarm_agents", "aquafarm_evaluate", self.trained, "--write", prefix)
        self.assertEqual(0, code, words)
        summary = json.loads(prefix.with_suffix(".json").read_text())
        mean, distinct = summary["return_per_episode"], summary["distinct_episodes"]
        self.assertRegex(self.page.text, f"<b>({mean:,.1f}|{mean:,.0f})</b>".replace("-", "−"))
        self.assertIn(f"{summary['episodes']} episodes, {distinct} distinct", self.page.words)

    def test_the_policy_stands_next_to_the_references_with_intervals(self):
        section = self.page.text[self.page.text.index("Return of the policy and of the references"):]
        section = section[:section.index("</section>")]
        shown = re.findall(r"<span>([^<]*)</span><b>(−?[\d.,]+)</b>", section)
        self.assertEqual({"RANDOM (all actions)", "q_learning", "planner", "clairvoyant"},
                         {label for label, _ in shown})
        means = [float(value.replace("−", "-").replace(",", "")) for _, value in shown]
        self.assertEqual(sorted(means, reverse=True), means, "the highest return first")
        self.assertEqual(4, len(re.findall(r"<span>success \d+ % \[\d+ %, \d+ %\]</span>", section)))
        self.assertIn("<span>100.0 % of clairvoyant</span>", section)  # of itself
        self.assertEqual(3, section.count("<span>100 episodes, "))

    def test_it_lists_what_became_of_each_device(self):
        found = re.findall(r"<td>F0 \w+( \w+)?</td>(.*?)</tr>", self.page.text)
        self.assertEqual(2, len(found), "the cove has one device: all episodes, and the videos")
        shares = [int(share) for share in re.findall(r"<td>(\d+) % \[\d+ %, \d+ %\]</td>", found[0][1])]
        self.assertEqual(3, len(shares), found[0])  # home, aboard, left
        self.assertAlmostEqual(100, sum(shares), delta=1)
        self.assertRegex(found[1][1], r"home at step \d+, health \d+ %|left at sea, health \d+ %")

    def test_shares_of_a_device_count_distinct_starts(self):
        device = {"id": 2, "kind": "deep_water_breeding", "episodes": 100, "delivered": 90,
                  "aboard": 0, "left": 10, "delivered_health": 0.953}
        table = outcomes.summary_table({"devices": [device], "distinct_episodes": 100})
        self.assertIn("<td>F2 deep water</td><td>90 % [83 %, 94 %]</td><td>0 % [0 %, 4 %]</td>"
                      "<td>10 % [6 %, 17 %]</td><td>95 %</td>", table)
        self.assertIn("90 % [60 %, 98 %]", outcomes.summary_table(
            {"devices": [device], "distinct_episodes": 10}))
        self.assertEqual("", outcomes.summary_table({}), "an evaluation of version 0.1.0")

    def test_it_holds_curves_of_return_success_and_loss(self):
        found = json.loads(re.search(r"const CURVES=(.*?);\n", self.page.text).group(1))
        self.assertEqual(["episode", "q_learning"], found["labels"])
        with open(self.trained / "metrics.csv", newline="") as file:
            trained = list(csv.DictReader(file))
        charts = {chart["id"]: chart["rows"] for chart in found["charts"]}
        for name, factor in (("return", 1.0), ("success", 100.0), ("loss", 1.0)):
            episode, mean = charts[f"curve_{name}"][-1]
            self.assertEqual(len(trained), episode)
            last = [factor * float(row[name]) for row in trained[-50:]]
            self.assertAlmostEqual(sum(last) / 50.0, mean, delta=1e-3 * abs(mean) + 1e-6)

    def test_devices_of_episodes_with_other_devices_have_their_own_kinds(self):
        first = [outcomes.Outcome("F0 monitoring", 3, 9, 1.0)]
        second = [outcomes.Outcome("F0 release", None, None, 0.5),
                  outcomes.Outcome("F1 release", 2, None, 0.75)]
        table = outcomes.episodes_table(["best", "worst"], [first, second])
        self.assertIn("<td>F0</td><td>monitoring: home at step 9, health 100 %</td>"
                      "<td>release: left at sea, health 50 %</td>", table)
        self.assertIn("<td>F1 release</td><td>–</td><td>aboard since step 2, health 75 %</td>",
                      table)

    def test_the_chart_of_a_benchmark_has_the_scale_of_the_learners(self):
        rows = [{"label": "RANDOM", "return_iqm": -1577.0, "return_interval": [-1583.0, -1569.0]},
                {"label": "SARSA", "return_iqm": 230.0, "return_interval": [30.0, 240.0]},
                {"label": "DQN", "return_iqm": 268.0, "return_interval": [266.0, 270.0]}]
        text = intervals.chart(rows)
        dots = [float(one) for one in re.findall(r'<circle cx="([\d.]+)"', text)]
        self.assertEqual(2, len(dots))
        self.assertGreater(dots[0] - dots[1], 80.0, "230 and 268 differ by a sixth of the range")
        self.assertIn("← -1,577.0</text>", text)
        self.assertLess(text.index("DQN"), text.index("SARSA"), "the best first")
        for tick in ("50", "150", "250"):
            self.assertRegex(text, rf">{tick}</text>")

    def test_a_family_has_outcomes_by_kind_and_no_videos(self):
        kind = {"kind": "monitoring", "devices": 200, "delivered": 150, "aboard": 0, "left": 50,
                "delivered_health": 0.9}
        table = outcomes.summary_table({"devices_by_kind": [kind], "distinct_episodes": 100})
        self.assertIn("<td>monitoring (200)</td><td>75 % [66 %, 82 %]</td>", table)
        family = self.folder / "family"
        family.mkdir()
        (family / "scenario.yaml").write_text("name: f\nfamily: {width: [6, 9]}\n")
        rows = [{"episode": str(i), "return": str(10 * i), "steps": "5", "delivered": "1",
                 "devices": "1", "reason": "all_retrieved"} for i in range(3)]
        text = "".join(report.video_episodes(family, self.folder, rows))
        self.assertIn("best: episode 2 of seed 1000", text)
        self.assertIn("There are no videos: the scenario is a family", text)
        self.assertFalse(videos.is_family(self.trained))

    def test_the_map_shows_the_ranch(self):
        pictures = [cv2.imdecode(np.frombuffer(one, np.uint8), cv2.IMREAD_COLOR)
                    for one in self.page.embedded("image/png")]
        self.assertEqual(1, len(pictures))
        self.assertEqual((640, 800, 3), pictures[0].shape)
        self.assertGreater(len(np.unique(pictures[0].reshape(-1, 3), axis=0)), 100)

    def test_the_videos_are_of_the_best_the_median_and_the_worst_episode(self):
        videos = self.page.embedded("video/mp4") + self.page.embedded("image/gif")
        returns = [float(one) for one in re.findall(r"return (-?[0-9.]+) in", self.page.words)]
        self.assertEqual(len(videos), len(returns))
        self.assertEqual(sorted(returns, reverse=True), returns)
        self.assertIn("best: episode ", self.page.words)
        for video in videos:
            path = self.folder / "video"
            path.write_bytes(video)
            capture = cv2.VideoCapture(str(path))
            pictures = 0
            while capture.read()[0]:
                pictures += 1
            self.assertGreater(pictures, 24)  # two seconds of pictures follow the steps

    def test_without_an_encoder_that_browsers_play_the_videos_are_gifs(self):
        output = self.folder / "gifs.html"
        code, words = run("aquafarm_bringup", "make_report", self.trained, "-o", output,
                          "--episodes", 1,
                          env={**os.environ, "OPENCV_VIDEOIO_PRIORITY_FFMPEG": "0"})
        self.assertEqual(0, code, words)
        page = Page(output)
        self.assertEqual([], page.embedded("video/mp4"))
        self.assertEqual(1, len(page.embedded("image/gif")))
        videos = self.page.embedded("video/mp4")
        self.assertTrue(videos, "there is no encoder of H.264 here")
        for video in videos:
            self.assertIn(b"avc1", video)

    def test_a_benchmark_shows_its_table_figures_and_best_learner(self):
        output = self.folder / "benchmark"
        code, words = run("aquafarm_agents", "aquafarm_benchmark", self.scenario, "--output",
                          output, "--runs", 1, "--episodes", 60, "--evaluation-episodes", 10,
                          "--algorithms", "random,q_learning", "--programs",
                          pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent)
        self.assertEqual(0, code, words)
        code, words = run("aquafarm_bringup", "make_report", output, "-o", self.folder / "b.html",
                          "--episodes", 10)
        self.assertEqual(0, code, words)
        page = Page(self.folder / "b.html")
        figures = list((output / "figures").glob("*.png"))
        self.assertEqual(len(figures) + 1, len(page.embedded("image/png")))
        for word in ("Benchmark on the scenario cove", "Q-learning, paper", "RANDOM", "The best learner",
                     "Seeds of the trainings", "evaluation_episodes",
                     "its share of the optimum", "Mean return of all episodes so far"):
            self.assertIn(word, page.words)
        rows = json.loads((output / "results.json").read_text())["table"]
        best = next(row for row in rows if row["name"] == "q_learning")  # the only learner
        head = page.words[:page.words.index("Table 1")]
        self.assertIn(f"{best['return_iqm']:.1f}", head)
        self.assertTrue("<b>Q-learning</b><span>best learner" in page.text)
        for row in rows:
            self.assertIn(row["label"], head)
        self.assertNotIn("average rewards", page.words, "captions are words, not file names")
        self.assertEqual([""], self.too_wide(page.text))
        self.assertIn("The best learner: q_learning, seed 1", page.words)
        shutil.rmtree(output / "runs" / "random", ignore_errors=True)
        (output / "runs" / "q_learning").rename(output / "runs" / "random")
        report.make([output], self.folder / "b.html", 10)
        self.assertIn("The best contestant with a run folder: random, seed 1",
                      Page(self.folder / "b.html").words)

    def test_a_comparison_needs_no_metrics(self):
        other = self.folder / "without_metrics"
        shutil.copytree(self.trained, other)
        (other / "metrics.csv").unlink()
        path = report.make([self.trained, other], self.folder / "c.html", 10)
        self.assertIn("Greedy play, 95 % intervals", Page(path).words)

    def test_with_money_it_shows_losses_next_to_the_references(self):
        self.assertNotIn("Losses", self.page.words, "the scenario of the other tests has no money")
        scenario = self.folder / "insured.yaml"
        scenario.write_text(SCENARIO + "money: {device_values: {temporary_breeding: 5000.5}}\n")
        trained = self.folder / "insured"
        code, words = run("aquafarm_agents", "aquafarm_train", scenario, "--algorithm",
                          "q_learning", "--episodes", 60, "--run-dir", trained, "--evaluate", 0,
                          "--random", 0)
        self.assertEqual(0, code, words)
        code, words = run("aquafarm_bringup", "make_report", trained, "--episodes", 20)
        self.assertEqual(0, code, words)
        page = Page(trained / "report.html")
        for word in ("Losses", "do nothing", "fetch by value", "loss x [CNY]",
                     "temporary breeding", "VaR 5 %"):
            self.assertIn(word, page.text)
        # Without a rescue the only device is lost in each episode.
        self.assertIn("<td>do nothing</td><td>5,000</td><td>0</td><td>0</td><td>5,000</td>",
                      page.text)
        self.assertEqual([""], self.too_wide(page.text))

    def test_a_launch_ends_with_the_report(self):
        folder = self.folder / "launched"
        with Ranch("train", f"scenario:={self.scenario}", "episodes:=40", "farms:=4",
                   "evaluation_episodes:=0", "random_episodes:=0", "viz:=false",
                   f"run_dir:={folder}", reports=True) as ranch:
            self.assertEqual(0, ranch.exit_code(90), ranch.words())
            self.assertIn(f"report     {(folder / 'report.html').as_uri()}", ranch.words())
        Page(folder / "report.html")

    def test_a_route_becomes_a_bag_only_of_its_own_scenario(self):
        route, bag = self.folder / "route.json", self.folder / "route.bag"
        code, words = run("aquafarm_agents", "aquafarm_evaluate", self.trained, "--episodes", 1,
                          "--route", route, "--route-episode", 5)
        self.assertEqual(0, code, words)
        own = self.trained / "scenario.yaml"
        self.assertEqual((0, ""), run("aquafarm_sim", "episode_bag", own, route, "-o", bag))
        code, words = run("aquafarm_sim", "verify_bag", bag)
        self.assertEqual(0, code, words)
        self.assertIn("episode 5 of seed ", words)
        other = self.folder / "other.yaml"
        other.write_text(SCENARIO.replace("width: 6", "width: 7"))
        code, words = run("aquafarm_sim", "episode_bag", other, route, "-o", bag)
        self.assertEqual((2, f"episode_bag: {route}: is a route in another scenario than {other}\n"),
                         (code, words))
        code, words = run("aquafarm_sim", "episode_bag", own, other, "-o", bag)
        self.assertEqual(2, code)
        self.assertIn(f"episode_bag: {other}: is not a route: ", words)
        code, words = run("aquafarm_sim", "episode_bag", own, route)
        self.assertEqual(2, code)
        self.assertIn("--output is required", words)

    def test_what_cannot_be_reported_on_has_its_line(self):
        empty = self.folder / "empty"
        empty.mkdir()
        code, words = run("aquafarm_bringup", "make_report", empty)
        self.assertEqual(2, code)
        self.assertEqual(f"make_report: {empty}: contains neither run.json nor results.json, "
                         "expected the folder of a run or a benchmark\n", words)
        broken = self.folder / "broken"
        shutil.copytree(self.trained, broken)
        for path in [broken / "policy.ckpt", *broken.glob("checkpoints/*")]:
            path.unlink()
        code, words = run("aquafarm_bringup", "make_report", broken)
        self.assertEqual(2, code)
        self.assertIn("make_report: ", words)
        self.assertEqual(1, len(words.splitlines()), words)

    def test_a_file_that_cannot_be_written_is_refused_before_the_work(self):
        folder = self.folder / "place"
        folder.mkdir()
        for output, words in ((self.folder / "none/page.html", "No such file or directory"),
                              (folder, "it is a folder")):
            with mock.patch.object(report, "make_text", side_effect=AssertionError("it worked")), \
                    self.assertRaisesRegex(report.ReportError,
                                           f"^{output}: cannot be written: {words}; .* -o$"):
                report.make([self.trained], output)

    def test_a_report_that_fails_leaves_the_page_before_and_no_other_file(self):
        page = self.folder / "place.html"
        page.write_text("before")
        files = sorted(self.folder.iterdir())
        with mock.patch.object(report, "make_text", side_effect=report.ReportError("no films")), \
                self.assertRaisesRegex(report.ReportError, "^no films$"):
            report.make([self.trained], page)
        self.assertEqual(("before", files), (page.read_text(), sorted(self.folder.iterdir())))

    def test_a_folder_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(report.ReportError, "/none: contains neither run.json nor"):
            report.make([self.folder / "none"], None)


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "report", ReportTest, sys.argv)
