#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_language refuses listed words, and a list of allowed words that is too long."""
import pathlib
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
WORDS = """
[words]
'\\banew\\b' = "again"
'\\bshall\\b' = "must"
"""


class CheckLanguageTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("tools/words.toml", WORDS)
        self.write("farm.h", "/// Starts an episode again.\n")

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def check(self, *options):
        return subprocess.run([TOOLS / "check_language", "--root", self.root, *options],
                              capture_output=True, text=True, check=False, timeout=60)

    def test_texts_without_a_listed_word_pass(self):
        done = self.check()
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("no new word", done.stdout)

    def test_a_listed_word_is_refused_with_its_line_and_what_to_write(self):
        self.write("farm.h", "/// One.\n/// Begins Anew.\n")
        done = self.check()
        self.assertEqual(1, done.returncode)
        self.assertIn("farm.h:2: got 'Anew', expected: again", done.stderr)

    def test_names_of_tests_are_read_as_words(self):
        self.write("test/farm_test.cpp", "TEST_F(Farm,\n       StartsAnewAtItsPort) {}\n")
        self.write("test/farm_test.py", "\ndef test_it_shall_end(self):\n    pass\n")
        done = self.check()
        self.assertEqual(1, done.returncode)
        self.assertIn("test/farm_test.cpp:1: got 'Anew', expected: again", done.stderr)
        self.assertIn("test/farm_test.py:2: got 'shall', expected: must", done.stderr)

    def test_an_allowed_number_is_accepted_and_one_more_is_refused(self):
        self.write("tools/words_allowed.txt", "1 farm.h\n")
        self.write("farm.h", "/// Begins anew.\n")
        self.assertEqual(0, self.check().returncode)
        self.write("farm.h", "/// Begins anew and shall end.\n")
        done = self.check()
        self.assertEqual(1, done.returncode)
        self.assertIn("contains 2 such words, expected at most 1", done.stderr)

    def test_a_page_has_100_columns_but_tables_and_programs_may_have_more(self):
        wide = "word " * 21
        self.write("docs/page.md", f"{wide[:100]}\n| {wide} |\n```\n{wide}\n```\n[a]: {wide}\n")
        self.assertEqual(0, self.check().returncode)
        self.write("docs/page.md", f"One.\n{wide[:101]}\n")
        done = self.check()
        self.assertEqual(1, done.returncode)
        self.assertIn("docs/page.md:2: got 101 columns, expected at most 100", done.stderr)

    def test_a_number_that_is_too_high_must_be_lowered(self):
        self.write("tools/words_allowed.txt", "3 farm.h\n")
        self.write("farm.h", "/// Begins anew.\n")
        done = self.check()
        self.assertEqual(1, done.returncode)
        self.assertIn("run tools/check_language --update", done.stderr)
        self.assertEqual(0, self.check("--update").returncode)
        allowed = (self.root / "tools/words_allowed.txt").read_text(encoding="utf-8")
        self.assertIn("1 farm.h\n", allowed)

    def test_update_never_raises_a_number(self):
        self.write("tools/words_allowed.txt", "1 farm.h\n")
        self.write("farm.h", "/// Begins anew and shall end.\n")
        self.assertEqual(1, self.check("--update").returncode)

    def test_this_checkout_passes(self):
        done = subprocess.run([TOOLS / "check_language"], capture_output=True, text=True,
                              check=False, timeout=60)
        self.assertEqual(0, done.returncode, done.stderr)


if __name__ == "__main__":
    unittest.main()
