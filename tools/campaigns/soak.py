# SPDX-License-Identifier: BSD-3-Clause
"""Steps every shipped scenario and checks the state after each step.

random    random, legal random and homing actions (farm_soak)
planner   actions of the planners, with a random one now and then (planner_soak)
"""
import re

from campaigns import common

# Program and steps of each scenario between looks at the clock. Planners are a thousand times slower.
KINDS = {"random": ("farm_soak", 200_000), "planner": ("planner_soak", 300)}


def run(campaign):
    """Runs the programs with one seed after another; count is in millions of random steps."""
    kinds = {kind: (campaign.program(KINDS[kind][0]), KINDS[kind][1])
             for kind in campaign.kinds(KINDS)}
    steps = 0
    seed = campaign.seed
    while campaign.more(steps // 1_000_000):
        for kind, (program, batch) in kinds.items():
            code, words = common.execute(program, batch, seed, common.SCENARIOS, seconds=1800)
            for what in ("steps", "episodes", "successes", "saves"):
                number = sum(int(found) for found in re.findall(rf" (\d+) {what}", words))
                campaign.attempt(f"{what}, {kind}", number)
                steps += number if what == "steps" and ("random" not in kinds or kind == "random") else 0
            campaign.attempt(f"scenarios left out, {kind}", words.count(": left out: "))
            last = words.strip().splitlines()[-1:]
            if not campaign.check(code == 0, f"{program.name} {batch} {seed}: exit code {code}: {last}"):
                return
        seed += 1
