# SPDX-License-Identifier: BSD-3-Clause
"""N farms with S agents each, as arrays: what every environment here stands on.

A backend has the attributes name, yaml, farms, agents, state_count, feature_count, plane_count,
height, width and buffers (see aquafarm_core.FarmBatch), and the calls reset(seed, first_episode),
step(actions), finished() and close(). LocalFarms is the farm in this process;
aquafarm_gym.ros.RosFarms the one behind ROS.
"""
import pathlib

import aquafarm_core as core

ENCODINGS = ("index", "features", "planes")
ALWAYS = ("rewards", "outcomes", "legal", "in_play", "reasons", "started")


def scenario_folder():
    """Folder of the shipped scenarios: beside an installed module, else of the sources."""
    prefix = pathlib.Path(core.__file__).parent / "../../.."  # <prefix>/lib/python3/dist-packages
    installed = (prefix / "share/aquafarm_sim/scenarios").resolve()
    return installed if installed.is_dir() else pathlib.Path(core.SCENARIO_FOLDER)


def find_scenario(scenario):
    """A Scenario from itself, from a shipped one's name, or from a file's path."""
    if isinstance(scenario, core.Scenario):
        return scenario
    shipped = scenario_folder() / f"{scenario}.yaml"
    if shipped.is_file() and "/" not in str(scenario):
        return core.Scenario.load(str(shipped))
    if pathlib.Path(scenario).is_file():
        return core.Scenario.load(str(scenario))
    names = ", ".join(sorted(path.stem for path in scenario_folder().glob("*.yaml")))
    raise ValueError(f"scenario: got '{scenario}', expected a file or one of: {names}")


def check_encoding(encoding, state_count, name):
    """Refuses what is no encoding, and a table of a farm that has too many states for one."""
    if encoding not in ENCODINGS:
        raise ValueError(f"observation: got '{encoding}', expected one of: {', '.join(ENCODINGS)}")
    if encoding == "index" and state_count == 0:
        raise ValueError(f"observation: got 'index', but {name} has too many states for a table; "
                         "expected features or planes")


class LocalFarms:
    """Farms in this process."""

    def __init__(self, scenario="paper", farms=1, observation="features", hashes=False, threads=1):
        scenario = find_scenario(scenario)
        check_encoding(observation, core.FarmBatch(scenario).state_count, scenario.name)
        write = [*ALWAYS, observation] + (["hashes"] if hashes else [])
        self.batch = core.FarmBatch(scenario, farms, write, threads)
        self.buffers = self.batch.buffers
        self.name = scenario.name
        self.yaml = scenario.yaml
        self.farms, self.agents = farms, scenario.agents
        self.state_count = self.batch.state_count
        self.feature_count = len(self.batch.feature_names)
        self.plane_count = len(core.PLANES)
        self.height, self.width = scenario.height, scenario.width
        self.reset, self.step = self.batch.reset, self.batch.step
        self.finished = self.batch.finished

    def close(self):
        """Nothing is held but memory."""
