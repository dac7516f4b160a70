# SPDX-License-Identifier: BSD-3-Clause
"""Each campaign in a short form, and how campaigns report failures and end. The short forms are
skipped unless AQUAFARM_CAMPAIGNS names a workspace."""
import contextlib
import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

TOOLS = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOOLS))
from campaigns import common  # noqa: E402

CAMPAIGN = TOOLS / "campaign"
WORKSPACE = os.environ.get("AQUAFARM_CAMPAIGNS", "")
LIMIT_S = 900
# Each takes seconds on an idle machine. The other fuzz targets are tests of the cores.
SHORT = ("soak --count 1 --only random",
         "soak --seconds 1 --only planner",
         "kill --count 2 --only tables,sim_node",
         "kill --count 5 --only networks,recorder,benchmark,ranks,workers --kills 1",
         "resources --count 6",
         "network --count 4",
         "concurrency --count 1",
         "fuzz --count 1 --only bag,request")


def campaign(*words):
    return subprocess.run([CAMPAIGN, *map(str, words)], capture_output=True, text=True,
                          timeout=LIMIT_S, check=False)


@pytest.mark.skipif(not WORKSPACE, reason="AQUAFARM_CAMPAIGNS names no workspace")
@pytest.mark.parametrize("words", SHORT)
def test_campaign_finds_no_failure(words):
    done = campaign(*words.split(), "--workspace", WORKSPACE)
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{words.split()[0]}: 0 failures in " in done.stdout


def test_a_failure_is_reported_with_exit_code_1(tmp_path):
    programs = tmp_path / "core" / "aquafarm_sim"
    programs.mkdir(parents=True)
    (programs / "farm_soak").write_text("#!/bin/sh\necho 'x.yaml: 5 steps, 1 episodes'; exit 1\n")
    (programs / "farm_soak").chmod(0o755)
    done = campaign("soak", "--count", 1, "--only", "random", "--workspace", tmp_path)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "FAILED farm_soak 200000 1: exit code 1: ['x.yaml: 5 steps, 1 episodes']" in done.stderr
    assert "soak: 1 failures in " in done.stdout


def test_an_unknown_kind_is_refused_with_those_there_are():
    done = campaign("kill", "--only", "tables,dog")
    assert done.returncode == 2
    assert ("--only: got 'dog', expected one of: tables, networks, sim_node, recorder, benchmark, "
            "ranks, workers" in done.stderr)


def test_a_program_that_is_not_built_is_named(tmp_path):
    done = campaign("kill", "--workspace", tmp_path)
    assert done.returncode == 2
    assert f"no program aquafarm_train in {tmp_path}" in done.stderr


# A trainer that ends at once in the uninterrupted run. In other runs it writes its process id to
# a file and runs until it is killed.
TRAINER = """#!/bin/bash
while [[ $1 != -d ]]; do shift; done
mkdir -p "$2"
touch "$2/policy.ckpt" "$2/metrics.csv"
[[ $2 == *_whole ]] && exit 0
echo $$ >>"$PIDS"
exec sleep 600
"""


def is_running(pid):
    try:
        state = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state not in "ZX"


def wait_for_a_trainer(pids, campaign_process):
    """Waits until a trainer, whose process id is in the file `pids`, has run for a second. The
    campaign kills the first trainer early, but not the second one."""
    end = time.monotonic() + 120
    last, since = None, time.monotonic()
    while last is None or time.monotonic() - since < 1.0:
        assert campaign_process.poll() is None and time.monotonic() < end
        time.sleep(0.05)
        listed = pids.read_text().split() if pids.exists() else []
        newest = listed[-1] if listed and is_running(listed[-1]) else None
        if newest is None or newest != last:
            last, since = newest, time.monotonic()


def test_ctrl_c_ends_the_program_that_runs(tmp_path):
    trainer = tmp_path / "core" / "aquafarm_agents" / "aquafarm_train"
    trainer.parent.mkdir(parents=True)
    trainer.write_text(TRAINER)
    trainer.chmod(0o755)
    pids = tmp_path / "pids"
    process = subprocess.Popen([CAMPAIGN, "kill", "--only", "tables", "--count", "1",
                                "--kills", "1", "--workspace", tmp_path],
                               env=dict(os.environ, PIDS=str(pids)), stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    try:
        wait_for_a_trainer(pids, process)
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 130
        assert not [pid for pid in pids.read_text().split() if is_running(pid)]
    finally:
        process.kill()
        process.wait()
        for pid in pids.read_text().split() if pids.exists() else []:
            with contextlib.suppress(ProcessLookupError):
                if is_running(pid):
                    os.kill(int(pid), signal.SIGKILL)


def test_ctrl_c_ends_the_children_of_a_program_that_was_killed():
    child = None
    with pytest.raises(KeyboardInterrupt):
        with common.started("bash", "-c", "sleep 600 & echo $!; wait") as process:
            child = int(process.stdout.readline())
            process.kill()
            process.wait()
            assert is_running(child)
            raise KeyboardInterrupt
    assert not is_running(child)
