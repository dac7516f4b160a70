#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_layers accepts this checkout and refuses wrong includes, folders and cycles."""
import pathlib
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
TABLE = """
[core]
path = "core"
include = "farm"
[core.folders]
base = []
grid = ["base"]
[user]
path = "user"
include = "user"
[user.folders]
"." = ["core/grid"]
"""


class CheckLayersTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "layers.toml").write_text(TABLE, encoding="utf-8")
        self.write("core/include/farm/base/check.h")
        self.write("core/include/farm/grid/cell.h", "farm/base/check.h")
        self.write("core/src/grid/cell.cpp", "farm/grid/cell.h", "base/text.h")
        self.write("core/src/base/text.h")
        self.write("user/include/user/names.h", "farm/grid/cell.h")

    def write(self, path, *includes):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        lines = ["#pragma once", "#include <vector>"] + [f'#include "{name}"' for name in includes]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def check(self, *arguments):
        command = [TOOLS / "check_layers", "--root", self.root, "--table",
                   self.root / "layers.toml", *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)

    def assert_refused(self, *words):
        done = self.check()
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_a_tree_that_keeps_to_the_table_passes(self):
        done = self.check()
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("5 files, no cycle", done.stdout)

    def test_an_include_against_the_arrows_is_refused_with_its_line(self):
        self.write("core/include/farm/base/rng.h", "farm/grid/cell.h")
        self.assert_refused('core/include/farm/base/rng.h:3: includes "farm/grid/cell.h" of grid, '
                            "but base may include nothing; move the code")

    def test_a_private_header_counts_as_one_of_its_folder(self):
        self.write("core/src/grid/secret.h")
        self.write("core/src/base/text.cpp", "grid/secret.h")
        self.assert_refused('core/src/base/text.cpp:3: includes "grid/secret.h" of grid')

    def test_an_include_of_another_component_needs_an_arrow_of_its_own(self):
        self.write("user/src/main.cpp", "farm/base/check.h")
        self.assert_refused('user/src/main.cpp:3: includes "farm/base/check.h" of core/base, but '
                            ". may include core/grid")

    def test_units_that_include_each_other_are_refused(self):
        self.write("core/include/farm/grid/map.h", "farm/grid/area.h")
        self.write("core/include/farm/grid/area.h")
        self.write("core/src/grid/area.cpp", "farm/grid/area.h", "farm/grid/map.h")
        self.assert_refused("include each other", "core/src/grid/area.cpp:4",
                            "core/include/farm/grid/map.h:3")

    def test_a_folder_that_the_table_does_not_name_is_refused(self):
        self.write("core/src/storms/track.cpp")
        self.assert_refused("core/src/storms/track.cpp: folder 'storms' is not in")

    def test_a_tree_without_sources_is_refused(self):
        self.root = self.root / "empty"
        self.root.mkdir()
        (self.root / "layers.toml").write_text(TABLE, encoding="utf-8")
        self.assert_refused("found no header and no source")

    def test_this_checkout_passes(self):
        done = subprocess.run([TOOLS / "check_layers"], capture_output=True, text=True,
                              check=False, timeout=60)
        self.assertEqual(0, done.returncode, done.stderr)


if __name__ == "__main__":
    unittest.main()
