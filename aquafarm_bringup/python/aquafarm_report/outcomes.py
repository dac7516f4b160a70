# SPDX-License-Identifier: BSD-3-Clause
"""Tables of the outcome of each device, in one episode and over all episodes of an evaluation."""
import dataclasses

import rosbag
from aquafarm_msgs.msg import DeviceState

from aquafarm_report import blocks, intervals

KINDS = {DeviceState.TEMPORARY_BREEDING: "temporary", DeviceState.MONITORING: "monitoring",
         DeviceState.BREEDING_RELEASE: "release", DeviceState.DEEP_WATER_BREEDING: "deep water"}


@dataclasses.dataclass
class Outcome:
    """A device at the end of an episode."""
    label: str
    picked_up: int  # step of the pickup or, for a self-propelled device, of its arrival; else None
    home: int  # step of the delivery; None if it was not delivered
    health: float

    def text(self):
        """Returns the outcome as text, for example "home at step 24, health 100 %"."""
        health = f"health {blocks.percent(self.health)}"
        if self.home is not None:
            return f"home at step {self.home}, {health}"
        if self.picked_up is not None:
            return f"aboard since step {self.picked_up}, {health}"
        return f"left at sea, {health}"


def read_outcomes(bag):
    """Returns the outcomes of the devices of a bag with one episode, in order of their ids."""
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


def episodes_table(captions, results):
    """Returns the table of the outcomes in some episodes: a row for each id, a column for each
    episode. If an id belongs to devices of different kinds in these episodes, each cell of its row
    also contains the kind.

    results: for each episode, the outcomes of read_outcomes
    """
    rows = []
    for i in range(max(map(len, results), default=0)):
        here = [one[i] if i < len(one) else None for one in results]
        labels = {one.label for one in here if one is not None}
        is_same = len(labels) == 1
        rows.append([labels.pop() if is_same else f"F{i}"] + [
            "–" if one is None else one.text() if is_same else
            f"{one.label.partition(' ')[2]}: {one.text()}" for one in here])
    return blocks.table(["device", *captions], rows)


NAMES = {"temporary_breeding": "temporary", "monitoring": "monitoring",
         "breeding_release": "release", "deep_water_breeding": "deep water"}


def _share(count, episodes, distinct):
    """Returns a share and its 95 % interval (Wilson) as "98 % [94 %, 99 %]". The sample size of
    the interval is the number of distinct starts, because equal episodes are not independent."""
    rate = count / episodes
    evidence = max(1, min(distinct or episodes, episodes))
    return intervals.share_text(rate, evidence)


def summary_table(summary):
    """Returns the table of the outcomes over all episodes of an evaluation: by device, or by kind
    if the episodes have different devices. Empty if the evaluation contains no outcomes."""
    by_kind = summary.get("devices_by_kind", ())
    rows = []
    for one in by_kind or summary.get("devices", ()):
        kind = NAMES.get(one["kind"], one["kind"])
        count = one["devices" if by_kind else "episodes"]
        health = one.get("delivered_health")
        rows.append([f"{kind} ({count:,})" if by_kind else f"F{one['id']} {kind}",
                     *(_share(one[name], count, summary.get("distinct_episodes"))
                       for name in ("delivered", "aboard", "left")),
                     "–" if health is None else blocks.percent(health)])
    return blocks.table(["kind of device (number)" if by_kind else "device", "home",
                         "aboard at the end", "left at sea", "health of devices at home"],
                        rows) if rows else ""
