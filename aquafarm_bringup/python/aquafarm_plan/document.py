# SPDX-License-Identifier: BSD-3-Clause
"""Reads plan files, and formats their times, amounts and probabilities."""
import datetime
import json
import pathlib

import jsonschema
import numpy as np

SCHEMA = pathlib.Path(__file__).with_name("plan.schema.json")
UTC = datetime.timezone.utc


class PlanError(Exception):
    """The plan file cannot be used. The message states where the fault is and what is expected."""


def load(path):
    """Reads and checks a plan file (plan.schema.json).

    @throws PlanError if the file is missing, is not JSON, or fails check()
    """
    try:
        document = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise PlanError(f"{path}: {error.strerror}; expected a plan file from aquafarm_plan "
                        "--json") from error
    except ValueError as error:
        raise PlanError(f"{path}: {error}; expected a plan file (JSON) from aquafarm_plan "
                        "--json") from error
    check(document, path)
    return document


def check(document, path):
    """@throws PlanError if the document does not fit the schema or contradicts itself"""
    # The validator gets the document without the frames: their grids contain about 100,000 numbers,
    # for which it would need seconds. _check_frames checks the frames.
    lean = document
    hazard = document.get("hazard") if isinstance(document, dict) else None
    if isinstance(hazard, dict) and isinstance(hazard.get("frames"), list):
        lean = {**document, "hazard": {**hazard, "frames": []}}
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    error = jsonschema.exceptions.best_match(
        jsonschema.Draft202012Validator(schema).iter_errors(lean))
    if error:
        place = ".".join(str(key) for key in error.absolute_path) or "the whole file"
        raise PlanError(f"{path}: {place}: {error.message[:200]}; expected a plan file of version "
                        f"{schema['properties']['version']['const']}, make it again with "
                        "aquafarm_plan --json")
    _check_frames(document, path)
    _check_references(document, path)


def _check_frames(document, path):
    cells = document["ranch"]["width"] * document["ranch"]["height"]
    for i, frame in enumerate(document["hazard"]["frames"]):
        place = f"{path}: hazard.frames.{i}"
        try:
            parse_time(frame["time"])
            grids = [np.array(grid, dtype=int) for grid in frame["percent"]]
        except (KeyError, TypeError, ValueError) as error:
            raise PlanError(f"{place}: {error!r}; expected a time and one grid per ring") from error
        if len(grids) != len(document["rings"]):
            raise PlanError(f"{place}: got {len(grids)} grids, expected one for each of the "
                            f"{len(document['rings'])} rings")
        for grid in grids:
            if grid.size not in (0, cells) or (grid.size and
                                               not 0 <= grid.min() <= grid.max() <= 100):
                raise PlanError(f"{place}: got a grid of {grid.size} numbers, expected 0 or {cells}"
                                " numbers in [0, 100]")


def _check_references(document, path):
    """Checks that the ids of ships, devices and ports are their positions in the lists. Checks
    that the ids in the orders of devices, in routes and in left_behind exist. Checks that each list
    of values by ring has one entry per ring."""
    for name in ("ships", "devices", "ports"):
        ids = [one["id"] for one in document[name]]
        if ids != list(range(len(ids))):
            raise PlanError(
                f"{path}: {name}: got the ids {ids}, expected 0 to {len(ids) - 1} in order")

    def refer(place, name, value):
        if value is not None and not 0 <= value < len(document[name]):
            raise PlanError(
                f"{path}: {place}: got {value}, expected one of the {len(document[name])} "
                f"{name}")

    for i, device in enumerate(document["devices"]):
        if device["order"]:
            refer(f"devices.{i}.order.ship", "ships", device["order"]["ship"])
            refer(f"devices.{i}.order.port", "ports", device["order"]["port"])
    for i, route in enumerate(document["plan"]["routes"]):
        refer(f"plan.routes.{i}.ship", "ships", route["ship"])
        for j, order in enumerate(route["orders"]):
            for key in ("device", "port"):
                refer(f"plan.routes.{i}.orders.{j}.{key}", f"{key}s", order[key])
            for device in order.get("devices", ()):
                refer(f"plan.routes.{i}.orders.{j}.devices", "devices", device)
    for i, left in enumerate(document["plan"]["left_behind"]):
        refer(f"plan.left_behind.{i}.device", "devices", left["device"])
    for place, arrays in (("devices", [d["arrival"] for d in document["devices"]] +
                           [d["odds"]["home_before"] for d in document["devices"]]),
                          ("storm.points", [p["radii_km"] for p in document["storm"]["points"]]),
                          ("hazard.timeline",
                           [t["probability"] for t in document["hazard"]["timeline"]])):
        if any(len(one) != len(document["rings"]) for one in arrays):
            raise PlanError(
                f"{path}: {place}: expected {len(document['rings'])} numbers, one per ring")


def parse_time(text):
    """Converts a time stamp of a plan file to a datetime in UTC."""
    return datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%SZ").replace(tzinfo=UTC)


class Clock:
    """Formats times in the ranch's local time and in UTC."""

    def __init__(self, clock):
        self.zone = clock["zone"]
        self.start = parse_time(clock["start"])
        self.end = parse_time(clock["end"])
        self._local = datetime.timezone(datetime.timedelta(minutes=clock["utc_offset_min"]))
        self.offset_min = clock["utc_offset_min"]

    def seconds(self, text):
        """Converts a time stamp to seconds after the start of the plan."""
        return (parse_time(text) - self.start).total_seconds()

    def at(self, seconds):
        """Converts seconds after the start of the plan to a time stamp."""
        return (self.start + datetime.timedelta(seconds=seconds)).strftime("%Y-%m-%dT%H:%M:%SZ")

    def local(self, text):
        return parse_time(text).astimezone(self._local)

    def day_time(self, text):
        """Returns local day and time, such as `Sat 24 Jul 14:20`; a dash for None."""
        if not text:
            return "–"
        local = self.local(text)
        return f"{local:%a} {local.day} {local:%b %H:%M}"

    def time(self, text):
        """Returns the local time of day. The weekday is in front, except on the day on which the
        plan starts. Returns a dash for None."""
        if not text:
            return "–"
        same = self.local(text).date() == self.start.astimezone(self._local).date()
        return f"{self.local(text):%H:%M}" if same else f"{self.local(text):%a %H:%M}"

    def utc(self, text):
        """Returns day of the month and time in UTC, such as `24 06:20`; a dash for None."""
        return f"{parse_time(text):%d %H:%M}" if text else "–"

    def utc_full(self, text):
        return f"{parse_time(text):%Y-%m-%d %H:%M} UTC" if text else "–"


def percent(share):
    """Returns a probability as text for a table; a dash for None. Returns "> 99 %" and "< 1 %" at
    the ends of the range, because a share of a sample is not certain."""
    if share is None:
        return "–"
    if share >= 0.995:
        return "> 99 %"
    return "< 1 %" if share < 0.005 else f"{100 * share:.0f} %"


def amount(value, currency, sign=False):
    """Returns an amount of money as text, such as `CNY 1.23 M`, `CNY 12,000` or `CNY 980`; a dash
    for None.

    sign: True writes + before a positive amount
    """
    if value is None:
        return "–"
    size = abs(value)
    if size >= 999_500:
        text = f"{size / 1e6:,.{2 if size < 9.995e6 else 1}f} M"
    elif size >= 10_000:
        text = f"{round(size, -3):,.0f}"
    else:
        text = f"{size:,.0f}"
    mark = "−" if value < 0 and text.strip("0.") else "+" if sign and text.strip("0.") else ""
    return f"{currency} {mark}{text}" if currency else f"{mark}{text}"


def sampling_error(share, members):
    """Returns the half-width of the 95 % interval of a share of the members (normal
    approximation)."""
    return 1.96 * (share * (1 - share) / members)**0.5
