# SPDX-License-Identifier: BSD-3-Clause
"""Outcome of each device in a recorded episode."""
import dataclasses

import rosbag
from aquafarm_benchmark.measures import wilson_interval
from aquafarm_msgs.msg import DeviceState

from aquafarm_report import page

KINDS = {DeviceState.TEMPORARY_BREEDING: "temporary", DeviceState.MONITORING: "monitoring",
         DeviceState.BREEDING_RELEASE: "release", DeviceState.DEEP_WATER_BREEDING: "deep water"}


@dataclasses.dataclass
class Outcome:
    """A device at the end of an episode; steps are None if it was not picked up or delivered."""
    label: str
    picked_up: int
    home: int
    health: float

    def text(self):
        """Returns "home at step 24, health 100 %" and the like."""
        health = f"health {self.health:.0%}"
        if self.home is not None:
            return f"home at step {self.home}, {health}"
        if self.picked_up is not None:
            return f"aboard since step {self.picked_up}, {health}"
        return f"left at sea, {health}"


def read_outcomes(bag):
    """Outcomes of the devices of a bag's only episode, by id."""
    found = {}
    with rosbag.Bag(str(bag)) as file:
        topics = [name for name in file.get_type_and_topic_info().topics
                  if name == "state" or name.endswith("/state")]
        for _, state, _ in file.read_messages(topics=topics):
            for device in state.devices:
                one = found.setdefault(device.id, Outcome(
                    f"F{device.id} {KINDS.get(device.kind, '')}", None, None, 1.0))
                one.health = device.health
                if device.status == DeviceState.DEPLOYED:
                    continue
                if one.picked_up is None:
                    one.picked_up = state.step
                if device.status == DeviceState.DELIVERED and one.home is None:
                    one.home = state.step
    return [found[key] for key in sorted(found)]


NAMES = {"temporary_breeding": "temporary", "monitoring": "monitoring",
         "breeding_release": "release", "deep_water_breeding": "deep water"}


def _share(count, episodes, distinct):
    """Returns "98% [94%, 99%]"; the interval counts each distinct start once."""
    rate = count / episodes
    evidence = max(1, min(distinct or episodes, episodes))
    low, high = wilson_interval(round(rate * evidence), evidence)
    return f"{rate:.0%} [{low:.0%}, {high:.0%}]"


def summary_table(summary):
    """Outcomes of each device over all episodes of an evaluation; "" if it does not have them."""
    rows = []
    for one in summary.get("devices", ()):
        health = one.get("delivered_health")
        rows.append([f"F{one['id']} {NAMES.get(one['kind'], one['kind'])}",
                     *(_share(one[name], one["episodes"], summary.get("distinct_episodes"))
                       for name in ("delivered", "aboard", "left")),
                     "–" if health is None else f"{health:.0%}"])
    return page.table(["device", "home", "aboard at the end", "left at sea",
                       "health of those at home"], rows) if rows else ""
