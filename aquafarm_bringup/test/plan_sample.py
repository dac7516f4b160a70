#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sample plan files for tests of the plan page.

A test fixture, not a plan: routes are greedy, the storm's errors are round numbers, and the ranch
and its devices are invented. The storm is typhoon In-Fa (2021) as in zhoushan_infa_2021.yaml.
`plan_sample.py FILE` writes the sample to a file.
"""
import collections
import copy
import datetime
import json
import sys

import numpy as np

from aquafarm_plan.geodesy import LocalPlane

START = datetime.datetime(2021, 7, 24, 0, tzinfo=datetime.timezone.utc)
HOURS, STEP_S, CELL_M, SIZE = 42, 600, 600, 25
PLANE = LocalPlane(30.135029, 122.625277)
LAND = [(22, 0, 3, 1), (22, 1, 1, 1), (15, 7, 2, 1), (4, 10, 1, 4), (10, 10, 2, 2), (14, 10, 1, 2),
        (3, 11, 1, 4), (9, 11, 1, 3), (13, 11, 1, 3), (8, 12, 1, 2), (10, 12, 1, 1), (2, 13, 1, 1),
        (14, 13, 1, 1)]
ROCKS = [(23, 1), (24, 1), (15, 6), (15, 8), (16, 8), (10, 9), (11, 9), (16, 9), (3, 10), (5, 10)]
PORTS = [(12, 12), (21, 0), (1, 14), (16, 6)]
DEVICES = [("F1", "deep_water_breeding", (4, 3), 1800000),
           ("F2", "deep_water_breeding", (8, 21), 1650000),
           ("F3", "breeding_release", (19, 12), 900000),
           ("F4", "temporary_breeding", (20, 20), 640000), ("F5", "monitoring", (12, 4), 210000),
           ("F6", "temporary_breeding", (2, 22), 480000)]
SPEED_KN = 4.0
# Hours since START, latitude, longitude, m/s, radii of the winds of 64, 50 and 34 kt in km.
TRACK = [(-18, 25.2, 125.4, 38, (40, 95, 241)), (-12, 25.6, 125.1, 38, (40, 95, 241)),
         (-6, 26.0, 124.9, 38, (40, 95, 241)), (0, 26.4, 124.6, 38, (40, 95, 241)),
         (6, 27.2, 124.3, 38, (40, 95, 241)), (12, 27.9, 124.1, 38, (40, 95, 241)),
         (18, 28.6, 123.7, 35, (40, 95, 241)), (24, 29.7, 123.0, 35, (40, 95, 241)),
         (30, 30.0, 122.2, 33, (40, 95, 241)), (42, 30.4, 121.5, 28, (0, 80, 229)),
         (54, 30.8, 120.9, 25, (0, 0, 180))]
RINGS = [{"id": f"{knots}kt", "name": f"{name} ({knots} kt)", "wind_kt": knots, "risk": risk}
         for knots, name, risk in ((64, "hurricane", -20), (50, "storm", -10), (34, "gale", -5))]


def stamp(hours):
    return (START + datetime.timedelta(hours=float(hours))).strftime("%Y-%m-%dT%H:%M:%SZ")


def position(x, y):
    latitude, longitude = PLANE.to_geo(x * CELL_M, y * CELL_M)
    return {"latitude": round(float(latitude), 5), "longitude": round(float(longitude), 5)}


def centre_of(latitude, longitude):
    x, y = PLANE.to_plane(latitude, longitude)
    return [round(float(x) / CELL_M, 2), round(float(y) / CELL_M, 2)]


def land_cells():
    return [(x + i, y + j) for x, y, w, h in LAND for i in range(w) for j in range(h)]


def route(start, goal, closed):
    """Returns the cells of the shortest path over water, without `start`."""
    back, queue = {start: None}, collections.deque([start])
    while queue:
        cell = queue.popleft()
        if cell == goal:
            path = []
            while cell != start:
                path.append(cell)
                cell = back[cell]
            return path[::-1]
        for dx, dy in ((0, 1), (0, -1), (-1, 0), (1, 0), (-1, 1), (1, 1), (-1, -1), (1, -1)):
            step = (cell[0] + dx, cell[1] + dy)
            if set(step) <= set(range(SIZE)) and step not in closed and step not in back:
                back[step] = cell
                queue.append(step)
    raise ValueError(f"no way from {start} to {goal}")


class Futures:
    """Members of the ensemble: centres and sizes of the storm at each step."""

    def __init__(self, members, seed):
        rng = np.random.default_rng(seed)
        self.hours = np.arange(0, HOURS + 1e-9, STEP_S / 3600)
        at = [row[0] for row in TRACK]
        places = np.array([centre_of(row[1], row[2]) for row in TRACK])
        self.track = np.stack([np.interp(self.hours, at, places[:, i]) for i in (0, 1)], 1)
        self.radii = np.stack(
            [np.interp(self.hours, at, [row[4][i] for row in TRACK])
             for i in range(3)], 1) * 1000 / CELL_M
        grow = (15 + 2.5 * self.hours) * 1000 / CELL_M  # one standard deviation [cells]
        error = rng.normal(size=(members, 1, 2)) * grow[None, :, None]
        self.centres = self.track[None] + error
        self.size = np.exp(rng.normal(size=(members, 1, 1)) * 0.2)
        self.grow = grow

    def reach(self, cells):
        """Returns whether each ring covers a cell, bool [members, steps, 3]. cells: one per step"""
        distance = np.linalg.norm(self.centres - np.asarray(cells, float)[None], axis=2)
        return distance[:, :, None] <= self.radii[None] * self.size

    def arrival(self, cell):
        """Returns the first hour in which each ring covers a cell, [members, 3]; inf: never."""
        covered = self.reach([cell] * len(self.hours))
        first = np.where(covered.any(1), self.hours[covered.argmax(1)], np.inf)
        return first


def km(path, start):
    cells = np.array([start, *path], float)
    return float(np.linalg.norm(np.diff(cells, axis=0), axis=1).sum()) * CELL_M / 1000


def make_route(ship, port, leave_h, stops, closed, futures):
    """Returns the route of a ship that brings each device of `stops` to the nearest port."""
    hours_per_km = 1 / (SPEED_KN * 1.852)
    at, now, path, orders, total = PORTS[port], leave_h, [[*PORTS[port], leave_h * 3600]], [], 0.0

    def go(goal):
        nonlocal at, now, total
        cells, length, before = route(at, goal, closed), 0.0, at
        for cell in cells:
            piece = km([cell], before)
            length += piece
            now += piece * hours_per_km
            path.append([*cell, int(now * 3600)])
            before = cell
        at, total = goal, total + length
        return length

    def order(action, length, device=None, port=None):
        orders.append({
            "action": action, "time": stamp(now), "cell": list(at), "position": position(*at),
            "device": device, "port": port, "km": round(length, 2), "kwh": round(length * 5.2, 1),
            "probability": safe_until(now)
        })

    def safe_until(hour):
        t = np.array([point[2] / 3600 for point in path])
        cells = np.stack(
            [np.interp(futures.hours, t, [point[i] for point in path]) for i in (0, 1)], 1)
        while_out = (futures.hours >= leave_h) & (futures.hours <= hour)
        hit = (futures.reach(cells)[:, :, 2] & while_out[None]).any(1)
        return round(float(1 - hit.mean()), 3)

    order("leave", 0.0, port=port)
    for device in stops:
        order("fetch", go(DEVICES[device][2]), device=device)
        nearest = min(range(len(PORTS)), key=lambda p: len(route(at, PORTS[p], closed)))
        length = go(PORTS[nearest])
        order("deliver", length, port=nearest)
        orders[-1]["devices"] = [device]
    return {
        "ship": ship, "km": round(total, 1), "kwh": round(total * 5.2, 1), "orders": orders,
        "path": path
    }


def loss_of(values):
    values = np.sort(values)
    n = len(values)
    points = [[float(values[i]), round(1 - (i + 1) / n, 4)] for i in range(0, n, max(1, n // 100))]
    worst = values[-max(1, n // 20):]
    return {
        "mean": round(float(values.mean()), 2),
        "standard_error": round(float(values.std() / np.sqrt(n)), 2), **{
            f"q{q:02}": round(float(np.quantile(values, q / 100)), 2) for q in (5, 50, 95)
        }, "cvar05": round(float(worst.mean()), 2), "exceedance": points
    }


def damage(futures, device, home):
    """Returns the loss of a device, [members]: 0 at home, else by its hours in the rings."""
    cell, value = DEVICES[device][2], DEVICES[device][3]
    exposed = futures.reach([cell] * len(futures.hours)).sum(1) * (STEP_S / 3600)
    share = np.clip(exposed @ np.array([0.10, 0.03, 0.005]), 0, 1)
    return np.where(home, 0.0, share) * value


def quantile_time(first, q):
    value = np.quantile(first, q, method="lower")
    return stamp(value) if np.isfinite(value) else None


def order_of(i, routes):
    """Returns (ship, order to fetch, order to deliver) of device i; None if no ship fetches it."""
    for one in routes:
        for fetch, deliver in zip(one["orders"][1::2], one["orders"][2::2]):
            if fetch["device"] == i:
                return one["ship"], fetch, deliver
    return None


def sample_device(i, routes, closed, futures, rng):
    """Returns the entry of device i, and by member: loss, loss without a plan, comes home."""
    name, kind, cell, value = DEVICES[i]
    arrival, members = futures.arrival(cell), futures.size.shape[0]
    home, hour, order = np.zeros(members, bool), np.inf, None
    if stops := order_of(i, routes):
        ship, fetch, deliver = stops
        home = rng.random(members) < deliver["probability"]
        hour = (datetime.datetime.fromisoformat(deliver["time"].replace("Z", "+00:00")) -
                START).total_seconds() / 3600
        order = {"ship": ship, "port": deliver["port"], "fetch": fetch["time"],
                 "deliver": deliver["time"]}
    lost, idle = damage(futures, i, home), damage(futures, i, np.zeros(members, bool))
    nearest = min(len(route(cell, port, closed)) for port in PORTS)
    trip_h = nearest * CELL_M / 1000 * 2.2 / (SPEED_KN * 1.852)
    chances = (0.95, 0.8, 0.5)
    latest = [float(np.quantile(arrival[:, 2], 1 - p)) - trip_h for p in chances]
    device = {
        "id": i, "name": name, "kind": kind, "cell": list(cell), "position": position(*cell),
        "value": value, "damage_before": 0.15 if i == 5 else 0.0, "order": order,
        "odds": {
            "home": round(float(home.mean()), 3),
            "home_before": [round(float((home & (hour <= arrival[:, r])).mean()), 3)
                            for r in range(3)]},
        "arrival": [{
            "probability": round(float(np.isfinite(arrival[:, r]).mean()), 3),
            **{f"q{int(q * 100):02}": quantile_time(arrival[:, r], q) for q in (0.05, 0.5, 0.95)}
        } for r in range(3)],
        "expected_damage": round(float(lost.mean()) / value, 4),
        "expected_loss": round(float(lost.mean()), 2),
        "expected_loss_idle": round(float(idle.mean()), 2),
        "deadlines": [{"probability": p, "leave": stamp(h) if 0 <= h < HOURS else None, "ship": 0,
                       "open": False} for p, h in zip(chances, latest)]}
    return device, lost, idle, home


def sample_change(name, text, extra, mean_loss, home_count):
    """Returns an entry of what_if. extra: additional mean loss; None: the change is impossible"""
    entry = {"change": name, "text": text, "possible": extra is not None, "mean_loss": None,
             "q95": None, "devices_home": None, "all_home": None, "difference": None}
    if extra is None:
        return entry
    half = abs(extra) * 0.08
    return {
        **entry, "mean_loss": round(float(mean_loss.mean()) + extra, 2),
        "q95": round(float(np.quantile(mean_loss, 0.95)) + extra, 2),
        "devices_home": round(float(home_count.mean()) - extra / 6e5, 2),
        "all_home": 0.0 if extra >= 0 else 0.81,
        "difference": {"mean": round(extra, 2), "low": round(extra - half, 2),
                       "high": round(extra + half, 2)}}


def sample_hazard(futures):
    """Returns the hazard of the ranch by hour, and that of each cell every second hour."""
    grid = np.stack(np.meshgrid(np.arange(SIZE), np.arange(SIZE)), -1).reshape(-1, 2)

    def percent(hour):
        k = int(round(hour * 3600 / STEP_S))
        gap = np.linalg.norm(futures.centres[:, k, None] - grid[None], axis=2)
        covered = [(gap <= futures.radii[k, r] * futures.size[:, 0]).mean(0) for r in range(3)]
        return [[] if one.max() < 0.005 else np.rint(one * 100).astype(int).tolist()
                for one in covered]

    any_cell = [futures.reach([corner] * len(futures.hours))
                for corner in ((0, 0), (24, 0), (0, 24), (24, 24), (12, 12))]
    over = np.logical_or.reduce(any_cell).mean(0)
    return {
        "timeline": [{"time": stamp(h),
                      "probability": [round(float(v), 3) for v in over[int(h * 6)]]}
                     for h in np.arange(0, HOURS + .1, 1)],
        "frames": [{"time": stamp(h), "percent": percent(h)} for h in range(0, HOURS + 1, 2)]}


def sample_storm():
    return {
        "kind": "typhoon", "name": "In-Fa (2106)", "agency": "CMA", "file": "202106.json",
        "issued": stamp(0), "age_h": 0.5, "hindcast": False, "recorded_until": stamp(0),
        "forecast_until": stamp(54), "points": [{
            "time": stamp(h), "source": "recorded" if h <= 0 else "forecast",
            "position": {"latitude": lat, "longitude": lon}, "at": centre_of(lat, lon),
            "wind_mps": wind, "wind_minutes": 2, "pressure_hpa": None, "grade": 3,
            "radii_km": list(radii), "radii_source": "recorded" if h <= 0 else "estimated"
        } for h, lat, lon, wind, radii in TRACK],
        "closest_approach": {"time": stamp(27), "distance_km": 31.0, "bearing_deg": 211.0}}


def sample_errors(futures):
    return [{
        "lead_h": h, "time": stamp(h), "centre": [round(float(v), 2) for v in futures.track[h * 6]],
        "along_km": 15 + 2.5 * h, "across_km": 15 + 2.5 * h,
        "radius70_km": round(1.552 * (15 + 2.5 * h), 1), "wind_mps": 1 + 0.2 * h, "size_log": 0.2
    } for h in range(0, HOURS + 1, 6)]


def sample_place():
    """Returns the part of the plan with ranch, rings, ports and ships."""
    return {
        "ranch": {
            "name": "dongji", "description": "Ranch off the Dongji islands (test fixture).",
            "width": SIZE, "height": SIZE, "cell_size_m": CELL_M, "origin": position(0, 0),
            "corners": [position(x, y)
                        for x, y in ((-.5, -.5), (24.5, -.5), (24.5, 24.5), (-.5, 24.5))],
            "land": [list(c) for c in land_cells()], "rocks": [list(c) for c in ROCKS]},
        "rings": RINGS,
        "ports": [{"id": i, "name": f"port {'ABCD'[i]}", "cell": list(c), "position": position(*c)}
                  for i, c in enumerate(PORTS)],
        "ships": [{"id": i, "name": f"Puhai {i + 1}", "cell": list(PORTS[p]),
                   "position": position(*PORTS[p]), "port": p, "speed_kn": SPEED_KN,
                   "capacity": 1, "ready": stamp(6)} for i, p in enumerate((0, 3))]}


def sample_head(seed):
    """Returns the part of the plan from `format` to `clock`."""
    return {
        "format": "aquafarm_plan", "version": 1, "provenance": {
            "program_version": "0.2.0", "seed": seed, "computed_at": stamp(0.05), "compute_s": 4.2,
            "command": "aquafarm_plan dongji.yaml --bulletin 202106.json --ships 2 --depart +6h",
            "scenario_name": "dongji", "scenario_hash": "test fixture, no scenario",
            "inputs": [{"role": "bulletin", "path": "202106.json", "hash": "test fixture"}]
        }, "outcome": {
            "kind": "plan", "exit_code": 0,
            "text": "Two ships bring five of six devices home; F6 is left behind."
        }, "warnings": [{
            "code": "device_left_behind", "severity": "warning",
            "text": "F6 is left behind: no ship can bring it to a port before the gale in more than 31 % of the futures.",
            "advice": "Secure it on site, or add a ship (see What if)."
        }, {
            "code": "known_until", "severity": "note",
            "text": "The storm is recorded until 2021-07-24 00:00 UTC and forecast until 2021-07-26 06:00 UTC.",
            "advice": "Plan again when the next bulletin arrives."
        }], "clock": {
            "start": stamp(0), "end": stamp(HOURS), "step_s": STEP_S, "utc_offset_min": 480,
            "zone": "UTC+8"}}


CHANGES = [("none", "this plan", 0.0), ("ships+1", "one ship more", -92000.0),
           ("capacity+1", "capacity 2 instead of 1", -61000.0),
           ("depart+3h", "leave 3 hours later", 118000.0),
           ("port_closed:0", "port A closed", 143000.0),
           ("ships-1", "one ship fewer", 402000.0),
           ("depart+12h", "leave 12 hours later", 950000.0),
           ("port_closed:3", "port D closed", None)]
ASSUMPTIONS = [("position error of the forecast", "15 km + 2.5 km per hour of lead", "assumed",
                "test fixture"),
               ("radii of the forecast winds", "spread 20 %", "estimated", "test fixture"),
               ("a ship stops work", "wind of 34 kt at its cell", "given", "--abort-wind 34"),
               ("positions until 2021-07-24 00:00 UTC", "4 fixes", "recorded",
                "CMA bulletin 202106.json")]


def sample(members=1000, seed=1):
    """Returns the sample plan file as a dictionary."""
    futures = Futures(members, seed)
    closed = set(land_cells()) | set(ROCKS)
    routes = [make_route(0, 0, 6, [1, 0], closed, futures),
              make_route(1, 3, 6, [2, 3, 4], closed, futures)]
    rng = np.random.default_rng(seed + 1)
    parts = [sample_device(i, routes, closed, futures, rng) for i in range(len(DEVICES))]
    devices = [part[0] for part in parts]
    mean_loss, idle_loss, home_count = (sum(part[k] for part in parts) for k in (1, 2, 3))
    return {
        **sample_head(seed), **sample_place(), "storm": sample_storm(),
        "ensemble": {"members": members, "seed": seed, "errors": sample_errors(futures)},
        "hazard": sample_hazard(futures), "devices": devices,
        "plan": {
            "objective": "most value saved on average", "method": "team search on the mean risk",
            "expected_value": 512.3, "bound": 520.1, "routes": routes, "left_behind": [{
                "device": 5, "reason": "too_late", "text": "F6: no ship is free before the gale"}]},
        "loss": {
            "currency": "CNY", "insured": sum(d[3] for d in DEVICES), "operating_cost": 5200.0,
            "with_plan": loss_of(mean_loss), "idle": loss_of(idle_loss)},
        "deadlines": {
            "first_departure": stamp(6), "no_departure_after": stamp(13.5),
            "rule": "From then on, leaving has a lower expected value than staying in port for every device."
        },
        "what_if": [sample_change(*one, mean_loss, home_count) for one in CHANGES],
        "assumptions": [dict(zip(("what", "value", "basis", "source"), one))
                        for one in ASSUMPTIONS]}


def nothing_to_save():
    """Returns a plan in which the bulletin comes too late: no ship leaves."""
    late = copy.deepcopy(sample(members=200))
    late["outcome"] = {
        "kind": "nothing_can_be_saved", "exit_code": 10,
        "text": "No ship can bring a device to a port before the gale with a chance above 5 %."
    }
    late["warnings"].insert(
        0, {
            "code": "nothing_can_be_saved", "severity": "stop",
            "text": "Nothing can be saved: the gale reaches the ranch before a ship returns.",
            "advice": "Keep all ships in port. Secure the devices on site if that is safe."
        })
    late["plan"].update(
        routes=[],
        expected_value=0.0,
        bound=0.0,
        left_behind=[{"device": d["id"], "reason": "too_late", "text": "the gale comes first"}
                     for d in late["devices"]])
    late["deadlines"].update(first_departure=None, no_departure_after=None)
    for device in late["devices"]:
        device.update(order=None,
                      odds={"home": 0.0, "home_before": [0.0] * 3},
                      expected_loss=device["expected_loss_idle"],
                      deadlines=[{"probability": p, "leave": None, "ship": None}
                                 for p in (.95, .8, .5)])
    late["loss"]["with_plan"] = late["loss"]["idle"]
    late["what_if"] = late["what_if"][:1]
    return late


def storm_stays_away():
    """Returns a plan without currency and energy model: all members pass at a distance."""
    calm = copy.deepcopy(nothing_to_save())
    calm["outcome"] = {
        "kind": "storm_stays_away", "exit_code": 11,
        "text": "In none of the 200 futures does a ring reach the ranch before 2021-07-26 06:00 UTC."
    }
    calm["warnings"] = [{
        "code": "storm_stays_away", "severity": "warning",
        "text": "No ring reaches the ranch until the forecast ends at 2021-07-26 06:00 UTC. That is not an all-clear.",
        "advice": "Plan again at the next bulletin."
    }]
    calm["hazard"] = {"timeline": [], "frames": []}
    nothing = loss_of(np.zeros(200))
    calm["loss"].update(currency=None, operating_cost=None, with_plan=nothing, idle=nothing)
    calm["what_if"] = []
    for left in calm["plan"]["left_behind"]:
        left.update(reason="safe_in_place", text="no ring reaches it in these futures")
    for device in calm["devices"]:
        device.update(expected_damage=0.0, expected_loss=0.0, expected_loss_idle=0.0)
        device["arrival"] = [{"probability": 0.0, "q05": None, "q50": None, "q95": None}] * 3
    return calm


def storm_unknown():
    """Returns a plan for a bulletin with neither winds nor radii: the risk is unknown."""
    plan = copy.deepcopy(storm_stays_away())
    text = "It is unknown whether the storm reaches the devices: its wind and radii are unknown."
    plan["outcome"] = {
        "kind": "storm_unknown", "exit_code": 12, "text": text, "unknown":
        "The storm's winds are unknown from 2021-07-24T00:00:00Z on."
    }
    plan["warnings"] = [{
        "code": "storm_unknown", "severity": "stop", "text": text,
        "advice": "Get the next bulletin."
    }]
    plan["hazard"]["timeline"] = [{"time": stamp(h), "probability": [None] * 3} for h in range(42)]
    nothing = {**dict.fromkeys(plan["loss"]["idle"]), "exceedance": []}
    plan["loss"].update(with_plan=nothing, idle=nothing)
    plan["plan"].update(expected_value=None, bound=None)
    for left in plan["plan"]["left_behind"]:
        left.update(reason="winds_unknown", text="the storm's winds are unknown")
    for device in plan["devices"]:
        device.update(expected_damage=None, expected_loss=None, expected_loss_idle=None)
        device["odds"] = {"home": None, "home_before": [None] * 3}
        device["arrival"] = [{"probability": None, "q05": None, "q50": None, "q95": None}] * 3
    return plan


def storm_unknown_of_before():
    """Returns storm_unknown as earlier versions wrote it: zeros instead of null."""
    plan = copy.deepcopy(storm_stays_away())
    new = storm_unknown()
    plan.update(warnings=new["warnings"], outcome={**new["outcome"]})
    del plan["outcome"]["unknown"]
    plan["hazard"]["timeline"] = [{"time": stamp(h), "probability": [0.0] * 3} for h in range(42)]
    return plan


def storm_unknown_aboard(chance=None):
    """Returns the plan storm_unknown with a ship that is at sea with F1 aboard and has orders.

    chance: probability of the orders; None, or a number as in files of earlier versions
    """
    plan = copy.deepcopy(storm_unknown())
    cell, port = [12, 13], PORTS[0]
    plan["ships"][0].update(cell=cell, position=position(*cell), port=None, aboard=[0])

    def order(action, hours, place):
        return {
            "action": action, "time": stamp(hours), "cell": list(place),
            "position": position(*place), "device": None,
            "port": 0 if action == "deliver" else None, "km": 0.6 * hours, "kwh": None,
            "probability": chance
        }

    orders = [order("leave", 0, cell), {**order("deliver", 1, port), "devices": [0]}]
    plan["plan"]["routes"] = [{
        "ship": 0, "km": 0.6, "kwh": None, "orders": orders,
        "path": [[*cell, 0.0], [*port, 3600.0]]
    }]
    plan["plan"]["left_behind"] = plan["plan"]["left_behind"][1:]
    plan["devices"][0].update(
        cell=cell, position=position(*cell),
        order={"ship": 0, "fetch": stamp(0), "deliver": stamp(1), "port": 0},
        odds={"home": chance, "home_before": [chance] * 3})
    return plan


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        json.dump(sample(), file, indent=1)
