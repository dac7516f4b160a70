#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of a run, of a benchmark and of several runs in headless Chromium: charts, tables, videos,
network."""
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from plan_browser_test import TOO_WIDE, open_browser, reason_to_skip  # noqa: E402
from report_test import SCENARIO, program, run  # noqa: E402

try:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
except ImportError:
    ActionChains = By = None

WIDTH, HEIGHT = 1280, 800
EPISODES = 40
RUNS = (("table", "q_learning"), ("other", "sarsa"))

RANGES = "return charts.map(chart => chart.xAxisRange());"
# Returns the tables and figures that are wider than their boxes.
SCROLLING = """
return [...document.querySelectorAll(".wide")].filter(one => one.scrollWidth > one.clientWidth)
  .map(one => one.textContent.slice(0, 60));
"""


@unittest.skipIf(reason_to_skip(), reason_to_skip())
class CompareBrowserTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_compare_browser_"))
        cls.scenario = cls.folder / "cove.yaml"
        # Each episode has another layout: intervals need different starts.
        cls.scenario.write_text(SCENARIO.replace("layout: {", "layout: {mode: per_episode, "))
        for name, algorithm in RUNS:
            code, words = run("aquafarm_agents", "aquafarm_train", cls.scenario, "--algorithm",
                              algorithm, "--episodes", 300, "--run-dir", cls.folder / name,
                              "--evaluate", 0, "--random", 0)
            assert code == 0, words
        cls.page = cls.folder / "page.html"
        code, words = run("aquafarm_bringup", "make_report",
                          *(cls.folder / name for name, _ in RUNS), "-o", cls.page,
                          "--episodes", EPISODES)
        assert code == 0, words
        cls.pages = [cls.page, *cls.make_other_pages()]
        cls.browser = open_browser()

    @classmethod
    def make_other_pages(cls):
        """Makes and returns the pages of a run and of a benchmark."""
        benchmark = cls.folder / "benchmark"
        code, words = run("aquafarm_agents", "aquafarm_benchmark", cls.scenario, "--output",
                          benchmark, "--runs", 2, "--episodes", 60, "--evaluation-episodes", 10,
                          "--algorithms", "random,q_learning", "--programs",
                          pathlib.Path(program("aquafarm_agents", "aquafarm_train")).parent)
        assert code == 0, words
        pages = []
        for source in (cls.folder / RUNS[0][0], benchmark):
            pages.append(cls.folder / f"page_of_{source.name}.html")
            code, words = run("aquafarm_bringup", "make_report", source, "-o", pages[-1],
                              "--episodes", EPISODES)
            assert code == 0, words
        return pages

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def show(self, width=WIDTH, page=None):
        self.browser.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": False})
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)
        self.browser.get((page or self.page).as_uri())

    def chart(self, name):
        """Scrolls a chart into the window and returns its element."""
        place = self.browser.find_element(By.ID, name)
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", place)
        return place

    def test_no_errors_and_no_requests_but_the_page_itself(self):
        for page in self.pages:
            self.show(page=page)
            self.assertEqual([], self.browser.get_log("browser"), page.name)
            addresses = set()
            for entry in self.browser.get_log("performance"):
                message = json.loads(entry["message"])["message"]
                if message["method"] == "Network.requestWillBeSent":
                    addresses.add(message["params"]["request"]["url"])
            self.assertEqual([page.as_uri()],
                             [one for one in addresses if not one.startswith("data:")])

    def test_they_fit_at_1280_pixels_without_scrolling_and_on_a_phone(self):
        for page in self.pages:
            self.show(page=page)
            self.assertEqual([], self.browser.execute_script(TOO_WIDE), page.name)
            self.assertEqual([], self.browser.execute_script(SCROLLING), page.name)
            self.show(width=390, page=page)
            self.assertEqual([], self.browser.execute_script(TOO_WIDE), page.name)

    def test_the_return_and_its_interval_are_seen_without_scrolling(self):
        for page, words in zip(self.pages[1:], ("of clairvoyant", "share of the optimum")):
            self.show(page=page)
            seen = self.browser.execute_script("""
              return [...document.querySelectorAll("b, span, td, th")].filter(one =>
                one.getBoundingClientRect().bottom < innerHeight).map(one => one.textContent)
                .join(" | ");""")
            self.assertIn(words, seen, page.name)
            self.assertRegex(seen, r"[−-]?[\d.,]+( \| 95 %: | )\[[−-]?[\d.,]+, [−-]?[\d.,]+\]", page.name)

    def test_numbers_of_episodes_have_thousands_separators(self):
        self.show()
        labels = self.browser.execute_script("""
          window.charts[0].updateOptions({dateWindow: [0, 5000]});
          return [...document.querySelectorAll("#curve_return .dygraph-axis-label-x")]
            .map(one => one.textContent);""")
        self.assertIn("2,000", labels)
        self.assertNotIn("2000", labels)

    def test_tiles_show_runs_and_references_by_return(self):
        self.show()
        tiles = [one.text.splitlines() for one in
                 self.browser.find_elements(By.CSS_SELECTOR, ".wide-tiles .tile")]
        self.assertEqual({"RANDOM (all actions)", "table: q_learning", "other: sarsa", "planner",
                          "clairvoyant"}, {tile[0] for tile in tiles})
        means = [float(tile[1].replace("−", "-").replace(",", "")) for tile in tiles]
        self.assertEqual(sorted(means, reverse=True), means)
        for tile in tiles:
            self.assertRegex(tile[2], r"^95 %: \[−?[\d.,]+, −?[\d.,]+\]$")
            self.assertRegex(tile[3], r"^success \d+ % \[\d+ %, \d+ %\]$")
        self.assertIn("100.0 % of clairvoyant", [tile[4] for tile in tiles])

    def test_the_curves_have_the_order_of_the_tiles(self):
        self.show()
        tiles = [one.text.splitlines()[0] for one in
                 self.browser.find_elements(By.CSS_SELECTOR, ".wide-tiles .tile.own")]
        self.assertEqual(tiles, self.browser.execute_script("return CURVES.labels.slice(1);"))
        names = [tile.partition(":")[0] for tile in tiles]
        self.assertEqual(f"Comparison of {' and '.join(names)}", self.browser.title)

    def test_names_next_to_each_other_have_the_styles_of_their_lines(self):
        self.show()
        drawn = self.browser.execute_script("""
          const drawn = [], write = CanvasRenderingContext2D.prototype.fillText;
          CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
            drawn.push(text);
            write.call(this, text, ...place);
          };
          CURVES.charts[0].lines.forEach(line => { line.value = 1.0; });
          window.charts[0].updateOptions({});
          CanvasRenderingContext2D.prototype.fillText = write;
          return drawn;""")
        names = next(text for text in drawn if "planner" in text)
        for label, style in (("RANDOM", "dotted"), ("planner", "dashed"), ("clairvoyant", "solid")):
            self.assertRegex(names, rf"{label}[^,]* \({style}\)")

    def test_the_pointer_shows_the_value_of_every_run(self):
        self.show()
        place = self.chart("curve_return")
        ActionChains(self.browser).move_to_element_with_offset(place, 100, 0).perform()
        legend = self.browser.find_element(By.ID, "curve_return_legend").text
        for label in ("table: q_learning", "other: sarsa"):
            self.assertRegex(legend, rf"^\d+: .*{label}: −?[\d.]+")
        first = legend.partition(":")[0]
        ActionChains(self.browser).move_to_element_with_offset(place, 200, 0).perform()
        second = self.browser.find_element(By.ID, "curve_return_legend").text.partition(":")[0]
        self.assertGreater(float(second), float(first))

    def test_runs_differ_by_their_dashes_for_a_print_without_colours(self):
        self.show()
        dashes = self.browser.execute_script("""
          return charts.map(chart => chart.getLabels().slice(1).map(
            label => chart.getOption("strokePattern", label)));""")
        for of_runs in dashes:
            self.assertEqual([None, [9, 4]], of_runs)

    def test_dragging_enlarges_a_part_of_all_curves_and_a_double_click_shows_all(self):
        self.show()
        whole = self.browser.execute_script(RANGES)
        self.assertGreaterEqual(len(whole), 2)
        place = self.chart("curve_return")
        ActionChains(self.browser).move_to_element_with_offset(place, -100, 0).click_and_hold() \
            .move_by_offset(200, 0).release().perform()
        part = self.browser.execute_script(RANGES)
        for now, before in zip(part, whole):
            self.assertEqual(part[0], now)
            self.assertLess(now[1] - now[0], 0.5 * (before[1] - before[0]))
        for _ in range(5):  # on a busy machine two clicks may be too far apart
            ActionChains(self.browser).move_to_element(place).double_click().perform()
            if self.browser.execute_script(RANGES) != part:
                break
        for now, before in zip(self.browser.execute_script(RANGES), whole):
            self.assertAlmostEqual(before[1] - before[0], now[1] - now[0], delta=2)

    def test_videos_of_the_same_episode_stand_side_by_side_with_controls(self):
        self.show()
        boxes = self.browser.execute_script("""
          return [...document.querySelectorAll(".videos")].map(row =>
            [...row.querySelectorAll("video, img")].map(one => {
              const box = one.getBoundingClientRect();
              return [box.top, box.width, one.tagName === "IMG" || one.controls]; }));""")
        self.assertTrue(boxes)
        for row in boxes:
            self.assertEqual(len(RUNS), len(row))
            for top, width, has_controls in row:
                self.assertAlmostEqual(row[0][0], top, delta=1)
                self.assertGreater(width, 480)
                self.assertTrue(has_controls)

    def test_it_compares_settings_measures_and_devices(self):
        self.show()
        words = self.browser.find_element(By.TAG_NAME, "body").text
        algorithms = [one.partition(": ")[2] for one in
                      self.browser.execute_script("return CURVES.labels.slice(1);")]
        for word in ("Settings that differ", f"algorithm {' '.join(algorithms)}", "devices home",
                     "the median return of the best run", "F0 "):
            self.assertIn(word, words)

    def test_only_runs_can_be_compared(self):
        empty = self.folder / "empty"
        empty.mkdir(exist_ok=True)
        code, words = run("aquafarm_bringup", "make_report", self.folder / "table", empty, "-o",
                          self.folder / "x.html", "--episodes", 2)
        self.assertEqual((2, f"make_report: {empty}: got no run (run.json), expected run folders "
                          "to compare; a benchmark has its own report\n"), (code, words))


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "compare_browser", CompareBrowserTest, sys.argv)
