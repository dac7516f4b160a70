#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains one policy that plays all ships of a farm, and plays it in the PettingZoo environment.

    python3 shared_policy.py [--scenario two_squads] [--steps 2000000] [--seed 1]

Install first: pip install './aquafarm_gym[sb3,pettingzoo]'. In training, each ship of each farm is
a separate environment for MaskablePPO, as with the vector environments of SuperSuit. Unlike the
environments of SuperSuit, the farms step in C++ and provide action masks. Gupta et al. 2017 and
Terry et al. 2020 describe this method, parameter sharing.
"""
import argparse

import aquafarm_gym
import numpy as np
import torch
from aquafarm_gym.spaces import action_mask
from masked_ppo import EVALUATION_SEED, GAMMA, DecayEntropy, make_model
from stable_baselines3.common.vec_env import VecNormalize


def play(model, env, episode):
    """Plays an evaluation episode of a PettingZoo environment greedily; returns its summary."""
    env.reset()
    env.farms.reset(EVALUATION_SEED, episode)  # env.reset accepts only seeds of trainings
    every = len(env.possible_agents)
    while env.agents:
        agents = env.agents
        rows = [env.possible_agents.index(agent) for agent in agents]
        seen = env.state().reshape(every, -1)[rows]
        masks = action_mask(env.farms.buffers["legal"][0])[rows]
        actions, _ = model.predict(seen, deterministic=True, action_masks=masks)
        _, _, _, _, infos = env.step(dict(zip(agents, actions)))
    return infos[agents[0]]["summary"]


def main(scenario="two_squads", steps=2_000_000, seed=1, farms=32, episodes=20, **options):
    """Trains and evaluates; returns (mean return, success rate). options: arguments of
    make_model."""
    torch.set_num_threads(1)
    envs = VecNormalize(aquafarm_gym.FarmVecEnv(farms, scenario), norm_obs=False, gamma=GAMMA)
    model = make_model(envs, seed, **options)
    model.learn(steps, callback=DecayEntropy())
    env = aquafarm_gym.FarmParallelEnv(scenario)
    played = [play(model, env, k) for k in range(episodes)]
    mean = np.mean([one["episode_return"] for one in played])
    success = np.mean([one["success"] for one in played])
    print(f"{scenario}: {model.num_timesteps:,} steps of ships; mean return {mean:.1f}, success "
          f"{100 * success:.0f} % in {episodes} greedy episodes")
    return mean, success


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="two_squads")
    parser.add_argument("--steps", type=int, default=2_000_000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    main(given.scenario, given.steps, given.seed)
