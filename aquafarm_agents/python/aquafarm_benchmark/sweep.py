# SPDX-License-Identifier: BSD-3-Clause
"""Trains one learner with every combination of options and seeds. Compares the combinations of
options in one table.

    aquafarm_sweep SCENARIO ALGORITHM --set gamma=0.95,0.98 --set hidden_size=64,128 --seeds 1-5
                   --output FOLDER [--steps N] [--jobs 2]

Each combination with a result is a row of FOLDER/table.md and FOLDER/table.csv. The row contains
the return and success rate of greedy evaluations, as means over the seeds of the trainings. The
evaluation episodes are not used for training. The row with the highest return is first. FOLDER/runs
contains the run folders. After Ctrl-C the same command resumes.
"""
import argparse
import csv
import io
import itertools
import json
import math
import os
import pathlib
import sys

from aquafarm_benchmark import cluster
from aquafarm_benchmark.cli import exit_code, find_program
from aquafarm_benchmark.runs import Job, RunFailed, is_complete, run_all

# 97.5 % quantiles of Student's t with 1 to 30 degrees of freedom. Above 30 degrees, 1.96 is used.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179,
           2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
           2.060, 2.056, 2.052, 2.048, 2.045, 2.042)


def parse_option(text):
    """Returns (key, values) of 'key=a,b'. A schedule with colons, such as linear:1:0, is one value.
    Raises ValueError."""
    key, equals, values = text.partition("=")
    if not equals or not key or not all(values.split(",")):
        raise ValueError(f"--set: got '{text}', expected key=value,value,…")
    return key, values.split(",")


def parse_seeds(text):
    """Returns the seeds of '1-5' or '1,3,8'. Raises ValueError."""
    try:
        seeds = []
        for part in text.split(","):
            first, dash, last = part.partition("-")
            seeds += range(int(first), int(last if dash else first) + 1)
    except ValueError:
        seeds = []
    if not seeds or len(set(seeds)) != len(seeds):
        raise ValueError(f"--seeds: got '{text}', expected different numbers, such as 1-5 or 1,3,8")
    return seeds


def combinations(options):
    """Returns all combinations of the values, each as a list of 'key=value'. The values of the last
    key change fastest. Raises ValueError if a key occurs twice."""
    keys = [key for key, _ in options]
    if len(set(keys)) != len(keys):
        raise ValueError(f"--set: got {', '.join(keys)}, expected each key once; write its values "
                         "with commas")
    return [[f"{key}={value}" for key, value in zip(keys, values)]
            for values in itertools.product(*(values for _, values in options))]


def jobs_of(given, settings, train):
    """Returns one job for each combination and seed."""
    jobs = []
    for number, chosen in enumerate(settings):
        for seed in given.seed_list:
            folder = given.output / "runs" / f"{number:03d}_seed_{seed}"
            command = [train, given.scenario, "--algorithm", given.algorithm, "--seed", str(seed),
                       "--run-dir", str(folder), "--evaluate", str(given.episodes), "--random", "0"]
            if given.steps:
                command += ["--steps", str(given.steps)]
            for word in chosen:
                command += ["--set", word]
            jobs.append(Job(str(number), folder.name, folder, folder / "evaluation.json", [command],
                            1.0, resumable=True))
    return jobs


def describe(chosen):
    """Returns a combination as text, for tables and messages."""
    return " ".join(chosen) or "(defaults)"


def interval(values):
    """Returns the mean and the half-width of its 95 % interval (Student's t). The half-width is nan
    for one value."""
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, math.nan
    spread = math.sqrt(sum((one - mean) ** 2 for one in values) / (len(values) - 1))
    freedom = len(values) - 1
    quantile = STUDENT[freedom - 1] if freedom <= len(STUDENT) else 1.96
    return mean, quantile * spread / math.sqrt(len(values))


def table_of(settings, results):
    """Returns rows (options, number of seeds, mean return, half-width of its 95 % interval, mean
    success rate). The row with the highest return is first.

    results: {number of the combination: [content of evaluation.json]}
    """
    rows = []
    for number, chosen in enumerate(settings):
        found = results.get(number, [])
        if found:
            mean, half = interval([one["return_per_episode"] for one in found])
            success = sum(one["success_rate"] for one in found) / len(found)
            rows.append((describe(chosen), len(found), mean, half, success))
    return sorted(rows, key=lambda row: -row[2])


def markdown_of(title, rows):
    """Returns the table as Markdown."""
    lines = [title, "", "| options | seeds | return | ± 95 % | success |",
             "| --- | ---: | ---: | ---: | ---: |"]
    for options, seeds, mean, half, success in rows:
        shown = "" if math.isnan(half) else f"{half:.1f}"
        lines.append(f"| {options} | {seeds} | {mean:.1f} | {shown} | {100 * success:.1f} % |")
    return "\n".join(lines) + "\n"


def csv_of(rows):
    """Returns the table as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["options", "seeds", "return", "return_half_width_95", "success"])
    writer.writerows(rows)
    return text.getvalue()


def arguments(words):
    parser = argparse.ArgumentParser(prog="aquafarm_sweep", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", help="scenario file or name")
    parser.add_argument("algorithm", help="name of the learner")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=A,B,…",
                        help="option of the learner with its values; several --set are combined")
    parser.add_argument("--seeds", default="1-3", help="seeds of the trainings, such as 1-5 or 1,3,8")
    parser.add_argument("--steps", type=int, default=0,
                        help="farm steps per training; 0: the algorithm's default")
    parser.add_argument("--episodes", type=int, default=200, help="number of evaluation episodes")
    parser.add_argument("--output", type=pathlib.Path, required=True,
                        help="folder for runs and tables")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="number of trainings in parallel, with --scheduler local or slurm")
    parser.add_argument("--scheduler", default=cluster.LOCAL, help=cluster.HELP)
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of aquafarm_train (default: the workspace's, or that on PATH)")
    given = parser.parse_args(words)
    for name, low in (("steps", 0), ("episodes", 1), ("jobs", 1)):
        if getattr(given, name) < low:
            raise ValueError(f"--{name}: got {getattr(given, name)}, expected at least {low}")
    cluster.check(given.scheduler)
    given.seed_list = parse_seeds(given.seeds)
    return given


def require_same(folder, name, task, advice=""):
    """Writes the task to the file `name` in the folder. Raises ValueError if the file already
    contains another task.

    advice: end of the error message
    """
    text = json.dumps(task, indent=1)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    if path.is_file() and path.read_text("utf-8") != text:
        raise ValueError(f"--output: got {folder}, which compares something else ({name}), expected "
                         f"a new folder{advice}")
    path.write_text(text, "utf-8")


def check_plan(given, settings):
    """Writes the settings of the comparison to the output folder. Raises ValueError if the folder
    contains a comparison with other settings. Seeds are not part of the settings."""
    require_same(given.output, "sweep.json",
                 {"scenario": given.scenario, "algorithm": given.algorithm, "steps": given.steps,
                  "episodes": given.episodes, "options": settings},
                 "; other seeds may be added to an old one")


def _run(words):
    given = arguments(words)
    settings = combinations([parse_option(one) for one in given.set])
    train = find_program("aquafarm_train", given.programs)
    given.output = given.output.resolve()
    if given.scenario.endswith((".yaml", ".yml")):
        given.scenario = str(pathlib.Path(given.scenario).resolve())
    check_plan(given, settings)
    jobs, code = jobs_of(given, settings, train), 0
    print(f"{len(settings)} combinations x {len(given.seed_list)} seeds = {len(jobs)} trainings")
    try:
        with cluster.Cluster(given.scheduler, given.jobs) as workers:
            declined = run_all(jobs, workers, lambda text: print(text, flush=True))
        for number, reason in declined.items():
            print(f"refused: {describe(settings[int(number)])}: {reason}", file=sys.stderr)
            code = 2
    except (RunFailed, cluster.Lost) as error:
        print(f"aquafarm_sweep: {error}", file=sys.stderr)
        code = 4
    results = {}
    for job in jobs:
        if is_complete(job.result):
            results.setdefault(int(job.contestant), []).append(json.loads(job.result.read_text()))
    rows = table_of(settings, results)
    text = markdown_of(f"{given.algorithm} on {given.scenario}, seeds {given.seeds}", rows)
    (given.output / "table.md").write_text(text, "utf-8")
    (given.output / "table.csv").write_text(csv_of(rows), "utf-8")
    print(f"\n{text}\nwritten: {given.output / 'table.md'}, table.csv")
    return code


def main(words=None):
    """Runs the program; returns its exit code: 0, 2 wrong argument or option, 3 storage, 4 failed
    runs, 130 interrupted."""
    return exit_code("aquafarm_sweep", lambda: _run(words))


if __name__ == "__main__":
    sys.exit(main())
