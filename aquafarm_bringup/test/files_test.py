#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Files are replaced as a whole, and not at all after an error."""
import os
import pathlib
import sys
import tempfile
import unittest

import rosunit
from aquafarm_bringup.files import open_atomically


class OpenAtomicallyTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="aquafarm_files_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.path = self.folder / "page.html"

    def names(self):
        return [path.name for path in self.folder.iterdir()]

    def test_the_new_file_replaces_the_old_one_when_it_is_complete(self):
        self.path.write_text("old")
        with open_atomically(self.path) as file:
            file.write("−1 °C\n" * 10000)
            self.assertEqual("old", self.path.read_text())
        self.assertEqual("−1 °C\n" * 10000, self.path.read_text(encoding="utf-8"))
        self.assertEqual(["page.html"], self.names())

    def test_binary_files_are_written_byte_for_byte(self):
        with open_atomically(str(self.path), "wb") as file:
            file.write(b"\x89PNG\r\n\x00")
        self.assertEqual(b"\x89PNG\r\n\x00", self.path.read_bytes())

    def test_an_error_keeps_the_old_file_and_leaves_no_other(self):
        self.path.write_text("old")
        for error in (ValueError, KeyboardInterrupt):
            with self.assertRaises(error), open_atomically(self.path) as file:
                file.write("new")
                raise error
            self.assertEqual(("old", ["page.html"]), (self.path.read_text(), self.names()))

    def test_a_folder_is_not_replaced_and_no_file_is_left(self):
        self.path.mkdir()
        with self.assertRaises(IsADirectoryError), open_atomically(self.path) as file:
            file.write("new")
        self.assertEqual(["page.html"], self.names())

    def test_a_missing_folder_is_an_error(self):
        with self.assertRaises(FileNotFoundError), open_atomically(self.folder / "no" / "page"):
            self.fail("there is nothing to write to")

    def test_permissions_follow_the_umask(self):
        self.addCleanup(os.umask, os.umask(0))
        for mask, mode in ((0o022, 0o644), (0o007, 0o660), (0o077, 0o600)):
            os.umask(mask)
            with open_atomically(self.path) as file:
                file.write("new")
            self.assertEqual(mode, self.path.stat().st_mode & 0o777)


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_bringup", "files", OpenAtomicallyTest, sys.argv)
