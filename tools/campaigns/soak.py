# SPDX-License-Identifier: BSD-3-Clause
"""Steps farms for a long time and checks conditions that must always hold.

random    random, legal random and homing actions in every shipped scenario (farm_soak)
planner   actions of the planners in these scenarios, with some random ones (planner_soak)
ros       a training through ROS in lockstep, only with --only. The memory of the sim node and of
          the trainer may grow by at most 1 % from the second fifth of the training to the last
          fifth
"""
import pathlib
import re
import statistics
import subprocess
import tempfile

from campaigns import common, ros

# For each kind: its program, and the steps in each scenario in one run of the program. --seconds is
# checked between runs. Planners are a thousand times slower.
KINDS = {"random": ("farm_soak", 200_000), "planner": ("planner_soak", 300)}
MILLION = 1_000_000
LIMIT_S = 6 * 3600
SAMPLE_S = 0.25     # time between measurements of memory
MOST_GROWTH = 0.01  # max growth of a process's memory, as a fraction (see check_flat)
FEWEST_SAMPLES = 20


def soak(campaign, kind, seed):
    """Runs a program once over all scenarios; returns the number of steps, or None after a
    failure."""
    name, batch = KINDS[kind]
    program = campaign.program(name)
    code, words = common.execute(program, batch, seed, common.SCENARIOS, seconds=1800)
    steps = 0
    for what in ("steps", "episodes", "successes", "saves"):
        number = sum(int(found) for found in re.findall(rf" (\d+) {what}", words))
        campaign.attempt(f"{what}, {kind}", number)
        steps += number if what == "steps" else 0
    campaign.attempt(f"scenarios left out, {kind}", words.count(": left out: "))
    last = words.strip().splitlines()[-1:]
    good = campaign.check(code == 0, f"{name} {batch} {seed}: exit code {code}: {last}")
    return steps if good else None


def check_flat(campaign, name, samples):
    """Checks that the median memory in the last fifth of the samples is at most 1 % above that in
    the second fifth."""
    fifth = len(samples) // 5
    early = statistics.median(samples[fifth:2 * fifth])
    late = statistics.median(samples[-fifth:])
    print(f"soak: memory of the {name}: {early / 1024:,.0f} kB, at the end {late / 1024:,.0f} kB "
          f"({100 * (late / early - 1):+.2f} %)", flush=True)
    campaign.check(late <= early * (1 + MOST_GROWTH),
                   f"the {name} grew from {early / 1024:.0f} to {late / 1024:.0f} kB")


def lockstep(campaign, steps):
    """Runs a training of `steps` commands through ROS; returns `steps`, or None after a failure."""
    samples = {"sim node": [], "trainer": []}
    with tempfile.TemporaryDirectory(prefix="aquafarm_soak_") as place, \
            ros.Ros(campaign, pathlib.Path(place)) as ranch:
        processes = {"sim node": ranch.sim("aquafarm"),
                     "trainer": ranch.train("aquafarm", "run", steps)}
        for _ in range(int(LIMIT_S / SAMPLE_S)):
            for name, process in processes.items():
                size = ros.memory(process)
                samples[name].extend([size] if size else [])
            try:
                code = processes["trainer"].wait(timeout=SAMPLE_S)
                break
            except subprocess.TimeoutExpired:
                code = None
        if not campaign.check(code == 0, f"ros: exit code {code}: {ranch.log('run')[-1000:]}"):
            return None
        campaign.attempt("commands through ROS", steps)
        campaign.attempt("calls through ROS", steps // ros.FARMS)
    for name, values in samples.items():
        if campaign.check(len(values) >= FEWEST_SAMPLES, f"ros: only {len(values)} measurements of "
                          f"the memory of the {name}; give a higher --count"):
            check_flat(campaign, name, values)
    return steps


def run(campaign):
    """Runs the kinds with one seed, then with the next seed, and so on. campaign.count is the
    number of steps in millions. If the kind random takes part, only its steps count."""
    kinds = campaign.kinds([*KINDS, "ros"]) if campaign.only else list(KINDS)
    steps, seed = 0, campaign.seed
    while campaign.more(steps // MILLION):
        for kind in kinds:
            done = (lockstep(campaign, MILLION * max(1, campaign.count)) if kind == "ros" else
                    soak(campaign, kind, seed))
            if done is None:
                return
            steps += done if kind == "random" or "random" not in kinds else 0
        seed += 1
