# SPDX-License-Identifier: BSD-3-Clause
"""Computes drawings of a plan's page: the region of the storm, the timeline and the loss curves.
chart.py computes the map."""
import datetime
import math

from . import coast
from .chart import nice, samples, svg_path
from .document import Clock, amount, parse_time
from .labels import Label, place, shorten
from .words import compass, first_deadlines, is_unknown, letter, numbered_name, order_text

REGION = 400.0  # side of the drawing of the region [px]
REGION_LABELS = 4  # max number of labelled positions of the storm
LINE = (1100.0, 104.0)  # width and left margin of the timeline [px]
TOP, HAZARD_HEIGHT, ROW, AXIS = 20.0, 50.0, 27.0, 48.0  # heights in the timeline [px]
NEAREST_H = 72  # max time from the plan's start to a closest approach that extends the timeline [h]
CURVE = (520.0, 270.0, 58.0, 44.0)  # width, height, left and lower margin of the loss curve [px]


def region(plan):
    """Returns the data of the drawing of the region, in pixels: the storm's track, the forecast
    error, the rings at the future storm position nearest to the ranch, and the coast. None if no
    position of the storm is known."""
    clock, ranch = Clock(plan["clock"]), plan["ranch"]
    cell_km = ranch["cell_size_m"] / 1000
    middle = [(ranch["width"] - 1) / 2, (ranch["height"] - 1) / 2]
    first = clock.start - datetime.timedelta(hours=12)
    last = min(clock.end, clock.start + datetime.timedelta(seconds=horizon_s(plan), hours=6))
    points = [p for p in plan["storm"]["points"] if first <= parse_time(p["time"]) <= last]
    points = points or plan["storm"]["points"][-1:]
    if not points:
        return None
    errors = [e for e in plan["ensemble"]["errors"] if parse_time(e["time"]) <= last]
    reach = [(middle[0], middle[1], 40 / cell_km)]
    reach += [(*p["at"], 30 / cell_km) for p in points]
    reach += [(*e["centre"], e["radius70_km"] / cell_km) for e in errors]
    west, east = min(x - r for x, _, r in reach), max(x + r for x, _, r in reach)
    south, north = min(y - r for _, y, r in reach), max(y + r for _, y, r in reach)
    side = 1.06 * max(1.5 * (east - west), north - south)
    scale = REGION / side

    # There is more space to the right of the track, where most labels are.
    left, top = west - 0.25 * (side - east + west), (south + north + side) / 2

    def px(x, y):
        return (x - left) * scale, (top - y) * scale

    drawn = [{
        "xy": px(*p["at"]), "source": p["source"], "time": clock.day_time(p["time"]),
        "wind": p["wind_mps"], "is_now": abs(clock.seconds(p["time"])) < 60.0,
        "is_future": clock.seconds(p["time"]) > 0.0
    } for p in points]
    rings, caption = _region_rings(plan, points, middle, px, scale / cell_km, clock)
    bar = [{"px": n * km / cell_km * scale, "text": f"{n:g} {unit}"}
           for unit, km in (("km", 1), ("nmi", 1.852)) for n in [nice(side * cell_km * 0.25 / km)]]
    lines = {
        source: svg_path([px(*p["at"]) for p in part]) for source, part in _parts(points)
        if len(part) > 1
    }
    rim = 0.02 * side  # margin beyond the drawing, which hides the edges of the clipped coast
    land = coast.rings(
        ranch["origin"], ranch["cell_size_m"],
        (left - rim, top - side - rim, left + side + rim, top + rim)) \
        if side * cell_km >= coast.LEAST_KM else []
    corner = px(-0.5, ranch["height"] - 0.5)
    box = {
        "x": corner[0], "y": corner[1], "w": max(ranch["width"] * scale, 5),
        "h": max(ranch["height"] * scale, 5)
    }
    return {
        "side": REGION, "points": _apart(drawn, 10.0), "lines": lines, "rings": rings, "scale_bar": bar,
        "cone": _cone(errors, px, scale / cell_km), "ranch": box, "caption": caption,
        "labels": _region_labels(plan, drawn, rings, box),
        "coast": "".join(svg_path([px(*corner) for corner in ring], True) for ring in land)
    }


def _apart(drawn, least):
    """Returns points of a track that are at least `least` pixels apart. The first, the present and
    the last point are always included."""
    kept = []
    for one in drawn:
        if (not kept or math.dist(one["xy"], kept[-1]["xy"]) >= least or one["is_now"]
                or one is drawn[-1]):
            kept.append(one)
    return kept


def _region_labels(plan, drawn, rings, box):
    """Returns the placed labels: the ranch; time and wind of the storm now and at some future
    positions; the names of the rings."""
    centre = (box["x"] + box["w"] / 2, box["y"] + box["h"] / 2)
    labels = [Label(["ranch"], centre, box["w"] / 2 + 2, 14, name="ranch-name")]
    now = [one for one in drawn if one["is_now"]][:1]  # empty if no point is at the plan's start
    ahead = [one for one in drawn if one["is_future"]] or drawn[-1:]
    others = [one for one in ahead[::math.ceil(len(ahead) / (REGION_LABELS - 1))]
              if all(math.dist(one["xy"], at["xy"]) > 40.0 for at in now)]
    for one in now + others:
        words = one["time"].split(" ", 1)[1]
        words += "" if one["wind"] is None else f", {one['wind']:.0f} m/s"
        labels.append(Label([f"now: {words}" if one["is_now"] else words], one["xy"], 6, 12,
                            name=one["source"]))
    for ring in rings:
        x, y = ring["xy"][0], ring["xy"][1] + ring["r"]
        name = plan["rings"][ring["ring"]]["name"].partition(" (")[0]  # the timeline has the wind
        labels.append(Label([name], (x, y), 3, 12, name="ring"))
    points = [(*one["xy"], 30.0) for one in drawn] + [(*centre, 90.0)]
    points += [(ring["xy"][0] + ring["r"] * math.cos(math.tau * i / 180),
                ring["xy"][1] + ring["r"] * math.sin(math.tau * i / 180), 8.0)
               for ring in rings for i in range(180)]
    points += [(x, y, 8.0) for a, b in zip(drawn, drawn[1:])
               for x, y in samples([a["xy"], b["xy"]])]
    return place(labels, points, REGION, REGION - 36)


def _parts(points):
    """Yields (source, points) of the recorded, forecast and assumed parts of a track. A later part
    begins at the last point of the part before it."""
    for source in ("recorded", "forecast", "assumed"):
        part = [i for i, p in enumerate(points) if p["source"] == source]
        if part:
            yield source, points[max(part[0] - 1, 0):part[-1] + 1]


def _region_rings(plan, points, middle, px, px_per_km, clock):
    """Returns (rings, caption) of the storm position nearest to the ranch, among the future
    positions with a wind radius above 0."""
    future = [p for p in points if parse_time(p["time"]) > clock.start and any(p["radii_km"])]
    if not future:
        return [], "No rings: no position after the start has a known wind radius above 0."
    nearest = min(future, key=lambda p: math.dist(p["at"], middle))
    rings = [{
        "xy": px(*nearest["at"]), "r": radius * px_per_km, "ring": i,
        "time": clock.day_time(nearest["time"])
    } for i, radius in enumerate(nearest["radii_km"]) if radius]
    return rings, (f"Rings at {clock.day_time(nearest['time'])}, the future point nearest to the "
                   "ranch.")


def _cone(errors, px, px_per_km):
    """Returns shapes whose union is the forecast cone: circles, and the areas between the outer
    tangents of successive circles."""
    circles = [(*px(*e["centre"]), e["radius70_km"] * px_per_km) for e in errors]
    shapes = [
        f"M{x - r:.1f} {y:.1f}a{r:.1f} {r:.1f} 0 1 0 {2 * r:.1f} 0"
        f"a{r:.1f} {r:.1f} 0 1 0 {-2 * r:.1f} 0Z"
        for x, y, r in circles if r > 0
    ]
    for (x0, y0, r0), (x1, y1, r1) in zip(circles, circles[1:]):
        gap = math.hypot(x1 - x0, y1 - y0)
        if gap <= abs(r1 - r0) or gap == 0:
            continue
        heading, spread = math.atan2(y1 - y0, x1 - x0), math.acos((r0 - r1) / gap)
        corner = [(x + r * math.cos(heading + side), y + r * math.sin(heading + side))
                  for x, y, r, side in ((x0, y0, r0, spread), (x1, y1, r1, spread),
                                        (x1, y1, r1, -spread), (x0, y0, r0, -spread))]
        shapes.append(svg_path(corner, True))
    return shapes


def horizon_s(plan):
    """Returns the end of the timeline [s after the start]: three hours after the latest of the
    orders, the rings' median arrival times at the devices, the last departures and a closest
    approach within NEAREST_H, but at most the end of the plan. Returns the end of the plan if there
    are no such events."""
    clock = Clock(plan["clock"])
    end = (clock.end - clock.start).total_seconds()
    events = [clock.seconds(o["time"]) for r in plan["plan"]["routes"] for o in r["orders"]]
    events += [clock.seconds(a["q50"]) for d in plan["devices"] for a in d["arrival"] if a["q50"]]
    events += [clock.seconds(t) for t in (plan["deadlines"]["no_departure_after"], ) if t]
    events += [clock.seconds(leave) for leave, _ in first_deadlines(plan).values()]
    nearest = plan["storm"]["closest_approach"]
    if nearest and 0.0 <= clock.seconds(nearest["time"]) <= NEAREST_H * 3600:
        events.append(clock.seconds(nearest["time"]))
    return min(end, max(events) + 3 * 3600) if events else end


def shown_hazard(plan):
    """Returns the hazard over time. Empty if all probabilities are 0, or if they mean nothing
    because the winds are unknown."""
    times = plan["hazard"]["timeline"]
    shown = any(any(one["probability"]) for one in times) and not is_unknown(plan)
    return times if shown else []


def timeline(plan):
    """Returns the data of the timeline: for each ring, the curve of the probability that it covers
    a cell of the ranch; below the curves, a row of orders for each ship that leaves."""
    clock, (width, left) = Clock(plan["clock"]), LINE
    end = max(horizon_s(plan), 3600)
    inner = width - left - 26

    def x_of(seconds):
        return left + inner * min(max(seconds / end, 0), 1)

    curves = []
    for i, ring in enumerate(plan["rings"]):
        points = [(x_of(clock.seconds(one["time"])),
                   HAZARD_HEIGHT * (1 - one["probability"][i]) + TOP)
                  for one in shown_hazard(plan) if 0 <= clock.seconds(one["time"]) <= end]
        if points:
            base = HAZARD_HEIGHT + TOP
            curves.append({
                "name": ring["name"], "line": svg_path(points), "ring": i,
                "area": svg_path([(points[0][0], base), *points, (points[-1][0], base)], True)
            })
    rows = [
        _row(plan, route, clock, x_of, TOP + HAZARD_HEIGHT + 14 + i * ROW)
        for i, route in enumerate(plan["plan"]["routes"])
    ]
    height = TOP + HAZARD_HEIGHT + 14 + max(len(rows), 1) * ROW + AXIS
    last = plan["deadlines"]["no_departure_after"]
    limit = x_of(clock.seconds(last)) if last else width - 26
    _mark_deadlines(plan, rows, clock, x_of, limit)
    _name_ends(plan, rows, clock, limit)
    return {
        "width": width, "height": height, "left": left, "right": width - 26, "top": TOP,
        "base": HAZARD_HEIGHT + TOP, "axis": height - AXIS, "curves": curves, "rows": rows,
        "ticks": _time_ticks(clock, end, x_of), "dates": _dates(clock, end, x_of), "end_s": end,
        "last": {"x": x_of(clock.seconds(last)), "text": clock.time(last)} if last else None,
        "nearest": _nearest(plan, clock, end, x_of)
    }


def _nearest(plan, clock, end, x_of):
    """Returns position and text of the closest approach on the timeline; None if the approach is
    unknown or outside the timeline."""
    nearest = plan["storm"]["closest_approach"]
    if not nearest or not 0.0 <= clock.seconds(nearest["time"]) <= end:
        return None
    x = x_of(clock.seconds(nearest["time"]))
    return {"x": x, "is_right": x > 0.8 * LINE[0],
            "text": f"centre {nearest['distance_km']:.0f} km {compass(nearest['bearing_deg'])}, "
                    f"{clock.time(nearest['time'])}"}


def _end_of(row):
    """Returns the end of the last bar of a row [px]; the left end of the axis without a bar."""
    return row["bars"][-1]["x"] + row["bars"][-1]["w"] if row["bars"] else LINE[1]


def _mark_deadlines(plan, rows, clock, x_of, right):
    """Sets the key `deadline` of each row to the mark of the ship's time in first_deadlines: its
    position, its time, and whether the time has space between the bars and `right` [px]. None
    without such a time."""
    deadlines = first_deadlines(plan)
    for row in rows:
        leave, device = deadlines.get(row["ship"], (None, None))
        row["deadline"] = None
        if leave:
            x, time = x_of(clock.seconds(leave)), clock.time(leave)
            row["deadline"] = {
                "x": x, "time": time, "is_named": _end_of(row) < x < right - 8.0 * len(time) - 8.0,
                "title": f"leave by {time} for a chance of 80 % to bring "
                         f"{plan['devices'][device]['name']} home"}


def _name_ends(plan, rows, clock, right):
    """Sets the key `end` of each row: a text after the last bar that states when the ship is back
    in port. In the first row, the text also explains the bars, if there is space. The text is empty
    if it would extend beyond `right` [px] or the mark of a deadline, or if the row has no bars."""
    for i, (row, route) in enumerate(zip(rows, plan["plan"]["routes"])):
        time = clock.time(route["orders"][-1]["time"]) if row["bars"] else ""
        texts = [f"in port {time}; dark: to a device, light: to a port"] if i == 0 else []
        end, mark = _end_of(row), row["deadline"]
        limit = min(right, mark["x"] - 8.0) if mark and mark["x"] > end else right
        row["end"] = next((text for text in [*texts, f"in port {time}", time]
                           if time and end + 6.6 * len(text) < limit), "")


def _row(plan, route, clock, x_of, y):
    bars = []
    for before, order in zip(route["orders"], route["orders"][1:]):
        x0, x1 = x_of(clock.seconds(before["time"])), x_of(clock.seconds(order["time"]))
        waits = order["action"] in ("leave", "wait")  # the ship is in port until this order
        if waits and x1 - x0 < 1:
            continue
        name = (plan["devices"][order["device"]]["name"] if order["action"] == "fetch" else
                letter(order["port"]) if order["port"] is not None else "")
        bars.append({
            "x": x0, "w": max(x1 - x0, 1), "text": name if x1 - x0 > 9 * len(name) + 3 else "",
            "kind": "wait" if waits else order["action"],
            "title": f"{order_text(plan, order)}, {clock.time(order['time'])}"
        })
    return {
        "y": y, "ship": route["ship"], "bars": bars,
        "name": shorten(numbered_name(plan, route["ship"]), LINE[1] - 14, 14)
    }


def _time_ticks(clock, end, x_of):
    """Returns the ticks of the time axis, at round hours of local time: at most about 13 ticks, at
    midnight if they are a day or more apart."""
    step = next((h for h in (1, 2, 3, 6, 12, 24, 48) if end / 3600 / h <= 13), 96)
    local = clock.local(clock.at(0)).replace(minute=0, second=0)
    ticks = []
    for hour in range(0, int(end // 3600) + 2):
        moment = local + datetime.timedelta(hours=hour)
        seconds = (moment - clock.start).total_seconds()
        if 0 <= seconds <= end and (24 * moment.toordinal() + moment.hour) % step == 0:
            utc = moment.astimezone(datetime.timezone.utc)
            ticks.append({"x": x_of(seconds), "time": f"{moment:%H:%M}", "utc": f"{utc:%H:%M}"})
    return ticks


DATE_WIDTH = 84.0  # width of a date below the axis [px]


def _dates(clock, end, x_of):
    """Returns the local dates below the axis: the first at the start of the plan, the others at
    midnight. Dates without space are left out."""
    first = clock.local(clock.at(0))
    days = [first]
    while (days[-1] - clock.start).total_seconds() <= end:
        days.append(days[-1].replace(hour=0, minute=0, second=0) + datetime.timedelta(days=1))
    dates = []
    for day in reversed(days[:-1]):  # of two dates that are too close, the later one is kept
        x = x_of((day - clock.start).total_seconds())
        if not dates or dates[0]["x"] - x >= DATE_WIDTH:
            dates.insert(0, {"x": x, "text": f"{day:%a} {day.day} {day:%b}",
                             "is_midnight": day is not first})
    return dates


def curve(plan):
    """Returns the data of two exceedance curves of the loss: with the plan, and if no ship
    leaves."""
    width, height, left, lower = CURVE
    loss = plan["loss"]
    top = max([x for name in ("with_plan", "idle") for x, _ in loss[name]["exceedance"]] + [0.0])
    top = top or max(loss["insured"], 1.0)

    def px(x, p):
        return left + (width - left - 54) * x / top, 10 + (height - lower - 10) * (1 - p)

    lines = []
    for name in ("idle", "with_plan"):
        steps, before = [], None
        for x, p in [[0.0, 1.0]] + loss[name]["exceedance"]:
            if before is not None:
                steps.append(px(x, before))
            steps.append(px(x, p))
            before = p
        lines.append({"name": name, "d": svg_path(steps), "mean": px(loss[name]["mean"], 0)[0]})
    step = nice(top / 4)
    ticks = [{"x": px(i * step, 0)[0], "text": amount(i * step, None)}
             for i in range(int(top / step) + 1)]
    return {
        "width": width, "height": height, "left": left, "base": px(0, 0)[1], "top": px(0, 1)[1],
        "right": width - 54, "lines": lines, "ticks": ticks,
        "shares": [{"y": px(0, p)[1], "text": f"{p:.0%}".replace("%", " %")}
                   for p in (0, .25, .5, .75, 1)], "twentieth": px(0, 0.05)[1]
    }
