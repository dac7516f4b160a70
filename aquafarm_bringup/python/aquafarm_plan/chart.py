# SPDX-License-Identifier: BSD-3-Clause
"""Computes the map of the ranch for SVG: coast, symbols, routes, labels, and isolines of the
hazard's probability."""
import math

import contourpy
import numpy as np
from scipy.ndimage import gaussian_filter

from .document import Clock
from .labels import Label, place
from .words import chance, compass, kind_name, left_reason, left_word, letter, storm_name

WIDTH, MAX_HEIGHT = 760.0, 860.0  # max width and height of the drawing [px]
LEVELS = (10, 50, 90)  # levels of the isolines [%]
NICE = (1, 2, 5)
LABEL_SIZE = 18.0  # font size [px]
MANY_DEVICES = 10  # if there are more devices, each label has one line


class Frame:
    """Converts map coordinates in cells to pixels of the drawing."""

    def __init__(self, ranch):
        self.scale = min(WIDTH / ranch["width"], MAX_HEIGHT / ranch["height"])
        self.width, self.height = self.scale * ranch["width"], self.scale * ranch["height"]

    def px(self, x, y):
        return (x + 0.5) * self.scale, self.height - (y + 0.5) * self.scale

    def path(self, points, closed=False):
        """Returns the SVG path data of a line through points [cells]."""
        return svg_path([self.px(x, y) for x, y in points], closed)


def svg_path(points, closed=False):
    """Returns the SVG path data of a line through points [px]."""
    text = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return text + "Z" if closed else text


def chart(plan):
    """Returns the data for the template templates/map.svg. Positions are in pixels of the
    drawing."""
    frame = Frame(plan["ranch"])
    routes = [_route(plan, frame, route) for route in plan["plan"]["routes"]]
    devices = [_device(plan, frame, device) for device in plan["devices"]]
    ports = [{"letter": letter(port["id"]), "name": port["name"], "xy": frame.px(*port["cell"])}
             for port in plan["ports"]]
    storm = storm_pointer(plan, frame)
    if storm:
        _keep_away(storm, [one["xy"] for one in devices + ports], frame)
    return {
        "storm": storm, "frame": frame, "coast": _coast(plan["ranch"], frame),
        "rocks": [frame.px(*cell) for cell in plan["ranch"]["rocks"]], "ports": ports,
        "devices": devices, "routes": routes,
        "labels": _labels(plan, frame, devices, ports, routes, storm),
        "ticks": _ticks(plan["ranch"],
                        frame), "scale_bar": _scale_bar(plan["ranch"],
                                                        frame), "hazard": isolines(plan, frame)
    }


def storm_pointer(plan, frame):
    """Returns an arrow with a label, 30 px from the border of the map. The arrow points to the
    storm's centre at the start of the plan. Returns None if this centre is unknown, or on the map
    and at least 30 px from the border."""
    clock, points = Clock(plan["clock"]), plan["storm"]["points"]
    seconds = [clock.seconds(one["time"]) for one in points]
    if not seconds or not seconds[0] <= 0.0 <= seconds[-1]:
        return None
    ranch = plan["ranch"]
    at = [np.interp(0.0, seconds, [one["at"][axis] for one in points]) for axis in (0, 1)]
    east, north = at[0] - (ranch["width"] - 1) / 2, at[1] - (ranch["height"] - 1) / 2
    inset = 30.0
    reach = max(abs(east) * frame.scale / (frame.width / 2 - inset),
                abs(north) * frame.scale / (frame.height / 2 - inset))
    if reach <= 1.0:
        return None
    bearing = math.degrees(math.atan2(east, north)) % 360
    km = math.hypot(east, north) * ranch["cell_size_m"] / 1000
    name = storm_name(plan) or plan["storm"]["kind"]
    return {"xy": (frame.width / 2 + east * frame.scale / reach,
                   frame.height / 2 - north * frame.scale / reach), "bearing": bearing,
            "words": f"{name}: centre {km:,.0f} km {compass(bearing)} "
                     f"({round(bearing) % 360:03d}°) at {clock.time(clock.at(0))}"}


def _keep_away(storm, symbols, frame):
    """Moves the arrow of storm_pointer along the nearest border of the map, by at most 80 px, to
    the closest position that is at least 45 px away from all symbols. Does not move the arrow if
    there is no such position."""
    x, y = storm["xy"]
    is_aside = min(x, frame.width - x) < min(y, frame.height - y)
    for shift in sorted(range(-80, 81, 10), key=abs):
        at = (x, y + shift) if is_aside else (x + shift, y)
        is_inside = 29 < at[0] < frame.width - 29 and 29 < at[1] < frame.height - 29
        if is_inside and all(math.dist(at, symbol) >= 45.0 for symbol in symbols):
            storm["xy"] = at
            return


def _coast(ranch, frame):
    """Returns the path data of the outlines of the land cells, with rounded corners."""
    if not ranch["land"]:
        return ""
    fine, pad = 4, 2
    mask = np.zeros((ranch["height"] + 2 * pad, ranch["width"] + 2 * pad))
    for x, y in ranch["land"]:
        mask[y + pad, x + pad] = 1
    # Land at the border of the map continues outside the map.
    mask[:pad], mask[-pad:] = mask[pad], mask[-pad - 1]
    mask[:, :pad], mask[:, -pad:] = mask[:, pad:pad + 1], mask[:, -pad - 1:-pad]
    smooth = gaussian_filter(np.kron(mask, np.ones((fine, fine))), 0.28 * fine)
    closed = np.pad(smooth, 1)
    # Samples of the fine grid have the indices 1, 2, …; index i is at (i - 0.5) / fine - 0.5 - pad
    # [cells].
    return _outlines(closed, 0.55, frame, lambda i: (i - 0.5) / fine - 0.5 - pad)


def _outlines(field, level, frame, to_cells):
    """Returns the path data of the outlines of the area where a field is above a level. The field
    must be below the level along its border, so that all outlines are closed."""
    lines = contourpy.contour_generator(z=field).lines(level)
    return "".join(frame.path(to_cells(line), True) for line in lines)


def _device(plan, frame, device):
    left = next((one for one in plan["plan"]["left_behind"] if one["device"] == device["id"]), None)
    return {
        "id": device["id"], "name": device["name"], "kind": device["kind"],
        "kind_name": kind_name(device["kind"]), "xy": frame.px(*device["cell"]),
        "home": chance(plan, device["odds"]["home"]), "left": device["order"] is None,
        "fate": left_word(plan, device["id"]),
        "reason": left_reason(plan, left) if left else "",
        "ship": (device["order"] or {}).get("ship")
    }


def _offset(points, distance):
    """Returns a line [px] that runs parallel to `points`, at a distance to starboard. The ways out
    and home then do not overlap."""
    points = np.array(points)
    if len(points) < 2:
        return points
    along = np.gradient(points, axis=0)
    norm = np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    return points + distance * np.stack([-along[:, 1], along[:, 0]], 1) / norm


def _route(plan, frame, route):
    """Returns the ship of a route, and the legs between its orders. `late` determines the shade of
    a leg: 0 if the leg begins when the first ship leaves, 1 if it begins at the end of the
    route."""
    clock = Clock(plan["clock"])
    ends = [clock.seconds(order["time"]) for order in route["orders"]]
    last = max(route["path"][-1][2], 1) if route["path"] else 1
    first = min((one["path"][0][2] for one in plan["plan"]["routes"] if one["path"]), default=0)
    shift = (0.07 + 0.06 * route["ship"]) * frame.scale
    legs = []
    for begin, end in zip(ends, ends[1:]):
        points = [frame.px(x, y) for x, y, s in route["path"] if begin - 1 <= s <= end + 1]
        if len(points) > 1:
            line = _offset(points, min(shift, 6))
            legs.append({
                "d": svg_path(line), "points": line, "late": round(
                    (begin - first) / max(last - first, 1), 2), "arrow": _arrow(line)
            })
    return {"ship": route["ship"], "name": plan["ships"][route["ship"]]["name"], "legs": legs}


def _arrow(line):
    """Returns the centre (x, y) of the middle segment of a line, and the segment's direction
    [degrees clockwise from the x axis]."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    k = int(np.searchsorted(np.cumsum(steps), steps.sum() / 2))
    k = min(k, len(steps) - 1)
    (x0, y0), (x1, y1) = line[k], line[k + 1]
    return (x0 + x1) / 2, (y0 + y1) / 2, math.degrees(math.atan2(y1 - y0, x1 - x0))


def _badges(plan):
    """Returns {device: badge} of the fetched devices. A badge such as 1b consists of the ship's
    number and a letter, which states the position of the device in the ship's order of fetching.
    The letter is lower-case, because ports have capital letters."""
    badges = {}
    for route in plan["plan"]["routes"]:
        fetched = [one["device"] for one in route["orders"] if one["action"] == "fetch"]
        badges.update(
            {device: f"{route['ship'] + 1}{letter(i).lower()}" for i, device in enumerate(fetched)})
    return badges


def samples(line, gap=7.0):
    """Yields points along a line that are at most `gap` pixels apart."""
    for (x0, y0), (x1, y1) in zip(line, line[1:]):
        n = max(1, math.ceil(math.hypot(x1 - x0, y1 - y0) / gap))
        for i in range(n):
            yield x0 + (x1 - x0) * i / n, y0 + (y1 - y0) * i / n


def _labels(plan, frame, devices, ports, routes, storm):
    points = [(*frame.px(x + dx, y + dy), 3.0) for x, y in plan["ranch"]["land"]
              for dx in (-0.45, 0.0, 0.45) for dy in (-0.45, 0.0, 0.45)]
    points += [(*frame.px(x, y), 8.0) for x, y in plan["ranch"]["rocks"]]
    for one in devices + ports:
        points += [(one["xy"][0] + dx, one["xy"][1] + dy, 60.0) for dx in (-8, 0, 8)
                   for dy in (-8, 0, 8)]
    points += [(x, y, 2.5) for route in routes for leg in route["legs"]
               for x, y in samples(leg["points"])]
    clock, badges = Clock(plan["clock"]), _badges(plan)
    labels = []
    for one, device in zip(devices, plan["devices"]):
        lines = ([f"{one['name']} {one['home']}", f"fetch {clock.time(device['order']['fetch'])}"]
                 if device["order"] else [one["name"], one["fate"]])
        lines = lines[:1] if len(devices) > MANY_DEVICES else lines
        labels.append(
            Label(lines,
                  one["xy"],
                  16,
                  LABEL_SIZE,
                  name=f"device-{one['id']}",
                  badge=badges.get(one["id"], ""),
                  ship=one["ship"] or 0))
    labels += [Label([port["name"]], port["xy"], 13, LABEL_SIZE - 2, name="port") for port in ports]
    if storm:
        points.append((*storm["xy"], 60.0))
        labels.append(Label([storm["words"]], storm["xy"], 20, LABEL_SIZE - 2, name="storm"))
    return place(labels, points, frame.width, frame.height)


def nice(target):
    """Returns the largest number of the form 1, 2 or 5 × 10^n that is at most `target`, with a
    tolerance for rounding errors."""
    power = 10.0**math.floor(math.log10(target))
    return max(n * power for n in NICE if n * power <= target * 1.0001)


def _scale_bar(ranch, frame):
    """Returns two scale bars with round lengths: one in km, one in nautical miles."""
    px_per_km = frame.scale * 1000 / ranch["cell_size_m"]
    bars = []
    for unit, km in (("km", 1.0), ("nmi", 1.852)):
        length = nice(frame.width * 0.22 / px_per_km / km)
        bars.append({"px": length * km * px_per_km, "text": f"{length:g} {unit}"})
    return bars


def _ticks(ranch, frame):
    """Returns the ticks of longitude on the lower border and of latitude on the left border."""
    south_west, south_east, _, north_west = ranch["corners"]
    west, east = south_west["longitude"], south_east["longitude"]
    south, north = south_west["latitude"], north_west["latitude"]
    minutes = [
        step for step in (1, 2, 5, 10, 15, 30, 60, 120, 300) if (east - west) * 60 / step <= 6.5
    ][:1] or [600]
    step = minutes[0] / 60

    def inside(low, high):
        edge = 0.04 * (high - low)  # space for half of a tick's text
        return [
            n * step for n in range(math.ceil((low + edge) / step),
                                    math.floor((high - edge) / step) + 1)
        ]

    return {
        "x": [((v - west) / (east - west) * frame.width, _degrees(v, "E", "W"))
              for v in inside(west, east)],
        "y": [(frame.height * (north - v) / (north - south), _degrees(v, "N", "S"))
              for v in inside(south, north)]
    }


def _degrees(value, positive, negative):
    minutes = round(abs(value) * 60)
    return f"{minutes // 60}°{minutes % 60:02}′{positive if value >= 0 else negative}"


def isolines(plan, frame):
    """Returns for each time of plan["hazard"]["frames"] this time [s after the start of the plan],
    and for each ring of the storm the outlines of the areas with a probability of at least 10, 50
    and 90 %.

    frame: the Frame (position and scale) of the drawing
    """
    ranch, clock, result = plan["ranch"], Clock(plan["clock"]), []
    for one in plan["hazard"]["frames"]:
        rings = []
        for grid in one["percent"]:
            outlines = []
            if grid:
                # The border cells are repeated once. A border of zeros around them closes the
                # outlines outside the map.
                field = np.pad(
                    np.pad(np.array(grid, float).reshape(ranch["height"], ranch["width"]),
                           1,
                           mode="edge"), 1)
                outlines = [
                    _outlines(field, level - 0.5, frame, lambda i: i - 2) for level in LEVELS
                ]
            rings.append(outlines)
        result.append({"s": clock.seconds(one["time"]), "rings": rings})
    return result
