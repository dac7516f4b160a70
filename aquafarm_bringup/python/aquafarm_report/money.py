# SPDX-License-Identifier: BSD-3-Clause
"""Compares the losses of a run's policy with those of the policies do_nothing and
fetch_by_value."""
import io
import pathlib

from aquafarm_benchmark import loss_figures, losses, results
from aquafarm_benchmark.protocol import REFERENCES, Contestant

from aquafarm_report import blocks, videos

_COLOUR = "#1b4f78"  # colour of the run's policy


def compare(own, scenario, folder, episodes, currency):
    """Evaluates the references; returns the contestants and the rows for results.money_table.

    own: name of the run's policy, and path of its evaluation.csv
    scenario: scenario file of the run
    folder: folder for the results of the references
    """
    name, path = own
    contestants = [Contestant(name, name, _COLOUR), *REFERENCES]
    paths = [path]
    for one in REFERENCES:
        prefix = pathlib.Path(folder) / one.name
        videos.call("aquafarm_agents", "aquafarm_evaluate", one.name, scenario, "--episodes",
                    episodes, "--seed", videos.SEED, "--write", prefix)
        paths.append(prefix.with_suffix(".csv"))
    rows = [{"name": one.name, "label": one.label,
             "money": losses.summarise(losses.read(path), currency)}
            for one, path in zip(contestants, paths)]
    return contestants, rows


def draw(contestants, rows):
    """Returns exceedance curves and the loss by kind of device as SVG."""
    figure, (curves, bars) = loss_figures.plt.subplots(2, 1, figsize=(7, 8))
    loss_figures.plot_exceedance(curves, contestants, rows)
    currency = rows[0]["money"]["currency"]
    curves.set_xlabel(f"loss x [{currency}]")
    curves.set_ylabel("probability of a larger loss")
    loss_figures.plot_loss_by_kind(bars, contestants, rows)
    bars.set_ylabel(f"loss per episode [{currency}]")
    figure.tight_layout()
    text = io.StringIO()
    figure.savefig(text, format="svg", transparent=True, metadata={"Date": None})
    loss_figures.plt.close(figure)
    svg = text.getvalue()
    return f'<div class="chart">{svg[svg.index("<svg"):]}</div>'


def show(own, scenario, folder, episodes, currency):
    """Returns the section of the report on losses. The parameters are those of compare."""
    contestants, rows = compare(own, scenario, folder, episodes, currency)
    note = (f"<p>Per episode, in {blocks.escape(currency)}. Insured = saved + damaged + lost; "
            "loss = damaged + lost. Triangles: CVaR, the mean loss of the worst 5 %.</p>")
    return blocks.section("Losses", note, blocks.markdown_table(results.money_table(rows)),
                          draw(contestants, rows))
