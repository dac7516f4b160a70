# SPDX-License-Identifier: BSD-3-Clause
"""Writes the tables and the figures of a complete benchmark."""
import os
import pathlib
import platform

from aquafarm_benchmark import human, results
from aquafarm_benchmark.protocol import OPTIMUM


def _summarise(one, of_one, best, settings, people):
    """Returns the row of a contestant. best: run of the optimum; None if there is no such run"""
    is_human = one.name == human.HUMAN.name
    yardstick = None
    if best is not None:
        # A contestant is compared with the optimum of the episodes that it played.
        table = best["folder"] / "evaluation.csv"
        yardstick = (
            human.optimum_of_the_same(people, settings["evaluation_seed"], table) if is_human
            else results.mean_return(table, of_one[0]["evaluation"]["episodes"]))
    row = results.summarise(one, of_one, yardstick, settings["episodes"])
    if is_human:
        human.add_intervals(row, people)
    return row


def tabulate(folder, contestants, found, settings, people):
    """Writes the results. Returns all contestants, including people and the optimum, and their
    rows."""
    everyone = [*contestants, *([human.contestant(people)] if people else []),
                *([OPTIMUM] if OPTIMUM.name in found else [])]
    best = found[OPTIMUM.name][0] if OPTIMUM.name in found else None
    rows = [_summarise(one, found[one.name], best, settings, people) for one in everyone]
    results.add_ea(rows)
    settings = dict(settings, machine={
        "processor": _processor(), "cores": os.cpu_count(), "load": os.getloadavg(),
        "OPENBLAS_CORETYPE": os.environ.get("OPENBLAS_CORETYPE")})
    results.write(folder, settings, rows, found)
    return everyone, rows


def draw(folder, everyone, found, rows):
    """Writes the figures of the results."""
    # Imported here, because matplotlib takes a second to load, which would delay --help.
    from aquafarm_benchmark import (error_figure, evaluation_figure, figures, headlines,
                                    loss_figures, route_figure)

    pictures = folder / "figures"
    pictures.mkdir(exist_ok=True)
    trained = headlines.without_printed([one for one in everyone if one.learns])
    references = {one.label: row["return_per_episode"] for one, row in zip(everyone, rows)
                  if one.name in ("planner", OPTIMUM.name)}
    if trained:
        figures.draw_rewards(pictures / "rewards.png", trained, found, references)
        figures.draw_average_rewards(pictures / "average_rewards.png", trained, found, references)
        error_figure.draw_square_error(pictures / "mean_square_error.png", trained, found)
        figures.draw_repeated(pictures / "repeated_trainings.png", trained, found, references)
        per_step = {one.label: row["return_per_step"] for one, row in zip(everyone, rows)
                    if one.name == OPTIMUM.name}
        figures.draw_mean_score(pictures / "mean_score.png", trained, found, per_step)
    evaluation_figure.draw_evaluation(pictures / "evaluation.png", everyone, rows)
    if any(row["money"] for row in rows):
        loss_figures.draw_losses(pictures / "losses.png", everyone, rows)
    for one in everyone:
        route, best = (folder / "runs" / name / "seed_1" / "route.json"
                       for name in (one.name, OPTIMUM.name))
        if route.is_file():  # people and learners of --learner NAME=COMMAND have no route
            route_figure.draw_route(pictures / f"route_{one.name}.png", one.label, route,
                                    None if one is OPTIMUM else best)


def _processor():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
        names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
        return next(names)
    except (OSError, StopIteration):
        return platform.processor()
