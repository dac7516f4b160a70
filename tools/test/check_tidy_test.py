#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_tidy accepts this build, refuses what .clang-tidy forbids, and chooses its sources."""
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(TOOLS))
WORKSPACE = os.environ.get("AQUAFARM_CAMPAIGNS")  # of ./aquafarm test
CLEAN = "^aquafarm_sim/core/"  # clang-tidy accepted all sources of this folder
HAS_TIDY = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")


def load():
    loader = importlib.machinery.SourceFileLoader("check_tidy", str(TOOLS / "check_tidy"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_tidy", loader))
    loader.exec_module(module)
    return module


def check_tidy(*words):
    return subprocess.run([TOOLS / "check_tidy", *words], capture_output=True, text=True,
                          timeout=3000, check=False)


def make_build(folder, files):
    """Writes sources, by path below the folder, and their compile commands."""
    entries = []
    for path, text in files.items():
        source = pathlib.Path(folder, path)
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text(text, encoding="utf-8")
        entries.append({"directory": folder, "file": str(source),
                        "command": f"/usr/bin/c++ -O3 -Wall -o x.o -c {source}"})
    pathlib.Path(folder, "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")


class ChoiceTest(unittest.TestCase):

    def setUp(self):
        self.tidy = load()

    def test_each_source_is_due_once_in_the_days_of_a_round(self):
        for path in ("aquafarm_sim/src/a.cpp", "aquafarm_viz/src/b.cpp"):
            self.assertEqual(1, sum(self.tidy.is_due(path, 40, day) for day in range(700, 740)))

    def test_a_changed_header_takes_its_source_or_one_that_includes_it(self):
        with tempfile.TemporaryDirectory() as folder:
            make_build(folder, {"aquafarm_sim/core/src/base/rng.cpp": "",
                                "aquafarm_sim/src/node/a.cpp": '#include "aquafarm/base/mutex.h"\n',
                                "aquafarm_sim/core/test/base/rng_test.cpp": ""})
            sources = self.tidy.sources_of(pathlib.Path(folder))
            self.assertEqual({"aquafarm_sim/core/src/base/rng.cpp", "aquafarm_sim/src/node/a.cpp"},
                             set(sources))
            start = "aquafarm_sim/core/include/aquafarm/base/"
            for header, expected in (("rng.h", "aquafarm_sim/core/src/base/rng.cpp"),
                                     ("mutex.h", "aquafarm_sim/src/node/a.cpp"), ("x.h", None)):
                self.assertEqual(expected, self.tidy.source_of_header(start + header, sources))


class UnityTest(unittest.TestCase):

    def test_sources_that_are_compiled_as_one_are_read_one_by_one(self):
        with tempfile.TemporaryDirectory() as folder:
            make_build(folder, {
                "aquafarm_sim/src/base/a.cpp": "", "aquafarm_sim/src/base/b.cpp": "",
                "Unity/unity_base_cxx.cxx": f'#include "{folder}/aquafarm_sim/src/base/a.cpp"\n\n'
                                            f'#include "{folder}/aquafarm_sim/src/base/b.cpp"\n'})
            path = pathlib.Path(folder, "compile_commands.json")
            path.write_text(json.dumps(json.loads(path.read_text())[2:]))
            sources = load().sources_of(pathlib.Path(folder))
            self.assertEqual(["aquafarm_sim/src/base/a.cpp", "aquafarm_sim/src/base/b.cpp"],
                             sorted(sources))
            self.assertEqual(f"/usr/bin/c++ -O3 -Wall -o x.o -c {folder}/aquafarm_sim/src/base/b.cpp",
                             sources["aquafarm_sim/src/base/b.cpp"]["command"])


@unittest.skipUnless(HAS_TIDY, "there is no clang-tidy")
class CheckTidyTest(unittest.TestCase):

    def check(self, *names):
        with tempfile.TemporaryDirectory() as folder:
            make_build(folder, {f"aquafarm_sim/src/{name}.cpp": f"class {name} {{}};\n"
                                for name in names})
            return check_tidy(folder, "--all")

    def test_clean_sources_pass(self):
        done = self.check("Ship", "Farm")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual("check_tidy: 2 of 2 sources, 0 with complaints\n", done.stdout)

    def test_a_name_of_another_style_is_refused_with_its_line(self):
        done = self.check("Ship", "farm_boat")
        self.assertEqual(1, done.returncode, done.stdout)
        self.assertIn("farm_boat.cpp:1:7: error: invalid case style for class 'farm_boat'",
                      done.stderr)
        self.assertEqual("check_tidy: 2 of 2 sources, 1 with complaints\n", done.stdout)

    def test_a_folder_without_compile_commands_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            done = check_tidy(folder)
        self.assertEqual(2, done.returncode)
        self.assertIn(f"{folder}/compile_commands.json: ", done.stderr)
        self.assertIn("CMAKE_EXPORT_COMPILE_COMMANDS=ON", done.stderr)

    def test_the_share_of_a_day_is_taken_of_matching_sources(self):
        with tempfile.TemporaryDirectory() as folder:
            make_build(folder, {f"aquafarm_{part}/src/a.cpp": "" for part in ("sim", "viz")})
            done = check_tidy(folder, "--share", "1", "--of", "aquafarm_sim/")
            self.assertEqual("check_tidy: 1 of 2 sources, 0 with complaints\n", done.stdout[-47:])
            done = check_tidy(folder, "--share", "0")
            self.assertEqual((2, "--share: got 0, expected 1 or more\n"),
                             (done.returncode, done.stderr))

    @unittest.skipUnless(WORKSPACE, "only ./aquafarm test says where its build is")
    def test_changed_sources_of_this_build_and_the_share_of_today_are_clean(self):
        done = check_tidy(pathlib.Path(WORKSPACE, "build"), "--of", CLEAN)
        self.assertEqual(0, done.returncode, done.stderr)


if __name__ == "__main__":
    unittest.main()
