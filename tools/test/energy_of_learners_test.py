#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/energy_of_learners.py and tools/energy_curve.py with programs that replace the training and
the evaluation."""
import csv
import os
import pathlib
import subprocess
import sys

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from energy_curve import energy_block  # noqa: E402

CURVE = ROOT / "tools" / "energy_curve.py"
TOOL = ROOT / "tools" / "energy_of_learners.py"
# Each training appends its arguments to the file `calls`. A policy of weight w uses 100 - w kWh and
# has a return of 200 - w without the term of energy.
TRAIN = """#!/bin/bash
echo "$*" >>calls
while [[ $1 != -d ]]; do shift; done
mkdir "$2"
"""
EVALUATE = """#!/usr/bin/python3
import json, re, sys
weight = float(re.search(r"weight: ([0-9.]+)", open(sys.argv[2]).read()).group(1))
out = sys.argv[sys.argv.index("-w") + 1] + ".json"
energy = 100 - weight
json.dump({"episodes": 7, "energy_kwh_per_episode": energy, "distance_km_per_episode": 50.0,
           "return_per_episode": 200 - weight - weight * energy, "success_rate": 1.0,
           "steps_per_episode": 9.0}, open(out, "w"))
"""


@pytest.fixture
def run(tmp_path):
    for name, text in (("aquafarm_train", TRAIN), ("aquafarm_evaluate", EVALUATE)):
        (tmp_path / name).write_text(text, encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    (tmp_path / "ranch.yaml").write_text("name: ranch\n", encoding="utf-8")

    def call(*words, algorithm="ppo"):
        done = subprocess.run([TOOL, "ranch.yaml", algorithm, "out.csv", "--seeds", "2", *words],
                              cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True,
                              env=dict(os.environ, PATH=f"{tmp_path}:{os.environ['PATH']}"))
        calls = (tmp_path / "calls").read_text(encoding="utf-8").splitlines()
        return done.stdout.splitlines(), calls
    return call


def test_the_table_has_the_changes_relative_to_the_first_weight(run):
    lines, _ = run("--weights", "0", "10")
    assert lines[2] == "| 0 | 2 | 200.0 | 100.00 | 1.000 |  |  |"
    assert lines[3] == ("| 10 | 2 | 190.0 | 90.00 | 1.000 | -5.0 % (-5.0 … -5.0) | "
                        "-10.0 % (-10.0 … -10.0) |")


def test_a_second_run_trains_only_what_is_missing(run):
    first, calls = run("--weights", "0", "10")
    assert len(calls) == 4
    again, calls = run("--weights", "0", "10")
    assert (again, len(calls)) == (first, 4)
    _, calls = run("--weights", "0", "10", "20")
    assert len(calls) == 6


def test_another_algorithm_has_its_own_trainings_and_table(run):
    run("--weights", "0", "10")
    lines, calls = run("--weights", "0", "10", algorithm="dqn")
    assert [("-a dqn" in call) for call in calls] == 4 * [False] + 4 * [True]
    assert lines[2].startswith("| 0 | 2 |")


def test_later_weights_start_with_the_policy_of_the_first(run):
    _, calls = run("--weights", "0.001", "3", "--from-first", "--", "-n", "500")
    starts = [call.partition("--init ")[2] for call in calls]
    assert starts == ["", "out/ppo_1_0.001 -n 500", "", "out/ppo_2_0.001 -n 500"]
    assert all(call.endswith("-n 500") for call in calls)


def test_a_curve_has_a_row_and_a_mark_for_each_weight(run, tmp_path):
    # The fixture `run` has written the programs.
    subprocess.run([CURVE, "ranch.yaml", "planner", "7", "curve.csv", "0", "10"], cwd=tmp_path,
                   timeout=60, check=True,
                   env=dict(os.environ, PATH=f"{tmp_path}:{os.environ['PATH']}"))
    with open(tmp_path / "curve.csv", newline="", encoding="utf-8") as file:
        rows = [(row["policy"], row["weight"], float(row["return_without_energy"]),
                 float(row["energy_kwh"])) for row in csv.DictReader(file)]
    assert rows == [("planner", "0", 200.0, 100.0), ("planner", "10", 190.0, 90.0)]
    assert (tmp_path / "curve.svg").read_text(encoding="utf-8").count("<circle") == 2


@pytest.mark.parametrize("block", ["{weight: 5, per_km: 1.5}", "{per_km: 1.5, weight: 5}",
                                   "{per_km: 1.5}"])
def test_a_block_of_the_scenario_keeps_its_values_and_gets_the_weight(block):
    text = energy_block(f"name: ranch\nenergy: {block}\n", 3.0)
    assert text.count("weight") == 1
    assert yaml.safe_load(text) == {"name": "ranch", "energy": {"weight": 3, "per_km": 1.5}}
