# SPDX-License-Identifier: BSD-3-Clause
"""Which learners a benchmark compares, with which settings, and what the paper printed."""
import dataclasses
import typing


@dataclasses.dataclass(frozen=True)
class Contestant:
    """Someone who takes part. {explored} and {settled} in its settings are shares of the training
    that _EXPLORED and _SETTLED episodes are."""
    name: str  # of the algorithm, as --algorithm and policy take it
    label: str  # for tables and figures
    colour: str
    learns: bool = True
    exploration: str = ""  # empty: the algorithm's own
    options: typing.Tuple[str, ...] = ()
    cost: float = 1.0  # of a training beside the others', until one is over
    episodes: int = 0  # of evaluation at most; 0: as many as asked for
    repeats: bool = True  # False: one run, since another seed would learn nothing else

    def for_episodes(self, episodes):
        """The same with the settings of a training of so many episodes."""
        shares = {"explored": f"{min(1.0, _EXPLORED / episodes):.6g}",
                  "settled": f"{min(1.0, _SETTLED / episodes):.6g}"}
        return dataclasses.replace(
            self, exploration=self.exploration.format(**shares),
            options=tuple(option.format(**shares) for option in self.options))


# Of a training, as §4.2 counts episodes: one after the other. With many farms at a time the first
# episodes are all of chance, and those that end soon come first.
FARMS = 1

# Trainings run side by side, a core each, hence device=cpu. Why these numbers:
# docs/decisions/settling_early.md. Networks have seen enough of chance after some thirty long
# episodes, tables after a thousand; what is left of chance is a choice among moves that are worth
# about the same: the temperature is a point of reward.
_EXPLORED = 30
_COOLING = "boltzmann:linear:20:1:{explored}"
_SETTLED = 400  # from here on a network only refines what it has learnt

CONTESTANTS = (
    Contestant("random", "RANDOM", "#7f7f7f", cost=0.05, repeats=False),
    Contestant("q_learning", "Q-learning", "#1f77b4", cost=0.02,
               exploration="epsilon_greedy:linear:1:0.01:0.5", options=("mask_illegal=true",)),
    Contestant("sarsa", "SARSA", "#17becf", cost=0.02,
               exploration="epsilon_greedy:linear:1:0.01:0.5", options=("mask_illegal=true",)),
    Contestant("dqn", "DQN", "#ff7f0e", cost=1.0, exploration=_COOLING,
               options=("device=cpu", "steps_per_update=1", "mask_blocked=true",
                        "learning_rate=linear:5e-4:3e-5:{settled}")),
    Contestant("lstm_dqn", "LSTM-DQN", "#d62728", cost=2.5, exploration=_COOLING,
               options=("device=cpu", "hidden=64", "mask_blocked=true",
                        "learning_rate=linear:5e-4:5e-5:{settled}")),
    Contestant("planner", "receding horizon", "#2ca02c", learns=False, cost=0.5, episodes=100,
               repeats=False),
)
OPTIMUM = Contestant("clairvoyant", "clairvoyant", "#000000", learns=False, cost=0.2, repeats=False)


@dataclasses.dataclass(frozen=True)
class Profile:
    """How much of it."""
    runs: int
    episodes: int
    evaluation_episodes: int


PROFILES = {
    "full": Profile(runs=10, episodes=2000, evaluation_episodes=1000),
    "quick": Profile(runs=2, episodes=800, evaluation_episodes=200),
}

# Table 1 as far as we know it; None: not known to us.
PAPER_TABLE = {
    "random": {"return_per_step": None, "success": 0.0, "stability": 0.0, "ea_paper": -0.7},
    "q_learning": {"return_per_step": None, "success": 0.7, "stability": 0.7, "ea_paper": 0.93},
    "sarsa": {"return_per_step": None, "success": 0.9, "stability": 0.9, "ea_paper": 0.97},
    "lstm_dqn": {"return_per_step": 1.67, "success": 1.0, "stability": 1.0, "ea_paper": 1.67,
                 "convergence": 300},
}
