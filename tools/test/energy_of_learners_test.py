#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/energy_of_learners.py with programs that replace the training and the evaluation."""
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
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

    def call(*words):
        done = subprocess.run([TOOL, "ranch.yaml", "ppo", "out.csv", "--seeds", "2", *words],
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


def test_later_weights_start_with_the_policy_of_the_first(run):
    _, calls = run("--weights", "0.001", "3", "--from-first", "--", "-n", "500")
    starts = [call.partition("--init ")[2] for call in calls]
    assert starts == ["", "out/ppo_1_0.001 -n 500", "", "out/ppo_2_0.001 -n 500"]
    assert all(call.endswith("-n 500") for call in calls)
