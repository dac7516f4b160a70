# SPDX-License-Identifier: BSD-3-Clause
"""The marine ranch for researchers: Gymnasium and PettingZoo over farms in this process or behind
ROS services, with the same spaces and the same transitions, bit for bit.

    env = gymnasium.make("aquafarm/Farm-v0", scenario="paper")       # one ship
    envs = gymnasium.make_vec("aquafarm/Farm-v0", num_envs=1024)     # many farms of one ship
    env = aquafarm_gym.FarmParallelEnv("two_squads")                 # several ships
"""
import gymnasium

from aquafarm_gym.env import FarmEnv, FarmVectorEnv
from aquafarm_gym.farms import LocalFarms, find_scenario

__all__ = ["FarmEnv", "FarmParallelEnv", "FarmVectorEnv", "LocalFarms", "RosFarms",
           "find_scenario"]

gymnasium.register("aquafarm/Farm-v0", entry_point=FarmEnv, vector_entry_point=FarmVectorEnv)


def __getattr__(name):
    """What needs PettingZoo or rospy is imported when it is asked for."""
    if name == "FarmParallelEnv":
        from aquafarm_gym.parallel_env import FarmParallelEnv
        return FarmParallelEnv
    if name == "RosFarms":
        from aquafarm_gym.ros import RosFarms
        return RosFarms
    raise AttributeError(f"module {__name__} has no {name}")
