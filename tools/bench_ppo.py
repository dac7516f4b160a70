#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the training speed of other PPO implementations. Prints the ratio of aquafarm's speed to
each of them.

usage: bench_ppo.py BENCH_OUTPUT, a file with the lines 'metric value unit' of bench_ppo

References: PPO of Stable-Baselines3, MaskablePPO of sb3_contrib, and the PPO in PyTorch of this
file. Each runs on one core and steps the farms through aquafarm_gym, with the settings of the
program bench_ppo: paper.yaml with 81 features, 256 farms x 64 steps per rollout, minibatches of
2,048, two epochs, two hidden layers of 128 units.
"""
import os
import sys
import time

import aquafarm_gym
import gymnasium
import numpy
import torch
from torch import nn

FARMS, HORIZON, BATCH, EPOCHS, HIDDEN = 256, 64, 2048, 2, 128
GAMMA, LAMBDA, CLIP, ENTROPY, RATE, NORM = 0.98, 0.95, 0.2, 0.01, 1e-3, 0.5
# Number of measured rollouts, after one rollout for warm-up.
ROLLOUTS = int(os.environ.get("AQUAFARM_BENCH_ROLLOUTS", "4"))
OURS = "ppo_training_steps"


def make_farms():
    return aquafarm_gym.FarmVectorEnv(FARMS, "paper", copy=False)


def make_sb3_farms():
    """Returns the farms as a VecEnv of Stable-Baselines3, which steps all of them in one call.

    The first step after the end of an episode only resets the farm. Here this reset counts as a
    step with reward 0. This does not slow down the references."""
    from stable_baselines3.common.vec_env import VecEnv

    class Farms(VecEnv):
        def __init__(self):
            self.farms = make_farms()
            super().__init__(FARMS, self.farms.single_observation_space,
                             gymnasium.spaces.Discrete(10))
            self.masks = None

        def reset(self):
            seen, infos = self.farms.reset(seed=1)
            self.masks = infos["action_mask"].astype(bool)
            return seen.copy()

        def step_async(self, actions):
            self.actions = actions

        def step_wait(self):
            seen, rewards, terminated, truncated, infos = self.farms.step(self.actions)
            self.masks = infos["action_mask"].astype(bool)
            return seen.copy(), 0.05 * rewards, terminated | truncated, [{}] * FARMS

        def env_method(self, name, *_args, indices=None, **_kwargs):
            assert name == "action_masks"
            return list(self.masks)

        def has_attr(self, name):
            return name == "action_masks"

        def get_attr(self, name, indices=None):
            return [getattr(self, name, None)] * FARMS

        def set_attr(self, name, value, indices=None):
            setattr(self, name, value)

        def env_is_wrapped(self, wrapper_class, indices=None):
            return [False] * FARMS

        def close(self):
            self.farms.close()

    return Farms()


def sb3_steps_per_second(algorithm):
    model = algorithm("MlpPolicy", make_sb3_farms(), n_steps=HORIZON, batch_size=BATCH,
                      n_epochs=EPOCHS, learning_rate=RATE, gamma=GAMMA, gae_lambda=LAMBDA,
                      clip_range=CLIP, ent_coef=ENTROPY, max_grad_norm=NORM, device="cpu", seed=1,
                      policy_kwargs={"net_arch": [HIDDEN, HIDDEN], "activation_fn": nn.ReLU})
    model.learn(FARMS * HORIZON)
    begin = time.perf_counter()
    model.learn(ROLLOUTS * FARMS * HORIZON, reset_num_timesteps=False)
    return ROLLOUTS * FARMS * HORIZON / (time.perf_counter() - begin)


def stable_baselines3():
    from stable_baselines3 import PPO
    return sb3_steps_per_second(PPO)


def maskable():
    from sb3_contrib import MaskablePPO
    return sb3_steps_per_second(MaskablePPO)


class ActorCritic(nn.Module):
    def __init__(self, features):
        super().__init__()
        self.trunk = nn.Sequential(nn.Linear(features, HIDDEN), nn.ReLU(),
                                   nn.Linear(HIDDEN, HIDDEN), nn.ReLU())
        self.logits, self.value = nn.Linear(HIDDEN, 10), nn.Linear(HIDDEN, 1)

    def forward(self, seen, masks):
        x = self.trunk(seen)
        logits = self.logits(x).masked_fill(~masks, -1e9)
        return logits.log_softmax(-1), self.value(x).squeeze(-1)


class TorchPpo:
    """Implements the algorithm of aquafarm's PPO with PyTorch's automatic differentiation.

    Truncated episodes are not bootstrapped, and the learning rate is constant. This hardly changes
    the speed."""

    def __init__(self):
        torch.manual_seed(1)
        self.farms = make_farms()
        self.seen, infos = self.farms.reset(seed=1)
        self.masks = torch.from_numpy(infos["action_mask"].astype(bool))
        self.network = ActorCritic(self.seen.shape[1])
        self.optimizer = torch.optim.Adam(self.network.parameters(), RATE, eps=1e-5)

    def collect(self):
        steps = []
        with torch.no_grad():
            for _ in range(HORIZON):
                seen = torch.from_numpy(self.seen.copy())
                logs, values = self.network(seen, self.masks)
                actions = torch.multinomial(logs.exp(), 1)
                masks = self.masks
                self.seen, rewards, ended, cut, infos = self.farms.step(actions[:, 0].numpy())
                self.masks = torch.from_numpy(infos["action_mask"].astype(bool))
                steps.append((seen, masks, actions, logs.gather(1, actions)[:, 0], values,
                              torch.from_numpy(0.05 * rewards), torch.from_numpy(ended | cut)))
            last = self.network(torch.from_numpy(self.seen.copy()), self.masks)[1]
        return [torch.stack(column) for column in zip(*steps)], last

    def learn(self):
        (seen, masks, actions, logs, values, rewards, over), last = self.collect()
        advantages, next_value, running = torch.zeros_like(values), last, 0.0
        for t in reversed(range(HORIZON)):
            goes_on = (~over[t]).float()
            delta = rewards[t] + GAMMA * next_value * goes_on - values[t]
            advantages[t] = running = delta + GAMMA * LAMBDA * goes_on * running
            next_value = values[t]
        flat = [x.flatten(0, 1) for x in (seen, masks, actions, logs, advantages,
                                          advantages + values)]
        for _ in range(EPOCHS):
            for rows in torch.randperm(FARMS * HORIZON).split(BATCH):
                self.update(*(x[rows] for x in flat))

    def update(self, seen, masks, actions, old_logs, advantages, targets):
        logs, values = self.network(seen, masks)
        ratio = (logs.gather(1, actions)[:, 0] - old_logs).exp()
        advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        policy = torch.min(ratio * advantages, ratio.clamp(1 - CLIP, 1 + CLIP) * advantages).mean()
        entropy = -(logs.exp() * logs).sum(-1).mean()
        loss = -policy + 0.5 * ((values - targets)**2).mean() - ENTROPY * entropy
        self.optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self.network.parameters(), NORM)
        self.optimizer.step()


def pytorch():
    ppo = TorchPpo()
    ppo.learn()
    begin = time.perf_counter()
    for _ in range(ROLLOUTS):
        ppo.learn()
    return ROLLOUTS * FARMS * HORIZON / (time.perf_counter() - begin)


REFERENCES = {"stable_baselines3_ppo": stable_baselines3, "sb3_contrib_maskable_ppo": maskable,
              "pytorch_ppo": pytorch}


def main(path):
    torch.set_num_threads(1)
    with open(path, encoding="utf-8") as lines:
        values = {words[0]: float(words[1]) for words in map(str.split, lines)
                  if len(words) == 3 and words[0] == OURS}
    if not values:
        print(f"bench_ppo: {path}: got no line '{OURS} VALUE UNIT', expected the output of the "
              f"program bench_ppo; run ./aquafarm bench ppo", file=sys.stderr)
        return 1
    for name, measure in REFERENCES.items():
        rate = measure()
        print(f"{name}_steps {rate:.6g} steps/s", flush=True)
        print(f"{OURS}_to_{name} {values[OURS] / rate:.6g} ratio", flush=True)
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(sys.argv[1]))
