#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Steps the farms from a compiled JAX function, and trains an actor-critic with it.

    python3 jax_policy_gradient.py [--scenario paper] [--updates 300] [--farms 256]

Install first: pip install ./aquafarm_gym jax optax. A jitted lax.scan steps the farms through
jax.experimental.io_callback, with one call for each step of all farms.
"""
import argparse
import functools

import aquafarm_core as core
import aquafarm_gym
import jax
import jax.numpy as jnp
import numpy as np
import optax
from aquafarm_gym.spaces import action_mask
from jax.experimental import io_callback

HORIZON, GAMMA, LAMBDA, ENTROPY, REWARD_SCALE = 32, 0.98, 0.95, 0.02, 0.05


class Farms:
    """N farms with one ship each. `step` takes and returns JAX arrays."""

    def __init__(self, scenario, count):
        self.batch = core.FarmBatch(aquafarm_gym.find_scenario(scenario), count,
                                    ["features", "rewards", "end_reasons", "legal", "is_first"])
        buffers, width = self.batch.buffers, len(self.batch.feature_names)
        self.buffers, self.finished = buffers, []
        self.shapes = (jax.ShapeDtypeStruct((count, width), jnp.float32),
                       jax.ShapeDtypeStruct((count, 10), jnp.bool_),
                       jax.ShapeDtypeStruct((count,), jnp.float32),
                       jax.ShapeDtypeStruct((count,), jnp.bool_))

    def reset(self, seed):
        """Starts the sequence of episodes of a seed; returns (features, mask)."""
        self.batch.reset(seed)
        return self._now()[:2]

    def _now(self):
        legal = action_mask(self.buffers["legal"][:, 0]).astype(bool)
        return (self.buffers["features"][:, 0].copy(), legal, self.buffers["rewards"][:, 0].copy(),
                self.buffers["end_reasons"] != 0)

    def _step(self, actions):
        self.batch.step(np.asarray(actions, np.uint8)[:, None])
        _, _, rewards, over = self._now()
        if over.any():
            self.finished += self.batch.finished()
            self.batch.start_next(over)
        features, mask, _, _ = self._now()
        return features, mask, rewards, over

    def step(self, actions):
        """Takes one step. Returns (features, mask, rewards, over) as JAX arrays. rewards and over
        (whether the episode ended) belong to this step. features and mask belong to the next
        action: a farm whose episode ended has already started the next one."""
        return io_callback(self._step, self.shapes, actions, ordered=True)


def layers(key, sizes):
    """Returns the weights of a multilayer perceptron."""
    keys = jax.random.split(key, len(sizes) - 1)
    return [(jax.random.normal(k, (a, b)) * (2 / a)**0.5, jnp.zeros(b))
            for k, a, b in zip(keys, sizes, sizes[1:])]


def apply(weights, x):
    """Evaluates a multilayer perceptron."""
    for matrix, bias in weights[:-1]:
        x = jnp.tanh(x @ matrix + bias)
    return x @ weights[-1][0] + weights[-1][1]


def log_probs(weights, features, mask):
    """Returns the log probabilities of the actions; illegal actions have probability 0."""
    return jax.nn.log_softmax(jnp.where(mask, 0.1 * apply(weights["actor"], features), -1e9))


def value(weights, features):
    """Returns V(s) in units of scaled reward."""
    return apply(weights["critic"], features)[..., 0]


def rollout(farms, weights, features, mask, key):
    """Plays HORIZON steps; returns the last observation and the rollout [T, N, …]."""
    def one(state, step_key):
        features, mask = state
        actions = jax.random.categorical(step_key, log_probs(weights, features, mask))
        after, after_mask, rewards, over = farms.step(actions)
        return (after, after_mask), (features, mask, actions, REWARD_SCALE * rewards, over)

    return jax.lax.scan(one, (features, mask), jax.random.split(key, HORIZON))


def loss_of(weights, played, last_features):
    """Returns the loss of advantage actor-critic (A2C) with generalized advantage estimation."""
    features, masks, actions, rewards, over = played
    values = value(weights, features)
    after = jnp.concatenate([values[1:], value(weights, last_features)[None]])
    # Here a truncation at the step limit counts as a termination. cleanrl_ppo.py distinguishes
    # them.
    deltas = rewards + GAMMA * jnp.where(over, 0.0, after) - values

    def back(running, row):
        delta, ends = row
        running = delta + GAMMA * LAMBDA * jnp.where(ends, 0.0, running)
        return running, running

    gains = jax.lax.stop_gradient(
        jax.lax.scan(back, jnp.zeros(values.shape[1]), (deltas, over), reverse=True)[1])
    logs = log_probs(weights, features, masks)
    chosen = jnp.take_along_axis(logs, actions[..., None], -1)[..., 0]
    scaled = (gains - gains.mean()) / (gains.std() + 1e-8)
    entropy = -(jnp.exp(logs) * jnp.where(masks, logs, 0.0)).sum(-1).mean()
    targets = jax.lax.stop_gradient(gains + values)
    return -(chosen * scaled).mean() + 0.5 * ((values - targets)**2).mean() - ENTROPY * entropy


def main(scenario="paper", updates=300, farms=256, seed=1):
    """Trains; returns the mean returns of the first and the last 200 episodes."""
    envs = Farms(scenario, farms)
    features, mask = envs.reset(seed)
    key = jax.random.PRNGKey(seed)
    sizes = [features.shape[1], 128, 128]
    actor_key, critic_key, key = jax.random.split(key, 3)
    weights = {"actor": layers(actor_key, [*sizes, 10]), "critic": layers(critic_key, [*sizes, 1])}
    optimizer = optax.chain(optax.clip_by_global_norm(0.5), optax.adam(3e-3))
    state = optimizer.init(weights)

    @functools.partial(jax.jit)
    def update(weights, state, features, mask, key):
        (features, mask), played = rollout(envs, weights, features, mask, key)
        slopes = jax.grad(loss_of)(weights, played, features)
        changes, state = optimizer.update(slopes, state)
        return optax.apply_updates(weights, changes), state, features, mask

    for k in range(updates):
        key, step_key = jax.random.split(key)
        weights, state, features, mask = update(weights, state, features, mask, step_key)
        if k % 50 == 49 or k == updates - 1:
            jax.block_until_ready(features)
            last = [one["episode_return"] for one in envs.finished[-200:]]
            print(f"{(k + 1) * HORIZON * farms:>10,} steps  return "
                  f"{np.mean(last) if last else float('nan'):8.1f}", flush=True)
    returns = [one["episode_return"] for one in envs.finished]
    return np.mean(returns[:200]), np.mean(returns[-200:])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--updates", type=int, default=300)
    parser.add_argument("--farms", type=int, default=256)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    main(given.scenario, given.updates, given.farms, given.seed)
