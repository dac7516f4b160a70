#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The plan's page in headless Chromium: script, layout, network and print."""
import base64
import copy
import io
import json
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

import cv2
import numpy as np
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import plan_sample  # noqa: E402
from aquafarm_plan import labels, page  # noqa: E402

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

WIDTH, HEIGHT = 1280, 800
PHONE = 390

# Returns pairs of labels of the map that overlap, and labels that cover a port or a device.
OVERLAPS = """
const box = one => one.getBoundingClientRect();
const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
                       Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;
const labels = [...document.querySelectorAll("#chart .labels > text")];
const symbols = [...document.querySelectorAll("#chart > .port circle, #chart > .device")];
const frame = box(document.querySelector("#chart .border"));
const found = [];
labels.forEach((label, i) => {
  labels.slice(i + 1).forEach(other => {
    if (meet(box(label), box(other))) found.push(label.textContent + " / " + other.textContent); });
  symbols.forEach(symbol => {
    if (meet(box(label), box(symbol))) found.push(label.textContent + " over a symbol"); });
  const at = box(label);
  if (at.left < frame.left || at.right > frame.right || at.top < frame.top ||
      at.bottom > frame.bottom) found.push(label.textContent + " leaves the map");
});
return found;
"""

# Returns the elements that extend beyond the window, except in boxes that scroll.
TOO_WIDE = """
return [...document.querySelectorAll("body *")].filter(one => !one.closest("svg *, section") &&
  one.getBoundingClientRect().right > innerWidth + 1).map(one => one.outerHTML.slice(0, 60));
"""

# The state of the map that the slider changes.
STATE = """
return {clock: document.getElementById("clock").textContent,
        state: document.getElementById("state").textContent,
        ships: [...document.querySelectorAll("#ships .ship")].map(
            one => one.getAttribute("transform")),
        home: [...document.querySelectorAll(".device.home")].map(one => one.id).sort(),
        aboard: [...document.querySelectorAll(".device.aboard:not(.home)")].map(
            one => one.id).sort(),
        explained: !document.getElementById("hatching").hidden,
        areas: document.querySelectorAll("#hazard path").length,
        cursor: document.getElementById("cursor").getAttribute("transform")};
"""


def reason_to_skip():
    """Returns why no browser can be controlled; empty if one can."""
    if webdriver is None:
        return "python3-selenium is not installed"
    for name in ("chromium", "chromedriver"):
        if not shutil.which(name):
            return f"{name} is not installed"
    return ""


def open_browser():
    options = Options()
    options.binary_location = shutil.which("chromium")
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                     "--disable-dev-shm-usage", "--force-device-scale-factor=1"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def long_plan(plan):
    """Returns a plan with more orders (up to 12 and 6 of the two ships) and with more notes."""
    plan = copy.deepcopy(plan)
    for route, count in zip(plan["plan"]["routes"], (12, 6)):
        route["orders"] = (route["orders"] * 6)[:count]
    plan["warnings"] += [{"code": "radii_estimated", "severity": "note", "advice": "",
                          "text": "Radii are estimated from the wind at 63 points of the storm."},
                         {"code": "ports_chosen", "severity": "note",
                          "text": "No port was given: the ports are chosen on the shore, " +
                                  "; ".join(f"port {one} at 30.7233,122.4367" for one in "ABCD"),
                          "advice": "Give your own, each as --ports LATITUDE,LONGITUDE."}]
    return plan


@unittest.skipIf(reason_to_skip(), reason_to_skip())
class BrowserTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="aquafarm_plan_browser_"))
        cls.plan = plan_sample.sample(members=400)
        for name, plan in (("plan", cls.plan), ("long", long_plan(cls.plan)),
                           ("late", plan_sample.nothing_to_save()),
                           ("calm", plan_sample.storm_stays_away()),
                           ("unknown", plan_sample.storm_unknown())):
            (cls.folder / f"{name}.html").write_text(page.render(plan), encoding="utf-8")
        cls.browser = open_browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def show(self, name="plan", width=WIDTH):
        self.browser.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": False})
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)
        self.browser.get((self.folder / f"{name}.html").as_uri())

    def move_slider(self, seconds):
        self.browser.execute_script(
            "const slider = document.getElementById('slider'); slider.value = arguments[0];"
            "slider.dispatchEvent(new Event('input'));", seconds)
        return self.browser.execute_script(STATE)

    def seconds(self, stamp):
        start = plan_sample.START.replace(tzinfo=None)
        return (plan_sample.datetime.datetime.strptime(stamp, "%Y-%m-%dT%H:%M:%SZ") -
                start).total_seconds()

    def picture(self, element):
        png = self.browser.execute_cdp_cmd("Page.captureScreenshot",
                                           {"captureBeyondViewport": True})
        image = cv2.imdecode(np.frombuffer(base64.b64decode(png["data"]), np.uint8),
                             cv2.IMREAD_COLOR)
        box = self.browser.execute_script(
            "const b = document.querySelector(arguments[0]).getBoundingClientRect();"
            "return [b.left + scrollX, b.top + scrollY, b.right + scrollX, b.bottom + scrollY]",
            element)
        x0, y0, x1, y1 = (int(v) for v in box)
        self.assertGreater(image.shape[0], 1)
        return image[max(y0, 0):y1, max(x0, 0):x1]

    def test_no_errors_and_no_requests_but_the_page_itself(self):
        for name in ("plan", "late", "calm", "unknown"):
            self.show(name)
            for seconds in (0, 30000, 10**9):
                self.move_slider(seconds)
            self.assertEqual([], self.browser.get_log("browser"), name)
            addresses = set()
            for entry in self.browser.get_log("performance"):
                message = json.loads(entry["message"])["message"]
                if message["method"] == "Network.requestWillBeSent":
                    addresses.add(message["params"]["request"]["url"])
            self.assertEqual({(self.folder / f"{name}.html").as_uri()}, addresses)

    def test_the_slider_moves_ships_devices_and_rings(self):
        self.show()
        route = self.plan["plan"]["routes"][0]
        fetch, deliver = (self.seconds(order["time"]) for order in route["orders"][1:3])
        before = self.move_slider(0)
        self.assertEqual(("Sat 24, 08:00 UTC+8 (Sat 24, 00:00 UTC)", [], []),
                         (before["clock"], before["home"], before["aboard"]))
        towing = self.move_slider(300 * np.ceil(fetch / 300))
        self.assertIn("device1", towing["aboard"])
        home = self.move_slider(300 * np.ceil(deliver / 300))
        self.assertIn("device1", home["home"])
        self.assertIn("hurricane (64 kt) < 1 %", before["state"], "no false all-clear")
        self.assertNotEqual(before["ships"][0], towing["ships"][0])
        self.assertNotEqual(before["cursor"], home["cursor"])
        self.assertEqual((0, False), (before["areas"], before["explained"]))
        late = self.move_slider(86400)
        self.assertGreater(late["areas"], 2)
        self.assertTrue(late["explained"])
        timeline = {
            self.seconds(one["time"]): one["probability"] for one in self.plan["hazard"]["timeline"]
        }
        shown = float(re.search(r"gale \(34 kt\) (\d+) %", late["state"])[1])
        self.assertAlmostEqual(100 * timeline[86400][2], shown, delta=0.51)

    def test_a_ship_lies_on_its_route_at_the_time_of_the_slider(self):
        self.show()
        path = self.plan["plan"]["routes"][0]["path"]
        x, y, seconds = path[len(path) // 2]
        exact = 300 * round(seconds / 300)
        place = self.move_slider(exact)["ships"][0]
        left, top = (float(v) for v in re.findall(r"[\d.]+", place))
        scale = 760 / 25
        # Rounding to 300 s shifts the time by at most 150 s, in which the ship moves half a cell.
        self.assertLess(abs((x + 0.5) * scale - left), scale)
        self.assertLess(abs(760 - (y + 0.5) * scale - top), scale)

    def test_the_first_screen_holds_warnings_answers_and_orders_in_time(self):
        self.show()
        for element in ("#warnings", "#answers", "#timeline", "#slider"):
            bottom = self.browser.execute_script(
                "return document.querySelector(arguments[0]).getBoundingClientRect().bottom",
                element)
            self.assertLess(bottom, HEIGHT, element)

    def test_the_slider_stays_next_to_the_map(self):
        self.show()
        boxes = self.browser.execute_script("""
          document.getElementById("map").scrollIntoView({block: "end"});
          const box = id => document.getElementById(id).getBoundingClientRect();
          return [box("slider").top, box("control").bottom,
                  box("chart").top, box("chart").bottom];"""
                                            )
        self.assertGreaterEqual(boxes[0], 0)
        self.assertLessEqual(boxes[1], boxes[2])
        self.assertLessEqual(boxes[3], HEIGHT)

    def test_labels_keep_free_of_each_other_and_of_symbols(self):
        for name in ("plan", "late", "calm", "unknown"):
            self.show(name)
            self.assertEqual([], self.browser.execute_script(OVERLAPS), name)

    def test_nothing_is_wider_than_the_window(self):
        for width in (WIDTH, PHONE):
            self.show(width=width)
            self.assertEqual([], self.browser.execute_script(TOO_WIDE), width)

    def test_the_picture_shows_both_routes_and_changes_with_the_slider(self):
        self.show()
        self.move_slider(0)
        calm = self.picture("#chart")
        self.move_slider(86400)
        storm = self.picture("#chart")
        self.assertEqual(calm.shape, storm.shape)
        self.assertGreater((cv2.absdiff(calm, storm).max(2) > 12).mean(), 0.02)
        for colour in ((0xb2, 0x72, 0x00), (0x00, 0x5e, 0xd5)):  # ships A and B, BGR
            near = np.abs(calm.astype(int) - colour).max(2) < 12
            self.assertGreater(near.sum(), 150, colour)

    def test_in_grey_the_routes_are_darker_than_the_sea(self):
        self.show()
        self.move_slider(0)
        grey = cv2.cvtColor(self.picture("#chart"), cv2.COLOR_BGR2GRAY)
        sea = np.median(grey)
        self.assertGreater(sea, 200)
        for leg in self.browser.execute_script("""
              const chart = document.getElementById("chart").getBoundingClientRect();
              return [...document.querySelectorAll("#chart .leg")].map(leg => {
                const at = leg.getPointAtLength(leg.getTotalLength() / 2.1);
                const px = new DOMPoint(at.x, at.y).matrixTransform(leg.getScreenCTM());
                return [px.x - chart.left, px.y - chart.top]; });"""):
            x, y = (int(v) for v in leg)
            darkest = grey[max(y - 8, 0):y + 9, max(x - 8, 0):x + 9].min()
            self.assertLess(darkest, sea - 60, leg)

    def test_labels_are_no_wider_than_the_room_that_they_get(self):
        for name in ("plan", "late"):
            self.show(name)
            lines = self.browser.execute_script("""
              return [...document.querySelectorAll("#chart .labels > text tspan")].map(line =>
                [line.textContent, parseFloat(getComputedStyle(line).fontSize),
                 line.getComputedTextLength()]); """)
            self.assertGreater(len(lines), 6)
            for text, size, width in lines:
                self.assertLessEqual(width, labels.text_width(text, size) + 1, (name, text))

    def test_it_prints_on_two_pages(self):
        for name in ("plan", "late", "calm", "unknown", "long"):
            self.show(name)
            printed = self.browser.execute_cdp_cmd(
                "Page.printToPDF", {"preferCSSPageSize": True, "printBackground": True})
            pdf = io.BytesIO(base64.b64decode(printed["data"])).getvalue()
            self.assertEqual(2, len(re.findall(rb"/Type\s*/Page\b", pdf)), name)
            box = [float(v) for v in re.search(rb"/MediaBox\s*\[([^\]]*)\]", pdf)[1].split()]
            self.assertAlmostEqual(210, box[2] / 72 * 25.4, delta=1)
            self.assertAlmostEqual(297, box[3] / 72 * 25.4, delta=1)

    def test_the_dark_style_changes_colours_only(self):
        self.show()
        light = self.browser.execute_script(
            "return getComputedStyle(document.body).backgroundColor")
        self.browser.execute_cdp_cmd(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia",
                        {"features": []})
        dark = self.browser.execute_script("return getComputedStyle(document.body).backgroundColor")
        self.assertNotEqual(light, dark)
        self.assertEqual([], self.browser.execute_script(OVERLAPS))


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "plan_browser", "plan_browser_test", sys.argv)
