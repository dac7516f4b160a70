# SPDX-License-Identifier: BSD-3-Clause
"""Makes the report of a run or a benchmark, or the comparison of several runs."""
import csv
import errno
import json
import pathlib
import tempfile

import numpy as np

from aquafarm_bringup.files import open_atomically
from aquafarm_report import blocks, compare, curves, intervals, outcomes, references, videos
from aquafarm_report.videos import ReportError

EPISODES = 1000  # default number of evaluation episodes, as in aquafarm_evaluate


def read_metrics(path):
    """Returns columns of metrics.csv as {name: array}; empty if there is no file or the file has no
    episode."""
    if not path.is_file():
        return {}
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name] or "nan") for row in rows])
            for name in ("return", "success", "loss", "exploration")} if rows else {}


def count_text(summary, episodes):
    """Returns the number of episodes as "100 episodes, 3 distinct"."""
    distinct = summary.get("distinct_episodes")  # None in evaluations of version 0.1.0
    return f"{episodes} episodes" + (f", {distinct} distinct" if distinct is not None else "")


def video_episodes(run, folder, rows):
    """Returns the sections of the best, median and worst episode: videos, outcomes of the devices,
    and a map. For a family of ranches, returns one section with the results of these episodes."""
    if videos.is_family(run):
        return [blocks.section("Best, median and worst episode", blocks.table(
            ["episode", "result"], [(f"{name}: episode {row['episode']} of seed {videos.SEED}",
                                     videos.result_text(row)) for name, row in videos.choose(rows)]),
            "<p>There are no videos: the scenario is a family, and each episode has a ranch of its "
            "own. ./aquafarm evaluate plays the policy on one ranch file.</p>")]
    shown, captions, results, chart = [], [], [], None
    for name, row in videos.choose(rows):
        bag = videos.bag_of(run, folder, int(row["episode"]))
        chart = chart or videos.draw_map(bag)
        caption = (f"{name}: episode {row['episode']} of seed {videos.SEED}, "
                   f"{videos.result_text(row)}")
        shown.append(blocks.video(videos.draw_video(bag, int(row["steps"])), caption))
        captions.append(f"{name}, episode {row['episode']}")
        results.append(outcomes.read_outcomes(bag))
    return [blocks.section("Best, median and worst episode",
                           f'<div class="videos">{"".join(shown)}</div>',
                           outcomes.episodes_table(captions, results)),
            blocks.section("The ranch", blocks.picture(chart, "at the start of an episode"))]


def show_episodes(run, folder, episodes):
    """Evaluates a run's policy. Returns the summary, the rows of the episodes, and the sections of
    the report."""
    summary, rows = videos.evaluate(run, folder, episodes)
    table = compare.measure_table([references.read_player(
        summary["algorithm"], folder / "evaluation", is_run=True)])
    losses = []
    if "money" in summary:
        from aquafarm_report import money  # imported here: it needs seconds to load

        losses = [money.show((summary["algorithm"], folder / "evaluation.csv"),
                             run / "scenario.yaml", folder, episodes,
                             summary["money"]["currency"])]
    devices = outcomes.summary_table(summary)
    if devices:
        losses.insert(0, blocks.section("What became of each device, all episodes", devices))
    return summary, rows, [
        blocks.section(f"Greedy play, {count_text(summary, len(rows))}", table), *losses,
        *video_episodes(run, folder, rows)]


def report_run(run, folder, episodes):
    """Returns the page of a run folder. folder: folder for temporary files"""
    settings = json.loads((run / "run.json").read_text(encoding="utf-8"))
    columns = read_metrics(run / "metrics.csv")
    summary, rows, sections = show_episodes(run, folder, episodes)
    facts = (f"<p>Trained for {len(columns.get('return', [])):,} episodes with seed "
             f"{settings['seed']}, version {blocks.escape(settings['version'])}.</p>")
    players = references.play_references(run / "scenario.yaml", folder, episodes)
    players.insert(1, references.read_player(settings["algorithm"], folder / "evaluation",
                                             is_run=True, training=columns.get("return", ())))
    training = curves.show([settings["algorithm"]], [columns], [curves.gap_note(players[1])],
                           players)
    return blocks.page(
        f"{settings['algorithm']} on the scenario {settings['scenario']}",
        blocks.section("Return of the policy and of the references", references.show_tiles(players), facts), training,
        *sections,
        blocks.section("Configuration",
                       blocks.details("run.json", json.dumps(settings, indent=2)),
                       blocks.details("scenario.yaml",
                                      (run / "scenario.yaml").read_text(encoding="utf-8"))))


_RUNS = "median of the runs, shaded from the lowest to the highest"
CAPTIONS = {
    "rewards": "50-episode mean return of each run by time steps (Fig. 12a of the paper); higher is "
               "better",
    "average_rewards": f"Mean return of all episodes so far (Fig. 12b): {_RUNS}; higher is better",
    "mean_square_error": f"50-episode mean square error of the value estimates (Fig. 12c): {_RUNS}",
    "repeated_trainings": f"50-episode mean return of each learner (Fig. 14): {_RUNS}",
    "mean_score": f"Return per step during the training (Fig. 13): {_RUNS}",
    "evaluation": "Return in the evaluation episodes, with 95 % intervals",
    "losses": "Losses of the trained policies in money",
}


def caption_of(stem):
    """Returns the caption of a figure of a benchmark. stem: name of its file without extension"""
    if stem.startswith("route_"):
        return f"Route and best moves of {stem[len('route_'):].replace('_', ' ')} in one episode"
    return CAPTIONS.get(stem, stem.replace("_", " "))


def best_run(benchmark, rows):
    """Returns the run folder runs/NAME/seed_1 of the best learner NAME. If this folder does not
    exist, returns that of the best contestant whose folder exists. None if there is no such
    folder."""
    for row in [intervals.best_learner(rows), *intervals.by_return(rows)]:
        run = benchmark / "runs" / row["name"] / "seed_1"
        if (run / "run.json").is_file():
            return run
    return None


def report_benchmark(benchmark, folder, episodes):
    """Returns the page of a benchmark's folder. folder: folder for temporary files"""
    settings = json.loads((benchmark / "benchmark.json").read_text(encoding="utf-8"))
    results = json.loads((benchmark / "results.json").read_text(encoding="utf-8"))
    best = intervals.best_learner(results["table"])
    tiles = blocks.tiles([
        (best["label"], "best learner"), (intervals.text(best), "its return, 95 % interval"),
        (intervals.share(best), "its share of the optimum"),
        (settings.get("scenario", "–"), "scenario"), (len(results["table"]), "contestants"),
        (max(row["runs"] for row in results["table"]), "runs of each"),
        (settings.get("episodes", "–"), "episodes of a training"),
        (settings.get("evaluation_seed", "–"), "seed of the evaluation"),
        (settings.get("version", "–"), "version")])
    figures = [blocks.picture(path, caption_of(path.stem), path.stem.startswith("route_"))
               for path in sorted((benchmark / "figures").glob("*.png"))]
    losses = []
    if (benchmark / "losses.md").is_file():
        losses = [blocks.section("Losses", blocks.markdown_table(
            (benchmark / "losses.md").read_text(encoding="utf-8")))]
    run = best_run(benchmark, results["table"])
    shown = []
    if run is not None:
        name = run.parent.name
        kind = "learner" if name == best["name"] else "contestant with a run folder"
        shown = [blocks.section(f"The best {kind}: {name}, seed 1")]
        shown += show_episodes(run, folder, episodes)[-1]
    seeds = sorted({run["seed"] for of_one in results["runs"].values() for run in of_one})
    return blocks.page(
        f"Benchmark on the scenario {settings.get('scenario', '(unknown)')}", tiles,
        blocks.section("Return and share of the optimum", intervals.table(results["table"]),
                       intervals.chart(results["table"])),
        blocks.section("Table 1, the paper's and ours", blocks.markdown_table(
            (benchmark / "table.md").read_text(encoding="utf-8"))),
        *losses, blocks.section("Figures", *figures), *shown,
        blocks.section("Configuration", f"<p>Seeds of the trainings: {blocks.escape(seeds)}</p>",
                       blocks.details("benchmark.json", json.dumps(settings, indent=2))))


def kind_of(source):
    """Returns report_run or report_benchmark, depending on the kind of a folder. Raises ReportError
    if it is neither a run nor a benchmark."""
    for name, report in (("run.json", report_run), ("results.json", report_benchmark)):
        if (source / name).is_file():
            return report
    raise ReportError(f"{source}: contains neither run.json nor results.json, expected "
                      "the folder of a run or a benchmark")


def make_text(sources, episodes):
    """Returns the page of a run or benchmark, or of the comparison of runs. Raises ReportError if
    the folders cannot be read or a program fails."""
    try:
        with tempfile.TemporaryDirectory(prefix="aquafarm_report_") as folder:
            work = pathlib.Path(folder)
            if len(sources) == 1:
                return kind_of(sources[0])(sources[0], work, episodes)
            return compare.report(sources, work, episodes, read_metrics)
    except (OSError, ValueError, KeyError) as error:
        named = ", ".join(map(str, sources))
        raise ReportError(f"{named}: cannot be read as a run or benchmark: "
                          f"{type(error).__name__}: {error}") from error


def make(sources, output, episodes=EPISODES):
    """Writes the report of a run or benchmark, or the comparison of runs. Returns its path. Raises
    ReportError if the report cannot be made or written."""
    sources = [pathlib.Path(source).resolve() for source in sources]
    default = sources[0] / "report.html" if len(sources) == 1 else "comparison.html"
    output = pathlib.Path(output or default).resolve()
    if len(sources) == 1:
        kind_of(sources[0])  # raises ReportError for other folders
    try:
        if output.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        with open_atomically(output) as file:  # opened before the work, which may take minutes
            file.write(make_text(sources, episodes))
    except OSError as error:
        raise ReportError(f"{output}: cannot be written: {error.strerror}; choose another file "
                          "with -o") from None
    return output
