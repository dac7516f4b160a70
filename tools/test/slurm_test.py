# SPDX-License-Identifier: BSD-3-Clause
"""The batch files of docs/scale in a Slurm of one node. ./aquafarm test names the workspace; without
one, and without the programs of Slurm, the tests are skipped."""
import importlib.util
import os
import pathlib
import subprocess
import sys
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import one_node_slurm  # noqa: E402

WORKSPACE = os.environ.get("AQUAFARM_CAMPAIGNS", "")
TRAIN = pathlib.Path(WORKSPACE, "core/aquafarm_agents/aquafarm_train")
LIMIT_S = 600.0
SHORT = ["-n", "12000", "-f", "16", "-o", "hidden_size=16", "-o", "rollout_size=1024", "--evaluate",
         "20", "--random", "0"]
RESULTS = ("policy.ckpt", "metrics.csv", "evaluation.csv")

pytestmark = pytest.mark.skipif(not WORKSPACE, reason="AQUAFARM_CAMPAIGNS names no workspace")


@pytest.fixture(scope="module", name="slurm")
def started_slurm():
    try:
        with one_node_slurm.OneNodeSlurm() as slurm:
            yield slurm
    except one_node_slurm.NoSlurm as error:
        if os.environ.get("AQUAFARM_TEST_SLURM") == "1":
            pytest.fail(str(error))
        pytest.skip(str(error))


def submit(slurm, folder, scenario, file, *options):
    """Submits a batch file; returns once its jobs have ended."""
    folder.mkdir()
    run = folder / "run"
    job = slurm.call("sbatch", "--parsable", "--chdir", folder, *options, ROOT / "docs/scale" / file,
                     *SHORT, AQUAFARM_TRAIN=str(TRAIN), RUN_DIR=str(run), SCENARIO=scenario).strip()
    end = time.monotonic() + LIMIT_S
    while slurm.call("squeue", "-h"):
        assert time.monotonic() < end, slurm.call("squeue")
        time.sleep(0.5)
    return run, job


def without_slurm(run, scenario, *words):
    """Trains in one process of its own."""
    done = subprocess.run([str(TRAIN), scenario, "--algorithm", "ppo", "--run-dir", str(run), *words,
                           *SHORT], capture_output=True, text=True, timeout=LIMIT_S, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def require_equal(run, other, output):
    for name in RESULTS:
        assert (run / name).is_file(), output
        assert (run / name).read_bytes() == (other / name).read_bytes(), f"{name} differs\n{output}"


def output_of(folder):
    return "".join(path.read_text(errors="replace") for path in sorted(folder.glob("*.txt")))


@pytest.mark.parametrize("scenario", ["procedural", "zhoushan_storms"])
def test_a_training_of_two_tasks_ends_like_one_without_slurm(slurm, tmp_path, scenario):
    run, _ = submit(slurm, tmp_path / "slurm", scenario, "train.sbatch", "--ntasks=2")
    output = output_of(tmp_path / "slurm")
    assert "ranks      2" in output
    without_slurm(tmp_path / "alone", scenario, "--set", "shards=8", "--set", "batch_size=2048")
    require_equal(run, tmp_path / "alone", output)


def test_an_array_trains_one_seed_per_job(slurm, tmp_path):
    run, job = submit(slurm, tmp_path / "slurm", "procedural", "seeds.sbatch")
    for seed in range(1, 6):
        without_slurm(tmp_path / f"alone_{seed}", "procedural", "--seed", str(seed))
        require_equal(run / f"seed_{seed}", tmp_path / f"alone_{seed}",
                      output_of(tmp_path / "slurm"))
    policies = {(run / f"seed_{seed}" / "policy.ckpt").read_bytes() for seed in range(1, 6)}
    assert len(policies) == 5
    assert len(list((tmp_path / "slurm").glob(f"aquafarm-seeds-{job}_*.txt"))) == 5


def sweep(output):
    """Returns a command that trains two seeds."""
    return list(map(str, [ROOT / "aquafarm_agents/scripts/aquafarm_sweep", "procedural", "ppo",
                          "--seeds", "1-2", "--steps", "12000", "--episodes", "20", "--programs",
                          TRAIN.parent, "--output", output]))


@pytest.fixture(scope="module", name="table")
def table_without_slurm(tmp_path_factory):
    output = tmp_path_factory.mktemp("sweep") / "here"
    subprocess.run(sweep(output), timeout=LIMIT_S, check=True)
    return (output / "table.csv").read_text()


def test_a_sweep_on_dask_workers_of_a_job_gives_the_table_of_this_machine(slurm, tmp_path, table):
    slurm.call("sbatch", "--wait", "--chdir", tmp_path, "--ntasks=2", "--time=10", ROOT / "docs/scale/dask.sbatch",
               *sweep(tmp_path / "there"))
    assert "2 trainings" in output_of(tmp_path)
    assert (tmp_path / "there/table.csv").read_text() == table


PROBE = """#!/usr/bin/python3
import os, subprocess, sys
from distributed import Client
from distributed.security import Security
address = sys.argv[2]
with Client(address, timeout=120) as client:
    print("own key:", client.submit(sum, [1, 2]).result())
subprocess.run("openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=other -keyout key -out cert",
               shell=True, check=True, capture_output=True)
other = Security(require_encryption=True, tls_client_cert="cert", tls_client_key="key",
                 tls_ca_file=os.environ["DASK_DISTRIBUTED__COMM__TLS__CA_FILE"])
for place, security in ((address, other),
                        (address.replace("tls", "tcp"), Security(require_encryption=False))):
    try:
        Client(place, timeout=10, security=security)
    except (OSError, RuntimeError) as error:
        print("refused", place[:3])
"""


def test_the_scheduler_of_a_job_refuses_programs_without_its_key(slurm, tmp_path):
    (tmp_path / "probe").write_text(PROBE)
    (tmp_path / "probe").chmod(0o755)
    slurm.call("sbatch", "--wait", "--chdir", tmp_path, "--ntasks=2", "--time=10",
               ROOT / "docs/scale/dask.sbatch", tmp_path / "probe")
    output = output_of(tmp_path)
    for words in ("own key: 3", "refused tls", "refused tcp"):
        assert words in output, output
    assert not list(tmp_path.glob(".aquafarm-dask-*"))  # the key


needs_jobqueue = pytest.mark.skipif(importlib.util.find_spec("dask_jobqueue") is None,
                                    reason="dask-jobqueue of PyPI is not installed")


@needs_jobqueue
def test_a_job_that_slurm_refuses_is_reported_in_one_line(slurm, tmp_path):
    done = subprocess.run([*sweep(tmp_path / "there"), "--scheduler", "slurm"], cwd=tmp_path,
                          env={**slurm.environment, "DASK_JOBQUEUE__SLURM__QUEUE": "nowhere"},
                          timeout=LIMIT_S, check=False, capture_output=True, text=True)
    assert done.returncode == 2, done.stdout + done.stderr
    assert "scheduler: got 'slurm', which does not accept a job: " in done.stderr, done.stderr
    assert "invalid partition" in done.stderr and done.stderr.count("\n") == 1, done.stderr


@needs_jobqueue
def test_a_sweep_that_submits_its_workers_gives_the_table_of_this_machine(slurm, tmp_path, table):
    done = subprocess.run([*sweep(tmp_path / "there"), "--scheduler", "slurm", "--jobs", "2"],
                          cwd=tmp_path, env=slurm.environment, timeout=LIMIT_S, check=False,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / "there/table.csv").read_text() == table
