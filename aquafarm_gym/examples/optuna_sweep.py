#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Searches hyperparameters of MaskablePPO with Optuna, which ends bad trials early.

    python3 optuna_sweep.py [--scenario paper] [--trials 20] [--steps 200000] [--storage FILE.db]

Install first: pip install './aquafarm_gym[sb3]' optuna. With --storage, several processes can share
one study.
"""
import argparse

import aquafarm_gym
import numpy as np
import optuna
import torch
from masked_ppo import evaluate
from sb3_contrib import MaskablePPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecNormalize


class Report(BaseCallback):
    """Reports the mean return of the last episodes to Optuna, which may end the trial."""

    def __init__(self, trial):
        super().__init__()
        self.trial, self.pruned = trial, False

    def _on_step(self):
        return not self.pruned

    def _on_rollout_end(self):
        episodes = self.model.ep_info_buffer
        if episodes:
            self.trial.report(float(np.mean([one["r"] for one in episodes])), self.num_timesteps)
            self.pruned = self.trial.should_prune()


def objective(trial, scenario, steps, farms=64):
    """Trains with the options of a trial; returns the mean return of 50 greedy episodes."""
    gamma = 1 - trial.suggest_float("one_minus_gamma", 0.005, 0.1, log=True)
    envs = VecNormalize(aquafarm_gym.FarmVecEnv(farms, scenario), norm_obs=False, gamma=gamma)
    model = MaskablePPO(
        "MlpPolicy", envs, seed=trial.number, gamma=gamma, batch_size=512,
        n_steps=trial.suggest_categorical("n_steps", [64, 128, 256]),
        n_epochs=trial.suggest_int("n_epochs", 1, 6),
        learning_rate=trial.suggest_float("learning_rate", 1e-4, 3e-3, log=True),
        ent_coef=trial.suggest_float("ent_coef", 1e-3, 0.1, log=True),
        gae_lambda=trial.suggest_float("gae_lambda", 0.8, 0.99))
    report = Report(trial)
    model.learn(steps, callback=report)
    if report.pruned:
        raise optuna.TrialPruned
    return float(evaluate(model, scenario, 50)[0])


def main(scenario="paper", trials=20, steps=200_000, storage=None, farms=64):
    """Runs the study and returns it."""
    torch.set_num_threads(1)
    study = optuna.create_study(
        study_name=f"maskable_ppo_{scenario}", direction="maximize", load_if_exists=True,
        storage=f"sqlite:///{storage}" if storage else None,
        pruner=optuna.pruners.MedianPruner(n_startup_trials=5))
    study.optimize(lambda trial: objective(trial, scenario, steps, farms), n_trials=trials)
    print(f"best return {study.best_value:.1f} with {study.best_params}")
    return study


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--scenario", default="paper")
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--steps", type=int, default=200_000)
    parser.add_argument("--storage", help="SQLite file of the study")
    given = parser.parse_args()
    main(given.scenario, given.trials, given.steps, given.storage)
