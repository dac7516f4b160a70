# SPDX-License-Identifier: BSD-3-Clause
"""Command line of the program aquafarm_benchmark."""
import argparse
import fcntl
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from aquafarm_benchmark import cluster, human, output, results, runs
from aquafarm_benchmark.protocol import FARMS, OPTIMUM, PROFILES, REFERENCES, Contestant

_OK, _FAILED, _BAD_INPUT, _STORAGE, _INTERRUPTED = 0, 1, 2, 3, 130
_EPILOG = """exit codes: 0 all results exist, 1 some runs failed (the others are kept), 2 bad argument,
3 storage, 130 interrupted (the same command resumes)"""


_LOCK_LIMIT_S = 15.0  # time for an interrupted benchmark to end its trainings and exit


class BadInput(ValueError):
    """Wrong input. The message is one line."""


class _Parser(argparse.ArgumentParser):

    def error(self, message):
        raise BadInput(message)


def _parser():
    """Returns the parser of the command line."""
    parser = _Parser(
        prog="aquafarm_benchmark", epilog=_EPILOG,
        description="Trains every learner several times, measures them as the paper's §4.2 does, "
        "and writes a table with the paper's Table 1 next to the results, and figures. After an "
        "interruption the same command resumes: finished runs are kept, others continue from "
        "their checkpoints.")
    parser.add_argument("scenario", nargs="?", default="paper",
                        help="scenario file, or the name of a shipped one (default: paper)")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("benchmark"),
                        help="folder of runs, tables and figures (default: ./benchmark)")
    parser.add_argument("--profile", default="full",
                        help="full: the whole protocol; quick: minutes; paper: learners as "
                        "printed, tuned ones and an ablation, days (default: full)")
    parser.add_argument("--algorithms", default="all",
                        help="rows of the table, separated by commas (default: those of the "
                        f"profile; full: {','.join(_default_names(PROFILES['full']))})")
    parser.add_argument("--runs", type=int, default=0,
                        help="trainings of each learner, with seeds 1, 2, … (default: the "
                        "profile's)")
    parser.add_argument("--episodes", type=int, default=0,
                        help="episodes of a training (default: the profile's)")
    parser.add_argument("--evaluation-episodes", type=int, default=0,
                        help="greedy episodes after each training, which never uses them (default: "
                        "the profile's)")
    parser.add_argument("--max-steps", type=int, default=0,
                        help="step limit of an episode (default: 5000 in profile paper, the "
                        "scenario's in others)")
    parser.add_argument("--evaluation-seed", type=int, default=1000,
                        help="seed of the evaluation episodes, the same for all learners (default: "
                        "1000)")
    parser.add_argument("--jobs", type=int, default=0,
                        help="number of runs in parallel, with --scheduler local or slurm (default: "
                        "one per core)")
    parser.add_argument("--scheduler", default=cluster.LOCAL, help=cluster.HELP)
    parser.add_argument("--human", default="none",
                        help="folder with bags of ./aquafarm play, which become a row; each folder "
                        "in it contains the bags of one person (default: none)")
    parser.add_argument("--learner", action="append", default=[], metavar="NAME=COMMAND",
                        help="a learner of another package as a row: a program that trains and "
                        "evaluates as aquafarm_gym.external describes, or a shared library (.so) "
                        "that registers NAME; may be repeated")
    parser.add_argument("--tables-only", action="store_true", help="draw no figures")
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of aquafarm_train and aquafarm_evaluate (default: the "
                        "workspace's, or those on PATH)")
    return parser


def parse(arguments):
    """Parses the arguments. If runs, episodes, evaluation_episodes or max_steps is 0 or absent, the
    profile sets it. Raises BadInput or cluster.BadScheduler."""
    options = _parser().parse_args(arguments)
    if options.profile not in PROFILES:
        raise BadInput(f"profile: got '{options.profile}', expected one of: "
                       + ", ".join(PROFILES))
    cluster.check(options.scheduler)
    profile = PROFILES[options.profile]
    _require_paper(options)
    for name in ("runs", "episodes", "evaluation_episodes", "max_steps"):
        if getattr(options, name) == 0:
            setattr(options, name, getattr(profile, name))
    options.jobs = options.jobs or len(os.sched_getaffinity(0))
    for name, least in (("runs", 1), ("episodes", 1), ("evaluation_episodes", 1), ("jobs", 1),
                        ("max_steps", 0), ("evaluation_seed", 0)):
        if getattr(options, name) < least:
            raise BadInput(f"{name}: got {getattr(options, name)}, expected {least} or more")
    names = [one.name for one in profile.contestants]
    options.algorithms = (_default_names(profile) if options.algorithms == "all" else
                          [name for name in options.algorithms.split(",") if name])
    for name in options.algorithms:
        if name not in names:
            raise BadInput(f"algorithms: got '{name}', expected some of: {', '.join(names)}")
    options.learners = [_external(text, number) for number, text in enumerate(
        text for text in options.learner if text != "none")]
    taken = [*names, OPTIMUM.name, human.HUMAN.name, *(one.name for one in options.learners)]
    for one in options.learners:
        if taken.count(one.name) > 1:
            raise BadInput(f"learner: got '{one.name}', expected a name that no other row has")
    if not options.algorithms and not options.learners:
        raise BadInput(f"algorithms: got none, expected some of: {', '.join(names)}")
    return options


_EXTERNAL_COLOURS = ("#8c564b", "#e377c2", "#9467bd", "#393b79")


def _external(text, number):
    """Returns the row of 'NAME=COMMAND' or 'NAME=FILE.so'. number: index of its colour"""
    name, _, command = text.partition("=")
    try:
        words = tuple(shlex.split(command))
    except ValueError:  # a quote that is not closed
        words = ()
    if not re.fullmatch("[a-z][a-z0-9_]*", name) or not words:
        raise BadInput(f"learner: got '{text}', expected NAME=COMMAND with a name of a-z, 0-9 and _, "
                       "such as mine=python3 my_learner.py")
    colour = _EXTERNAL_COLOURS[number % len(_EXTERNAL_COLOURS)]
    if len(words) > 1 or not words[0].endswith(".so"):
        return Contestant(name, name, colour, command=words)
    library = pathlib.Path(words[0]).resolve()
    if not library.is_file():
        raise BadInput(f"learner: got '{text}', but there is no file {library}; expected a shared "
                       "library that registers the learner")
    return Contestant(name, name, colour, library=str(library))


def _load_in_programs(contestants):
    """Sets AQUAFARM_LEARNERS, so that the programs of this benchmark load the libraries of its
    learners."""
    libraries = [one.library for one in contestants if one.library]
    if libraries:
        there = os.environ.get("AQUAFARM_LEARNERS", "")
        os.environ["AQUAFARM_LEARNERS"] = ":".join([*libraries, *filter(None, [there])])


def _own_packages(program):
    """Returns the words to put before the command of a program. If the program belongs to a virtual
    environment that contains aquafarm_core, they remove the workspace from PYTHONPATH, because the
    workspace would hide packages of that environment. For other programs, the list is empty."""
    home = pathlib.Path(shutil.which(program) or program).parent.parent
    if not (home / "pyvenv.cfg").is_file() or not any(
            home.glob("lib/python*/site-packages/aquafarm_core")):
        return []
    kept = [one for one in os.environ.get("PYTHONPATH", "").split(":")
            if one and not one.endswith("/dist-packages")]
    return ["env", f"PYTHONPATH={':'.join(kept)}"]


def _external_command(one, options, seed, run):
    """Returns the command that trains and evaluates a learner of another package."""
    return [*_own_packages(one.command[0]), *one.command, one.scenario or options.scenario, "--name", one.name,
            "--max-steps", str(options.max_steps), "--episodes", str(options.episodes),
            "--seed", str(seed), "--evaluation-episodes", str(options.evaluation_episodes),
            "--evaluation-seed", str(options.evaluation_seed), "--run-dir", str(run)]


def _default_names(profile):
    return [one.name for one in profile.contestants if not one.named_only]


def _require_paper(options):
    """Raises BadInput if profile paper is used with another scenario than paper: some of its rows
    use the scenario paper_plain."""
    if options.profile == "paper" and options.scenario != "paper":
        raise BadInput(f"scenario: got '{options.scenario}' with profile paper, expected paper, "
                       "whose rows have scenarios of their own; use profile full for another "
                       "scenario")


def find_program(name, folder, package="aquafarm_agents"):
    """Returns the path of a program: in `folder` if set, else in the workspace or on PATH. Raises
    BadInput if there is none."""
    places = [folder] if folder else [
        pathlib.Path(prefix) / "lib" / package
        for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
    for place in places:
        if os.access(place / name, os.X_OK):
            return str((place / name).resolve())
    found = None if folder else shutil.which(name)
    if found is None:
        where = folder or "the workspace (source its setup.bash) or on PATH"
        raise BadInput(f"programs: there is no {name} in {where}; build first, or give --programs")
    return found


def make_jobs(options, contestants, folder):
    """Returns the jobs: one per contestant and seed; only one for a contestant whose results do not
    depend on the seed."""
    train = find_program("aquafarm_train", options.programs)
    evaluate = find_program("aquafarm_evaluate", options.programs)
    jobs = []
    for one in contestants:
        farm = [one.scenario or options.scenario, "--max-steps", str(options.max_steps)]
        for seed in range(1, options.runs + 1) if one.repeats else (1,):
            run = folder / "runs" / one.name / f"seed_{seed}"
            commands = []
            if one.command:
                jobs.append(runs.Job(one.name, f"{one.name} {seed}", run, run / "evaluation.json",
                                     [_external_command(one, options, seed, run)], one.cost))
                continue
            if one.learns:
                commands.append([
                    train, *farm, "--algorithm", one.algorithm_name,
                    "--episodes", str(options.episodes),
                    "--seed", str(seed), "--run-dir", str(run), "--evaluate", "0", "--random", "0",
                    "--farms", str(FARMS), "--checkpoint-period", "120",
                    *(["--exploration", one.exploration] if one.exploration else []),
                    *(word for option in one.options for word in ("--set", option))])
            episodes = options.evaluation_episodes
            episodes = min(episodes, one.episodes) if one.episodes else episodes
            commands.append([
                evaluate, str(run) if one.learns else one.algorithm_name, *farm,
                "--episodes", str(episodes), "--seed", str(options.evaluation_seed),
                "--policy-seed", str(seed), "--write", str(run / "evaluation"),
                *(["--route", str(run / "route.json")] if seed == 1 else [])])
            jobs.append(runs.Job(one.name, f"{one.name} {seed}" if one.repeats else one.name, run,
                                 run / "evaluation.json", commands, one.cost, one.learns))
    return jobs


def settings_of(options, contestants, farm):
    """Returns the settings that affect the results. All results in a folder must have the same
    settings, except that runs and learners may be added (see claim)."""
    return {**farm, "runs": options.runs, "episodes": options.episodes,
            "evaluation_episodes": options.evaluation_episodes, "max_steps": options.max_steps,
            "evaluation_seed": options.evaluation_seed, "farms": FARMS,
            "learners": {one.name: _settings_of_one(one) for one in contestants}}


def _settings_of_one(one):
    settings = {"exploration": one.exploration, "options": list(one.options)}
    if one.algorithm:
        settings["algorithm"] = one.algorithm
    if one.scenario:
        settings["scenario"] = one.scenario
    if one.command:
        settings["command"] = list(one.command)
    if one.library:
        settings["library"] = one.library
    return settings


def claim(folder, settings):
    """Creates the folder of a benchmark if needed, locks it and writes its settings. Raises
    BadInput if the folder contains another benchmark or other files, or is in use.

    Returns the descriptor of the lock, which this process holds until it ends."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "benchmark.json"
    there = None
    if path.exists():
        try:
            there = json.loads(path.read_text())
        except ValueError:
            raise BadInput(f"{path}: is damaged; name another folder") from None
    elif any(folder.iterdir()):
        raise BadInput(f"{folder}: is not empty and holds no benchmark; name another folder")
    lock = _lock(folder)
    if there is not None:
        for key, value in settings.items():
            if key in ("runs", "learners"):  # runs and learners may be added
                continue
            if there.get(key) != value:
                raise BadInput(f"{folder}: holds a benchmark with {key} {there.get(key)}, got "
                               f"{value}; name another folder")
        for name, learner in settings["learners"].items():
            if there.get("learners", {}).get(name, learner) != learner:
                raise BadInput(f"{folder}: holds runs of {name} with other settings; name another "
                               "folder")
        settings = dict(settings, learners={**there.get("learners", {}), **settings["learners"]})
    results.write_atomically(path, json.dumps(settings, indent=2) + "\n")
    return lock


def _lock(folder):
    lock = os.open(folder / "lock", os.O_RDWR | os.O_CREAT, 0o644)
    end = time.monotonic() + _LOCK_LIMIT_S
    is_reported = False
    while True:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return lock
        except BlockingIOError:
            if time.monotonic() > end:
                os.close(lock)
                raise BadInput(f"{folder}: is in use by another benchmark") from None
            if not is_reported:
                _say(f"{folder} is in use; waiting up to {_LOCK_LIMIT_S:.0f} s for that to end")
                is_reported = True
            time.sleep(0.1)


def read_people(folder, farm):
    """Returns the people whose bags are in a folder, with their episodes. Raises BadInput."""
    try:
        people = human.find(pathlib.Path(folder))
        human.verify(people, find_program("verify_bag", None, "aquafarm_sim"))
        return human.read(people, farm["scenario_hash"])
    except human.BadBag as error:
        raise BadInput(str(error)) from None


_FARM_KEYS = ("scenario", "scenario_hash", "version")


def look_at_farm(options):
    """Returns {scenario: its name, scenario_hash, version: that of the programs}, and whether the
    scenario has the key money. Raises BadInput if the scenario is invalid."""
    evaluate = find_program("aquafarm_evaluate", options.programs)
    with tempfile.TemporaryDirectory(prefix="aquafarm_") as folder:
        one = subprocess.run([evaluate, "random", options.scenario, "--episodes", "1",
                              "--max-steps", str(options.max_steps), "--write", f"{folder}/one"],
                             capture_output=True, text=True, check=False)
        if one.returncode != 0:
            lines = one.stderr.strip().splitlines()
            raise BadInput(lines[-1] if lines else f"scenario: got '{options.scenario}'")
        found = json.loads(pathlib.Path(folder, "one.json").read_text())
    return {key: found[key] for key in _FARM_KEYS}, "money" in found


def _require_alike(name, of_one):
    """Raises BadInput if the runs of one contestant were trained with different options."""
    kinds = {run["training"].get("options", "") for run in of_one}
    if len(kinds) > 1:
        raise BadInput(f"{name}: its runs were made with different options ({'; '.join(kinds)}); "
                       "remove their folders or name another one")


def run(options):
    """Runs the complete protocol: trains, evaluates, writes and draws."""
    _load_in_programs(options.learners)
    farm, has_money = look_at_farm(options)
    names = set(options.algorithms)
    if has_money:
        names.update(one.name for one in REFERENCES)
    contestants = [one.for_episodes(options.episodes)
                   for one in PROFILES[options.profile].contestants if one.name in names]
    contestants += options.learners
    folder = options.output.resolve()
    people = read_people(options.human, farm) if options.human != "none" else []
    settings = settings_of(options, contestants, farm)
    claim(folder, settings)
    jobs = make_jobs(options, [*contestants, OPTIMUM], folder)
    is_whole = not any(job.has_begun or runs.is_complete(job.result) for job in jobs)
    start = time.monotonic()
    declined = _run_jobs(jobs, options, folder)
    for name, reason in declined.items():
        _say(f"{name} is left out: {reason}")
    if all(one.name in declined for one in contestants):
        raise BadInput("no row of the table is left, see above; select other --algorithms")
    found = {}
    for job in jobs:
        if job.contestant not in declined:
            found.setdefault(job.contestant, []).append(results.read_run(job.folder))
    for name, of_one in found.items():
        _require_alike(name, of_one)
    if people:
        human.write_runs(people, farm, folder / "runs" / human.HUMAN.name)
        found[human.HUMAN.name] = [
            results.read_run(folder / "runs" / human.HUMAN.name / f"seed_{number}")
            for number in range(1, len(people) + 1)]
    seconds = time.monotonic() - start
    settings.update(jobs=options.jobs, wall_s=round(seconds, 1) if is_whole else None)
    contestants = [one for one in contestants if one.name in found]
    everyone, rows = output.tabulate(folder, contestants, found, settings, people)
    if not options.tables_only:
        output.draw(folder, everyone, found, rows)
    print(results.table(rows) + results.money_table(rows))
    what = "tables" if options.tables_only else "tables and figures"
    print(f"took {runs.describe_seconds(seconds)}; {what} are in {folder}")


def _run_jobs(jobs, options, folder):
    """Executes the jobs. Returns {contestant: reason} for contestants that do not take part."""
    with cluster.Cluster(options.scheduler, options.jobs) as workers:
        place = (f"{options.jobs} in parallel" if workers.is_local else
                 f"on the scheduler {options.scheduler}")
        _say(f"{len(jobs)} runs, {place}, in {folder}")
        return runs.run_all(jobs, workers, _say)


def _say(text):
    print(text, flush=True)


def exit_code(name, command):
    """Runs a command of this package and returns its exit code. An error is printed in one line.
    SIGTERM has the same effect as SIGINT: the command saves and exits."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return command()
    except (ValueError, BadInput) as error:
        code, words = _BAD_INPUT, str(error)
    except (runs.Interrupted, KeyboardInterrupt) as error:
        code, words = _INTERRUPTED, str(error) or "interrupted"
    except (OSError, subprocess.SubprocessError) as error:
        code, words = _STORAGE, f"storage: {error}"
    print(f"{name}: {words}", file=sys.stderr)
    return code


def main(arguments=None):
    """Runs the program; returns its exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    # roslaunch adds __name:=… and __log:=…
    arguments = [word for word in arguments if not word.startswith("__")]
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # save and exit, as for SIGINT
    try:
        run(parse(arguments))
        return _OK
    except (BadInput, cluster.BadScheduler) as error:
        print(error, file=sys.stderr)
        return _BAD_INPUT
    except cluster.Lost as error:
        print(error, file=sys.stderr)
        return _FAILED
    except runs.RunFailed as error:
        print(f"some runs failed; the others are kept:\n{error}", file=sys.stderr)
        return _FAILED
    except (runs.Interrupted, KeyboardInterrupt) as error:
        print(str(error) or "interrupted", file=sys.stderr)
        return _INTERRUPTED
    except (OSError, subprocess.SubprocessError) as error:
        print(f"storage: {error}", file=sys.stderr)
        return _STORAGE
