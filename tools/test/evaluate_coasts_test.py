# SPDX-License-Identifier: BSD-3-Clause
"""tools/evaluate_coasts.py on the small chart of the tests and the shipped archive of storms. Without
the programs of a workspace (AQUAFARM_CAMPAIGNS) the tests are skipped."""
import csv
import json
import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORKSPACE = os.environ.get("AQUAFARM_CAMPAIGNS", "")
CHART = ROOT / "aquafarm_sim/core/test/data/coast.json"
ARCHIVE = ROOT / "aquafarm_sim/scenarios/archives/zhoushan_cma.txt"
EPISODES = 3

pytestmark = pytest.mark.skipif(not WORKSPACE, reason="AQUAFARM_CAMPAIGNS names no workspace")


def evaluate(output, ranches):
    """Returns the completed process."""
    path = os.pathsep.join([f"{WORKSPACE}/core/aquafarm_agents", f"{WORKSPACE}/devel/lib/aquafarm_sim",
                            f"{WORKSPACE}/core/aquafarm_sim", os.environ["PATH"]])
    return subprocess.run([ROOT / "tools/evaluate_coasts.py", CHART, ARCHIVE, output, "--ranches",
                           str(ranches), "--episodes", str(EPISODES), "--seed", "4"],
                          env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False,
                          timeout=300)


def rows_of(folder):
    with open(folder / "ranches.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_last_line_sums_the_ranches_and_a_second_run_continues(tmp_path):
    first = evaluate(tmp_path, 2)
    assert first.returncode == 0, first.stderr
    rows = rows_of(tmp_path)
    assert [row["ranch"] for row in rows] == ["0", "1"]
    for row in rows:
        figures = json.loads((tmp_path / f"coast_{row['ranch']}.json").read_text(encoding="utf-8"))
        assert figures["episodes"] == figures["distinct_episodes"] == EPISODES
        assert figures["return_per_episode"] == pytest.approx(float(row["return"]))
    more = evaluate(tmp_path, 3)
    assert more.returncode == 0, more.stderr
    assert rows_of(tmp_path)[:2] == rows
    assert len(re.findall(r"^ranch \d+ of 3", more.stderr, re.MULTILINE)) == 1
    planned = [row for row in rows_of(tmp_path) if int(row["planned"])]
    assert planned
    share = (sum(float(row["return_of_planned"]) * int(row["planned"]) for row in planned)
             / sum(float(row["optimum"]) * int(row["planned"]) for row in planned))
    words = re.search(r"share ([-0-9.]+) \[([-0-9.]+), ([-0-9.]+)\]; (\d+) of (\d+) solved$",
                      more.stdout.strip())
    assert float(words[1]) == pytest.approx(share, abs=1e-4)
    assert float(words[2]) <= share + 1e-4 and share - 1e-4 <= float(words[3])
    assert int(words[5]) == sum(int(row["solvable"]) for row in planned)


def test_the_ranches_are_those_of_the_seed(tmp_path):
    for name in ("a", "b"):
        assert evaluate(tmp_path / name, 1).returncode == 0
    ranch = [(tmp_path / name / "coast_0.yaml").read_text(encoding="utf-8") for name in ("a", "b")]
    assert ranch[0] == ranch[1]
