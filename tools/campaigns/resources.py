# SPDX-License-Identifier: BSD-3-Clause
"""Runs programs with a full disk, in a read-only folder, or with limits on file sizes, descriptors
or memory. Each program must succeed, or end with a nonzero exit code and a readable message. No
program may leave a partial file."""
import contextlib
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile

from campaigns import common

LIMIT_S = 300
UNPRIVILEGED_ID = 65534
# Output that no user should see: a raw exception, a report of a sanitizer, a Python traceback.
RAW = re.compile(r"terminate called|what\(\):|Traceback|ERROR: AddressSanitizer|internal error")
# Arguments of a training that takes a second and writes some checkpoints.
TRAINING = ("-a", "q_learning", "-n", "300000", "--checkpoint-period", "0.05", "--evaluate", "20",
            "--random", "0", "--scenarios", str(common.SCENARIOS))


def limits(**values):
    """Returns options of Popen that set resource limits (setrlimit). A write beyond the max file
    size then returns an error and sends no signal."""
    def apply():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        for name, value in values.items():
            resource.setrlimit(getattr(resource, f"RLIMIT_{name}"), (value, value))
    return {"preexec_fn": apply, "restore_signals": False}


def as_nobody():
    """Returns options of Popen that run a program as an unprivileged user. The root user could
    write to read-only folders."""
    if os.geteuid() != 0:
        return {}
    return {"user": UNPRIVILEGED_ID, "group": UNPRIVILEGED_ID, "extra_groups": []}


@contextlib.contextmanager
def small_disk(folder, kilobytes):
    """Mounts a file system of this size in a new folder; yields the folder, or None if this process
    may not mount."""
    folder.mkdir()
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs", str(folder)],
                          check=False, capture_output=True)
    try:
        yield folder if done.returncode == 0 else None
    finally:
        if done.returncode == 0:
            subprocess.run(["umount", "-l", str(folder)], check=False)


def of_memory_group():
    """Returns the folder in which memory_group() makes a control group. With cgroup version 1 it is
    the root of the memory controller, with version 2 the group of this process. None if neither
    exists."""
    for line in pathlib.Path("/proc/self/cgroup").read_text().splitlines():
        _, controllers, path = line.split(":", 2)
        if controllers == "memory":
            return pathlib.Path("/sys/fs/cgroup/memory")
        folder = pathlib.Path("/sys/fs/cgroup" + path)
        if not controllers and (folder / "memory.max").exists():
            return folder
    return None


@contextlib.contextmanager
def memory_group(megabytes):
    """Makes a control group with this memory limit. Yields the options of Popen for a process in
    it; None if this process may not make one."""
    parent = of_memory_group()
    group = parent / f"aquafarm_{os.getpid()}" if parent else None
    try:
        group.mkdir()
        limit = group / "memory.max"
        if not limit.exists():
            limit = group / "memory.limit_in_bytes"
        limit.write_text(str(megabytes << 20))
    except (OSError, AttributeError):
        if group and group.is_dir():
            group.rmdir()
        yield None
        return
    try:
        yield {"preexec_fn": lambda: (group / "cgroup.procs").write_text(str(os.getpid()))}
    finally:
        group.rmdir()


def judge(campaign, what, folder, code, words):
    """Records a failure if a program under a limit hung, crashed, printed text that RAW matches,
    failed without a message, or left temporary files."""
    campaign.attempt("programs under a limit")
    campaign.attempt("hung or crashed" if code is None or code < 0 else
                     "refusals" if code else "successes")
    lines = [line for line in words.splitlines() if line.strip()]
    shown = " | ".join(lines[-3:])
    campaign.check(code is not None, f"{what}: still running after {LIMIT_S} s")
    campaign.check(code is None or code >= 0, f"{what}: ended by signal {-(code or 0)}: {shown}")
    campaign.check(not RAW.search(words), f"{what}: raw words: {shown}")
    if code:
        campaign.check(bool(lines), f"{what}: exit code {code} without a message")
    if folder.is_dir():
        campaign.check(not common.left_over(folder), f"{what}: left {common.left_over(folder)}")


def train(campaign, what, folder, **options):
    """Trains under a limit and judges the training. If it failed but wrote a checkpoint, the
    checkpoint must be playable."""
    trainer = campaign.program("aquafarm_train")
    code, words = common.execute(trainer, "paper", *TRAINING, "-d", folder, seconds=LIMIT_S, **options)
    judge(campaign, what, folder, code, words)
    if code and any(folder.glob("checkpoints/step_*.ckpt")):
        evaluate = campaign.program("aquafarm_evaluate")
        code, words = common.execute(evaluate, folder, "-e", "2", seconds=LIMIT_S)
        campaign.check(code == 0, f"{what}: its checkpoint cannot be played: {words[-300:]}")
        campaign.attempt("checkpoints played afterwards")


def build_ranch(campaign, what, folder, output, **options):
    """Runs aquafarm_scenario and judges the run; returns its exit code."""
    program = campaign.program("aquafarm_scenario")
    code, words = common.execute(program, "--center", "30,122", "-o", output, seconds=LIMIT_S,
                                 **options)
    judge(campaign, what, folder, code, words)
    return code


def disk_full(campaign, place):
    kilobytes = campaign.rng.choice([16, 64, 300, 900, 1500, 2500])
    with small_disk(place / "disk", kilobytes) as disk:
        if disk is None:
            campaign.attempt("full disks left out: no right to mount")
        else:
            train(campaign, f"training on a disk of {kilobytes} kB", disk / "run")
            free = os.statvfs(disk).f_bavail * os.statvfs(disk).f_frsize
            (disk / "filler").write_bytes(bytes(free))
            output = disk / "ranch.yaml"
            code = build_ranch(campaign, "aquafarm scenario on a full disk", disk, output)
            campaign.check(code != 0, "aquafarm scenario: succeeded on a full disk")
            campaign.check(not output.exists(), "aquafarm scenario: half a file on a full disk")


def file_size(campaign, place):
    size = campaign.rng.choice([100, 4096, 100_000, 400_000])
    train(campaign, f"training with files of at most {size} bytes", place / "run",
          **limits(FSIZE=size))


def read_only(campaign, place):
    closed = place / "closed"
    closed.mkdir(mode=0o555)
    place.chmod(0o755)
    train(campaign, "training in a read-only folder", closed / "run", **as_nobody())
    code = build_ranch(campaign, "aquafarm scenario into a read-only folder", closed,
                       closed / "ranch.yaml", **as_nobody())
    campaign.check(code != 0, "aquafarm scenario: wrote into a read-only folder")


def descriptors(campaign, place):
    number = campaign.rng.randint(4, 12)
    train(campaign, f"training with {number} descriptors", place / "run", **limits(NOFILE=number))


def memory(campaign, place):
    megabytes = campaign.rng.choice([60, 150, 400, 700, 900, 1100, 1500])
    train(campaign, f"training with {megabytes} MB of address space", place / "run",
          **limits(AS=megabytes << 20))
    megabytes = campaign.rng.choice([20, 30, 40, 60, 100])
    build_ranch(campaign, f"aquafarm scenario with {megabytes} MB of address space", place,
                place / "ranch.yaml", **limits(AS=megabytes << 20))


def control_group(campaign, place):
    """Trains in a control group. The kernel kills a training that needs more memory than its group
    has. The next start must then read the files of the killed training and remove temporary
    files."""
    megabytes = campaign.rng.choice([20, 40, 60, 80, 100, 130, 160])
    folder, what = place / "run", f"training in a control group of {megabytes} MB"
    trainer = campaign.program("aquafarm_train")
    words = [trainer, "paper", *TRAINING, "-d", folder]
    with memory_group(megabytes) as group:
        if group is None:
            campaign.attempt("control groups left out: no right to make one")
            return
        code, output = common.execute(*words, seconds=LIMIT_S, **group)
    campaign.attempt("programs in a control group")
    if code == -signal.SIGKILL:
        campaign.attempt("programs that the kernel killed in their control group")
        resume = ["--resume"] if (folder / "run.json").exists() else []
        code, output = common.execute(*words, *resume, seconds=LIMIT_S)
        campaign.check(code == 0, f"{what}: the start after the kill failed: {output[-300:]}")
    judge(campaign, what, folder, code, output)


def run(campaign):
    """Makes campaign.count tries of the kinds of limits in turn. If the count is 0, starts tries
    for campaign.seconds."""
    kinds = [disk_full, read_only, descriptors, file_size, memory, control_group]
    number = 0
    while campaign.more(number):
        with tempfile.TemporaryDirectory(prefix="aquafarm_resources_") as place:
            kinds[number % len(kinds)](campaign, pathlib.Path(place))
        number += 1
