# SPDX-License-Identifier: BSD-3-Clause
"""The command ./aquafarm plan: runs the program aquafarm_plan, and makes the page and the GeoJSON
of its plan."""
import argparse
import os
import pathlib
import subprocess
import sys

from aquafarm_bringup.files import open_atomically
from aquafarm_bringup.programs import find_program

from . import geojson, page
from .document import PlanError, load

BAD_INPUT = 2
EPILOG = """All other arguments go to aquafarm_plan; its help follows.

exit codes: those of aquafarm_plan, also listed in docs/plan.md
"""


def main(arguments):
    """Runs the command. Returns the exit code of aquafarm_plan (0 with --from), or 2 if the page
    cannot be made."""
    parser = argparse.ArgumentParser(
        prog="aquafarm plan",
        allow_abbrev=False,
        add_help=False,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Plans the rescue of a ranch's devices before a storm: which ship fetches "
        "which device, when, and with what probability.",
        usage="./aquafarm plan RANCH.yaml [--bulletin FILE | --storm FILE --at TIME] [-o plan.html]"
    )
    parser.add_argument("-o",
                        "--output",
                        default="plan.html",
                        type=pathlib.Path,
                        help="page to write (default: plan.html); the plan and its routes are "
                        "written next to it, as plan.json and plan.geojson for plan.html")
    parser.add_argument("--from",
                        dest="source",
                        type=pathlib.Path,
                        metavar="PLAN.json",
                        help="make the page of an existing plan file, without planning")
    parser.add_argument("--open", action="store_true", help="open the page, if there is a display")
    parser.add_argument("-h", "--help", action="store_true", help="show this help and exit")
    options, rest = parser.parse_known_args(arguments)
    try:
        if options.help or not (rest or options.source):
            parser.print_help()
            sys.stdout.flush()
            return run([program(), "--help"]) if options.help else BAD_INPUT
        return make(options, rest)
    except (PlanError, OSError) as error:
        print(f"aquafarm plan: {error}", file=sys.stderr)
        return BAD_INPUT


def make(options, rest):
    """Makes a plan unless a plan file is given, and writes the page and the GeoJSON.

    @returns the exit code
    @throws PlanError for wrong arguments or a wrong plan file
    """
    if not options.output.name.strip(".") or options.output.suffix.lower() in (".json", ".geojson"):
        raise PlanError(f"-o: got {options.output}, expected the name of the page, such as plan.html")
    output = options.output.with_suffix(options.output.suffix or ".html")
    if not output.resolve().parent.is_dir():
        raise PlanError(f"-o: there is no folder {output.resolve().parent}; make it first")
    if options.source:
        if rest:
            raise PlanError(f"--from: got also {' '.join(rest)}, expected no other arguments")
        code, source = 0, options.source
    else:
        source = output.with_suffix(".json")
        before = stamp(source)
        code = run([program(), *rest, "--json", str(source)])
        if stamp(source) == before:  # the input was refused, with a message
            return code or BAD_INPUT
    plan = load(source)
    for path, text in ((output, page.render(plan)),
                       (output.with_suffix(".geojson"), geojson.text(plan))):
        with open_atomically(path) as file:
            file.write(text)
    print(f"page       {output.resolve().as_uri()}")
    print(f"routes     {output.with_suffix('.geojson')} (GeoJSON, for QGIS)", flush=True)
    if options.open and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        subprocess.Popen(["xdg-open", str(output)],
                         stdout=subprocess.DEVNULL,
                         stderr=subprocess.DEVNULL,
                         start_new_session=True)
    return code


def stamp(path):
    """Returns a value that changes when the file is written; None if there is no file."""
    try:
        status = path.stat()
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def program():
    """Returns the path of aquafarm_plan: AQUAFARM_PLAN, or the program of the workspace."""
    if os.environ.get("AQUAFARM_PLAN"):
        return os.environ["AQUAFARM_PLAN"]
    found = find_program("aquafarm_agents", "aquafarm_plan")
    if not found:
        raise PlanError("aquafarm_agents has no aquafarm_plan; build the workspace first")
    return found


def run(command):
    """Runs a program with the streams of this process, and returns its exit code."""
    return subprocess.run(command, check=False).returncode
