# SPDX-License-Identifier: BSD-3-Clause
"""Renders a plan as one self-contained HTML page."""
import json
import pathlib
import re

import jinja2
import markupsafe

from . import chart, figures, words
from .document import Clock, amount, percent

# In a devel space of catkin, the package is a stub that extends its __path__. jinja2.PackageLoader
# does not work there.
TEMPLATES = pathlib.Path(__file__).with_name("templates")
UNIT = re.compile(r"(?<=\d) (?=%)")  # the space in "92 %", at which a line must not break
BASIS = {
    "recorded": "recorded", "forecast": "forecast", "published": "published",
    "estimated": "estimated", "assumed": "assumed", "given": "given by you"
}


def render(plan):
    """Returns the text of the HTML page of a plan."""
    clock, currency = Clock(plan["clock"]), plan["loss"]["currency"]
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES),
                                     autoescape=True,
                                     trim_blocks=True,
                                     lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    environment.filters.update(pct=percent,
                               money=lambda v, sign=False: amount(v, currency, sign),
                               number=lambda v: amount(v, None),
                               gap=lambda v: amount(v, None, True),
                               t=clock.time,
                               dt=clock.day_time,
                               utc=clock.utc,
                               utc_full=clock.utc_full,
                               kind=words.kind_name,
                               keep_units=lambda text: UNIT.sub("\u00a0", text))
    drawing, line = chart.chart(plan), figures.timeline(plan)
    departures = _departures(plan)
    first = min(
        (clock.seconds(r["orders"][0]["time"]) for r in plan["plan"]["routes"] if r["orders"]),
        default=0.0)
    return environment.get_template("plan.html").render(
        plan=plan,
        clock=clock,
        map=drawing,
        timeline=line,
        storm_name=words.storm_name(plan),
        early_wind=words.early_wind(plan),
        orders_of=lambda route: words.merged_orders(plan, route),
        region=figures.region(plan),
        curve=None if words.is_unknown(plan) else figures.curve(plan),
        answers=words.answers(plan),
        basis=BASIS,
        order_text=lambda order: words.order_text(plan, order),
        numbered=lambda i: words.numbered_name(plan, i),
        chance=lambda share: words.chance(plan, share),
        fate=lambda i: words.left_word(plan, i),
        left_reason=lambda left: words.left_reason(plan, left),
        deadline_text=lambda one: words.deadline_text(plan, one),
        no_rings=words.no_rings(plan),
        last_known=(words.last_known(plan)
                    if plan["deadlines"].get("not_known_beyond") else None),
        unknown=words.is_unknown(plan),
        unknown_cause=words.unknown_cause(plan),
        device_name=lambda i: plan["devices"][i]["name"],
        departures=departures,
        first_s=int(first),
        compass=words.compass,
        data=_data(plan, clock, drawing, line))


def _data(plan, clock, drawing, line):
    """Returns the data for the script of the time slider, as JSON that is safe inside a script
    element."""
    routes = []
    for route in plan["plan"]["routes"]:
        points = [[round(v, 1) for v in drawing["frame"].px(x, y)] + [s]
                  for x, y, s in route["path"]]
        events = [[clock.seconds(o["time"]), o["action"], o["device"],
                   o.get("devices", [])] for o in route["orders"]]
        routes.append({"ship": route["ship"], "path": points, "events": events})
    data = {
        "start_ms": int(clock.start.timestamp() * 1000), "offset_min": clock.offset_min,
        "zone": clock.zone, "end_s": line["end_s"], "left": line["left"], "right": line["right"],
        "routes": routes, "hazard": drawing["hazard"],
        "rings": [ring["name"] for ring in plan["rings"]], "no_rings": words.no_rings(plan),
        "timeline": [[clock.seconds(one["time"]), one["probability"]]
                     for one in figures.shown_hazard(plan)]
    }
    text = json.dumps(data, separators=(",", ":"))
    return markupsafe.Markup(text.replace("<", "\\u003c").replace("&", "\\u0026"))


def _departures(plan):
    """Returns {device: time of the first departure of the ship that fetches it}."""
    leaves = {}
    for route in plan["plan"]["routes"]:
        for order in route["orders"]:
            if order["action"] == "fetch":
                leaves[order["device"]] = route["orders"][0]["time"]
    return leaves
