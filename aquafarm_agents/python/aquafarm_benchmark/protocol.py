# SPDX-License-Identifier: BSD-3-Clause
"""The learners of a benchmark with their settings, and the paper's Table 1 as printed."""
import dataclasses
import re
import typing


@dataclasses.dataclass(frozen=True)
class PrintedRow:
    """A row of Table 1 of the paper: the text of each cell as printed (CC BY, Song et al. 2023)."""
    average_return: str
    success: str
    convergence: str  # includes the rank of Eq. 16 in brackets
    stability: str
    ea: str

    def terms(self):
        """Returns the four terms of Eq. 16: return per step, success, rank and stability."""
        rank = int(re.search(r"\((\d+)\)", self.convergence).group(1))
        return (_number(self.average_return), _number(self.success), rank,
                _number(self.stability))


def _number(text):
    return float(text.split()[0].replace("−", "-"))


# Table 1 by row name. The column "Convergence Speed" has the unit timesteps in the first row only;
# the protocol (§4.2) counts episodes.
PAPER_TABLE = {
    "lstm_dqn": PrintedRow("1.67 per step", "1", "≤300 timesteps (4)", "1", "1.67"),
    "sarsa": PrintedRow("−1", "0.9", "≤700 (2)", "0.9", "0.93"),
    "q_learning": PrintedRow("−1.21", "0.7", "≤500 (3)", "0.7", "0.97"),
    "random": PrintedRow("−10", "0", "Failed (1)", "0", "−0.7"),
}


@dataclasses.dataclass(frozen=True)
class Contestant:
    """A row of the benchmark: an algorithm with its settings. exploration and options may contain
    two placeholders, which for_episodes replaces: {explored}, the fraction of the training after
    which the exploration temperature is 1, and {last_rate}, the final learning rate."""
    name: str  # name of the row and of its folder
    label: str  # for tables and figures
    colour: str
    linestyle: str = "solid"  # as in matplotlib
    algorithm: str = ""  # name for --algorithm and policy; empty: the row's name
    learns: bool = True
    exploration: str = ""  # empty: the algorithm's default
    options: typing.Tuple[str, ...] = ()
    cost: float = 1.0  # estimated duration of a run, relative to the others
    episodes: int = 0  # maximum number of evaluation episodes; 0: as many as requested
    repeats: bool = True  # False: one run, because the result does not depend on the seed
    scenario: str = ""  # empty: that of the benchmark
    paper_row: str = ""  # key of PAPER_TABLE; empty if Table 1 has no such row
    named_only: bool = False  # True: not part of --algorithms all
    command: typing.Tuple[str, ...] = ()  # program of a learner of another package; see --learner
    library: str = ""  # shared library that registers the learner; see --learner

    @property
    def algorithm_name(self):
        return self.algorithm or self.name

    def for_episodes(self, episodes):
        """Returns this row with the settings for a training of `episodes` episodes."""
        numbers = {"explored": f"{min(1.0, _EXPLORED / episodes):.6g}",
                   "last_rate": f"{_FIRST_RATE / (1.0 + _SLOWING * episodes):.6g}"}
        return dataclasses.replace(
            self, exploration=self.exploration.format(**numbers),
            options=tuple(option.format(**numbers) for option in self.options))


# A training plays its episodes one after the other, as in §4.2 of the paper. If many farms ran at
# the same time, all of the first recorded episodes would be exploration, and short episodes would
# be recorded first.
FARMS = 1

# Trainings run in parallel, one per core, so they use device=cpu. docs/decisions/settling_early.md
# gives the reasons for these numbers. For DQN and LSTM-DQN, temperature and learning rate depend on
# the number of episodes so far, not on the fraction of the training that is done: short and long
# trainings start alike.
_EXPLORED = 100  # episodes until the temperature is one unit of reward
_COOLING = "boltzmann:harmonic:20:1:{explored}"
_FIRST_RATE = 5e-4
_SLOWING = 49 / 2000  # per episode: the rate is _FIRST_RATE / (1 + _SLOWING · episode)
_NETWORK = ("device=cpu", "mask_blocked=true", "target_update_interval=25", "ema_rate=0.002",
            "buffer_size=300000", "action_gap=0.5", "repetition_penalty=10",
            f"learning_rate=harmonic:{_FIRST_RATE}:{{last_rate}}:1")
_TABLE_EXPLORATION = "epsilon_greedy:linear:1:0.01:0.5"

# Q-learning, SARSA, DQN, LSTM-DQN, PPO and planner have colours of Okabe and Ito (2008), Color
# universal design.
_RANDOM = Contestant("random", "RANDOM", "#7f7f7f", cost=0.05, options=("actions=reachable",),
                     paper_row="random")
_Q_LEARNING = Contestant("q_learning", "Q-learning", "#0072b2", cost=0.02,
                         exploration=_TABLE_EXPLORATION, options=("mask_illegal=true",),
                         paper_row="q_learning")
_SARSA = Contestant("sarsa", "SARSA", "#56b4e9", cost=0.02, exploration=_TABLE_EXPLORATION,
                    options=("mask_illegal=true",), paper_row="sarsa")
_DQN = Contestant("dqn", "DQN", "#e69f00", cost=1.0, exploration=_COOLING,
                  options=_NETWORK + ("train_interval=1",))
_LSTM_DQN = Contestant("lstm_dqn", "LSTM-DQN", "#d55e00", cost=2.5, exploration=_COOLING,
                       options=_NETWORK + ("hidden_size=64", "batch_size=64"),
                       paper_row="lstm_dqn")

# PPO learns only from its newest steps. One farm provides few of them, so each is used ten times.
_PPO = Contestant("ppo", "PPO", "#cc79a7", cost=0.15,
                  options=("rollout_size=2048", "batch_size=256", "epochs=10",
                           "learning_rate=linear:0.001:0:1"))

CONTESTANTS = (
    _RANDOM,
    Contestant("random_all", "RANDOM (all actions)", "#bcbd22", algorithm="random", cost=0.05,
               options=("actions=all",), named_only=True),
    _Q_LEARNING,
    _SARSA,
    _DQN,
    _LSTM_DQN,
    _PPO,
    Contestant("planner", "planner", "#009e73", learns=False, cost=0.5, episodes=100,
               repeats=False),
)
# Reference policies for the money losses of the other rows. They take part if the scenario has the
# key money.
REFERENCES = (
    Contestant("do_nothing", "do nothing", "#aa3377", learns=False, cost=0.05, repeats=False,
               named_only=True),
    Contestant("fetch_by_value", "fetch by value", "#8c564b", learns=False, cost=0.1,
               repeats=False, named_only=True),
)
CONTESTANTS += REFERENCES
OPTIMUM = Contestant("clairvoyant", "clairvoyant", "#000000", learns=False, cost=0.2, repeats=False)

PRINTED = ", printed"  # end of the label of a learner with the settings that the paper prints
_PRINTED_NAME = "_printed"  # end of its name
# The farm of `paper` with the plain observation: no precomputed routes, no lookahead risk.
PLAIN_SCENARIO = "paper_plain"


def _printed(one, options, cost):
    """Returns a row with the settings that the paper prints, on the scenario with the plain
    observation. Its line is dashed and has the colour of the tuned learner."""
    return dataclasses.replace(one, name=one.name + _PRINTED_NAME, algorithm=one.algorithm_name,
                               label=one.label + PRINTED, linestyle="dashed", options=options,
                               exploration="", cost=cost, scenario=PLAIN_SCENARIO)


def are_printed(learners):
    """Returns whether all learners have the settings that the paper prints; False if there are
    none."""
    return bool(learners) and all(one.name.endswith(_PRINTED_NAME) for one in learners)


def _changed(one, suffix, label, colour, changes=(), scenario=""):
    """Returns a tuned row with some options or the scenario changed, for the ablation."""
    keys = {change.split("=", 1)[0] for change in changes}
    kept = tuple(option for option in one.options if option.split("=", 1)[0] not in keys)
    return dataclasses.replace(one, name=f"{one.name}_{suffix}", algorithm=one.algorithm_name,
                               label=f"{one.label}, {label}", colour=colour, paper_row="",
                               options=kept + tuple(changes), scenario=scenario)


def _tuned(one):
    return dataclasses.replace(one, label=f"{one.label}, tuned", paper_row="")


# Settings of replay, target and optimiser as in preset=paper of DQN (docs/algorithms.md).
# Exploration and masks keep their tuned settings.
_PAPER_REPLAY = ("priority_exponent=0", "loss=mse", "max_grad_norm=0", "double_dqn=false",
                 "action_gap=0", "ema_rate=0", "reward_scale=1", "gamma=0.99",
                 "target_update_interval=250", "buffer_size=100000",
                 "learning_rate=linear:0.0005:0.00001:1")

_PAPER_CONTESTANTS = (
    dataclasses.replace(_RANDOM, scenario=PLAIN_SCENARIO),
    _printed(_Q_LEARNING, ("gamma=0.99",), cost=0.02),
    _printed(_SARSA, ("gamma=0.99",), cost=0.02),
    _printed(_DQN, ("preset=paper", "device=cpu"), cost=2.0),
    _printed(_LSTM_DQN, ("preset=paper", "device=cpu"), cost=4.0),
    _tuned(_Q_LEARNING),
    _tuned(_SARSA),
    _tuned(_DQN),
    _tuned(_LSTM_DQN),
    _changed(_DQN, "no_routes", "tuned, plain observation", "#ffbb78", scenario=PLAIN_SCENARIO),
    _changed(_DQN, "no_masks", "tuned, no masks", "#c49c94",
             ("mask_illegal=false", "mask_blocked=false")),
    _changed(_DQN, "paper_replay", "tuned, the paper's replay and optimiser", "#8c564b",
             _PAPER_REPLAY),
    _changed(_LSTM_DQN, "no_routes", "tuned, plain observation", "#ff9896",
             scenario=PLAIN_SCENARIO),
    _changed(_LSTM_DQN, "no_masks", "tuned, no masks", "#f7b6d2",
             ("mask_illegal=false", "mask_blocked=false")),
    _changed(_LSTM_DQN, "paper_replay", "tuned, the paper's replay and optimiser", "#e377c2",
             _PAPER_REPLAY),
)


@dataclasses.dataclass(frozen=True)
class Profile:
    """Size of a benchmark, and its rows."""
    runs: int
    episodes: int
    evaluation_episodes: int
    max_steps: int = 0  # 0: the scenario's step limit
    contestants: typing.Tuple[Contestant, ...] = CONTESTANTS


PROFILES = {
    "full": Profile(runs=10, episodes=2000, evaluation_episodes=1000),
    "quick": Profile(runs=2, episodes=800, evaluation_episodes=200),
    "paper": Profile(runs=10, episodes=2000, evaluation_episodes=1000, max_steps=5000,
                     contestants=_PAPER_CONTESTANTS),
}
