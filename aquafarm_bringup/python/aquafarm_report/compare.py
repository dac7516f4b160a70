# SPDX-License-Identifier: BSD-3-Clause
"""Makes the page that compares runs: returns with intervals, training curves, and videos of the
same episodes."""
import collections
import json

from aquafarm_report import blocks, curves, outcomes, references, videos
from aquafarm_report.videos import ReportError

MEASURES = (("return", "return", None), ("steps", "steps", "{:.1f}"),
            ("delivered", "devices home", "{:.2f}"),
            ("delivered_health", "health of devices brought home", "{:.3f}"),
            ("crashes", "crashes", "{:.2f}"), ("collisions", "collisions", "{:.2f}"),
            ("steps_in_disaster", "steps in disaster", "{:.2f}"),
            ("energy_kwh", "energy, kWh", "{:.2f}"), ("distance_km", "distance, km", "{:.1f}"))
RARE = ("collisions", "energy_kwh", "distance_km")  # omitted if they are 0 in all episodes
MOST_FILMS = 4  # max number of runs whose episodes are shown


class Run:
    """A run folder with its settings, training and evaluation."""

    def __init__(self, folder, work, episodes, read_metrics):
        if not (folder / "run.json").is_file():
            raise ReportError(f"{folder}: got no run (run.json), expected run folders to compare; "
                              "a benchmark has its own report")
        self.folder = folder
        self.work = work
        self.settings = json.loads((folder / "run.json").read_text(encoding="utf-8"))
        self.columns = read_metrics(folder / "metrics.csv")
        work.mkdir()
        self.summary, _ = videos.evaluate(folder, work, episodes)
        self.player = references.read_player(folder.name, work / "evaluation", is_run=True,
                                             training=self.columns.get("return", ()))

    @property
    def scenario(self):
        return self.settings["scenario"]


def label_runs(runs):
    """Sets a short label for each run: the name of its folder, a number if several folders have
    this name, and the learner unless the name contains it."""
    names = collections.Counter(run.folder.name for run in runs)
    seen = collections.Counter()
    for run in runs:
        name = run.folder.name
        seen[name] += 1
        number = f" ({seen[name]})" if names[name] > 1 else ""
        algorithm = run.settings["algorithm"]
        run.player.label = name + number + ("" if algorithm in name else f": {algorithm}")


def measure_table(players):
    """Returns the table of means per episode with 95 % intervals, with a column for each
    references.Player."""
    rows = []
    for name, words, form in MEASURES:
        if not all(name in one.rows[0] for one in players):
            continue
        if name in RARE and not any(any(references.column(one, name)) for one in players):
            continue
        rows.append([words] + [references.text(references.mean_interval(
            references.column(one, name), one.distinct), form) for one in players])
    rows.insert(1, ["success"] + [references.success_text(one) for one in players])
    rows.append(["episodes, distinct"] + [f"{len(one.rows)}, {one.distinct}" for one in players])
    return blocks.table(["mean of an episode, 95 % interval", *[one.label for one in players]],
                        rows)


def differences(runs):
    """Returns the table of the settings that differ between the runs."""
    def flat(settings):
        found = {key: value for key, value in settings.items()
                 if isinstance(value, (str, int, float, bool)) and key != "options"}
        for option in settings.get("options", "").split():
            key, _, value = option.partition("=")
            found[key] = value
        return found

    settings = [flat(run.settings) for run in runs]
    keys = sorted({key for one in settings for key in one})
    rows = [[key] + [one.get(key, "–") for one in settings] for key in keys
            if len({str(one.get(key, "–")) for one in settings}) > 1]
    if not rows:
        return "<p>All settings are the same.</p>"
    return blocks.table(["setting"] + [run.player.label for run in runs], rows)


def choose_episodes(runs):
    """Returns [(reason, episode)]: the episode with the median return of the first run, and the
    episode with the largest difference between the runs' returns if it is another one. The runs are
    in order of return."""
    returns = [{int(row["episode"]): float(row["return"]) for row in run.player.rows}
               for run in runs]
    common = sorted(set.intersection(*(set(one) for one in returns)))
    ranked = sorted(common, key=lambda episode: returns[0][episode])
    chosen = [("the median return of the best run", ranked[len(ranked) // 2])]
    apart = max(common, key=lambda episode: (max(one[episode] for one in returns) -
                                             min(one[episode] for one in returns), -episode))
    if apart != chosen[0][1]:
        chosen.append(("the largest difference between the runs", apart))
    return chosen


def show_episode(runs, reason, episode):
    """Returns the section of an episode: the videos of the runs side by side, and the outcome of
    each device."""
    shown, results = [], []
    for run in runs:
        row = next(one for one in run.player.rows if int(one["episode"]) == episode)
        bag = videos.bag_of(run.folder, run.work, episode)
        caption = f"{run.player.label}: {videos.result_text(row)}"
        shown.append(blocks.video(videos.draw_video(bag, int(row["steps"])), caption))
        results.append(outcomes.read_outcomes(bag))
    title = f"Episode {episode} of seed {videos.SEED}: {reason}"
    return blocks.section(title, f'<div class="videos">{"".join(shown)}</div>',
                          outcomes.episodes_table([run.player.label for run in runs], results))


def report(folders, work, episodes, read_metrics):
    """Returns the page that compares run folders, the highest return first.

    read_metrics: the function report.read_metrics
    """
    runs = [Run(folder, work / str(i), episodes, read_metrics)
            for i, folder in enumerate(folders)]
    label_runs(runs)
    runs.sort(key=lambda run: references.rank(run.player))
    sections = []
    by_scenario = collections.defaultdict(list)
    for run in runs:
        by_scenario[run.settings.get("scenario_hash", run.scenario)].append(run)
    for i, group in enumerate(by_scenario.values()):
        place = work / f"references_{i}"
        place.mkdir()
        players = references.play_references(group[0].folder / "scenario.yaml", place, episodes)
        own = [run.player for run in group]
        title = f"Return on the scenario {group[0].scenario}"
        sections.append(blocks.section(title, references.show_tiles(players[:1] + own +
                                                                    players[1:])))
    sections.append(curves.show([run.player.label for run in runs],
                                [run.columns for run in runs],
                                [curves.gap_note(run.player) for run in runs],
                                [*[run.player for run in runs],
                                 *(players if len(by_scenario) == 1 else ())]))
    sections.append(blocks.section("Greedy play, 95 % intervals",
                                   measure_table([run.player for run in runs])))
    devices = [(run.player.label, outcomes.summary_table(run.summary)) for run in runs]
    sections.append(blocks.section("What became of each device, all episodes", *(
        f"<h3>{blocks.escape(label)}</h3>{table}" for label, table in devices if table)))
    sections.append(blocks.section("Settings that differ", differences(runs)))
    if len(by_scenario) == 1 and videos.is_family(runs[0].folder):
        sections.append(blocks.section(
            "Episodes", "<p>There are no videos: the scenario is a family, and each episode has a "
            "ranch of its own.</p>"))
    elif len(by_scenario) == 1:
        for reason, episode in choose_episodes(runs):
            sections.append(show_episode(runs[:MOST_FILMS], reason, episode))
    else:
        sections.append(blocks.section(
            "Episodes", "<p>The runs have different scenarios, so they have no episodes in "
            "common.</p>"))
    names = " and ".join([", ".join(run.folder.name for run in runs[:-1]), runs[-1].folder.name])
    return blocks.page(f"Comparison of {names}", *sections)
