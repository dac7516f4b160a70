#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the cost of recording every episode (record:=all) of a single-ship training through ROS.

Runs pairs of trainings, one without and one with recording, in alternating order, so that both
kinds see the same load of the machine. Prints lines `metric value unit`: the median times of each
kind, and the median and quartiles of the slowdown within pairs. The setup.bash of a built workspace
must be sourced. Starts its own ROS master."""
import argparse
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

import roslib.packages

from campaigns.ros import free_port

LIMIT_S = 300.0  # max duration of a training
END_S = 60.0  # max time for a node to end and to write its remaining bags


def program(package, name):
    """Returns the path of an executable of a package; ends this program if there is none."""
    found = roslib.packages.find_node(package, name)
    if not found:
        raise SystemExit(f"bench_recording: {package} has no {name}; run ./aquafarm build")
    return found[0]


def cpu_s(process, limit_s):
    """Waits for the end of a process and returns its processor time [s]. Ends this program if the
    process takes longer than `limit_s`."""
    end = time.monotonic() + limit_s
    while True:
        pid, status, usage = os.wait4(process.pid, os.WNOHANG)
        if pid != 0:
            break
        if time.monotonic() > end:
            raise SystemExit(f"bench_recording: {process.args[0]} did not end within {limit_s} s")
        time.sleep(0.01)
    process.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime


def end_all(processes):
    """Kills the processes that are still running."""
    for process in processes:
        if process.returncode is None:
            process.kill()
            process.wait(END_S)


def train(folder, keep, steps, environment):
    """Runs one training. Returns the wall time of its steps [s], the processor time of sim node and
    learner [s], and the number of bags.

    The processor time includes the time in which the sim node writes bags after the training."""
    namespace = f"/bench_{folder.name}"
    common = {"env": environment, "stderr": subprocess.DEVNULL}
    log = folder / "train.log"
    processes = []
    try:
        sim = subprocess.Popen(
            [program("aquafarm_sim", "sim_node"), f"__ns:={namespace}", "_scenario:=paper",
             "_publish_clock:=false", f"_keep:={keep}", f"_keep_dir:={folder / 'bags'}"],
            stdout=subprocess.DEVNULL, **common)
        processes.append(sim)
        with open(log, "wb") as words:
            learner = subprocess.Popen(
                [program("aquafarm_agents", "train_node"), f"__ns:={namespace}",
                 f"_steps:={steps}", "_evaluation_episodes:=0", f"_run_dir:={folder / 'run'}"],
                stdout=words, **common)
        processes.append(learner)
        cpu = cpu_s(learner, LIMIT_S)
        words = log.read_text()
        found = re.search(r"steps, [\d,]+ episodes in (?:(\d+) min )?([\d.]+) s", words)
        if found is None:
            raise SystemExit(f"bench_recording: the training failed:\n{words}")
        wall = 60.0 * float(found[1] or 0) + float(found[2])
        sim.terminate()
        cpu += cpu_s(sim, END_S)
    finally:
        end_all(processes)
    return wall, cpu, len(list((folder / "bags").glob("*.bag")))


def main():
    """Starts a master, runs the pairs and prints the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=9)
    parser.add_argument("--steps", type=int, default=60000)
    arguments = parser.parse_args()
    port = free_port()
    environment = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1")
    master = subprocess.Popen(["roscore", "-p", str(port)], env=environment,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    results = {"none": [], "all": []}
    bags = 0
    try:
        time.sleep(3.0)
        with tempfile.TemporaryDirectory(prefix="aquafarm_bench_") as top:
            for pair in range(arguments.pairs):
                order = ("none", "all") if pair % 2 == 0 else ("all", "none")
                for keep in order:
                    folder = pathlib.Path(top) / f"{keep}_{pair}"
                    folder.mkdir()
                    *result, kept = train(folder, keep, arguments.steps, environment)
                    results[keep].append(result)
                    bags += kept
    finally:
        master.terminate()
        try:
            master.wait(END_S)
        finally:
            end_all([master])
    for index, what in enumerate(("wall", "cpu")):
        without = [result[index] for result in results["none"]]
        with_all = [result[index] for result in results["all"]]
        print(f"record_none_{what} {statistics.median(without):.2f} s")
        print(f"record_all_{what} {statistics.median(with_all):.2f} s")
        ratios = [b / a for a, b in zip(without, with_all)]
        print(f"record_all_{what}_slowdown {100 * (statistics.median(ratios) - 1):.1f} %")
        if len(ratios) > 1:
            cuts = statistics.quantiles(ratios, n=4, method="inclusive")
            for name, cut in zip(("lower", "upper"), cuts[::2]):
                print(f"record_all_{what}_slowdown_{name}_quartile {100 * (cut - 1):.1f} %")
        total = sum(with_all) / sum(without)
        print(f"record_all_{what}_slowdown_of_all_pairs {100 * (total - 1):.1f} %")
    print(f"record_all_bags {bags / arguments.pairs:.0f} per training")
    print(f"load_average {os.getloadavg()[0]:.1f} processes")


if __name__ == "__main__":
    main()
