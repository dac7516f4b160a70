# SPDX-License-Identifier: BSD-3-Clause
"""Rescue plans, as ./aquafarm plan makes them: which ship fetches which device before a storm."""
from __future__ import annotations

import datetime
import importlib
import json
import pathlib
import time
from typing import Any

import aquafarm_core as core

from aquafarm_gym.farms import find_scenario

Path = str | pathlib.Path


def seconds_of(name: str, moment: str | datetime.datetime) -> int:
    """Returns a time as seconds since 1970 (UTC). Raises ValueError if it is not a time or has no
    time zone."""
    try:
        given = (datetime.datetime.fromisoformat(moment.replace("Z", "+00:00"))
                 if isinstance(moment, str) else moment)
    except ValueError:
        given = None
    if not isinstance(given, datetime.datetime) or given.tzinfo is None:
        raise ValueError(f"{name}: got {moment!r}, expected a time with its zone, such as "
                         "'2021-07-24T12:00:00Z' or a datetime with tzinfo")
    return int(given.timestamp())


def number(name: str, value: Any, low: float, high: float) -> Any:
    """Returns `value`. Raises ValueError if it is not a number in [low, high]. If `low` is an
    int, the number must be whole."""
    whole = isinstance(low, int)
    fits = isinstance(value, int if whole else (int, float)) and not isinstance(value, bool)
    if not (fits and low <= value <= high):
        kind = "a whole number" if whole else "a number"
        raise ValueError(f"{name}: got {value!r}, expected {kind} in [{low}, {high}]")
    return value if whole else float(value)


def plan_rescue(ranch: core.Scenario | Path, *, bulletin: Path | None = None,
                storm: Path | None = None, storm_name: str = "",
                at: str | datetime.datetime | None = None, devices: Path | None = None,
                ships_file: Path | None = None, ships: int | None = None,
                speed_kn: float | None = None, capacity: int | None = None,
                depart_h: float = 0.0, abort_wind_kt: float = 34.0, risk_averse: float = 0.0,
                currency: str = "", utc_offset_h: float | None = None, members: int = 1000,
                seed: int = 1) -> dict[str, Any]:
    """Plans a rescue and returns the content of plan.json (plan.schema.json) as a dict.

    ranch: a scenario with a geographic origin, its file or its name. bulletin: file with the
    forecast of the storm. storm: instead of a bulletin, a file with a recorded track. storm_name
    selects a storm of the file. at: start of the plan; required with `storm`. Default: now if the
    newest report of the bulletin is less than 12 h old, else the time of this report. devices,
    ships_file: CSV files (docs/plan.md). ships: number of ships. speed_kn [kn], capacity [devices]:
    values for ships for which ships_file has none. depart_h: earliest departure after the start
    [h]. abort_wind_kt: wind that stops ships [kt]. risk_averse: a fraction of the possible storms,
    in [0, 1]. Above 0, the plan minimises the mean loss over the fraction with the largest losses.
    With 0, it maximises the mean value saved over all possible storms. currency: currency of the
    devices' values. utc_offset_h: local time minus UTC [h]; default: from the longitude. members:
    number of possible storms. seed: seed of the random numbers that draw the possible storms.

    Raises ValueError with a message of one line if an option, a file or a position is wrong.
    """
    native: Any = importlib.import_module("aquafarm_core._native")
    request = native._RescueRequest()
    request.now = int(time.time())
    if at is not None:
        request.at = seconds_of("at", at)
    for name, text in (("bulletin", bulletin), ("storm", storm), ("storm_name", storm_name),
                       ("devices", devices), ("ships_file", ships_file), ("currency", currency)):
        setattr(request, name, "" if text is None else str(text))
    for name, value, low, high in (
            ("ships", ships, 0, 64), ("speed_kn", speed_kn, 0.1, 60.0),
            ("capacity", capacity, 1, 100), ("abort_wind_kt", abort_wind_kt, 10.0, 100.0),
            ("risk_averse", risk_averse, 0.0, 1.0), ("utc_offset_h", utc_offset_h, -14.0, 14.0),
            ("members", members, 10, 20000), ("seed", seed, 0, 2**63 - 1)):
        if value is not None:
            setattr(request, name, number(name, value, low, high))
    request.depart_s = 3600.0 * number("depart_h", depart_h, 0.0, 1000.0)
    scenario = find_scenario(ranch)
    plan: dict[str, Any] = json.loads(native._plan_rescue(
        scenario, request, f"aquafarm_gym.plan_rescue({scenario.name!r}, …)"))
    return plan
