#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command in a Slurm cluster of one node. Needs Debian's packages munge, slurmctld, slurmd
and slurm-client.

Usage, as root: one_node_slurm.py COMMAND [ARGUMENT…]
The environment variable SLURM_CONF is set for the command, so that its sbatch, srun and squeue use
the cluster. The cluster ends when the command ends. All its files are in a temporary folder; a Slurm of this host is not changed.
"""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "sinfo")
START_S = 120.0
LIMIT_S = 600.0  # max time of a command that `call` runs [s]
CPUS = 8  # number that Slurm can assign to jobs; the machine may have fewer

CONFIGURATION = """ClusterName=aquafarm_test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmctldTimeout=600
SlurmdTimeout=600
MessageTimeout=60
NodeName=localhost NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory=65536 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class NoSlurm(RuntimeError):
    """Slurm cannot be started here. The message states the reason."""


def require():
    """Raises NoSlurm if a program is missing or this process is not root."""
    os.environ["PATH"] += ":/usr/sbin:/sbin"
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing:
        raise NoSlurm(f"no Slurm here: {', '.join(missing)} missing; install munge, slurmctld, slurmd "
                      "and slurm-client")
    if os.geteuid() != 0:
        raise NoSlurm("no Slurm here: its node must be started as root")


class OneNodeSlurm:
    """The cluster, as a context manager. Programs with the variables `environment` use it."""

    def __init__(self):
        require()
        self._folder = tempfile.TemporaryDirectory(prefix="aquafarm_slurm_")
        self.folder = pathlib.Path(self._folder.name)
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}
        self._daemons = []

    def __enter__(self):
        try:
            self._start()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for one in reversed(self._daemons):
            one.terminate()
            try:
                one.wait(20.0)
            except subprocess.TimeoutExpired:
                one.kill()
                one.wait()
        self._folder.cleanup()

    def _daemon(self, *command):
        with open(self.folder / f"{command[0]}.log", "ab") as log:
            self._daemons.append(subprocess.Popen(list(map(str, command)), stdout=log,
                                                  stderr=subprocess.STDOUT,
                                                  stdin=subprocess.DEVNULL, env=self.environment))

    def _start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        with socket.socket() as one, socket.socket() as other:
            one.bind(("", 0))
            other.bind(("", 0))
            ports = one.getsockname()[1], other.getsockname()[1]
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], folder=self.folder, controller_port=ports[0],
            node_port=ports[1], cpus=CPUS))
        # Without --force, munged refuses folders that other users can write to, such as /tmp.
        self._daemon("munged", "--foreground", "--force", "--key-file", key,
                     "--socket", self.folder / "munge.socket", "--pid-file",
                     self.folder / "munge.pid", "--log-file", self.folder / "munge.log",
                     "--seed-file", self.folder / "munge.seed", "--num-threads", 2)
        self._wait((self.folder / "munge.socket").exists)
        self._daemon("slurmctld", "-D", "-c")
        self._daemon("slurmd", "-D")
        self._wait(lambda: "idle" in self.call("sinfo", "-h", "-o", "%T", check=False))

    def _wait(self, condition):
        end = time.monotonic() + START_S
        while not condition():
            if time.monotonic() > end or any(one.poll() is not None for one in self._daemons):
                logs = "".join(path.read_text(errors="replace")[-1500:]
                               for path in sorted(self.folder.glob("*.log")))
                raise NoSlurm(f"Slurm did not start within {START_S:.0f} s:\n{logs}")
            time.sleep(0.2)

    def call(self, *command, check=True, **variables):
        """Runs a command in the cluster; returns its output."""
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False,
                              env={**self.environment, **variables}, timeout=LIMIT_S)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(map(str, command))}: exit code {done.returncode}: "
                               f"{done.stderr}")
        return done.stdout


def main(words):
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))  # ends the daemons
    if not words or words[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if words else 2
    try:
        with OneNodeSlurm() as slurm:
            return subprocess.run(words, env=slurm.environment, check=False).returncode
    except NoSlurm as error:
        print(f"one_node_slurm: {error}", file=sys.stderr)
        return 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
