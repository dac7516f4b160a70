# SPDX-License-Identifier: BSD-3-Clause
"""Seeds and options of reset, sequences of episodes, and the summaries in infos."""
from __future__ import annotations

import operator
from collections.abc import Callable, Collection
from typing import Any

import aquafarm_core as core

# Seeds must fit into an int64 array and a C long.
SEED_LIMIT: int = 1 << 63
EPISODE_LIMIT: int = 1 << 62

REASON_CODES: dict[str, int] = {name: code for code, name in enumerate(core.REASONS)}
# Value of info["summary"] before the end of an episode: placeholders with the keys and value types
# of the summary at the end.
NO_SUMMARY: dict[str, Any] = {
    **{name: value for name, value in core.NO_EPISODE.items() if name != "farm"}, "reason": 0}


def whole_number(where: str, value: Any, limit: int, hint: str) -> int:
    """Returns `value` as int. Raises ValueError if it is not a whole number in [0, limit).
    limit: a power of two. hint: last part of the error message."""
    try:
        number = operator.index(value)
    except TypeError:
        number = -1
    if not 0 <= number < limit:
        raise ValueError(f"reset: {where}: got {value!r}, expected a whole number in [0, 2**"
                         f"{limit.bit_length() - 1}); {hint}")
    return number


def check_seed(seed: Any) -> int:
    """Returns `seed` as int. Raises ValueError if it is not a whole number in [0, 2**63)."""
    return whole_number("seed", seed, SEED_LIMIT, "pass such a number, or None to draw a seed")


def check_options(options: dict[str, Any] | None, known: Collection[str]) -> dict[str, Any]:
    """Returns the options of reset. Raises ValueError if a name is unknown or `episode` is not a
    whole number in [0, 2**62)."""
    options = {} if options is None else options
    for name in options:
        if name not in known:
            raise ValueError(f"reset: options: got '{name}', expected one of: "
                             f"{', '.join(sorted(known))}; correct the name or leave it out")
    if "episode" in options:
        whole_number("options['episode']", options["episode"], EPISODE_LIMIT,
                     "number the episodes of a seed from 0")
    return options


def summary_of(finished: dict[str, Any]) -> dict[str, Any]:
    """Converts a dict from FarmBatch.finished() to a dict with the keys of NO_SUMMARY. Converts
    the end reason to a number."""
    numbers = {name: finished[name] for name in NO_SUMMARY}
    numbers["reason"] = REASON_CODES[finished["reason"]]
    return numbers


class Episodes:
    """Position in a sequence of episodes. A seed starts a sequence; a reset without a seed
    continues it."""

    seed: int | None
    episode: int

    def __init__(self) -> None:
        self.seed, self.episode = None, 0

    def next(self, seed: Any, options: dict[str, Any], drawn_seed: Callable[[], int | None],
             by: int = 1) -> tuple[int, int]:
        """Returns the next (seed, episode). options: may contain `episode`, the number of the next
        episode. drawn_seed: called to draw a seed if there is none yet. by: number of episodes by
        which a reset without a seed advances."""
        if seed is not None:
            self.seed, self.episode = check_seed(seed), 0
        elif self.seed is None:
            self.seed, self.episode = (drawn_seed() or 0) % SEED_LIMIT, 0
        else:
            self.episode += by
        if "episode" in options:
            self.episode = operator.index(options["episode"])
        return self.seed, self.episode

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, Episodes)
                and (self.seed, self.episode) == (other.seed, other.episode))

    def __hash__(self) -> int:
        return hash(Episodes)  # independent of the position, which changes
