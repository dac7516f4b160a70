# SPDX-License-Identifier: BSD-3-Clause
"""The Gymnasium ids. The number after -v increases when the same seed and actions give other
observations, rewards, episode ends or infos than before. docs/python.md lists the changes."""
from __future__ import annotations

import gymnasium

# Shipped scenarios that have an id, by the name in the id. Each has one ship.
SCENARIOS: dict[str, str] = {
    "Paper": "paper", "PaperPartial": "paper_partial", "Partial": "partial", "Procedural": "procedural",
    "RedTide": "red_tide", "ZhoushanDanas2019": "zhoushan_danas_2019",
    "ZhoushanInfa2021": "zhoushan_infa_2021", "ZhoushanMitag2019": "zhoushan_mitag_2019",
    "ZhoushanStorms": "zhoushan_storms"}
VERSION: int = 1


def register_envs() -> None:
    """Registers aquafarm/Farm-v1 and one id per scenario, such as aquafarm/Paper-v1."""
    for name, scenario in {"Farm": "paper", **SCENARIOS}.items():
        gymnasium.register(f"aquafarm/{name}-v{VERSION}", entry_point="aquafarm_gym.env:FarmEnv",
                           vector_entry_point="aquafarm_gym.vector_env:FarmVectorEnv",
                           kwargs={"scenario": scenario})
