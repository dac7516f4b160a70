#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times a rescue plan on one core: 1,000 members, 40 x 40 cells, six devices, two ships.

tools/time_plan.py page --coast COAST.json [--runs 5] [--core 0]  # from chart and bulletin to page
tools/time_plan.py node --coast COAST.json [--runs 5] [--core 0]  # a new bulletin in plan_node

Prints median, min and max of wall and processor seconds. Build first; `node` needs a sourced
setup.bash. The forecast is In-Fa (2021) as recorded, with the latitude and longitude of each
forecast point moved by up to 0.4 degrees.
"""
import argparse
import json
import os
import pathlib
import random
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time

from campaigns.ros import free_port

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIB = ROOT / ".ws/devel/lib"
ARCHIVE = ROOT / "aquafarm_sim/scenarios/archives/zhoushan_cma.txt"
PLACE, AT = "30.2,122.6", "2021-07-24T00:30:00Z"
DEVICES = [("F1", 30.16, 122.66, "monitoring", 45000), ("F2", 30.22, 122.66, "monitoring", 45000),
           ("F3", 30.24, 122.62, "temporary_breeding", 60000),
           ("F4", 30.15, 122.60, "temporary_breeding", 55000),
           ("F5", 30.18, 122.56, "breeding_release", 30000),
           ("F6", 30.26, 122.57, "deep_water_breeding", 120000)]
MOST_S = 120  # max time until a plan arrives [s]


def infa():
    """Returns the fixes of In-Fa in the archive from 0 to 72 hours after 2021-07-24 00:00 UTC,
    each as (hours, latitude, longitude, wind [m/s])."""
    inside, points = False, []
    for line in ARCHIVE.read_text(encoding="utf-8").splitlines():
        if line.startswith("storm "):
            inside = line.startswith("storm 2106 ")
        elif inside and line and not line.startswith("#"):
            stamp, latitude, longitude, _, wind = line.split()[:5]
            moment = time.strptime(stamp, "%Y%m%d%H%M")
            hours = (moment.tm_mday - 24) * 24 + moment.tm_hour
            if moment.tm_mon == 7 and 0 <= hours <= 72:
                points.append((hours, float(latitude), float(longitude), wind))
    return points


def bulletin(seed):
    """Returns a bulletin (JSON) of 2021-07-24 00:00 UTC with a forecast of 72 hours."""
    draw = random.Random(seed)

    def point(hours, latitude, longitude, wind, moved):
        east, north = (draw.uniform(-moved, moved) for _ in range(2))
        return {"time": f"2021-07-{24 + (hours + 8) // 24}T{(hours + 8) % 24:02}:00:00",
                "lat": round(latitude + north, 2), "lng": round(longitude + east, 2), "strong": "",
                "speed": float(wind)}

    track = infa()
    ahead = [point(*one, 0.4) for one in track if one[0] in (12, 24, 36, 48, 60, 72)]
    now = {**point(*track[0], 0.0), "forecast": [{"sets": "CMA", "points": ahead}]}
    return json.dumps([{"tfbh": "202106", "ename": "In-Fa", "points": [now]}])


def report(name, walls, cpus):
    for what, values in (("wall", walls), ("processor", cpus)):
        print(f"{name}: {what} median {statistics.median(values):.2f} s "
              f"({min(values):.2f} to {max(values):.2f} s, n = {len(values)})")


def time_page(folder, options):
    arguments = ["taskset", "-c", str(options.core), ROOT / "aquafarm", "plan", "--coast",
                 options.coast.resolve(), "--place", PLACE, "--devices", folder / "devices.csv",
                 "--ships", "2", "--at", AT, "-o", folder / "plan.html"]
    walls, cpus = [], []
    for run in range(options.runs):
        file = folder / "bulletin.json"
        file.write_text(bulletin(run), encoding="utf-8")
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run([str(one) for one in [*arguments, "--bulletin", file]], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit(f"{done.stdout}\naquafarm plan: got exit code {done.returncode}, expected 0")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        walls.append(time.monotonic() - began)
        cpus.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    report("page", walls, cpus)


def processor_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def measure_node(folder, options, pid):
    """Writes new bulletins to the folder; returns (wall, processor, compute_s) [s] of each plan."""
    import rospy
    from aquafarm_msgs.msg import RescuePlan
    plans = []
    rospy.init_node("time_plan", anonymous=True, disable_signals=True)
    rospy.Subscriber("/aquafarm/plan", RescuePlan, lambda one: plans.append((time.monotonic(), one)))
    rows = []
    for run in range(options.runs + 1):
        time.sleep(3.0)  # longer than plan_node's parameter min_period_s
        count, before, began = len(plans), processor_s(pid), time.monotonic()
        part = folder / "part"
        part.write_text(bulletin(run), encoding="utf-8")
        part.rename(folder / "bulletins" / f"{run:03}.json")
        while len(plans) == count or plans[-1][1].result == RescuePlan.NONE:
            if time.monotonic() - began > MOST_S:
                sys.exit(f"plan_node: got no plan within {MOST_S} s, expected one")
            time.sleep(0.002)
        at, plan = plans[-1]
        if plan.fault:
            sys.exit(f"plan_node: got the fault {plan.fault!r}, expected a plan")
        if run:  # without the first plan, which includes the node's start
            rows.append((at - began, processor_s(pid) - before, plan.compute_s))
    return rows


def time_node(folder, options):
    ranch, port = folder / "ranch.yaml", free_port()
    (folder / "bulletins").mkdir()
    subprocess.run([LIB / "aquafarm_sim/aquafarm_scenario", "--chart", options.coast, "--center",
                    PLACE, "--size", "40x40", "--cell", "500m", "-o", ranch], check=True,
                   stdout=subprocess.DEVNULL)
    os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1")
    os.environ.pop("ROS_HOSTNAME", None)
    master = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    node = None
    try:
        time.sleep(5.0)
        node = subprocess.Popen(
            ["taskset", "-c", str(options.core), LIB / "aquafarm_agents/plan_node",
             "__ns:=/aquafarm", f"_scenario:={ranch}", f"_bulletin:={folder / 'bulletins'}",
             f"_devices:={folder / 'devices.csv'}", "_ships:=2", "_members:=1000", f"_at:={AT}"],
            stdout=subprocess.DEVNULL)
        rows = measure_node(folder, options, node.pid)
    finally:
        for process in (node, master):
            if process is not None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(20)
                except subprocess.TimeoutExpired:
                    process.kill()
    report("from the file to the message", [one[0] for one in rows], [one[1] for one in rows])
    report("planning in the node (compute_s)", [one[2] for one in rows], [one[1] for one in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("page", "node"))
    parser.add_argument("--coast", type=pathlib.Path, required=True, help="coast (GeoJSON)")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--core", type=int, default=0, help="core of aquafarm plan or plan_node")
    options = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f}, core {options.core}")
    with tempfile.TemporaryDirectory(prefix="time_plan.") as name:
        folder = pathlib.Path(name)
        rows = "".join(",".join(map(str, one)) + "\n" for one in DEVICES)
        (folder / "devices.csv").write_text("name,latitude,longitude,kind,value\n" + rows,
                                            encoding="utf-8")
        {"page": time_page, "node": time_node}[options.what](folder, options)


if __name__ == "__main__":
    main()
