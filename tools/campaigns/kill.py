# SPDX-License-Identifier: BSD-3-Clause
"""Kills trainers (SIGKILL) at random moments and resumes them until they end by themselves. The
result must equal that of an uninterrupted run bit for bit, and no temporary file may be left."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time

from campaigns import common

# Arguments of each learner: tables often, networks now and then. Each takes about a second.
TABLES = {"q_learning": ["-n", "400000"], "sarsa": ["-n", "400000"],
          "random": ["-n", "400000"]}
NETWORKS = {"dqn": ["-n", "3000", "-o", "hidden=16", "-o", "start=200", "-o", "replay=2000"],
            "ppo": ["-n", "8000", "-f", "16", "-o", "hidden_size=16", "-o", "rollout_size=512",
                    "-o", "batch_size=128"]}
NETWORK_EVERY = 20   # one try in so many trains a network
MOST_KILLS = 30      # in one run; the last attempt is left to end
LIMIT_S = 300


def command(trainer, name, arguments, folder, resume):
    return [str(trainer), "paper", "-a", name, *arguments, "--checkpoint-period", "0.02",
            "--evaluate", "0", "--random", "0", "--scenarios", str(common.SCENARIOS), "-d",
            str(folder), *(["--resume"] if resume else [])]


def holds_run(folder):
    return (folder / "run.json").exists() or any(folder.glob("checkpoints/step_*.ckpt"))


def results(folder):
    """The files that an interruption must not change."""
    return {name: (folder / name).read_bytes() for name in ("policy.ckpt", "metrics.csv")}


class Reference:
    """An uninterrupted run, and how long it took."""

    def __init__(self, campaign, trainer, name, arguments, folder):
        begin = time.monotonic()
        code, words = common.execute(*command(trainer, name, arguments, folder, False),
                                     seconds=LIMIT_S)
        self.seconds = time.monotonic() - begin
        self.good = campaign.check(code == 0, f"{name}: uninterrupted: exit code {code}: {words}")
        self.results = results(folder) if self.good else {}


def interrupted_run(campaign, arguments_of, folder, longest_s):
    """Runs until the end with a kill at random moments. Returns the last output, or None."""
    for kills in range(MOST_KILLS + 1):
        process = subprocess.Popen(arguments_of(holds_run(folder)), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        wait_s = campaign.rng.uniform(0.0, longest_s) if kills < MOST_KILLS else LIMIT_S
        try:
            words = process.communicate(timeout=wait_s)[0].decode(errors="replace")
            campaign.check(process.returncode == 0,
                           f"{folder.name}: exit code {process.returncode} after {kills} kills: {words}")
            return words if process.returncode == 0 else None
        except subprocess.TimeoutExpired:
            os.kill(process.pid, signal.SIGKILL)
            process.communicate()
            campaign.attempt("kills")
    return None


def try_once(campaign, trainer, reference, name, arguments, folder):
    """One run with kills; its results must equal the reference."""
    words = interrupted_run(
        campaign, lambda resume: command(trainer, name, arguments, folder, resume), folder,
        0.7 * reference.seconds)
    if words is None:
        return
    campaign.attempt(f"runs of {name} compared")
    for file, expected in reference.results.items():
        campaign.check((folder / file).read_bytes() == expected,
                       f"{name}: {file} differs from the uninterrupted run in {folder}")
    campaign.check(not common.left_over(folder), f"{name}: left {common.left_over(folder)}")


def run(campaign):
    """Count is the number of runs."""
    trainer = campaign.program("aquafarm_train")
    references = {}
    number = 0
    with tempfile.TemporaryDirectory(prefix="aquafarm_kill_") as place:
        place = pathlib.Path(place)
        while campaign.more(number) and not campaign.failures:
            kinds = NETWORKS if number % NETWORK_EVERY == NETWORK_EVERY - 1 else TABLES
            name = campaign.rng.choice(sorted(kinds))
            if name not in references:
                references[name] = Reference(campaign, trainer, name, kinds[name], place / name)
            if references[name].good:
                folder = place / f"{name}_{number}"
                try_once(campaign, trainer, references[name], name, kinds[name], folder)
                common.remove(folder)
            number += 1
