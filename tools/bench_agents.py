#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures joint steps per second with one policy_node per ship (default: 8), in lockstep via ROS.

Prints one line `metric value unit` for the policy random and one for a network. Each value is the
median of several rounds. The setup.bash of a built workspace must be sourced. Starts a ROS master
if none runs."""
import argparse
import pathlib
import signal
import socket
import statistics
import subprocess
import tempfile
import time

import rosgraph
import roslib.packages
import rospkg
import rospy
from aquafarm_msgs.srv import GetState

LIMIT_S = 30.0


def start(*command):
    """Starts a program whose output is discarded; returns the process."""
    return subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def program(package, name):
    """Returns the path of an executable of a package; ends this program if there is none."""
    found = roslib.packages.find_node(package, name)
    if not found:
        raise SystemExit(f"bench_agents: {package} has no {name}; run ./aquafarm build")
    return found[0]


def scenario_of(ships, folder):
    """Writes a copy of two_squads.yaml with `ships` ships into a folder; returns its path."""
    source = pathlib.Path(rospkg.RosPack().get_path("aquafarm_sim")) / "scenarios/two_squads.yaml"
    text = source.read_text(encoding="utf-8")
    two = "ships: {count: 2,"
    assert two in text, "two_squads.yaml no longer has 2 ships"
    changed = text.replace(two, f"ships: {{count: {ships},")
    path = pathlib.Path(folder) / "ships.yaml"
    path.write_text(changed, encoding="utf-8")
    return path


def train_network(scenario, folder):
    """Trains a DQN of the default size for 6,000 steps; returns its run folder.

    More training does not change the speed of the network. A good policy, however, ends episodes
    within a round, which `measure` then repeats."""
    run = pathlib.Path(folder) / "dqn"
    subprocess.run([program("aquafarm_agents", "aquafarm_train"), scenario, "-a", "dqn", "-n",
                    "6000", "-o", "device=cpu", "--random", "0", "--evaluate", "0", "-d", run],
                   check=True, stdout=subprocess.DEVNULL, timeout=300)
    return run


def measure(get_state, rounds, round_s):
    """Returns the joint steps per second of `rounds` rounds of `round_s` seconds each.

    First waits for step 100 of an episode. Repeats a round in which an episode ends. Ends this
    program if the wait takes longer than LIMIT_S, or if all rounds together take more than LIMIT_S
    longer than `rounds` * `round_s`."""
    rates = []
    end = time.monotonic() + LIMIT_S
    while get_state().state.step < 100:
        if time.monotonic() > end:
            raise SystemExit(f"bench_agents: the agents did not reach step 100 within {LIMIT_S} s; "
                             "start sim_node and policy_node by hand to see their messages")
        time.sleep(0.1)
    limit_s = LIMIT_S + rounds * round_s
    end = time.monotonic() + limit_s
    while len(rates) < rounds:
        if time.monotonic() > end:
            raise SystemExit(f"bench_agents: {len(rates)} of {rounds} rounds stayed within an "
                             f"episode in {limit_s:g} s; shorten --round-s or give fewer --rounds")
        before, begin = get_state().state, time.monotonic()
        time.sleep(round_s)
        after, elapsed = get_state().state, time.monotonic() - begin
        if after.episode == before.episode:
            rates.append((after.step - before.step) / elapsed)
    return rates


def end_all(children):
    """Interrupts processes, the last one first, and kills each that does not end within 10 s."""
    for child in reversed(children):
        child.send_signal(signal.SIGINT)
    for child in reversed(children):
        try:
            child.wait(10)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()


def measure_agents(name, policy, scenario, arguments):
    """Starts a sim node and its agents, prints the median of their speed, and ends them."""
    space = f"/bench_agents_{name}_{socket.gethostname().replace('-', '_')}"
    children = []
    try:
        children.append(start(program("aquafarm_sim", "sim_node"), f"__ns:={space}", "__name:=sim",
                              "_publish_clock:=false", f"_scenario:={scenario}"))
        for ship in range(arguments.ships):
            children.append(start(program("aquafarm_agents", "policy_node"), f"__ns:={space}",
                                  f"__name:=agent_{ship}", "_mode:=act", f"_policy:={policy}",
                                  f"_ship:={ship}"))
        get_state = rospy.ServiceProxy(f"{space}/get_state", GetState, persistent=True)
        get_state.wait_for_service(LIMIT_S)
        rates = measure(get_state, arguments.rounds, arguments.round_s)
    finally:
        end_all(children)
    print(f"ros_{arguments.ships}_agent_nodes_{name} {statistics.median(rates):.0f} joint_steps/s")


def main():
    """Measures the policy random, then a network."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ships", type=int, default=8,
                        help="number of ships, with one policy_node each (default: 8)")
    parser.add_argument("--rounds", type=int, default=5,
                        help="number of rounds of each policy (default: 5)")
    parser.add_argument("--round-s", type=float, default=0.5,
                        help="seconds of a round (default: 0.5)")
    arguments = parser.parse_args()
    children = []
    with tempfile.TemporaryDirectory(prefix="aquafarm_bench_") as folder:
        try:
            if not rosgraph.is_master_online():
                children.append(start("roscore", "-p", rosgraph.network.parse_http_host_and_port(
                    rosgraph.get_master_uri())[1]))
            end = time.monotonic() + LIMIT_S
            while not rosgraph.is_master_online():
                if time.monotonic() > end:
                    raise SystemExit(f"bench_agents: no ROS master started within {LIMIT_S:g} s; "
                                     "check rosmaster")
                time.sleep(0.2)
            rospy.init_node("bench_agents", anonymous=True, disable_signals=True)
            scenario = scenario_of(arguments.ships, folder)
            for name, policy in (("random", "random"), ("dqn", train_network(scenario, folder))):
                measure_agents(name, policy, scenario, arguments)
        finally:
            end_all(children)


if __name__ == "__main__":
    main()
