# SPDX-License-Identifier: BSD-3-Clause
"""Computes measures from complete runs, and writes them to files."""
import csv
import json
import math
import os

import numpy as np

from aquafarm_benchmark import losses, measures
from aquafarm_benchmark.protocol import PAPER_TABLE

_EVALUATED = ("return_per_episode", "return_per_step", "success_rate", "steps_per_episode",
              "crashes_per_episode", "steps_in_disaster_per_episode", "delivered_health")
# Evaluations of version 0.1.0 do not contain these.
_ADDED = ("energy_kwh_per_episode", "distance_km_per_episode")


def write_atomically(path, text):
    """Writes a temporary file in the same folder, then renames it to `path`."""
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(text)
    os.replace(temporary, path)


def read_curve(metrics):
    """Returns columns of a training's metrics.csv: {name: array with an entry per episode}."""
    columns = {"return": [], "steps": [], "success": [], "loss": []}
    with open(metrics, newline="") as file:
        for row in csv.DictReader(file):
            for name, values in columns.items():
                values.append(float(row[name]))
    return {name: np.array(values) for name, values in columns.items()}


def read_run(folder):
    """Returns the results of one run of a contestant. 'training' is the content of run.json. If the
    contestant was not trained, 'curve' is None and 'training' is empty."""
    evaluation = json.loads((folder / "evaluation.json").read_text())
    metrics = folder / "metrics.csv"
    curve = read_curve(metrics) if metrics.exists() else None
    run = {name: evaluation[name] for name in _EVALUATED}
    run.update(seed=int(folder.name.rsplit("_", maxsplit=1)[-1]), folder=folder, curve=curve,
               convergence=None, settled=None, evaluation=evaluation)
    for name in _ADDED:
        run[name] = evaluation.get(name)
    # Evaluations of version 0.1.0 do not contain the number of distinct episodes.
    run["distinct_episodes"] = evaluation.get("distinct_episodes")
    run["evaluation_episodes"] = evaluation["episodes"]
    run["money"] = losses.read(folder / "evaluation.csv")
    settings = folder / "run.json"
    run["training"] = json.loads(settings.read_text()) if settings.exists() else {}
    if run["training"]:
        run["libraries"] = run["training"].get("libraries", "")
    if curve is not None:
        run["convergence"] = measures.convergence(curve["return"], curve["success"])
        run["settled"] = measures.convergence(curve["return"], curve["success"], measures.NOISE)
    return run


def mean_return(evaluation_csv, count):
    """Returns the mean return of the first `count` episodes of an evaluation."""
    with open(evaluation_csv, newline="") as file:
        returns = [float(row["return"]) for row in csv.DictReader(file)
                   if int(row["episode"]) < count]
    return float(np.mean(returns))


def _interval(values):
    low, high = measures.bootstrap_interval(values)
    return [low, high]


def summarise(contestant, runs, optimum, training_episodes):
    """Returns the measures of a contestant over its runs. add_ea adds the ranks, which depend on
    all contestants.

    optimum: mean return of the clairvoyant on the same evaluation episodes; None if it is unknown
    """
    def column(name):
        return np.array([run[name] for run in runs], dtype=float)

    returns = column("return_per_episode")
    row = {"name": contestant.name, "label": contestant.label, "runs": len(runs),
           "paper_row": contestant.paper_row}
    for name in _EVALUATED:
        row[name] = float(column(name).mean())
    for name in _ADDED:
        row[name] = None if None in [run[name] for run in runs] else float(column(name).mean())
    row["success_worst"] = float(column("success_rate").min())
    row["return_iqm"] = measures.interquartile_mean(returns)
    row["return_interval"] = _interval(returns)
    row["return_per_step_interval"] = _interval(column("return_per_step"))
    row["success_interval"] = _interval(column("success_rate"))
    row["share_of_optimum"] = None
    if optimum is not None and optimum > 0.0:  # the share of an optimum of 0 or less is undefined
        row["share_of_optimum"] = row["return_per_episode"] / optimum
    row["stability"] = row["stability_settled"] = row["stability_interval"] = None
    for name, stability in (("convergence", "stability"), ("settled", "stability_settled")):
        episodes = [run[name] for run in runs]
        row[name] = measures.median_convergence(episodes)
        row[name + "_runs"] = episodes
        if contestant.learns:
            row[stability] = sum(one is not None for one in episodes) / len(episodes)
    if contestant.learns:
        converged = sum(one is not None for one in row["convergence_runs"])
        row["stability_interval"] = list(measures.wilson_interval(converged, len(runs)))
    row["training_steps"] = float(np.mean([run["evaluation"]["training_steps"] for run in runs]))
    row["episodes"] = training_episodes
    row["evaluation_episodes"] = runs[0]["evaluation_episodes"]
    counts = [run["distinct_episodes"] for run in runs]
    row["distinct_episodes"] = None if None in counts else min(counts)
    row["money"] = None
    if all(run["money"] for run in runs):
        row["money"] = losses.summarise(losses.pool([run["money"] for run in runs]),
                                        runs[0]["evaluation"]["money"]["currency"])
    return row


def add_ea(rows):
    """Adds rank, ea_paper and ea_normalised to all rows. They are None for rows that did not learn;
    ea_normalised is also None if share_of_optimum is None."""
    trained = [row for row in rows if row["stability"] is not None]
    ranks = measures.convergence_ranks({row["name"]: row["convergence"] for row in trained})
    for row in rows:
        row["rank"] = ranks.get(row["name"])
        row["ea_paper"] = row["ea_normalised"] = None
        if row["rank"] is None:
            continue
        row["ea_paper"] = measures.ea_paper(row["return_per_step"], row["success_rate"],
                                            row["rank"], row["stability"])
        if row["share_of_optimum"] is None:
            continue
        row["ea_normalised"] = measures.ea_normalised(
            row["share_of_optimum"], row["success_rate"], row["convergence"], row["stability"],
            row["episodes"])


def _text(value, form="{:.2f}"):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    return form.format(value)


def _share(value):
    return "below 0" if value is not None and value < 0.0 else _text(value, "{:.3f}")


def _distinct(row):
    """Returns the number of evaluation episodes with different starts, as "990 of 1000"."""
    return f"{_text(row['distinct_episodes'], '{}')} of {row['evaluation_episodes']}"


def table(rows):
    """Returns the results as a Markdown table. A row of Table 1 follows the row with which it is
    compared."""
    lines = ["| | return per step | success | converged at | stability | settled at | EA | "
             "EA in [0, 1] | return per episode, 95 % interval | share of the optimum | "
             "distinct episodes |",
             "| --- " * 11 + "|"]
    for row in rows:
        printed = PAPER_TABLE.get(row.get("paper_row"))
        low, high = row["return_interval"]
        interval = "" if math.isnan(low) else f" ({low:.1f} … {high:.1f})"
        settled = _text(row["settled"], "{:.0f}")
        if row["settled"] is not None:
            settled += f" ({_text(row['stability_settled'], '{:.1f}')})"
        lines.append("| " + " | ".join((
            row["label"], _text(row["return_per_step"]), _text(row["success_rate"], "{:.3f}"),
            _text(row["convergence"], "{:.0f}"), _text(row["stability"], "{:.1f}"), settled,
            _text(row["ea_paper"]), _text(row["ea_normalised"]),
            f"{row['return_iqm']:.1f}{interval}", _share(row["share_of_optimum"]),
            _distinct(row))) + " |")
        if printed:
            lines.append("| " + " | ".join((
                f"*{row['label']}, paper*", printed.average_return, printed.success,
                printed.convergence, printed.stability, "–", printed.ea, "–", "–", "–",
                "–")) + " |")
    return "\n".join(lines) + "\n"


def money_table(rows):
    """Returns the losses as a Markdown table; empty without money."""
    rows = [row for row in rows if row["money"]]
    if not rows:
        return ""
    def interval(bounds):
        return "" if any(map(math.isnan, bounds)) else f" ({bounds[0]:,.0f} … {bounds[1]:,.0f})"

    unit = rows[0]["money"]["currency"]
    lines = [f"\nLosses per episode in {unit} (loss = insured - saved).\n",
             "| | insured | saved | damaged | lost | loss ± standard error | operating cost | "
             "VaR 5 %, 95 % interval | CVaR 5 %, 95 % interval | distinct episodes |",
             "| --- " * 10 + "|"]
    for row in rows:
        money = row["money"]
        error = money["standard_error"]
        lines.append("| " + " | ".join((
            row["label"], *(f"{money[part]:,.0f}" for part in ("insured", "saved", "damaged",
                                                               "lost")),
            f"{money['loss']:,.0f} ± {_text(error, '{:,.0f}')}",
            f"{money['operating_cost']:,.0f}",
            f"{money['var']:,.0f}{interval(money['var_interval'])}",
            f"{money['cvar']:,.0f}{interval(money['cvar_interval'])}",
            f"{money['distinct_episodes']} of {money['episodes']}")) + " |")
    return "\n".join(lines) + "\n"


_MONEY_COLUMNS = ("insured", "saved", "damaged", "lost", "loss", "standard_error",
                  "operating_cost", "var", "var_low", "var_high", "cvar", "cvar_low", "cvar_high",
                  "episodes", "distinct_episodes")


def write_losses(folder, rows):
    """Writes losses.csv and exceedance.csv (the points of the curves). losses.csv has a line per
    row and kind of device. Lines of the kind "all" have all columns, other lines only the
    columns insured to loss. Writes nothing without money."""
    rows = [row for row in rows if row["money"]]
    if not rows:
        return
    lines = [",".join(("name", "kind", "currency", *_MONEY_COLUMNS))]
    points = ["name,loss,probability_of_more"]
    for row in rows:
        money = dict(row["money"])
        for name in ("var", "cvar"):
            money[f"{name}_low"], money[f"{name}_high"] = money[f"{name}_interval"]
        kinds = {"all": money, **{kind: dict(parts, loss=parts["damaged"] + parts["lost"])
                                  for kind, parts in money["by_kind"].items()}}
        for kind, values in kinds.items():
            lines.append(",".join((row["name"], kind, money["currency"], *(
                "" if math.isnan(values.get(c, math.nan)) else str(values[c])
                for c in _MONEY_COLUMNS))))
        points += [f"{row['name']},{x},{p}" for x, p in zip(*money["exceedance"])]
    write_atomically(folder / "losses.csv", "\n".join(lines) + "\n")
    write_atomically(folder / "exceedance.csv", "\n".join(points) + "\n")


_TABLE_NOTES = """
Rows in italics: Table 1 of the paper as printed, with the rank of Eq. 16 in brackets. Its unit of
convergence is timesteps; the paper's protocol (§4.2) counts episodes, and so do the other rows.
Distinct episodes start with another layout, other ships or another storm; the others repeat.
Eq. 16 gives the printed EA of three rows, and −0.80 for RANDOM, where the paper prints −0.7.
"""


_HUMAN_NOTES = """
The row of human play contains the finished episodes of its bags; episodes that were abandoned are
not recorded. With one person the interval is over episodes, with several over people, as it is over
the runs of a learner. The share of the optimum is given if all episodes are evaluation episodes.
"""


def write(folder, settings, rows, runs):
    """Writes results.json (all results), table.csv (a line per row), runs.csv (a line per run) and
    table.md; with money also losses.csv, exceedance.csv and losses.md."""
    columns = ["name", "runs", "return_per_step", "return_per_step_low", "return_per_step_high",
               "success_rate", "success_low", "success_high", "success_worst", "convergence",
               "stability", "stability_low", "stability_high", "settled", "stability_settled", "rank", "ea_paper", "ea_normalised",
               "return_per_episode", "return_iqm", "return_low", "return_high",
               "share_of_optimum", "steps_per_episode", "crashes_per_episode",
               "steps_in_disaster_per_episode", *_ADDED, "training_steps", "evaluation_episodes",
               "distinct_episodes"]
    lines = [",".join(columns)]
    for row in rows:
        flat = dict(row)
        for name in ("return", "return_per_step", "success", "stability"):
            flat[f"{name}_low"], flat[f"{name}_high"] = row[f"{name}_interval"] or (None, None)
        lines.append(",".join("" if flat[name] is None else str(flat[name]) for name in columns))
    write_atomically(folder / "table.csv", "\n".join(lines) + "\n")

    run_columns = ["seed", "convergence", "settled", *_EVALUATED, *_ADDED]
    lines = [",".join(["name", *run_columns])]
    for name, of_one in runs.items():
        for run in of_one:
            lines.append(",".join([name] + ["" if run[c] is None else str(run[c])
                                            for c in run_columns]))
    write_atomically(folder / "runs.csv", "\n".join(lines) + "\n")

    everything = {"settings": settings, "table": rows,
                  "runs": {name: [_without(run, "curve", "folder", "training", "money")
                                  for run in of_one]
                           for name, of_one in runs.items()}}
    text = json.dumps(_without_nan(everything), indent=2, allow_nan=False)
    write_atomically(folder / "results.json", text + "\n")
    notes = _TABLE_NOTES if any(row["paper_row"] for row in rows) else ""
    if any(row["name"] == "human" for row in rows):
        notes += _HUMAN_NOTES
    write_atomically(folder / "table.md", table(rows) + notes)
    write_losses(folder, rows)
    if any(row["money"] for row in rows):
        write_atomically(folder / "losses.md", money_table(rows))


def _without(run, *names):
    return {name: value for name, value in run.items() if name not in names}


def _without_nan(value):
    if isinstance(value, dict):
        return {key: _without_nan(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_without_nan(one) for one in value]
    return None if isinstance(value, float) and math.isnan(value) else value
