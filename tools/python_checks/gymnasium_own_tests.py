# SPDX-License-Identifier: BSD-3-Clause
"""Runs Gymnasium's own tests, from a checkout of Gymnasium, with the ids of aquafarm_gym.

    python gymnasium_own_tests.py CHECKOUT [PYTEST_OPTION …]

tests/envs/test_envs.py runs with each id. The tests in tests/vector (test_vector_env.py and
test_autoreset_mode.py) use aquafarm/Paper-v1 instead of CartPole-v1. The checkout must have the
version of the installed Gymnasium; pytest is needed.
"""
import pathlib
import re
import shutil
import sys
import tempfile

import aquafarm_gym  # noqa: F401
import gymnasium
import pytest

SPECS = '''
import aquafarm_gym
import gymnasium
from gymnasium.utils.env_checker import data_equivalence
all_testing_env_specs = [spec for name, spec in gymnasium.registry.items()
                         if name.startswith("aquafarm/")]
all_testing_initialised_envs = [gymnasium.make(spec.id, disable_env_checker=True)
                                for spec in all_testing_env_specs]


def assert_equals(one, other, where=""):
    assert data_equivalence(one, other), where
'''
WANTED = ("envs/test_envs.py", "vector/test_autoreset_mode.py", "vector/test_vector_env.py")


def main():
    checkout = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        tests = pathlib.Path(folder) / "tests"
        shutil.copytree(checkout / "tests", tests)
        (tests / "envs" / "utils.py").write_text(SPECS, "utf-8")
        for path in tests.glob("vector/*.py"):
            text = path.read_text("utf-8")
            path.write_text(re.sub(r'"CartPole-v1"', '"aquafarm/Paper-v1"',
                                   "import aquafarm_gym\n" + text
                                   if "from __future__" not in text else
                                   text.replace("from __future__ import annotations\n",
                                                "from __future__ import annotations\n"
                                                "import aquafarm_gym\n")), "utf-8")
        print(f"Gymnasium {gymnasium.__version__}, tests of {checkout}", flush=True)
        return pytest.main(["-q", "-p", "no:cacheprovider", "--rootdir", folder,
                            *sys.argv[2:], *(str(tests / name) for name in WANTED)])


if __name__ == "__main__":
    sys.exit(main())
