# SPDX-License-Identifier: BSD-3-Clause
"""The marks of the tools' tests."""


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes seconds; ./aquafarm test --fast leaves it out")
