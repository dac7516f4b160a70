#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the speed of a well-known reference and prints the ratio of a benchmark's figure to it.

usage: bench_reference.py taxi | numpy | sb3 | torch BENCH_OUTPUT, a file with 'metric value unit'
lines. Each reference uses one core. Only Taxi simulates an environment. The other references do
not, which makes them faster than real trainings.
"""
import sys
import time

import numpy

CHUNK = 10000
DURATION_S = 3.0
STATES, ACTIONS = 20000, 10
FEATURES, FARMS = 43, 16  # of paper.yaml, without water distances and lookahead risks


def taxi_steps_per_second():
    """Steps Gymnasium's newest Taxi with precomputed random actions; returns steps per second."""
    import gymnasium  # installed only for this reference
    newest = max(name for name in gymnasium.registry if name.startswith("Taxi-v"))
    env = gymnasium.make(newest)
    env.reset(seed=1)
    actions = numpy.random.default_rng(1).integers(0, 6, CHUNK).tolist()
    steps = 0
    start = time.perf_counter()
    while time.perf_counter() - start < DURATION_S:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        steps += CHUNK
    return steps / (time.perf_counter() - start)


def numpy_steps_per_second():
    """Runs Q-learning as a NumPy loop on precomputed states and rewards; returns training steps per
    second. The missing environment makes it faster than a real training."""
    rng = numpy.random.default_rng(1)
    table = numpy.zeros((STATES, ACTIONS), numpy.float32)
    states = rng.integers(0, STATES, CHUNK + 1).tolist()
    rewards = rng.uniform(-5, 0, CHUNK).tolist()
    explores = (rng.random(CHUNK) < 0.1).tolist()
    others = rng.integers(0, ACTIONS, CHUNK).tolist()
    steps = 0
    start = time.perf_counter()
    while time.perf_counter() - start < DURATION_S:
        for k in range(CHUNK):
            row = table[states[k]]
            action = others[k] if explores[k] else row.argmax()
            row[action] += 0.1 * (rewards[k] + 0.97 * table[states[k + 1]].max() - row[action])
        steps += CHUNK
    return steps / (time.perf_counter() - start)


def sb3_updates_per_second():
    """Trains Stable-Baselines3's DQN with the hyperparameters of bench_deep on 16 environments with
    a constant observation; returns updates per second, with four environment steps per update."""
    import gymnasium
    import torch
    from stable_baselines3 import DQN
    from stable_baselines3.common.vec_env import DummyVecEnv
    torch.set_num_threads(1)

    class Still(gymnasium.Env):
        observation_space = gymnasium.spaces.Box(-1, 1, (FEATURES,), numpy.float32)
        action_space = gymnasium.spaces.Discrete(ACTIONS)
        seen = observation_space.sample()

        def reset(self, *, seed=None, options=None):
            return self.seen, {}

        def step(self, action):
            return self.seen, -1.0, False, False, {}

    start, updates = 5000, 2000
    model = DQN("MlpPolicy", DummyVecEnv([Still] * FARMS), buffer_size=100000, batch_size=64,
                learning_starts=start, train_freq=1, gradient_steps=FARMS // 4,
                target_update_interval=1000, policy_kwargs={"net_arch": [128, 128]},
                device="cpu", seed=1)
    model.learn(start)  # only fills the replay
    begin = time.perf_counter()
    model.learn(4 * updates, reset_num_timesteps=False)
    return updates / (time.perf_counter() - begin)


def torch_updates_per_second():
    """Runs updates of a recurrent Q-network in PyTorch without an environment; returns updates per
    second. Each update has 32 sampled sequences of 16 steps after a burn-in of 8 steps, an LSTM of
    64 units between linear layers, Double DQN, Huber loss and Adam."""
    import torch
    from torch import nn
    torch.set_num_threads(1)
    torch.manual_seed(1)
    batch, sequence, burn_in, hidden = 32, 16, 8, 64

    class Network(nn.Module):
        def __init__(self):
            super().__init__()
            self.input = nn.Linear(FEATURES, hidden)
            self.lstm = nn.LSTM(hidden, hidden)
            self.second = nn.Linear(2 * hidden, 2 * hidden)
            self.head = nn.Linear(2 * hidden, ACTIONS)

        def forward(self, steps):
            with torch.no_grad():
                _, state = self.lstm(self.input(steps[:burn_in]).relu())
            seen = self.input(steps[burn_in:]).relu()
            output, _ = self.lstm(seen, state)
            return self.head(self.second(torch.cat([output, seen], -1)).relu())

    online, target = Network(), Network()
    target.load_state_dict(online.state_dict())
    optimizer = torch.optim.Adam(online.parameters(), 5e-4)
    replay = torch.rand(10000, burn_in + sequence + 1, FEATURES)
    updates = 0
    begin = time.perf_counter()
    while time.perf_counter() - begin < DURATION_S:
        steps = replay[torch.randint(len(replay), (batch,))].transpose(0, 1).contiguous()
        actions = torch.randint(ACTIONS, (sequence, batch, 1))
        values = online(steps)
        with torch.no_grad():
            best = values[1:].argmax(-1, keepdim=True)
            wanted = -1.0 + 0.97 * target(steps)[1:-1].gather(-1, best[:-1])
        loss = nn.functional.smooth_l1_loss(values[:-2].gather(-1, actions[:-1]), wanted)
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(online.parameters(), 10.0)
        optimizer.step()
        updates += 1
    return updates / (time.perf_counter() - begin)


# For each reference: its function, its name, and the metric of aquafarm to compare with it.
REFERENCES = {
    "taxi": (taxi_steps_per_second, "taxi_v3", "farm_steps_tabular"),
    "numpy": (numpy_steps_per_second, "numpy_q_learning", "q_learning_training_steps"),
    "sb3": (sb3_updates_per_second, "stable_baselines3", "dqn_updates"),
    "torch": (torch_updates_per_second, "pytorch", "lstm_dqn_updates"),
}


def main(which, path):
    measure, name, metric = REFERENCES[which]
    rate = measure()
    counted = "updates" if metric.endswith("updates") else "steps"
    print(f"{name}_{counted} {rate:.6g} {counted}/s")
    with open(path, encoding="utf-8") as lines:
        for words in map(str.split, lines):
            if len(words) == 3 and words[0] == metric:
                print(f"{metric}_to_{name} {float(words[1]) / rate:.6g} ratio")
                return 0
    print(f"bench_reference: {path} has no line '{metric} VALUE UNIT'", file=sys.stderr)
    return 1


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in REFERENCES:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(main(*sys.argv[1:]))
