# SPDX-License-Identifier: BSD-3-Clause
"""Plans rescues for many ranches, or evaluates policies on them, and writes one table. Runs on the
cores of this machine or of a cluster.

    aquafarm_many plan RANCH.yaml… --output FOLDER -- --bulletin FILE --ships 2
    aquafarm_many evaluate RANCH.yaml… --policy generalist --policy runs/x --output FOLDER -- --episodes 200

Arguments after -- go to aquafarm_plan or aquafarm_evaluate. FOLDER/table.md and table.csv have a
row for each ranch (and policy) with a result. FOLDER/runs has the result files and logs. After
Ctrl-C the same command resumes. Exit codes: 0 all results exist, 2 wrong argument, 3 storage,
4 some ranches failed, 130 interrupted.
"""
import argparse
import csv
import json
import os
import pathlib
import sys

from aquafarm_benchmark import cluster
from aquafarm_benchmark.cli import exit_code, find_program
from aquafarm_benchmark.runs import Job, RunFailed, is_complete, run_all
from aquafarm_benchmark.sweep import require_same

# Exit codes of aquafarm_plan after which its plan file is complete (docs/plan.md).
_PLANNED = (0, 10, 11, 12, 13)
_EVALUATE, _PLAN = "evaluate", "plan"
_COLUMNS = {
    _PLAN: ("ranch", "outcome", "insured", "mean_loss_without_plan", "mean_loss"),
    _EVALUATE: ("ranch", "policy", "return", "success"),
}


def is_planned(result):
    """Returns whether a plan was written. The program writes either a complete file or none."""
    return result.is_file()


def arguments(words):
    """Parses the arguments. Those after -- are for the program that runs. Raises ValueError."""
    words, rest = (words, []) if "--" not in words else (
        words[:words.index("--")], words[words.index("--") + 1:])
    parser = argparse.ArgumentParser(prog="aquafarm_many", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=(_PLAN, _EVALUATE))
    parser.add_argument("ranches", nargs="+", metavar="RANCH", help="scenario files or names")
    parser.add_argument("--policy", action="append", default=[],
                        help="evaluate: run folder, checkpoint or name; may be repeated (default: "
                        "generalist)")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="folder for results")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)),
                        help="number of ranches in parallel, with --scheduler local or slurm")
    parser.add_argument("--scheduler", default=cluster.LOCAL, help=cluster.HELP)
    parser.add_argument("--programs", type=pathlib.Path,
                        help="folder of the programs (default: the workspace's, or those on PATH)")
    given = parser.parse_args(words)
    if given.jobs < 1:
        raise ValueError(f"--jobs: got {given.jobs}, expected at least 1")
    if given.policy and given.what == _PLAN:
        raise ValueError("--policy: got a policy with plan, expected none; plans need no policy")
    cluster.check(given.scheduler)
    given.output, given.rest = given.output.resolve(), rest
    given.policy = given.policy or ["generalist"]
    return given


def jobs_of(given):
    """Returns the jobs, and for each job the first columns of its row: the ranch; for evaluate also
    the policy."""
    program = find_program(f"aquafarm_{given.what}", given.programs)
    jobs, rows = [], []
    for number, ranch in enumerate(given.ranches):
        for other, policy in enumerate(given.policy if given.what == _EVALUATE else [None]):
            name = f"{number:04d}_{pathlib.Path(ranch).stem}" + (f"_{other}" if other else "")
            folder = given.output / "runs" / name
            if policy is None:
                result = folder / "plan.json"
                command, good = [program, ranch, "--json", str(result), *given.rest], _PLANNED
                rows.append([ranch])
            else:
                result, good = folder / "evaluation.json", (0,)
                command = [program, policy, ranch, "--write", str(folder / "evaluation"), *given.rest]
                rows.append([ranch, policy])
            jobs.append(Job(name, name, folder, result, [command], 1.0, good_codes=good))
    return jobs, rows


def numbers_of(what, result):
    """Returns the last columns of a row, which are read from a result file."""
    found = json.loads(result.read_text("utf-8"))
    if what == _EVALUATE:
        return [found["return_per_episode"], found["success_rate"]]
    loss = found["loss"]
    return [found["outcome"]["kind"], loss["insured"], loss["idle"]["mean"], loss["with_plan"]["mean"]]


def write_tables(folder, columns, rows):
    """Writes table.csv and table.md. Returns the text of table.md."""
    with open(folder / "table.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([columns, *rows])
    shown = [[f"{one:.6g}" if isinstance(one, float) else "unknown" if one is None else str(one)
              for one in row] for row in rows]
    lines = [columns, ["---"] * len(columns), *shown]
    text = "".join("| " + " | ".join(line) + " |\n" for line in lines)
    (folder / "table.md").write_text(text, "utf-8")
    return text


def _files(words):
    """Returns {path: [size, modification time]} of the files that the words name. For a run folder,
    these are its policy and checkpoints. many.json contains the result, so that require_same raises
    ValueError if a file has changed."""
    inside = [str(path) for word in words for path in
              [pathlib.Path(word) / "policy.ckpt", *pathlib.Path(word).glob("checkpoints/*.ckpt")]]
    return {word: [os.stat(word).st_size, os.stat(word).st_mtime_ns]
            for word in (*words, *inside) if os.path.isfile(word)}


def _say(text):
    print(text, flush=True)


def _run(given):
    jobs, rows = jobs_of(given)
    require_same(given.output, "many.json", {
        "what": given.what, "ranches": given.ranches, "arguments": given.rest,
        "policies": given.policy, "files": _files([*given.ranches, *given.rest, *given.policy])})
    complete, code = is_planned if given.what == _PLAN else is_complete, 0
    try:
        with cluster.Cluster(given.scheduler, given.jobs) as workers:
            declined = run_all(jobs, workers, _say, complete=complete)
        for name, reason in declined.items():
            print(f"refused: {name}: {reason}", file=sys.stderr)
            code = 4
    except (RunFailed, cluster.Lost) as error:
        print(f"aquafarm_many: {error}", file=sys.stderr)
        code = 4
    table = [row + numbers_of(given.what, job.result) for row, job in zip(rows, jobs)
             if complete(job.result)]
    print(f"\n{write_tables(given.output, list(_COLUMNS[given.what]), table)}\n"
          f"written: {given.output / 'table.md'}, table.csv; "
          f"{len(table)} of {len(jobs)} results exist")
    return code


def main(words=None):
    """Runs the program; returns its exit code."""
    words = sys.argv[1:] if words is None else words
    return exit_code("aquafarm_many", lambda: _run(arguments(words)))


if __name__ == "__main__":
    sys.exit(main())
