# SPDX-License-Identifier: BSD-3-Clause
"""The headlines of the figures of §4, computed from the data of results.py. A headline begins with
the message of the figure. A second sentence states what limits it, such as ranges that overlap."""
import dataclasses
import math

import numpy as np

from aquafarm_benchmark import measures
from aquafarm_benchmark.curves import columns_of_runs, moving_means
from aquafarm_benchmark.protocol import PRINTED, are_printed
from aquafarm_benchmark.style import joined, number

REACHED = 0.9  # a learner has learnt once it reaches this fraction of the best reference
_FAILED = 0.1  # a learner does not learn the task if less of its last episodes succeed; see below
NBSP = "\N{NO-BREAK SPACE}"


def learners_of(contestants):
    """Returns the contestants except RANDOM."""
    return [one for one in contestants if not one.name.startswith("random")]


def failed_learners(contestants, runs):
    """Returns the labels of the learners that do not learn the task. These are learners with less
    than _FAILED successes in the last 50 episodes of every run, and those whose mean return of the
    last 50 episodes, in the median of the runs, is below that of RANDOM."""
    def last(one, column):
        return columns_of_runs(runs[one.name], column)[:, -measures.WINDOW:].mean(axis=1)

    learners = learners_of(contestants)
    random = [np.median(last(one, "return")) for one in contestants if one not in learners]
    return [one.label for one in learners if last(one, "success").max() < _FAILED
            or np.median(last(one, "return")) < min(random, default=-math.inf)]


def describe_failed(headline):
    """Returns the part of a note that defines which learners do not learn; "" if the headline names
    none."""
    return (f"A learner does not learn the task if less than {100 * _FAILED:.0f} % of its last "
            f"{measures.WINDOW} episodes succeed in each run, or if it ends below RANDOM."
            if "not learn the task" in headline else "")


def as_printed(text, contestants):
    """Returns a headline, which begins with "As printed" if all learners have the settings that the
    paper prints; their names then need no ", printed"."""
    if not text or not are_printed(learners_of(contestants)):
        return text
    is_name = any(text.startswith(one.label) for one in contestants)
    text = text.replace(PRINTED, "")
    return f"As printed, {text if is_name else text[0].lower() + text[1:]}"


def without_printed(contestants):
    """Returns the contestants as figures show them. If all learners have the settings that the
    paper prints, the headline states this once (as_printed): their labels do not contain PRINTED,
    and their lines are solid."""
    if not are_printed(learners_of(contestants)):
        return contestants
    return [dataclasses.replace(one, label=one.label.replace(PRINTED, ""), linestyle="solid")
            for one in contestants]


def highest(contestants, runs, ends, what, digits=0):
    """Returns the headline of a chart, such as "DQN ends with the highest return: 271.". Compares
    the last values of the lines, rounded to `digits`, without RANDOM. Learners that do not learn
    the task come first, because they are the news. A last sentence states whether the range of the
    runs of the best learner overlaps those of others."""
    learners = {one.label for one in learners_of(contestants)}
    last = sorted((end for end in ends if end.name in learners), key=lambda end: (-end.y, end.name))
    if not last:
        return what.capitalize()
    failed = failed_learners(contestants, runs)
    names = [f"{end.name} ({number(end.y, digits)})" for end in last if end.name in failed]
    said = [f"{joined(names)} {'does' if len(names) == 1 else 'do'} not learn the task "
            f"{within(contestants, runs)}."] if names else []
    learnt = [end for end in last if end.name not in failed]
    said += _best_sentences(learnt, what, digits) if learnt else []
    return as_printed(" ".join(said), contestants)


def _best_sentences(ends, what, digits):
    """Returns the sentences of `highest` about learners that learn the task. ends: in descending
    order"""
    first, value = ends[0], number(ends[0].y, digits)
    names = [end.name for end in ends if number(end.y, digits) == value]
    if len(ends) == 1:
        return [f"{first.name} ends with a {what} of {value}."]
    said = [f"{joined(names)} {'ends' if len(names) == 1 else 'end'} with the highest {what}: "
            f"{value}."]
    others = ends[len(names):]
    if others and len(names) == 1 and not math.isnan(first.low):
        near = [end.name for end in others  # a line of one run has no range
                if (end.y if math.isnan(end.high) else end.high) >= first.low]
        said.append(f"The range of its runs overlaps {'that' if len(near) == 1 else 'those'} of "
                    f"{joined(near)}." if near else
                    "Each of its runs is above all runs of the others.")
    return said


def with_range(end, digits=0):
    """Returns the value at the end of a line as text, with the range of the runs in brackets."""
    value, low, high = (number(one, digits) for one in (end.y, end.low, end.high))
    return value if math.isnan(end.low) or low == high else f"{value} ({low} to {high})"


def with_values(contestants, ends, digits=0):
    """Returns the ends of lines. Appends the last values to the names of contestants, and the range
    of the runs of learners: "DQN 271 (268 to 273)"."""
    labels = {one.label for one in contestants}
    learners = {one.label for one in learners_of(contestants)}
    values = [with_range(end, digits) if end.name in learners else number(end.y, digits)
              for end in ends]
    return [end._replace(name=f"{end.name}{NBSP}{value}") if end.name in labels else end
            for end, value in zip(ends, values)]


def target_of(references):
    """Returns the return to which the headline of Fig. 12a refers: REACHED of the best reference,
    or infinity if there is no positive reference."""
    best = max(references.values(), default=0.0)
    return REACHED * best if best > 0.0 else math.inf


def steps_until(of_one, target):
    """Returns the number of steps after which the 50-episode mean return first reaches `target`,
    for each run. Infinity if it never does."""
    found = []
    for curve in (run["curve"] for run in of_one):
        episodes, means = moving_means(curve["return"])
        reached = episodes[means >= target]
        found.append(np.cumsum(curve["steps"])[reached[0] - 1] if len(reached) else math.inf)
    return found


def steps_text(value):
    """Returns a number of steps as text: "200k", "1M"."""
    for unit, sign in ((1e6, "M"), (1e3, "k")):
        if value >= unit:
            return f"{value / unit:g}{sign}"
    return f"{value:g}"


def rounded_steps(value):
    """Returns a number of steps with two digits as text."""
    return steps_text(_two_digits(value))


def _two_digits(value):
    return float(f"{value:.2g}")


def in_some(steps):
    """Returns a text such as "in 3 of 4 runs", given the result of steps_until."""
    return f"in {np.isfinite(steps).sum()} of {len(steps)} runs"


def learning_times(contestants, runs, references):
    """Returns the headline of Fig. 12a: which learner needs the fewest steps to REACHED of the best
    reference, in the median of its runs, and how many times as many steps the others need. "" if
    there is no positive reference, or if there are no learners."""
    target = target_of(references)
    steps_of = {one.label: steps_until(runs[one.name], target) for one in learners_of(contestants)}
    if target == math.inf or not steps_of:
        return ""
    goal = f"{100 * REACHED:.0f} % of the return of the {max(references, key=references.get)}"
    found = sorted((float(np.median(steps)), name) for name, steps in steps_of.items())
    known = [(_two_digits(steps), name) for steps, name in found if steps < math.inf]
    partly = [name for steps, name in found if min(steps_of[name]) < steps == math.inf]
    late = [name for _, name in found if min(steps_of[name]) == math.inf]
    said = _fastest_sentences(known, steps_of, goal)
    said += [f"{name} reaches {goal if i == 0 and not known else 'it'} only "
             f"{in_some(steps_of[name])}." for i, name in enumerate(partly)]
    if late and not said:
        names = "No learner reaches" if len(late) > 1 else f"{late[0]} does not reach"
        said = [f"{names} {goal} {within(contestants, runs)}."]
    elif late:
        said.append(f"{joined(late)} {'does' if len(late) == 1 else 'do'} not reach it "
                    f"{within(contestants, runs)}.")
    return as_printed(" ".join(said), contestants)


def _ratio(ratio):
    """Returns a ratio above 1 as "1.02 times", "1.4 times", "3 times" or "21 times"."""
    if ratio < 1.095:
        return f"{max(ratio, 1.01):.2f} times"
    if ratio < 9.95:
        return f"{ratio:.1f}".removesuffix(".0") + " times"
    return f"{ratio:,.0f} times"


def _fastest_sentences(known, steps_of, goal):
    """Returns the sentences of learning_times about learners that reach the goal.

    known: [(median number of steps, name)] in ascending order
    steps_of: {name: numbers of steps of the runs}
    """
    if not known:
        return []
    steps = known[0][0]
    first = [name for value, name in known if value == steps]
    ratios = [(name, _ratio(value / steps)) for value, name in known[len(first):]]
    if len(steps_of) == 1:
        return [f"{first[0]} needs {steps:,.0f} time steps to {goal}."]
    said = [f"{joined(first)} {'learns' if len(first) == 1 else 'learn'} fastest: {steps:,.0f} "
            f"time steps to {goal}."]
    if ratios:
        others = [f"{name}{'' if i else ' needs'} {ratio}"
                  for i, (name, ratio) in enumerate(ratios)]
        said.append(f"{joined(others)} as many.")
    near = [name for _, name in known[len(first):] if len(first) == 1
            and len(steps_of[name]) > 1 and min(steps_of[name]) <= max(steps_of[first[0]])]
    if near:
        said.append(f"The range of its runs overlaps {'that' if len(near) == 1 else 'those'} of "
                    f"{joined(near)}.")
    return said


def within(contestants, runs):
    """Returns a text such as "within 2,000 episodes", with the length of the longest run."""
    longest = max(len(run["curve"]["return"]) for one in contestants for run in runs[one.name])
    return f"within {longest:,} episodes"


def means_so_far(of_one):
    """Returns the mean return of all episodes so far, [runs, episodes]."""
    curves = columns_of_runs(of_one, "return")
    return np.cumsum(curves, axis=1) / np.arange(1, curves.shape[1] + 1)


def recovery(of_one):
    """Returns the first episode at which the mean return so far is above 0, in the median of the
    runs. Infinity if this does not happen."""
    is_above = np.median(means_so_far(of_one), axis=0) > 0.0
    return int(np.argmax(is_above)) + 1 if is_above.any() else math.inf


def recovery_times(contestants, runs):
    """Returns the headline of Fig. 12b: the first episode at which the mean return so far is above
    0, in the median of the runs. "" if this is the first episode or does not happen."""
    found = sorted((recovery(runs[one.name]), one.label) for one in learners_of(contestants))
    known = [pair for pair in found if pair[0] < math.inf]
    never = [name for episode, name in found if episode == math.inf]
    if not known or known[0][0] == 1:
        return ""
    first = [name for episode, name in known if episode == known[0][0]]
    others = [f"{name} at {episode:,}" for episode, name in known[len(first):]]
    is_one = len(first) == 1
    said = (f"{joined(first)} {'recovers' if is_one else 'recover'}"
            f"{' first' if len(found) > len(first) else ''}: the mean return of all episodes so "
            f"far rises above 0 at episode {known[0][0]:,}")
    said += f"; {joined(others)}." if others else "."
    if never:
        said += (f" {joined(never)} {'does' if len(never) == 1 else 'do'} not rise above 0 "
                 f"{within(contestants, runs)}.")
    return as_printed(said, contestants)
