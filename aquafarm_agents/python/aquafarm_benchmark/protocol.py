# SPDX-License-Identifier: BSD-3-Clause
"""Which learners a benchmark compares, with which settings, and what the paper printed."""
import dataclasses
import typing


@dataclasses.dataclass(frozen=True)
class Contestant:
    """Who takes part. Its settings may name {explored}, the share of the training in which networks
    explore, and {last_rate}, their learning rate in the end."""
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
        numbers = {"explored": f"{min(1.0, _EXPLORED / episodes):.6g}",
                   "last_rate": f"{_FIRST_RATE / (1.0 + _SLOWING * episodes):.6g}"}
        return dataclasses.replace(
            self, exploration=self.exploration.format(**numbers),
            options=tuple(option.format(**numbers) for option in self.options))


# Of a training, as §4.2 counts episodes: one after the other. With many farms at a time the first
# episodes are all of chance, and those that end soon come first.
FARMS = 1

# Trainings run side by side, a core each, hence device=cpu. Why these numbers:
# docs/decisions/settling_early.md. Settings are by episodes, so that a shorter or longer benchmark
# has the same beginning.
_EXPLORED = 100  # episodes until the temperature is a point of reward
_COOLING = "boltzmann:harmonic:20:1:{explored}"
_FIRST_RATE = 5e-4
_SLOWING = 49 / 2000  # an episode; the rate is that of the first over 1 + this times the episodes
_NETWORK = ("device=cpu", "mask_blocked=true", "target_period=25", "average_rate=0.002",
            "replay=300000", "action_gap=0.5", "repetition_penalty=10",
            f"learning_rate=harmonic:{_FIRST_RATE}:{{last_rate}}:1")

CONTESTANTS = (
    Contestant("random", "RANDOM", "#7f7f7f", cost=0.05, repeats=False),
    Contestant("q_learning", "Q-learning", "#1f77b4", cost=0.02,
               exploration="epsilon_greedy:linear:1:0.01:0.5", options=("mask_illegal=true",)),
    Contestant("sarsa", "SARSA", "#17becf", cost=0.02,
               exploration="epsilon_greedy:linear:1:0.01:0.5", options=("mask_illegal=true",)),
    Contestant("dqn", "DQN", "#ff7f0e", cost=1.0, exploration=_COOLING,
               options=_NETWORK + ("steps_per_update=1",)),
    Contestant("lstm_dqn", "LSTM-DQN", "#d62728", cost=2.5, exploration=_COOLING,
               options=_NETWORK + ("hidden=64", "batch=64")),
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
