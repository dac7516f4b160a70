# SPDX-License-Identifier: BSD-3-Clause
"""Checks with pyright --verifytypes that at least 95 % of the public symbols have known types."""
import json
import os
import pathlib
import subprocess
import sys

WANTED = 0.95

# pyright queries the python on PATH for the folders of packages.
VARIABLES = {**os.environ,
             "PATH": f"{pathlib.Path(sys.executable).parent}:{os.environ.get('PATH', '')}"}

for package in ("aquafarm_core", "aquafarm_gym"):
    done = subprocess.run([sys.executable, "-m", "pyright", "--pythonpath", sys.executable,
                           "--ignoreexternal", "--outputjson", "--verifytypes", package],
                          capture_output=True, text=True, check=False, env=VARIABLES)
    report = json.loads(done.stdout)["typeCompleteness"]
    print(f"{package}: {report['completenessScore']:.3f}")
    for symbol in report["symbols"]:
        if symbol["isExported"] and not symbol["isTypeKnown"]:
            print("  unknown:", symbol["name"])
    if report["completenessScore"] < WANTED:
        sys.exit(f"{package}: got {report['completenessScore']:.3f}, expected {WANTED}")
