# SPDX-License-Identifier: BSD-3-Clause
"""A virtual environment for tests that need packages from PyPI.

enter_venv() restarts the test program with the Python of the virtual environment that the argument
--venv FOLDER names. It creates the environment if necessary. Without access to PyPI, all cases are
skipped with a message. Without --venv, the program continues with the running Python.
"""
import importlib.util
import os
import pathlib
import subprocess
import sys
import unittest
from xml.etree import ElementTree

# The latest Stable-Baselines3 that supports Debian 12's python3-torch, and a Gymnasium for it.
WANTED = ["gymnasium==1.0.0", "pettingzoo==1.25.0", "stable-baselines3==2.4.1",
          "farama-notifications==0.0.4", "cloudpickle", "typing-extensions"]
LIMIT_S = 150


def enter_venv():
    """Restarts this program in the virtual environment. Returns "" if it already runs there, or if
    there is no --venv and the packages are installed. Else returns why the tests cannot run."""
    if "--venv" not in sys.argv:
        missing = [name for name in ("gymnasium", "pettingzoo")
                   if importlib.util.find_spec(name) is None]
        return f"no {' and no '.join(missing)} here; pip install them, or give --venv FOLDER" if (
            missing) else ""
    venv = pathlib.Path(sys.argv[sys.argv.index("--venv") + 1])
    if pathlib.Path(sys.prefix) == venv:
        return ""
    ready = venv / "ready"
    try:
        if not ready.is_file() or ready.read_text() != " ".join(WANTED):
            for command in (["/usr/bin/python3", "-m", "venv", "--clear",
                             "--system-site-packages", venv],
                            [venv / "bin/python", "-m", "pip", "install", "-q", "--no-deps",
                             "--timeout", "10", "--retries", "1", *WANTED]):
                subprocess.run(command, check=True, timeout=LIMIT_S, capture_output=True,
                               text=True)
            ready.write_text(" ".join(WANTED))
    except (subprocess.SubprocessError, OSError) as error:
        words = (getattr(error, "stderr", None) or str(error)).strip().splitlines()
        return f"no virtual environment, PyPI is out of reach? {words[-1] if words else error}"
    os.execv(venv / "bin/python", [str(venv / "bin/python"), *sys.argv])


def run_tests(name, cases, why_not):
    """Runs the cases of a test program. Uses rostest if rostest has started the program, else
    unittest."""
    results = [one.split("xml:")[1] for one in sys.argv if one.startswith("--gtest_output=xml:")]
    if not results:
        suite = unittest.defaultTestLoader.loadTestsFromTestCase(cases)
        sys.exit(not unittest.TextTestRunner(verbosity=1).run(suite).wasSuccessful())
    if why_not:
        report_skipped(name, cases, why_not, results[0])
        sys.exit(0)
    import rostest
    rostest.rosrun("aquafarm_gym", name, cases)


def report_skipped(name, cases, why_not, path):
    """Writes a result with every case skipped, because rosunit counts skipped cases as passed."""
    suite = ElementTree.Element("testsuite", name=name, failures="0", errors="0")
    for case_name in unittest.TestLoader().getTestCaseNames(cases):
        case = ElementTree.SubElement(suite, "testcase", classname=cases.__name__, name=case_name)
        ElementTree.SubElement(case, "skipped", message=why_not)
    suite.set("tests", str(len(suite)))
    pathlib.Path(path).parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(suite).write(path)
    print(f"skipped: {why_not}")
