# SPDX-License-Identifier: BSD-3-Clause
"""Gymnasium and PettingZoo environments of the marine ranch, with farms in this process or behind
ROS services. Both kinds of farms have the same spaces and bit-identical transitions.

    env = gymnasium.make("aquafarm/Paper-v1")                        # one ship
    env = gymnasium.make("aquafarm/Farm-v1", scenario="my.yaml")     # one ship on any farm
    envs = gymnasium.make_vec("aquafarm/Farm-v1", num_envs=1024)     # many farms of one ship
    env = aquafarm_gym.FarmParallelEnv("two_squads")                 # several ships
    envs = aquafarm_gym.TeamVectorEnv(1024, "two_squads")            # many farms of several ships
    plan = aquafarm_gym.plan_rescue("my.yaml", bulletin="now.json")  # orders before a storm
"""
import importlib
import importlib.util
from typing import TYPE_CHECKING, Any

from aquafarm_core import __version__ as __version__

from aquafarm_gym.env import FarmEnv as FarmEnv
from aquafarm_gym.farms import LocalFarms as LocalFarms
from aquafarm_gym.farms import find_scenario as find_scenario
from aquafarm_gym.planning import plan_rescue as plan_rescue
from aquafarm_gym.registration import register_envs as register_envs
from aquafarm_gym.vector_env import FarmVectorEnv as FarmVectorEnv
from aquafarm_gym.vector_env import TeamVectorEnv as TeamVectorEnv
from aquafarm_gym.wrappers import ActionMaskInObservation as ActionMaskInObservation
from aquafarm_gym.wrappers import VectorActionMaskInObservation as VectorActionMaskInObservation

if TYPE_CHECKING:
    from aquafarm_gym.parallel_env import FarmParallelEnv as FarmParallelEnv
    from aquafarm_gym.ros import RosFarms as RosFarms
    from aquafarm_gym.sb3 import FarmVecEnv as FarmVecEnv

# Classes that are imported on first use, because they need optional packages: the module and these
# packages, by class.
_OPTIONAL: dict[str, tuple[str, list[str]]] = {
    "FarmParallelEnv": ("parallel_env", ["pettingzoo"]),
    "FarmVecEnv": ("sb3", ["stable_baselines3"]),
    "RosFarms": ("ros", ["rospy", "aquafarm_msgs"])}

__all__ = ["ActionMaskInObservation", "FarmEnv", "FarmVectorEnv", "LocalFarms", "TeamVectorEnv",
           "VectorActionMaskInObservation", "find_scenario", "plan_rescue", "register_envs"]
__all__ += [name for name, (_, needs) in _OPTIONAL.items()
            if all(map(importlib.util.find_spec, needs))]

register_envs()


def __getattr__(name: str) -> Any:
    if name in _OPTIONAL:
        module, _ = _OPTIONAL[name]
        return getattr(importlib.import_module(f"aquafarm_gym.{module}"), name)
    raise AttributeError(f"module {__name__} has no {name}")
