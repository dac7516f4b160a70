# SPDX-License-Identifier: BSD-3-Clause
"""tools/draw_plan_figures.py with results that have and lack deviating groups and storms."""
import json
import pathlib
import subprocess
import sys
import warnings

import pytest

pytest.importorskip("matplotlib")

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import draw_plan_figures as tool  # noqa: E402

NEAR, FAR = 0.52, 0.70  # kept shares of a group with a promise of 0.5


def group(kept, count=100, half=0.05):
    return {"promised": 0.5, "count": count,
            "kept": {"mean": kept, "low": kept - half, "high": kept + half}}


def results(home, gales):
    return {"storms": 6000, **{key: {"diagram": [group(kept) for kept in kept_shares]}
                               for key, kept_shares in (("home", home), ("gales", gales))}}


def storm(name, **values):
    return {"name": name, "id": "x", "nearest": "2021-07-24T00:00Z", "at_risk": 100.0,
            "promised": 50.0, "saved": 60.0, "saved_low": 55.0, "saved_high": 65.0,
            "clairvoyant": 60.0, **values}


@pytest.fixture
def figures(monkeypatch):
    """The figures that the tool has drawn; they stay open until the end of the test."""
    kept = []
    monkeypatch.setattr(tool.plt, "close", kept.append)
    yield kept
    monkeypatch.undo()
    tool.plt.close("all")


@pytest.mark.parametrize("home, gales, far, missed", [
    ([NEAR], [NEAR], 0, 0),
    ([NEAR, FAR], [NEAR], 1, 1),
    ([NEAR], [NEAR, FAR], 1, 1),
    ([FAR], [FAR], 2, 2),
])
def test_both_charts_have_their_size_also_without_far_groups(figures, tmp_path, home, gales, far,
                                                             missed):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # matplotlib warns if a layout collapses
        tool.draw_reliability(results(home, gales), tmp_path / "plan.png")
    figure = figures[-1]  # a first figure also makes matplotlib close "all"
    left, right = figure.axes[:2]
    for axes in (left, right):
        assert axes.get_window_extent().width > 0.3 * figure.bbox.width
    labels = [text.get_text() for axes in (left, right) for text in axes.texts]
    assert labels.count("20 points") == far  # the worst groups; with other data there is one
    words = [text.get_text() for text in left.get_legend().get_texts()]
    assert ("over 5 points off" in words) == (far > 0)
    assert ("interval misses the promise" in words) == (missed > 0)
    assert ("group, 95 % interval" in words) == (NEAR in home + gales)
    total = len(home + gales)
    title = " ".join(figure._suptitle.get_text().split())
    worst = (f"; in {far} it happens more often than promised, by up to 20 points." if far else
             ", at worst 2 points off.")
    assert title == (
        f"Promised chances hold within 5 points in {total - far} of {total} groups{worst} The 95 % "
        f"intervals of {total - missed} groups contain the promise (6,000 simulated storms).")
    sizes = figure.axes[2]
    assert sizes.get_yscale() == "log" and not sizes.patches, "no bars: they would begin at 10"
    assert list(sizes.lines[0].get_ydata()) == [100] * len(home)


def test_groups_of_fewer_than_20_cases_are_left_out_and_one_point_is_singular():
    data = results([0.51], [0.51])
    data["home"]["diagram"].append(group(FAR, count=19))
    assert "in 2 of 2 groups, at worst 1 point off." in tool.reliability(data)
    data["home"]["diagram"] += [group(FAR), group(0.3)]
    assert "in 2 of 4 groups, at worst 20 points off." in " ".join(tool.reliability(data).split())
    data["home"]["diagram"][-2:] = [group(0.3)]
    assert "; in 1 it happens less often than promised, by up to 20 points." in " ".join(
        tool.reliability(data).split())


@pytest.mark.parametrize("name, shown", [
    ("IN-FA", "In-Fa 2021"), ("In-fa", "In-Fa 2021"), ("In-Fa", "In-Fa 2021"),
    ("Fung-wong", "Fung-Wong 2021"), ("MITAG", "Mitag 2021"), ("", "X 2021")])
def test_each_part_of_a_name_begins_with_a_capital_letter(name, shown):
    assert tool.name_of(storm(name)) == shown


def test_the_title_of_the_back_test_names_the_storms_in_which_the_plan_saves_less():
    storms = [storm("IN-FA"), storm("MITAG", saved=30.0), storm("CALM", at_risk=0.0, saved=0.0,
                                                                clairvoyant=0.0)]
    lines = tool.finding(storms).split("\n")
    assert " ".join(lines) == (
        "The plan saves what a clairvoyant saves in 1 of 2 storms with something at stake (not in "
        "Mitag 2021). Over all 3 storms it saves 75 % of the clairvoyant's value and promises 167 "
        "% of what it saves.")
    assert max(map(len, lines)) <= tool.LETTERS
    assert "promises" not in tool.finding([storm("CALM", saved=0.0, promised=9.0)])


@pytest.mark.parametrize("promised", [50.0, 70.0])
def test_the_note_states_why_a_promise_is_below_what_is_saved(figures, tmp_path, promised):
    data = {"bulletins": 4, "lead_h": 12.0, "storms": [storm("IN-FA", promised=promised)]}
    tool.draw_back_test(data, tmp_path / "plan.png")
    figure = figures[-1]
    assert ("selected because they came near" in figure._supxlabel.get_text()) == (promised < 60.0)
    assert any("at stake 100.0" in text.get_text() for text in figure.axes[0].texts)
    right = figure._suptitle.get_window_extent(figure.canvas.get_renderer()).x1
    assert right < figure.bbox.width


def test_the_program_draws_both_figures_from_files(tmp_path):
    (tmp_path / "storms.json").write_text(json.dumps(results([NEAR], [NEAR])))
    (tmp_path / "back_test.json").write_text(json.dumps(
        {"bulletins": 4, "lead_h": 12.0, "storms": [storm("IN-FA"), storm("MITAG", saved=30.0)]}))
    subprocess.run([sys.executable, ROOT / "tools" / "draw_plan_figures.py", "storms.json",
                    "back_test.json", "."], cwd=tmp_path, timeout=120, check=True)
    for name in ("plan_reliability", "plan_back_test"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
