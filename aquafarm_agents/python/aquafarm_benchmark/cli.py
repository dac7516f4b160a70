# SPDX-License-Identifier: BSD-3-Clause
"""The program aquafarm_benchmark."""
import argparse
import json
import os
import pathlib
import platform
import shutil
import signal
import subprocess
import sys
import time

from aquafarm_benchmark import results, runs
from aquafarm_benchmark.protocol import CONTESTANTS, OPTIMUM, PROFILES

_OK, _FAILED, _BAD_INPUT, _STORAGE, _INTERRUPTED = 0, 1, 2, 3, 130
_EPILOG = """exit codes: 0 all is there, 1 some runs failed (the others are kept), 2 bad argument,
3 storage, 130 interrupted (the same command goes on)"""


class BadInput(ValueError):
    """One line: what it got, what it expected."""


def parse(arguments):
    """Arguments with the profile's numbers filled in."""
    names = [one.name for one in CONTESTANTS]
    parser = argparse.ArgumentParser(
        prog="aquafarm_benchmark", epilog=_EPILOG,
        description="Trains every learner several times, measures them as the paper's §4.2 does, "
        "and ends with Table 1 beside ours and the figures. Killed or interrupted, the same "
        "command goes on: finished runs are kept, others resume from their checkpoints.")
    parser.add_argument("scenario", nargs="?", default="paper",
                        help="scenario file, or the name of a shipped one (default: paper)")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("benchmark"),
                        help="folder of runs, tables and figures (default: ./benchmark)")
    parser.add_argument("--profile", default="full",
                        help="full: the whole protocol; quick: minutes (default: full)")
    parser.add_argument("--algorithms", default="all",
                        help="who takes part, separated by commas (default: all, which are "
                        f"{','.join(names)})")
    parser.add_argument("--runs", type=int, default=0,
                        help="trainings of each, with seeds 1, 2, … (default: the profile's)")
    parser.add_argument("--episodes", type=int, default=0,
                        help="episodes of a training (default: the profile's)")
    parser.add_argument("--evaluation-episodes", type=int, default=0,
                        help="greedy episodes never trained on (default: the profile's)")
    parser.add_argument("--max-steps", type=int, default=5000,
                        help="step limit of an episode (default: 5000)")
    parser.add_argument("--evaluation-seed", type=int, default=1000,
                        help="seed of those episodes, the same for all (default: 1000)")
    parser.add_argument("--jobs", type=int, default=0,
                        help="runs side by side (default: one a core)")
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of aquafarm_train and aquafarm_evaluate (default: the "
                        "workspace's, or those on PATH)")
    options = parser.parse_args(arguments)
    if options.profile not in PROFILES:
        raise BadInput(f"profile: got '{options.profile}', expected one of: "
                       + ", ".join(PROFILES))
    profile = PROFILES[options.profile]
    for name in ("runs", "episodes", "evaluation_episodes"):
        if getattr(options, name) == 0:
            setattr(options, name, getattr(profile, name))
    options.jobs = options.jobs or len(os.sched_getaffinity(0))
    for name in ("runs", "episodes", "evaluation_episodes", "max_steps", "jobs"):
        if getattr(options, name) < 1:
            raise BadInput(f"{name}: got {getattr(options, name)}, expected 1 or more")
    if options.algorithms == "all":
        options.algorithms = ",".join(names)
    options.algorithms = [name for name in options.algorithms.split(",") if name]
    for name in options.algorithms:
        if name not in names:
            raise BadInput(f"algorithms: got '{name}', expected some of: {', '.join(names)}")
    if not options.algorithms:
        raise BadInput(f"algorithms: got none, expected some of: {', '.join(names)}")
    return options


def find_program(name, folder):
    """Path of a program of the core."""
    places = [folder] if folder else [
        pathlib.Path(prefix) / "lib/aquafarm_agents"
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
    """All runs: a job a seed for learners, one for those who only play."""
    train = find_program("aquafarm_train", options.programs)
    evaluate = find_program("aquafarm_evaluate", options.programs)
    farm = [options.scenario, "--max-steps", str(options.max_steps)]
    jobs = []
    for one in contestants:
        for seed in range(1, options.runs + 1) if one.learns else (1,):
            run = folder / "runs" / one.name / f"seed_{seed}"
            commands = []
            if one.learns:
                commands.append([
                    train, *farm, "--algorithm", one.name, "--episodes", str(options.episodes),
                    "--seed", str(seed), "--run-dir", str(run), "--evaluate", "0", "--random", "0",
                    "--checkpoint-period", "120",
                    *(["--exploration", one.exploration] if one.exploration else []),
                    *(word for option in one.options for word in ("--set", option)),
                    *(["--resume"] if _has_begun(run) else [])])
            episodes = options.evaluation_episodes
            episodes = min(episodes, one.episodes) if one.episodes else episodes
            commands.append([
                evaluate, str(run) if one.learns else one.name, *farm, "--episodes", str(episodes),
                "--seed", str(options.evaluation_seed), "--write", str(run / "evaluation"),
                *(["--route", str(run / "route.json")] if seed == 1 else [])])
            jobs.append(runs.Job(one.name, f"{one.name} {seed}" if one.learns else one.name, run,
                                 run / "evaluation.json", commands, one.cost))
    return jobs


def _has_begun(run):
    return (run / "run.json").exists() or any((run / "checkpoints").glob("step_*.ckpt"))


def settings_of(options, contestants):
    """What decides the results; a folder holds results of one such set."""
    return {"scenario": options.scenario, "runs": options.runs, "episodes": options.episodes,
            "evaluation_episodes": options.evaluation_episodes, "max_steps": options.max_steps,
            "evaluation_seed": options.evaluation_seed,
            "learners": {one.name: {"exploration": one.exploration, "options": list(one.options)}
                         for one in contestants}}


def claim(folder, settings):
    """Makes the folder, or refuses one that holds another benchmark."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "benchmark.json"
    if path.exists():
        try:
            there = json.loads(path.read_text())
        except ValueError:
            raise BadInput(f"{path}: is damaged; name another folder") from None
        for key in ("scenario", "episodes", "evaluation_episodes", "max_steps", "evaluation_seed"):
            if there.get(key) != settings[key]:
                raise BadInput(f"{folder}: holds a benchmark with {key} {there.get(key)}, got "
                               f"{settings[key]}; name another folder")
        for name, learner in settings["learners"].items():
            if there.get("learners", {}).get(name, learner) != learner:
                raise BadInput(f"{folder}: holds runs of {name} with other settings; name another "
                               "folder")
        settings = dict(settings, learners={**there.get("learners", {}), **settings["learners"]})
    elif any(folder.iterdir()):
        raise BadInput(f"{folder}: is not empty and holds no benchmark; name another folder")
    results.write_atomically(path, json.dumps(settings, indent=2) + "\n")


def check_scenario(options):
    """Refuses a scenario that no one can play, before anything is made."""
    evaluate = find_program("aquafarm_evaluate", options.programs)
    one = subprocess.run([evaluate, "random", options.scenario, "--episodes", "1", "--max-steps",
                          str(options.max_steps)], capture_output=True, text=True, check=False)
    if one.returncode != 0:
        lines = one.stderr.strip().splitlines()
        raise BadInput(lines[-1] if lines else f"scenario: got '{options.scenario}'")


def run(options):
    """The whole protocol: trains, measures, writes and draws."""
    check_scenario(options)
    contestants = [one for one in CONTESTANTS if one.name in options.algorithms]
    folder = options.output.resolve()
    settings = settings_of(options, contestants)
    jobs = make_jobs(options, [*contestants, OPTIMUM], folder)
    claim(folder, settings)
    start = time.monotonic()
    _say(f"{len(jobs)} runs, {options.jobs} side by side, in {folder}")
    declined = runs.run_all(jobs, options.jobs, _say)
    for name, reason in declined.items():
        _say(f"{name} does not take part: {reason}")
    if len(declined) > len(contestants):
        raise BadInput("nobody takes part")
    found = {}
    for job in jobs:
        if job.contestant not in declined:
            found.setdefault(job.contestant, []).append(results.read_run(job.folder))
    seconds = time.monotonic() - start
    _conclude(folder, [one for one in contestants if one.name in found], found, settings, seconds,
              options)
    print(f"took {runs.describe_seconds(seconds)}; tables and figures are in {folder}")


def _conclude(folder, contestants, found, settings, seconds, options):
    from aquafarm_benchmark import figures  # matplotlib takes a second that --help need not wait

    everyone = [*contestants, *([OPTIMUM] if OPTIMUM.name in found else [])]
    best = found[OPTIMUM.name][0] if OPTIMUM.name in found else None
    optimum = best["return_per_episode"] if best else None
    rows = []
    for one in everyone:
        # Some play fewer episodes; the optimum is then that of the same ones.
        count = found[one.name][0]["evaluation"]["episodes"]
        yardstick = results.mean_return(best["folder"] / "evaluation.csv", count) if best else None
        rows.append(results.summarise(one, found[one.name], yardstick, options.episodes))
    results.add_ea(rows)
    evaluation = next(iter(found.values()))[0]["evaluation"]
    settings = dict(
        settings, version=evaluation["version"], scenario_name=evaluation["scenario"],
        scenario_hash=evaluation["scenario_hash"], wall_s=round(seconds, 1), jobs=options.jobs,
        machine={"processor": _processor(), "cores": os.cpu_count(), "load": os.getloadavg(),
                 "OPENBLAS_CORETYPE": os.environ.get("OPENBLAS_CORETYPE")})
    results.write(folder, settings, rows, found)

    pictures = folder / "figures"
    pictures.mkdir(exist_ok=True)
    trained = [one for one in contestants if one.learns]
    if trained:
        figures.draw_rewards(pictures / "rewards.png", trained, found, optimum)
        figures.draw_average_rewards(pictures / "average_rewards.png", trained, found)
        figures.draw_square_error(pictures / "mean_square_error.png", trained, found)
        figures.draw_repeated(pictures / "repeated_trainings.png", trained, found, optimum)
    figures.draw_mean_score(pictures / "mean_score.png", everyone, rows)
    for one in everyone:
        figures.draw_route(pictures / f"route_{one.name}.png", one.label,
                           folder / "runs" / one.name / "seed_1" / "route.json")
    print(results.table(rows))


def _processor():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
        return next(names)
    except (OSError, StopIteration):
        return platform.processor()


def _say(text):
    print(text, flush=True)


def main(arguments=None):
    """Returns the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    # roslaunch adds __name:=… and __log:=…
    arguments = [word for word in arguments if not word.startswith("__")]
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # both mean: save and end
    try:
        run(parse(arguments))
        return _OK
    except BadInput as error:
        print(error, file=sys.stderr)
        return _BAD_INPUT
    except runs.RunFailed as error:
        print(f"some runs failed; the others are kept:\n{error}", file=sys.stderr)
        return _FAILED
    except runs.Interrupted as error:
        print(error, file=sys.stderr)
        return _INTERRUPTED
    except (OSError, subprocess.SubprocessError) as error:
        print(f"storage: {error}", file=sys.stderr)
        return _STORAGE
