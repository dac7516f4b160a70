# SPDX-License-Identifier: BSD-3-Clause
"""Gives mutated and huge files to readers. The fuzz targets read mutated samples. libFuzzer mutates
the samples if the targets were built with AQUAFARM_FUZZ; otherwise fuzz/mutate.cpp mutates them.
The program aquafarm_scenario reads the huge files."""
import json
import os
import pathlib
import re
import resource
import subprocess
import tempfile

from campaigns import common

TARGETS = ("chart", "hazard_file", "map_yaml", "preset", "scenario", "sea", "checkpoint", "fleet",
           "bag", "request")
ROUND_S = 30        # libFuzzer's time for each target in a round
# Argument CHANGES of mutate.cpp: a sixth of the mutated inputs of a target in a round.
CHANGES = 20_000
SLOW = {"bag": 500, "checkpoint": 500, "request": 2_000}  # CHANGES for slow targets
LENGTH = 1024       # max input size of libFuzzer [bytes]; longer inputs take more time
LENGTHS = {"preset": 96, "map_yaml": 256, "fleet": 400, "request": 400, "bag": 60_000,
           "checkpoint": 16_384}
# Without -entropic=0, libFuzzer weights inputs by rare features, which takes half of the time of a
# fast target. With halt_on_error, undefined behaviour ends a target like an invalid address. Short
# stack traces and a small quarantine save time.
QUICK = ("-entropic=0", "-reduce_inputs=0")
SANITIZERS = {"UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
              "ASAN_OPTIONS": "malloc_context_size=2:quarantine_size_mb=8"}
MOST_S = 20         # max time to read one file [s]: wall time in libFuzzer, else processor time
MOST_MEMORY = 1 << 30  # max memory to read one file [bytes]
DATA = common.ROOT / "aquafarm_sim" / "core" / "test"


def corpus(name):
    """Returns the folders of samples for a target, the same as in its CMakeLists.txt."""
    if name == "checkpoint":
        old = common.ROOT / "aquafarm_agents" / "core" / "test" / "data" / "version_0_1_0"
        return [*(old / run for run in ("dqn", "lstm_dqn", "maddpg", "q_learning", "sarsa")),
                old.parents[1] / "fuzz_checkpoint"]
    if name == "fleet":
        return [common.ROOT / "aquafarm_agents" / "core" / "test" / "fuzz_fleet"]
    if name in ("bag", "request"):
        return [common.ROOT / "aquafarm_sim" / "test" / f"fuzz_{name}"]
    if name == "scenario":
        return [DATA / "invalid_scenarios", common.SCENARIOS]
    return [DATA / f"fuzz_{name}"] if name in ("map_yaml", "preset", "sea") else [DATA / "data"]


def run_target(campaign, name, seed, place):
    """Runs a target for one round and counts the inputs. After a failure, moves the inputs that
    caused the failure to the working directory of this program. Rounds share the folder `place`, in
    which libFuzzer keeps inputs that reach new code."""
    program = campaign.program(f"fuzz_{name}")
    grown = place / name
    grown.mkdir(exist_ok=True)
    if b"LLVMFuzzerRunDriver" in program.read_bytes():
        words = [f"-max_total_time={ROUND_S}", f"-seed={seed}", f"-timeout={MOST_S}",
                 f"-malloc_limit_mb={MOST_MEMORY >> 20}", f"-rss_limit_mb={2 * MOST_MEMORY >> 20}",
                 f"-max_len={LENGTHS.get(name, LENGTH)}", "-print_final_stats=1", *QUICK, grown]
    else:
        words = [f"--seed={seed}", SLOW.get(name, CHANGES)]
    code, output = common.execute(program, *words, *corpus(name), seconds=ROUND_S * 30, cwd=place,
                                  env={**os.environ, **SANITIZERS})
    inputs = re.search(r"stat::number_of_executed_units: (\d+)|inputs: (\d+)", output)
    campaign.attempt(f"inputs of fuzz_{name}", int(inputs.group(1) or inputs.group(2))
                     if inputs else 0)
    if not campaign.check(code == 0, f"fuzz_{name}: seed {seed}: exit code {code}: "
                          f"{output[-600:]}"):
        # mutate.cpp does not save inputs. Targets that read a file leave their input in /dev/shm.
        left = pathlib.Path("/dev/shm").glob(f"fuzz_{name}.*")
        kinds = ("crash-*", "leak-*", "oom-*", "timeout-*")
        for found in [*(path for kind in kinds for path in place.glob(kind)), *left]:
            kept = pathlib.Path.cwd() / f"fuzz_{name}_{found.name}"
            kept.write_bytes(found.read_bytes())
            found.unlink()
            print(f"kept {kept}")


def bulletin(points):
    """Returns an invalid bulletin: a storm of `points` points that all have the same time."""
    point = json.dumps({"time": "2021-07-25T14:00:00", "lat": 30, "lng": 122, "pressure": 50})
    return ('[{"tfbh": "202106", "points": [' + ",\n".join([point] * points) + "]}]").encode()


def huge_files():
    """Yields (name, arguments, bytes) of files for which earlier versions needed minutes or
    gigabytes."""
    yield "bulletin.json", ["--track", "--center", "30,122"], bulletin(150_000_000 // 75)
    yield "line.json", ["--track", "--center", "30,122"], b"[" + b" " * 500_000_000 + b"]"
    yield "deep.json", ["--chart", "--center", "30,122"], b"[" * 100_000_000
    yield "bst.txt", ["--track", "--center", "30,122"], \
        b"66666 0000 01 0012 0000 0 6 (nameless) 20200101\n" + \
        b"2019072500 1 297 1230 1000 12\n" * 3_000_000
    yield "sea.asc", ["--chart", "--center", "30,122"], \
        b"ncols 20000\nnrows 20000\nxllcorner 122\nyllcorner 30\ncellsize 0.001\n" + b"1 " * 50_000_000
    yield "image.pgm", ["--chart", "--center", "30,122"], b"P5 60000 60000 255\n" + bytes(1000)


def limit_memory():
    """Limits the address space of this process to MOST_MEMORY. Allocations beyond it fail."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def read_huge(campaign, name, arguments, content):
    """Runs aquafarm_scenario on one huge file. It must exit with code 0 or 2 within MOST_S seconds
    of processor time and within MOST_MEMORY."""
    with tempfile.TemporaryDirectory(prefix="aquafarm_fuzz_") as place:
        path = pathlib.Path(place) / name
        path.write_bytes(content)
        program = campaign.program("aquafarm_scenario")
        words = [program, *arguments[1:], arguments[0], path]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with common.started(*words, preexec_fn=limit_memory) as process:
            try:
                output = process.communicate(timeout=30 * MOST_S)[0].decode(errors="replace")
            except subprocess.TimeoutExpired:
                process.kill()
                output = process.communicate()[0].decode(errors="replace")
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    what = f"{name} of {len(content) >> 20} MiB"
    campaign.attempt("huge files")
    campaign.check(process.returncode in (0, 2), f"{what}: exit code {process.returncode}: "
                   f"{output[-300:]}")
    campaign.check(seconds < MOST_S, f"{what}: took {seconds:.0f} s, expected less than {MOST_S}")


def run(campaign):
    """Runs campaign.count rounds over the targets. If the count is 0, starts rounds for
    campaign.seconds. Then reads each huge file once unless --only is given."""
    with tempfile.TemporaryDirectory(prefix="aquafarm_fuzz_") as place:
        number = 0
        while campaign.more(number):
            for name in campaign.kinds(TARGETS):
                run_target(campaign, name, campaign.seed + number, pathlib.Path(place))
            number += 1
    for name, arguments, content in [] if campaign.only else huge_files():
        read_huge(campaign, name, arguments, content)
