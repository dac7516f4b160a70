#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains PPO with an action mask; one file to copy and change, in the style of CleanRL.

    python3 cleanrl_ppo.py [--scenario paper] [--steps 1500000] [--farms 64] [--seed 1]

Install first: pip install './aquafarm_gym[sb3]' (includes torch). The farms step together in C++
and write their features directly into the memory of a tensor. Huang et al. 2022 describe CleanRL.
"""
import argparse
import time

import aquafarm_core as core
import aquafarm_gym
import numpy as np
import torch
from aquafarm_gym.spaces import action_mask
from torch import nn

# The episodes of aquafarm_evaluate --seed 1000. Seeds of trainings are below 2**63; with them, an
# archive of storms draws the storms of the training years.
EVALUATION_SEED = 2**63 + 1000
HORIZON, EPOCHS, BATCH = 256, 2, 512
GAMMA, LAMBDA, CLIP, ENTROPY, RATE, REWARD_SCALE = 0.98, 0.95, 0.2, 0.02, 1e-3, 0.05


class Farms:
    """N farms with one ship each, with observations, masks and results as torch tensors. If an
    episode ends, the next one starts in the same step."""

    def __init__(self, scenario, count):
        self.batch = core.FarmBatch(aquafarm_gym.find_scenario(scenario), count,
                                    ["features", "rewards", "end_reasons", "legal", "is_first"])
        self.features = torch.from_numpy(self.batch.buffers["features"][:, 0])
        self.rewards = self.batch.buffers["rewards"][:, 0]
        self.end_reasons = self.batch.buffers["end_reasons"]
        self.legal = self.batch.buffers["legal"][:, 0]
        self.finished = []

    def mask(self):
        """Returns the legal actions, bool [N, 10]."""
        return torch.from_numpy(action_mask(self.legal).astype(bool))

    def step(self, actions):
        """Takes one step. Returns (rewards [N], features after the step [N, F], last [N],
        terminated [N]). last: whether the episode has ended. terminated: whether it has ended
        for another reason than the step limit."""
        self.batch.step(actions.numpy().astype(np.uint8)[:, None])
        rewards, after = torch.from_numpy(self.rewards.copy()), self.features.clone()
        last = self.end_reasons != 0
        terminated = torch.from_numpy(last & (self.end_reasons != core.STEP_LIMIT))
        if last.any():
            self.finished += self.batch.finished()
            self.batch.start_next(last)
        return rewards, after, torch.from_numpy(last), terminated


class Agent(nn.Module):
    """An actor and a critic with two hidden layers each."""

    def __init__(self, features, actions=10, hidden=128):
        super().__init__()

        def layers(outputs, gain):
            parts = []
            for width, into in ((features, hidden), (hidden, hidden)):
                parts += [orthogonal(nn.Linear(width, into), 2**0.5), nn.Tanh()]
            return nn.Sequential(*parts, orthogonal(nn.Linear(hidden, outputs), gain))

        self.actor, self.critic = layers(actions, 0.01), layers(1, 1.0)

    def choices(self, features, mask):
        """Returns the distribution over actions; illegal actions have probability 0."""
        logits = self.actor(features).masked_fill(~mask, -1e9)
        return torch.distributions.Categorical(logits=logits)

    def value(self, features):
        """Returns V(s) in units of scaled reward, [N]."""
        return self.critic(features).squeeze(-1)


def orthogonal(layer, gain):
    """Initialises a layer with orthogonal weights and biases of 0."""
    nn.init.orthogonal_(layer.weight, gain)
    nn.init.zeros_(layer.bias)
    return layer


def advantages(rewards, values, lasts, after):
    """Returns advantages by generalized advantage estimation (Schulman et al. 2016). All arrays are
    [T, N]. after: V of the state after each step, or 0 if the state is terminal. The state at the
    step limit is not terminal."""
    result, running = torch.zeros_like(rewards), 0.0
    for t in reversed(range(len(rewards))):
        delta = rewards[t] + GAMMA * after[t] - values[t]
        running = delta + GAMMA * LAMBDA * (~lasts[t]) * running
        result[t] = running
    return result


@torch.no_grad()
def collect(agent, farms):
    """Plays HORIZON steps in all farms; returns the rollout as tensors [T, N, …]."""
    rows = []
    for _ in range(HORIZON):
        features, mask = farms.features.clone(), farms.mask()
        choices = agent.choices(features, mask)
        actions = choices.sample()
        rewards, after, last, terminated = farms.step(actions)
        rows.append((features, mask, actions, choices.log_prob(actions), agent.value(features),
                     REWARD_SCALE * rewards, last, agent.value(after) * ~terminated))
    return [torch.stack(column) for column in zip(*rows)]


def update(agent, optimizer, rollout, remaining):
    """Improves the policy with the clipped objective (Schulman et al. 2017)."""
    features, masks, actions, old, values, rewards, lasts, after = rollout
    gains = advantages(rewards, values, lasts, after)
    flat = [part.flatten(0, 1) for part in (features, masks, actions, old, gains, gains + values)]
    for _ in range(EPOCHS):
        for rows in torch.randperm(len(flat[0])).split(BATCH):
            seen, mask, action, before, gain, target = (part[rows] for part in flat)
            gain = (gain - gain.mean()) / (gain.std() + 1e-8)
            choices = agent.choices(seen, mask)
            ratio = (choices.log_prob(action) - before).exp()
            loss = (-torch.min(ratio * gain, ratio.clamp(1 - CLIP, 1 + CLIP) * gain).mean()
                    + 0.5 * (agent.value(seen) - target).pow(2).mean() / 2
                    - ENTROPY * remaining * choices.entropy().mean())
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
            optimizer.step()


@torch.no_grad()
def evaluate(agent, scenario, episodes):
    """Returns (mean return, success rate) of greedy play in episodes not used for training."""
    farms, records = Farms(scenario, episodes), {}
    farms.batch.reset(EVALUATION_SEED)
    while len(records) < episodes:
        farms.step(agent.choices(farms.features, farms.mask()).probs.argmax(-1))
        for one in farms.finished:
            records.setdefault(one["farm"], one)
        farms.finished.clear()
    return (np.mean([one["episode_return"] for one in records.values()]),
            np.mean([one["success"] for one in records.values()]))


def main(scenario="paper", steps=1_500_000, farms=64, seed=1, episodes=100):
    """Trains and evaluates; returns (mean return, success rate)."""
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    envs = Farms(scenario, farms)
    envs.batch.reset(seed)
    agent = Agent(envs.features.shape[1])
    optimizer = torch.optim.Adam(agent.parameters(), lr=RATE, eps=1e-5)
    updates, began = max(1, steps // (HORIZON * farms)), time.monotonic()
    for k in range(updates):
        remaining = 1 - k / updates
        optimizer.param_groups[0]["lr"] = RATE * remaining
        update(agent, optimizer, collect(agent, envs), remaining)
        if k % 10 == 9 and envs.finished:
            last = envs.finished[-100:]
            played = (k + 1) * HORIZON * farms
            print(f"{played:>9,} steps  {played / (time.monotonic() - began):>8,.0f} steps/s  return "
                  f"{np.mean([one['episode_return'] for one in last]):8.1f}  success "
                  f"{np.mean([one['success'] for one in last]):.2f}", flush=True)
    mean, success = evaluate(agent, scenario, episodes)
    print(f"{scenario}: mean return {mean:.1f}, success {100 * success:.0f} % in {episodes} greedy "
          "episodes")
    return mean, success


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--steps", type=int, default=1_500_000)
    parser.add_argument("--farms", type=int, default=64)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    main(given.scenario, given.steps, given.farms, given.seed)
