# SPDX-License-Identifier: BSD-3-Clause
"""Sentences of the page: orders, and the answers to the five questions at its top."""
import math
import re

from .document import Clock, amount, percent, sampling_error

KINDS = {
    "temporary_breeding": "temporary cage", "monitoring": "monitoring buoy",
    "breeding_release": "release cage", "deep_water_breeding": "deep-water cage"
}

BULLETIN_OLD = 13  # exit code of aquafarm_plan if the bulletin is old


def kind_name(kind):
    """Returns the display name of a kind of device. In an unknown kind, spaces replace the
    underscores."""
    return KINDS.get(kind, kind.replace("_", " "))


def numbered_name(plan, ship):
    """Returns the name of a ship with the number that the map shows: "ship 1" or "2: Haixing"."""
    name = plan["ships"][ship]["name"]
    return name if name == f"ship {ship + 1}" else f"{ship + 1}: {name}"


def letter(number):
    """Returns the letters of a number: A for 0, Z for 25, AA for 26."""
    text = ""
    while number >= 0:
        text = chr(ord("A") + number % 26) + text
        number = number // 26 - 1
    return text


def storm_name(plan):
    """Returns the name of the storm with a capital after each hyphen, such as In-Fa: archives and
    bulletins write the same name with different capitals."""
    return re.sub(r"-(.)", lambda found: found[0].upper(), plan["storm"]["name"])


def compass(bearing_deg):
    """Returns the compass point of a bearing, such as NNE."""
    return ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW",
            "NW", "NNW")[round(bearing_deg / 22.5) % 16]


def is_unknown(plan):
    """Returns whether the storm's winds are unknown. Low probabilities then do not mean safety."""
    return plan["outcome"]["kind"] == "storm_unknown"


def unknown_cause(plan):
    """Returns in a few words why the numbers of a plan are unknown."""
    ended = any(warning["code"] == "forecast_ended" for warning in plan["warnings"])
    return "the bulletin's forecast has ended" if ended else "the storm's winds are unknown"


def unknown_reason(plan):
    """Returns in a sentence why the numbers of a plan are unknown; None if they are known."""
    outcome = plan["outcome"]
    return (outcome.get("unknown") or outcome["text"]) if is_unknown(plan) else None


def chance(plan, share):
    """Returns the probability of an order or a device as text; "unknown" if it is not known."""
    return "unknown" if is_unknown(plan) or share is None else percent(share)


def left_word(plan, device):
    """Returns the state of a device that is not fetched: "left behind", "stays in place" or
    "unknown"."""
    if is_unknown(plan):
        return "unknown"
    safe = any(left["device"] == device and left["reason"] == "safe_in_place"
               for left in plan["plan"]["left_behind"])
    return "stays in place" if safe else "left behind"


def left_reason(plan, left):
    """Returns why a device is left behind, without the device's name at the start."""
    if is_unknown(plan):
        return unknown_cause(plan)
    name = plan["devices"][left["device"]]["name"]
    return left["text"].removeprefix(f"{name}: ")


def deadline_text(plan, deadline):
    """Returns the latest departure that meets a deadline's probability, as text for a table."""
    if is_unknown(plan):
        return "unknown"
    if not deadline["leave"]:
        return "no departure has this chance"
    day_time = Clock(plan["clock"]).day_time(deadline["leave"])
    return f"not known beyond {day_time}" if deadline.get("open") else day_time


def last_known(plan):
    """Returns the text for a plan whose last useful departure is not known."""
    beyond = Clock(plan["clock"]).day_time(plan["deadlines"]["not_known_beyond"])
    return (f"Ships may leave at least until {beyond}. What follows is not known: plan again at "
            "the next bulletin.")


def device_names(plan, ids):
    names = [plan["devices"][i]["name"] for i in ids]
    return ", ".join(names)


def some(parts, separator, limit=3):
    """Joins the parts of a list. If there are at least `limit` + 2 parts, joins the first `limit`
    parts and adds the number of the others."""
    more = len(parts) - limit
    if more <= 1:
        return separator.join(parts)
    return separator.join(parts[:limit]) + f" and {more} more, see the orders"


def order_text(plan, order):
    """Returns an order as an instruction, such as `fetch F3`."""
    port = plan["ports"][order["port"]]["name"] if order["port"] is not None else "its position"
    if order["action"] == "leave":
        return f"leave {port}"
    if order["action"] == "fetch":
        return f"fetch {plan['devices'][order['device']]['name']}"
    if order["action"] == "deliver":
        ids = order.get("devices") or [i for i in [order["device"]] if i is not None]
        text = f"deliver {device_names(plan, ids)} at {port}" if ids else f"return to {port}"
        return f"{text} and leave" if order.get("leaves") else text
    return f"wait in {port}" if order["port"] is not None else "wait"


def merged_orders(plan, route):
    """Returns the orders of a route for a table. An order to leave a port at the time of a delivery
    there, with the same chance, is part of the delivery, which then has the key `leaves`."""
    merged = []
    for order in route["orders"]:
        last = merged[-1] if merged else None
        if (last and (last["action"], order["action"]) == ("deliver", "leave")
                and (last["time"], last["port"]) == (order["time"], order["port"])
                and chance(plan, last["probability"]) == chance(plan, order["probability"])):
            merged[-1] = {**last, "leaves": True}
        else:
            merged.append(order)
    return merged


def early_wind(plan):
    """Returns why the widest ring may be over the ranch at the start of the plan, although its
    radius is smaller than the distance of the storm's centre. None if that is not so."""
    clock, ranch, times = Clock(plan["clock"]), plan["ranch"], plan["hazard"]["timeline"]
    at = [one for one in plan["storm"]["points"] if abs(clock.seconds(one["time"])) < 60.0]
    spread = [one for one in plan["ensemble"]["errors"] if abs(clock.seconds(one["time"])) < 60.0]
    if is_unknown(plan) or not (at and spread and times) or times[0]["probability"][-1] < 0.005:
        return None
    radius, share = at[0]["radii_km"][-1], times[0]["probability"][-1]
    km = math.dist(at[0]["at"], [(ranch["width"] - 1) / 2, (ranch["height"] - 1) / 2])
    km *= ranch["cell_size_m"] / 1000
    if not radius or radius >= km:
        return None
    wide = radius * math.exp(1.645 * (spread[0]["size_log"] or 0.0))  # a twentieth is above it
    name = plan["rings"][-1]["name"]
    text = (f"The chance of {name} is {percent(share)} at the start, although the centre is "
            f"{km:,.0f} km away, because the radius of this wind is uncertain: {radius:,.0f} km "
            f"({at[0]['radii_source']}), but more than about {round(wide, -1):,.0f} km in one future "
            "of twenty.")
    leave = next((one for route in plan["plan"]["routes"] for one in route["orders"][:1]
                  if one["action"] == "leave" and abs(clock.seconds(one["time"])) < 60.0), None)
    is_only = max(times[0]["probability"][:-1], default=0.0) < 0.005
    if leave and is_only and leave["probability"] < 0.995:
        text += (" A ship does not leave a port that this wind has reached, as in "
                 f"{percent(1.0 - leave['probability'])} of the futures: {order_text(plan, leave)}, "
                 f"{percent(leave['probability'])}.")
    return text


def no_rings(plan):
    """Returns the sentence that the timeline shows if it has no curves."""
    if is_unknown(plan):
        return f"Unknown: {unknown_cause(plan)}."
    end = Clock(plan["clock"]).day_time(plan["clock"]["end"])
    return f"No ring reaches the ranch before {end} in these futures."


def answers(plan):
    """Returns (question, answer, remark) of each of the five questions."""
    return [_first(plan), _leave(plan), _lose(plan), _sure(plan), _one_more(plan)]


def _first(plan):
    clock, firsts = Clock(plan["clock"]), []
    for route in plan["plan"]["routes"]:
        fetch = next((one for one in route["orders"] if one["action"] == "fetch"), None)
        if fetch:
            firsts.append((fetch["time"], f"{plan['devices'][fetch['device']]['name']} with "
                           f"{plan['ships'][route['ship']]['name']} ({clock.time(fetch['time'])})"))
    left = plan["plan"]["left_behind"]
    remark = " ".join(f"{word.capitalize()}: {device_names(plan, ids)}."
                      for word in ("left behind", "stays in place", "unknown")
                      for ids in [[one["device"] for one in left
                                   if left_word(plan, one["device"]) == word]] if ids)
    answer = some([text for _, text in sorted(firsts)], "; ") or "Nothing."
    others = "No device is left behind."
    if is_unknown(plan):
        others = "Ships with devices aboard have orders. Their chances are unknown."
    return "What do I fetch first?", answer, remark or others


def _leave(plan):
    clock, deadlines = Clock(plan["clock"]), plan["deadlines"]
    leaves = [(order["time"], plan["ships"][route["ship"]]["name"])
              for route in plan["plan"]["routes"] for order in route["orders"][:1]]
    away = plan["outcome"]["kind"] == "storm_stays_away"
    if is_unknown(plan):
        return ("When must the ships leave?", "Unknown.",
                f"Unknown, because {unknown_cause(plan)}. Get a newer bulletin with winds or radii.")
    if not leaves:
        answer = "No ship needs to leave now." if away else "No ship should leave."
        if plan["outcome"]["exit_code"] == BULLETIN_OLD:
            answer = "Unknown: the bulletin is old."
    elif len({time for time, _ in leaves}) == 1:
        who = ("Every ship" if len(leaves) == len(plan["ships"]) else some(
            [name for _, name in leaves], " and "))
        answer = f"{who} at {clock.day_time(leaves[0][0])}."
    else:
        answer = some([f"{name} at {clock.day_time(time)}" for time, name in sorted(leaves)],
                      "; ") + "."
    last = deadlines["no_departure_after"]
    if last:
        remark = f"{_latest(plan, clock)}Do not leave after {clock.day_time(last)}."
    elif deadlines.get("not_known_beyond"):
        remark = f"{_latest(plan, clock)}{last_known(plan)}"
    elif away:
        remark = f"{_horizon(plan, clock)} Plan again at the next bulletin."
    else:
        remark = "No departure is advised at any time of this plan."
    return "When must the ships leave?", answer, remark


def _horizon(plan, clock):
    """Returns a sentence with the time until which the storm is known."""
    until = plan["storm"]["forecast_until"] or plan["storm"]["recorded_until"]
    return f"Nothing is known after {clock.day_time(until)}."


def first_deadlines(plan):
    """Returns {ship: (departure, device)}: the latest departure at which the first device of the
    ship has a chance of 80 %. Omits ships without such a departure and unknown ones. Empty if no
    departure is advised."""
    advised = plan["deadlines"]["no_departure_after"] or plan["deadlines"].get("not_known_beyond")
    found = {}
    for route in plan["plan"]["routes"] if advised and not is_unknown(plan) else []:
        first = next((one["device"] for one in route["orders"] if one["action"] == "fetch"), None)
        for one in plan["devices"][first]["deadlines"] if first is not None else []:
            if one["probability"] == 0.8 and one["leave"] and not one.get("open"):
                found[route["ship"]] = (one["leave"], first)
    return found


def _latest(plan, clock):
    """Returns a sentence with the times of first_deadlines; empty if there are none."""
    parts = [f"{clock.time(leave)} ({plan['devices'][device]['name']})"
             for leave, device in first_deadlines(plan).values()]
    return f"For a chance of at least 80 %, leave by {some(parts, ', ')}. " if parts else ""


def _lose(plan):
    loss = plan["loss"]
    mine, idle, currency = loss["with_plan"], loss["idle"], loss["currency"]
    if is_unknown(plan):
        return "What do I lose?", "Unknown.", plan["outcome"]["text"]
    if mine["mean"] == 0 and mine["cvar05"] == 0:
        return ("What do I lose?", f"Nothing in these {plan['ensemble']['members']:,} futures.",
                _horizon(plan, Clock(plan["clock"])))
    answer = f"{amount(mine['mean'], currency)} of {amount(loss['insured'], currency)} on average."
    # A loss cannot exceed the insured value.
    least = amount(mine["q95"] or 0.0, currency)
    least = f"everything: {least}" if (mine["q95"] or 0.0) >= loss["insured"] else f"{least} or more"
    remark = (f"One time in twenty {least}. " if mine["q95"] else
              f"In 19 of 20 futures nothing; {amount(mine['cvar05'], currency)} on average in the "
              "worst twentieth. ")
    remark += f"If no ship leaves: {amount(idle['mean'], currency)} on average."
    if not currency:
        remark += " In units of value, not in money."
    return "What do I lose?", answer, remark


def _sure(plan):
    members, devices = plan["ensemble"]["members"], plan["devices"]
    planned = [one for one in devices if one["order"]]
    if is_unknown(plan) or not planned:
        answer = "Not at all." if is_unknown(plan) else "No device is fetched."
        return ("How sure is it?", answer,
                f"Computed over {members:,} possible storms. The assumptions are on the last page.")
    worst = min(planned, key=lambda one: one["odds"]["home"])
    best = max(planned, key=lambda one: one["odds"]["home"])
    if len(planned) == 1:
        answer = f"{worst['name']} comes home in {percent(worst['odds']['home'])} of the futures."
    elif percent(worst["odds"]["home"]) == percent(best["odds"]["home"]):
        answer = (f"Each fetched device comes home in {percent(worst['odds']['home'])} of the "
                  "futures.")
    else:
        answer = (
            f"Each fetched device comes home in {percent(worst['odds']['home'])} ({worst['name']}) to "
            f"{percent(best['odds']['home'])} ({best['name']}) of the futures.")
    base = plan["what_if"][0]["all_home"] if plan["what_if"] else None
    each, shares = "", [one["odds"]["home"] for one in planned]
    if base is not None and len(planned) == len(devices) > 1:
        each, answer = answer + " ", f"All {len(devices)} come home in {percent(base)} of the futures."
        shares.append(base)
    points = f"{max(1, *(100 * sampling_error(share, members) for share in shares)):.0f}"
    return (
        "How sure is it?", answer,
        f"{each}{members:,} possible storms, sampling error at most {points} "
        f"point{'' if points == '1' else 's'}.")


def _one_more(plan):
    question, currency = "What does one more ship bring?", plan["loss"]["currency"]
    if is_unknown(plan):
        return question, "Unknown.", f"Unknown, because {unknown_cause(plan)}."
    row = next((one for one in plan["what_if"] if one["change"] == "ships+1"), None)
    if not row or not row["possible"] or not row["difference"]:
        return question, "Not computed.", row["text"] if row else "The plan has no such comparison."
    gap = row["difference"]
    interval = (
        f"95 % interval {amount(-gap['high'], currency)} to {amount(-gap['low'], currency)}, "
        "before the cost of the ship.")
    if gap["high"] >= 0:
        return question, "No gain that these futures can show.", interval
    return question, f"{amount(-gap['mean'], currency)} less loss on average.", interval
