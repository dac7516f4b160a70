#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Evaluates a policy on a scenario with several weights of energy, writes one line per weight to a
CSV file, and draws the curve of return against energy next to it (.svg).

usage: energy_curve.py SCENARIO.yaml POLICY EPISODES OUT.csv [WEIGHT ...]

The energy of each action is that of a small workboat (docs/real_ranches.md), unless the scenario
has its own block `energy`. The return excludes the term of energy. aquafarm_evaluate must be on the
PATH.
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

WEIGHTS = (0.0, 0.2, 1.0, 3.0, 10.0)
ON_BOARD_KW = 2.0


def energy_block(text, weight):
    """Returns the text of the scenario with the weight in its block `energy`. Adds the block if the
    scenario has none."""
    lines = text.splitlines()
    for i, line in enumerate(lines):
        if line.startswith("energy: {"):
            lines[i] = re.sub(r"weight: [^,}]*(, )?", "", line).replace(
                "{", f"{{weight: {weight:g}, ", 1)
            return "\n".join(lines) + "\n"
        if line.startswith("energy:"):
            sys.exit("energy_curve: got a block energy of several lines, expected none or one line")
    idle = ON_BOARD_KW * 180 / 3600  # a step of 180 s, the default
    return text + (f"\nenergy: {{weight: {weight:g}, per_km: 1.2, per_device: 0.5, "
                   f"rough_sea: 0.5, idle_per_step: {idle:g}}}\n")


def measure(text, policy, episodes, weight):
    """Returns a row with the means of energy, distance, success, steps, and the return without the
    term of energy."""
    with tempfile.TemporaryDirectory() as folder:
        scenario = pathlib.Path(folder) / "scenario.yaml"
        scenario.write_text(energy_block(text, weight), encoding="utf-8")
        subprocess.run(["aquafarm_evaluate", policy, str(scenario), "-e", str(episodes), "-w",
                        f"{folder}/evaluation"], check=True)
        one = json.loads(pathlib.Path(f"{folder}/evaluation.json").read_text(encoding="utf-8"))
    energy = one["energy_kwh_per_episode"]
    return {"policy": policy, "weight": f"{weight:g}", "episodes": one["episodes"],
            "return_without_energy": f"{one['return_per_episode'] + weight * energy:.3f}",
            "energy_kwh": f"{energy:.3f}", "distance_km": f"{one['distance_km_per_episode']:.3f}",
            "success_rate": f"{one['success_rate']:g}",
            "steps": f"{one['steps_per_episode']:.2f}"}


def draw(rows, path):
    """Draws return against energy, with a point for each weight."""
    points = [(float(row["energy_kwh"]), float(row["return_without_energy"])) for row in rows]
    low, high = ([pick(axis) for axis in zip(*points)] for pick in (min, max))
    width, height, left, top = 640, 360, 80, 30
    scale = [size / max(b - a, 1e-9) for size, a, b in zip((500, 260), low, high)]

    def place(point):
        return (left + (point[0] - low[0]) * scale[0],
                top + 260 - (point[1] - low[1]) * scale[1])

    marks = []
    for row, point in zip(rows, points):
        x, y = place(point)
        marks.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="#1b4f78"/>'
                     f'<text x="{x + 7:.1f}" y="{y - 7:.1f}">{row["weight"]}</text>')
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(place, points))
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" font-size="13">'
        f'<rect width="{width}" height="{height}" fill="white"/>'
        f'<polyline points="{line}" fill="none" stroke="#1b4f78"/>{"".join(marks)}'
        f'<text x="{left}" y="{height - 15}">energy per episode [kWh], {low[0]:.1f} to '
        f'{high[0]:.1f}; at each point: weight</text>'
        f'<text transform="translate(25 {height - 50}) rotate(-90)">return without energy, '
        f'{low[1]:.1f} to {high[1]:.1f}</text></svg>\n', encoding="utf-8")


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    text = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    weights = [float(word) for word in sys.argv[5:]] or WEIGHTS
    rows = [measure(text, sys.argv[2], int(sys.argv[3]), weight) for weight in weights]
    with open(sys.argv[4], "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    draw(rows, pathlib.Path(sys.argv[4]).with_suffix(".svg"))


if __name__ == "__main__":
    main()
