# SPDX-License-Identifier: BSD-3-Clause
"""Steps every shipped scenario and checks the state after each step (farm_soak)."""
import re

from campaigns import common

BATCH = 200_000  # steps of each scenario between looks at the clock


def run(campaign):
    """Runs farm_soak with one seed after another; count is in millions of steps."""
    program = campaign.program("farm_soak")
    steps = 0
    seed = campaign.seed
    while campaign.more(steps // 1_000_000):
        code, words = common.execute(program, BATCH, seed, common.SCENARIOS, seconds=1800)
        for what in ("steps", "episodes", "successes", "saves"):
            number = sum(int(found) for found in re.findall(rf" (\d+) {what}", words))
            campaign.attempt(what, number)
            steps += number if what == "steps" else 0
        last = words.strip().splitlines()[-1:]
        if not campaign.check(code == 0, f"farm_soak {BATCH} {seed}: exit code {code}: {last}"):
            return
        seed += 1
