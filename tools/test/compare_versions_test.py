# SPDX-License-Identifier: BSD-3-Clause
"""tools/compare_versions.py: ratios of the figures of two workspaces."""
import pathlib
import subprocess

PROGRAM = pathlib.Path(__file__).resolve().parent.parent / "compare_versions.py"


def workspace(folder, *lines):
    """Makes a workspace whose bench_sim prints some lines."""
    program = folder / "core/aquafarm_sim/bench_sim"
    program.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\n" + "\n".join(f"echo '{line}'" for line in lines) + "\n")
    program.chmod(0o755)
    return folder


def compare(*words):
    return subprocess.run([PROGRAM, *words, "--only", "sim"], capture_output=True, text=True,
                          timeout=60, check=False)


def test_a_higher_rate_and_a_lower_cost_are_both_above_1(tmp_path):
    old = workspace(tmp_path / "old", "a table", "rate 100 steps/s", "reset 3 ms",
                    "size 8 bytes/farm", "sent 5 MB/s", "cost_per_ship 2 ratio", "share 2 ratio", "gone 1 x")
    new = workspace(tmp_path / "new", "rate 150 steps/s", "reset 2 ms", "size 4 bytes/farm",
                    "sent 10 MB/s", "cost_per_ship 1 ratio", "share 1 ratio")
    done = compare(old, new, "--rounds", "2")
    assert done.returncode == 0, done.stderr
    found = {line.split()[0]: line.split(maxsplit=1)[1] for line in done.stdout.splitlines()}
    assert found == {"rate": "1.500 (1.500 to 1.500), n 2, steps/s",
                     "reset": "1.500 (1.500 to 1.500), n 2, ms",
                     "size": "2.000 (2.000 to 2.000), n 2, bytes/farm",
                     "sent": "2.000 (2.000 to 2.000), n 2, MB/s",
                     "cost_per_ship": "2.000 (2.000 to 2.000), n 2, ratio",
                     "share": "0.500 (0.500 to 0.500), n 2, ratio",
                     "gone": "printed by only one version"}


def test_a_workspace_that_is_not_built_is_named(tmp_path):
    done = compare(workspace(tmp_path / "old", "rate 1 steps/s"), tmp_path / "none")
    assert done.returncode == 1
    assert f"compare_versions: {tmp_path}/none/core/aquafarm_sim/bench_sim: " in done.stderr
    assert done.stderr.endswith("; build it with ./aquafarm bench\n")
    assert compare(tmp_path, tmp_path, "--rounds", "1").returncode == 2
