#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the relation of tracks/wind_radii.h to recorded rings, and prints coefficients and errors.

  tools/fit_wind_radii.py ../shared/data

The relation is ln r = a + b sqrt(V / w - 1) + c (|latitude| - 25). A ring of the wind w is the area
with winds of at least w; r is the radius of a circle with the same area. V is the storm's max wind.
b and c are fitted to rings of the JMA (30 and 50 kt). With these slopes, a is fitted to the rings
of each authority. For the CMA, a is also computed from the median errors of the former estimate
(the function `holland`) over 24,494 bulletin rings; see docs/data.md.
"""
import csv
import json
import math
import statistics
import sys
from pathlib import Path

import numpy as np

NM_KM = 1.852
KT_MPS = 0.514444
CLASSES = ((0, 48), (48, 64), (64, 200))  # classes of storms by max wind [kt]
# Medians of (former estimate / recorded radius) over the bulletin rings (docs/data.md): for 34 kt
# in storms below 48 kt; for 50 and 64 kt in all storms.
FORMER_34_TS, FORMER_50, FORMER_64 = 0.47, 1.27, 1.79


def rms(quadrants):
    return math.sqrt(sum(float(one) ** 2 for one in quadrants) / 4)


def jma(path):
    """Yields (authority, storm, w [kt], V [kt], latitude, radius [km], pressure [hPa]) of each
    ring."""
    storm = ""
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("66666"):
            storm = line[6:10]
            continue
        wind = int(line[33:36].strip() or 0)
        if len(line) < 62 or wind == 0:
            continue
        for w, far, near in ((50, line[42:46], line[47:51]), (30, line[53:57], line[58:62])):
            if int(far.strip() or 0) > 0:  # a circle, which need not be centred on the storm
                radius = (int(far) + int(near)) / 2 * NM_KM
                yield "JMA", storm, w, wind, int(line[15:18]) / 10, radius, float(line[24:28])


def bulletins(path):
    for storm in json.loads(path.read_text(encoding="utf-8-sig")):
        for point in storm["points"]:
            for w, force in ((34, 7), (50, 10), (64, 12)):
                rings = point.get(f"radius{force}_quad")
                if not isinstance(rings, dict) or not point.get("speed"):
                    continue
                radius = rms(rings.get(key) or 0 for key in ("ne", "se", "sw", "nw"))
                wind = float(point["speed"]) / KT_MPS
                if radius > 0:
                    yield "CMA", path.stem, w, wind, point["lat"], radius, point["pressure"]


def jtwc(folder):
    for path in sorted(folder.glob("bwp*.dat")):
        for line in path.read_text(encoding="utf-8").splitlines():
            field = [one.strip() for one in line.split(",")]
            if len(field) < 17 or field[11] in ("", "0"):
                continue
            radius = rms(field[13:17]) * NM_KM
            if radius > 0:
                yield ("JTWC", path.stem, int(field[11]), int(field[8]),
                       int(field[6][:-1]) / 10, radius, float(field[9]))
    for path in sorted(folder.glob("ibtracs*.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                for w in (34, 50, 64):
                    rings = [row[f"USA_R{w}_{q}"].strip() for q in ("NE", "SE", "SW", "NW")]
                    if not any(rings) or not row["USA_WIND"].strip().isdigit():
                        continue
                    yield ("JTWC", row["SID"], w, int(row["USA_WIND"]), abs(float(row["USA_LAT"])),
                           rms(one or 0 for one in rings) * NM_KM, None)


def holland(w, wind, latitude, pressure):
    """Returns the former estimate [km]: Holland (1980) with Rmax of Willoughby et al. (2006,
    Eq. 7a)."""
    v = wind * KT_MPS
    f = 2 * 7.292e-5 * math.sin(math.radians(latitude))
    rmax = 46400 * math.exp(-0.0155 * v + 0.0169 * latitude)
    drop = 100 * (1010 - (pressure or 1010))
    shape = min(2.5, max(1.0, math.e * 1.15 * v * v / drop)) if drop > 0 else 1.3
    inner, outer = rmax, 2e6
    for _ in range(50):
        middle = (inner + outer) / 2
        a = (rmax / middle) ** shape
        turning = f * middle / 2
        blows = math.sqrt((v * v + v * f * rmax) * a * math.exp(1 - a) + turning ** 2) - turning
        inner, outer = (middle, outer) if blows >= w * KT_MPS else (inner, middle)
    return inner / 1000


def knaff_zehr(w, wind, latitude):
    """Returns the radius [km] of the wind w in the Rankine vortex of Knaff and Zehr (2007, Wea.
    Forecasting 22, 71-88); w and wind in kt."""
    rmax = 66.785 - 0.09102 * wind + 1.0619 * (latitude - 25)
    return rmax * (wind / w) ** (1 / (0.1147 + 0.0055 * wind - 0.001 * (latitude - 25)))


def predictors(rows):
    return np.array([[1.0, math.sqrt(max(row[3] / row[2] - 1, 0)), row[4] - 25] for row in rows])


def left_out(rows):
    """Returns the standard deviation of the residuals of ln r. The fit for each ring uses all
    storms except that of the ring."""
    x, y = predictors(rows), np.log([row[5] for row in rows])
    storms = np.array([row[1] for row in rows])
    rest = np.zeros(len(rows))
    for storm in sorted(set(storms)):
        one = storms == storm
        fit, *_ = np.linalg.lstsq(x[~one], y[~one], rcond=None)
        rest[one] = y[one] - x[one] @ fit
    return rest.std()


def errors(name, ratios):
    logs = np.log(ratios)
    print(f"    {name:12s} median of estimated / recorded {np.median(ratios):5.2f}, "
          f"log-standard deviation {logs.std():.2f}")


def main():
    data = Path(sys.argv[1] if len(sys.argv) == 2 else "../shared/data")
    rows = list(jma(data / "tracks" / "bst_all_2015-2021.txt")) + list(jtwc(data / "tracks"))
    for path in sorted((data / "bulletins").glob("[0-9]*.json")):
        rows += bulletins(path)
    slopes = {}
    for w in (30, 50):
        some = [row for row in rows if row[0] == "JMA" and row[2] == w and row[3] >= w]
        fit, *_ = np.linalg.lstsq(predictors(some), np.log([row[5] for row in some]), rcond=None)
        slopes[w] = fit[1:]
        print(f"{w} kt: b = {fit[1]:.3f}, c = {fit[2]:.3f} ({len(some)} rings); log-standard "
              f"deviation of a storm that is left out: {left_out(some):.2f}")
    slopes[34], slopes[64] = slopes[30], slopes[50]
    for authority in ("JMA", "CMA", "JTWC"):
        for w in (30, 34, 50, 64):
            some = [row for row in rows if row[0] == authority and row[2] == w and row[3] >= w]
            if not some:
                continue
            rest = np.log([row[5] for row in some]) - predictors(some)[:, 1:] @ slopes[w]
            print(f"{authority} {w} kt: {len(some)} rings of {len({row[1] for row in some})} storms, "
                  f"a = {rest.mean():.3f}")
            spread = (f"{low}-{high} kt {rest[inside].std():.2f}" for low, high in CLASSES
                      if (inside := [low <= row[3] < high for row in some]) and sum(inside) > 1)
            print("    log-standard deviation by wind of the storm: " + ", ".join(spread))
            errors("relation", np.exp(rest.mean() - rest))
            errors("former", [holland(w, *row[3:5], row[6]) / row[5] for row in some])
            errors("Knaff, Zehr", [knaff_zehr(w, *row[3:5]) / row[5] for row in some])
    # The storms of the 24,494 bulletin rings are assumed to have the winds, latitudes and pressures
    # of the JMA's storms.
    storms = sorted({(row[3], row[4], row[6]) for row in rows if row[0] == "JMA"})
    for w, former, chosen in ((34, FORMER_34_TS, lambda v: v < 48), (50, FORMER_50, lambda v: True),
                              (64, FORMER_64, lambda v: True)):
        some = [one for one in storms if one[0] >= w and chosen(one[0])]
        ratios = [holland(w, *one) / math.exp(predictors([("", "", w, *one)])[0, 1:] @ slopes[w])
                  for one in some]
        print(f"CMA {w} kt by the former estimate's bias: a = "
              f"{math.log(statistics.median(ratios) / former):.2f}")


if __name__ == "__main__":
    main()
