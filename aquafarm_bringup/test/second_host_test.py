#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""roslaunch starts a ship's agent, or a rank of a training with its sim node, on another host by
<machine>, as in docs/several_agents.md and docs/scale.md.

The other host is a network namespace with its own ssh server; skipped if either is unavailable."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xmlrpc.client

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from ranch import DATA, Program, SecondHost, free_port, program  # noqa: E402

SSHD = "/usr/sbin/sshd"
LAUNCH = """<launch>
  <machine name="boat" address="{there}" user="{user}" ssh-port="2222" env-loader="{loader}"/>
  <include file="$(find aquafarm_bringup)/launch/agents.launch">
    <arg name="scenario" value="{scenario}"/>
    <arg name="ships" value="1"/>
    <arg name="viz" value="false"/>
    <arg name="late_s" value="3600"/>
  </include>
  <include file="$(find aquafarm_bringup)/launch/agent.launch">
    <arg name="ship" value="1"/>
    <arg name="machine" value="boat"/>
  </include>
</launch>
"""
RANKS = """<launch>
  <machine name="node2" address="{there}" user="{user}" ssh-port="2222" env-loader="{loader}"/>
  <include file="$(find aquafarm_bringup)/launch/ranks.launch">
    <arg name="count" value="1"/>
    <arg name="run_dir" value="{run}"/>
{arguments}
  </include>
  <include file="$(find aquafarm_bringup)/launch/ranks.launch">
    <arg name="first_rank" value="1"/>
    <arg name="machine" value="node2"/>
{arguments}
  </include>
</launch>
"""
LOADER = """#!/bin/bash
export PATH='{path}' PYTHONPATH='{python}' LD_LIBRARY_PATH='{libraries}'
export ROS_PACKAGE_PATH='{packages}' ROS_ROOT='{root}' ROS_ETC_DIR='{etc}' ROS_DISTRO='{distro}'
export CMAKE_PREFIX_PATH='{prefix}' ROS_HOME='{home}' ROS_LOG_DIR='{home}/log' ROS_IP={there}
unset ROS_HOSTNAME
{blas}
exec "$@"
"""
SSHD_CONFIG = """Port 2222
ListenAddress {there}
HostKey {folder}/host
AuthorizedKeysFile {folder}/home/.ssh/id_ed25519.pub
PidFile none
StrictModes no
UsePAM no
PermitRootLogin yes
"""


class SecondHostTest(unittest.TestCase):

    def setUp(self):
        if not os.path.exists(SSHD):
            self.skipTest(f"there is no {SSHD} (package openssh-server)")
        self.host = SecondHost(self)
        folder = tempfile.TemporaryDirectory(prefix="aquafarm_host_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "home" / ".ssh").mkdir(parents=True)
        for key in ("host", "home/.ssh/id_ed25519"):
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f",
                            str(self.folder / key)], check=True)
        config = self.folder / "sshd_config"
        config.write_text(SSHD_CONFIG.format(there=self.host.there, folder=self.folder))
        os.makedirs("/run/sshd", exist_ok=True)
        self.server = Program(self, *self.host.inside, SSHD, "-D", "-e", "-f", config)

    def loader(self):
        """Writes an env-loader as on a ship's computer; returns its path."""
        value = os.environ.get
        path = self.folder / "env.sh"
        # These variables select the kernels of OpenBLAS, which affect the result of a training.
        blas = [f"export {name}='{text}'" for name, text in os.environ.items()
                if name.startswith("OPENBLAS_")]
        path.write_text(LOADER.format(
            path=value("PATH"), python=value("PYTHONPATH", ""), there=self.host.there,
            libraries=value("LD_LIBRARY_PATH", ""), packages=value("ROS_PACKAGE_PATH", ""),
            root=value("ROS_ROOT", ""), etc=value("ROS_ETC_DIR", ""),
            distro=value("ROS_DISTRO", ""), prefix=value("CMAKE_PREFIX_PATH", ""),
            home=self.folder / "boat", blas="\n".join(blas)))
        path.chmod(0o755)
        return path

    def start(self, port, text, **values):
        """Starts a launch file, which may use the other host."""
        launch = self.folder / "two_hosts.launch"
        launch.write_text(text.format(there=self.host.there, user=os.environ.get("USER", "root"),
                                      loader=self.loader(), **values))
        run = Program(self, *self.host.environment(port, inside=False),
                      f"HOME={self.folder / 'home'}", "ROSLAUNCH_SSH_UNKNOWN=1",
                      f"ROS_HOME={self.folder / 'ros'}", f"ROS_LOG_DIR={self.folder / 'log'}",
                      "roslaunch", "-p", str(port), launch)
        self.addCleanup(run.interrupt)  # roslaunch must end its nodes also if a check fails
        return run

    def test_a_rank_trains_there_with_its_sim_node(self):
        ppo = {"hidden_size": 16, "rollout_size": 512, "batch_size": 128}
        values = {"scenario": DATA / "tiny.yaml", "farms": 16, "steps": 20000, "seed": 3,
                  "options": " ".join(f"{name}={value}" for name, value in ppo.items()),
                  "evaluation_episodes": 0, "master_addr": self.host.here,
                  "master_port": free_port(), "rank_start_s": 120}
        arguments = "\n".join(f'    <arg name="{name}" value="{value}"/>'
                              for name, value in values.items())
        run = self.start(free_port(), RANKS, run=self.folder / "run", arguments=arguments)
        self.assertEqual(0, run.code(limit_s=240), run.words())
        self.assertRegex(run.words(), "ranks      2, ")
        self.assertIn(f"[{self.host.there}", run.words(), "started there")
        local = Program(self, program("aquafarm_agents", "aquafarm_train"), values["scenario"],
                        "--algorithm", "ppo", "--farms", "16", "--steps", "20000", "--seed", "3",
                        "--ranks", "1", "--evaluate", "0", "--run-dir", self.folder / "local",
                        *[word for name, value in ppo.items() for word in ("--set", f"{name}={value}")])
        self.assertEqual(0, local.code(limit_s=240), local.words())
        for name in ("policy.ckpt", "metrics.csv"):
            self.assertEqual((self.folder / "local" / name).read_bytes(),
                             (self.folder / "run" / name).read_bytes(), name)

    def test_roslaunch_starts_an_agent_there(self):
        port = free_port()
        run = self.start(port, LAUNCH, scenario=DATA / "wide.yaml")
        master = xmlrpc.client.ServerProxy(f"http://{self.host.here}:{port}")

        def address():
            try:
                code, _, uri = master.lookupNode("/second_host", "/aquafarm/agent_1")
            except OSError:
                return ""
            return uri if code == 1 else ""

        run.wait_for(lambda: address() != "", "the agent of ship 1 to be there", limit_s=60)
        self.assertEqual(self.host.there, re.match(r"http://([^:/]+)", address()).group(1))
        # The farm steps, and the clock advances, only when both ships have sent a command.
        self.assertGreater(self.clock_after(port, 60), 1.0)

    def clock_after(self, port, limit_s):
        """Returns how far the farm's clock advances in 30 messages [s]; 0.0 without messages."""
        command = [*self.host.environment(port, inside=False), "rostopic", "echo", "-n", "30", "-p",
                   "/clock"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit_s, check=False)
        stamps = [int(line.split(",")[0]) for line in done.stdout.splitlines()[1:]]
        return (stamps[-1] - stamps[0]) / 1e9 if stamps else 0.0


if __name__ == "__main__":
    rostest.rosrun("aquafarm_bringup", "second_host", SecondHostTest)
