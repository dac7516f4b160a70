#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a storm archive of the tracks near a place from CMA best tracks (CHyyyyBST.txt).

  tools/make_storm_archive.py --center 30.165 122.70 CH*BST.txt > storms.txt

aquafarm_sim/scenarios/archives/zhoushan_cma.txt is made with this --center from the files of all
years that the developers have. docs/data.md describes the format.
"""
import argparse
import math
import sys

GRADES = {0: "unknown", 1: "TD", 2: "TS", 3: "STS", 4: "TY", 5: "STY", 6: "SuperTY"}
LOWEST_WIND = (("TD", 10.8), ("TS", 17.2), ("STS", 24.5), ("TY", 32.7), ("STY", 41.5),
               ("SuperTY", 51.0))
GALE_MPS = 17.2
CREDIT = (
    "Tropical cyclones near {:g} N {:g} E, from the CMA best track data set, tcdata.typhoon.org.cn:",
    "Ying, M., et al., 2014: An overview of the China Meteorological Administration tropical cyclone",
    "database. J. Atmos. Oceanic Technol. 31, 287-301, doi:10.1175/JTECH-D-12-00119.1",
    "Lu, X. Q., et al., 2021: Western North Pacific tropical cyclone database created by the China",
    "Meteorological Administration. Adv. Atmos. Sci. 38, 690-699, doi:10.1007/s00376-020-0211-7",
    "Kept: storms with a gale and a fix within {:g} km, and their fixes within {:g} km.",
    "Made by tools/make_storm_archive.py.",
)


def distance_km(a, b):
    """Returns the great-circle distance between two points (latitude, longitude) [degrees]."""
    lat1, lon1, lat2, lon2 = (math.radians(x) for x in (*a, *b))
    half = (math.sin((lat2 - lat1) / 2) ** 2 +
            math.cos(lat1) * math.cos(lat2) * math.sin((lon2 - lon1) / 2) ** 2)
    return 2 * 6371.0 * math.asin(math.sqrt(half))


def read(path):
    """Yields (id, name, fixes) of each storm. A fix is (YYYYMMDDHH, latitude, longitude, code
    of the grade, pressure [hPa], wind [m/s]). 0 is a missing pressure or wind; the wind 9 means
    below 10 m/s."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [line.split() for line in file if line.strip()]
    at = 0
    while at < len(lines):
        header = lines[at]
        if header[0] != "66666":
            raise ValueError(f"{path}: got {header[0]}, expected a header, 66666 …")
        count = int(header[2])
        number = header[4]
        name = " ".join(header[7:-1])
        storm = "CMA" + str(int(header[3])) if number == "0000" else number
        fixes = []
        for time, grade, latitude, longitude, pressure, wind, *_ in lines[at + 1:at + 1 + count]:
            longitude = int(longitude) / 10
            fixes.append((time, int(latitude) / 10,
                          longitude - 360 if longitude > 180 else longitude,
                          int(grade), int(pressure), int(wind)))
        yield storm, "" if name == "(nameless)" else name, fixes
        at += 1 + count


def grade_of(code, wind):
    """Returns the grade of a fix. If the code is not in GRADES, such as 9 (extratropical), the wind
    determines the grade, as in tracks/formats/cma.cpp."""
    if code in GRADES:
        return GRADES[code]
    reached = [name for name, lowest in LOWEST_WIND if 0 < lowest <= wind and wind != 9]
    return reached[-1] if reached else "unknown"


def text_of(fix):
    time, latitude, longitude, code, pressure, wind = fix
    return (f"{time}00 {latitude:g} {longitude:g} {grade_of(code, wind)} "
            f"{'<10' if wind == 9 else wind if wind else '-'} {pressure or '-'}")


def near(fixes, center, km):
    """Returns the fixes from the first to the last that is within `km` of the center."""
    inside = [i for i, fix in enumerate(fixes) if distance_km(fix[1:3], center) <= km]
    return fixes[inside[0]:inside[-1] + 1] if inside else []


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--center", nargs=2, type=float, required=True, metavar=("LAT", "LON"))
    parser.add_argument("--within", type=float, default=500.0, metavar="KM",
                        help="keep storms with a gale and a fix within this distance (default 500: "
                        "legs between fixes come nearer than the fixes)")
    parser.add_argument("--keep", type=float, default=1000.0, metavar="KM",
                        help="keep their fixes within this distance (default 1000)")
    parser.add_argument("files", nargs="+", help="CHyyyyBST.txt")
    args = parser.parse_args()
    center = tuple(args.center)
    print("aquafarm-storms 1")
    for line in CREDIT:
        values = center if "N {" in line else (args.within, args.keep)
        print("# " + line.format(*values))
    kept = 0
    for path in sorted(args.files, key=lambda path: path.rsplit("/", 1)[-1]):
        for storm, name, fixes in read(path):
            close = [fix for fix in fixes if distance_km(fix[1:3], center) <= args.within]
            if not any(fix[5] >= GALE_MPS and fix[5] != 9 for fix in close):
                continue
            run = near(fixes, center, args.keep)
            if len(run) < 2:
                continue
            print(f"storm {storm} 2 CMA | {name}".rstrip())
            for fix in run:
                print(text_of(fix))
            kept += 1
    print(f"{kept} storms", file=sys.stderr)


if __name__ == "__main__":
    main()
