# SPDX-License-Identifier: BSD-3-Clause
"""Converts a plan to GeoJSON (RFC 7946): longitude before latitude, outer rings
of polygons counter-clockwise."""
import json

import numpy as np

from .document import Clock
from .geodesy import LocalPlane
from .words import is_unknown, kind_name, left_reason, order_text, unknown_reason

CIRCLE_POINTS = 72


def feature_collection(plan):
    """Returns all features of a plan. Their property `layer` is port, device, route, order,
    storm_track, storm_position, ring or forecast_error."""
    place = _Placing(plan)
    features = [
        *_ports(plan), *_devices(plan), *_routes(plan, place), *_orders(plan), *_storm(plan, place),
        *_cone(plan, place)
    ]
    return {"type": "FeatureCollection", "features": features}


def text(plan):
    """Returns the text of the GeoJSON file of a plan."""
    return json.dumps(feature_collection(plan), ensure_ascii=False, indent=1) + "\n"


class _Placing:
    """Converts map coordinates in cells to [longitude, latitude]."""

    def __init__(self, plan):
        origin = plan["ranch"]["origin"]
        self._plane = LocalPlane(origin["latitude"], origin["longitude"])
        self._cell_m = plan["ranch"]["cell_size_m"]

    def lon_lat(self, x, y):
        latitude, longitude = self._plane.to_geo(x * self._cell_m, y * self._cell_m)
        return [round(longitude, 6), round(latitude, 6)]

    def circle(self, x, y, radius_km):
        """Returns a circle as a closed ring of [longitude, latitude], counter-clockwise. x, y:
        centre [cells]"""
        radius = radius_km * 1000 / self._cell_m
        ring = [
            self.lon_lat(x + radius * np.cos(a), y + radius * np.sin(a))
            for a in np.linspace(0, 2 * np.pi, CIRCLE_POINTS, endpoint=False)
        ]
        return ring + ring[:1]


def _feature(layer, geometry, coordinates, **properties):
    return {
        "type": "Feature", "geometry": {"type": geometry, "coordinates": coordinates},
        "properties": {"layer": layer, **properties}
    }


def _point(position):
    return [round(position["longitude"], 6), round(position["latitude"], 6)]


def _ports(plan):
    return [
        _feature("port", "Point", _point(port["position"]), name=port["name"])
        for port in plan["ports"]
    ]


def _devices(plan):
    reasons = {left["device"]: left_reason(plan, left) for left in plan["plan"]["left_behind"]}
    for device in plan["devices"]:
        order = device["order"] or {}
        yield _feature("device",
                       "Point",
                       _point(device["position"]),
                       name=device["name"],
                       kind=kind_name(device["kind"]),
                       value=device["value"],
                       probability_home=None if is_unknown(plan) else device["odds"]["home"],
                       ship=plan["ships"][order["ship"]]["name"] if order else None,
                       fetch=order.get("fetch"),
                       deliver=order.get("deliver"),
                       left_behind=reasons.get(device["id"]),
                       expected_loss=None if is_unknown(plan) else device["expected_loss"],
                       unknown=unknown_reason(plan))


def _routes(plan, place):
    clock = Clock(plan["clock"])
    for route in plan["plan"]["routes"]:
        points = [place.lon_lat(x, y) for x, y, _ in route["path"]]
        yield _feature("route",
                       "LineString",
                       points,
                       ship=plan["ships"][route["ship"]]["name"],
                       km=route["km"],
                       kwh=route["kwh"],
                       times=[clock.at(seconds) for _, _, seconds in route["path"]])


def _orders(plan):
    for route in plan["plan"]["routes"]:
        for number, order in enumerate(route["orders"], 1):
            yield _feature("order",
                           "Point",
                           _point(order["position"]),
                           number=number,
                           ship=plan["ships"][route["ship"]]["name"],
                           action=order["action"],
                           time=order["time"],
                           probability=None if is_unknown(plan) else order["probability"],
                           unknown=unknown_reason(plan),
                           text=order_text(plan, order))


def _storm(plan, place):
    points = plan["storm"]["points"]
    for source in ("recorded", "forecast", "assumed"):
        line = [point for point in points if point["source"] == source]
        before = [p for p in points if line and p["time"] < line[0]["time"]][-1:]
        if len(before + line) > 1 and line:
            yield _feature("storm_track",
                           "LineString", [_point(p["position"]) for p in before + line],
                           source=source,
                           name=plan["storm"]["name"])
    for point in points:
        yield _feature("storm_position",
                       "Point",
                       _point(point["position"]),
                       time=point["time"],
                       source=point["source"],
                       wind_mps=point["wind_mps"])
        for ring, radius in zip(plan["rings"], point["radii_km"]):
            if radius:
                yield _feature("ring",
                               "Polygon", [place.circle(*point["at"], radius)],
                               ring=ring["id"],
                               name=ring["name"],
                               time=point["time"],
                               radius_km=radius,
                               source=point["radii_source"])


def _cone(plan, place):
    for error in plan["ensemble"]["errors"]:
        if error["radius70_km"] > 0:
            yield _feature("forecast_error",
                           "Polygon", [place.circle(*error["centre"], error["radius70_km"])],
                           time=error["time"],
                           lead_h=error["lead_h"],
                           probability=0.7,
                           radius_km=error["radius70_km"])
