#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/model.md maps every item of the paper, and each file it names contains its symbols."""
import pathlib
import re
import sys
import unittest

import rosunit

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/model.md"
PAPER = ROOT.parent / "shared/paper/paper.txt"

SECTIONS = ("1 2 2.1 2.2 2.3 2.4 2.5 2.6 3 3.1 3.2 3.3 3.4 3.4.1 3.4.2 3.4.3 3.4.4 4 4.1 4.1.1 4.1.2 "
            "4.2 5 6").split()
ITEMS = ([f"§{section}" for section in SECTIONS] + [f"Eq. {n}" for n in range(1, 17)] +
         [f"Fig. {n}" for n in range(1, 15)] + ["Table 1", "Algorithm 1", "Algorithm 2"])
_ITEM = re.compile(r"^- \*\*((?:§|Eq\. |Fig\. |Table |Algorithm )[\d.]+)\*\* (.*?)(?=^- |^#|^$)",
                   re.MULTILINE | re.DOTALL)
_NAMED = re.compile(r"`([\w./]+/[\w.]+)`:\s+((?:`[^`]+`(?:,\s+(?:and\s+)?)?)+)")


def read_items():
    """Returns {item of the paper: text of its line in docs/model.md}."""
    return dict(_ITEM.findall(PAGE.read_text(encoding="utf-8")))


def find_symbols(text):
    """Returns the pairs (file, symbol) that a text names as `file`: `symbol`, `symbol`."""
    return [(path, symbol) for path, symbols in _NAMED.findall(text)
            for symbol in re.findall(r"`([^`]+)`", symbols)]


def contains(source, symbol):
    """Returns whether each name in a symbol such as Farm::Step is a whole word of the source."""
    return all(re.search(rf"\b{name}\b", source) for name in re.findall(r"\w+", symbol))


@unittest.skipUnless(PAGE.exists(), f"no page at {PAGE}: the package stands alone")
class ModelMapTest(unittest.TestCase):

    def test_every_item_of_the_paper_has_a_line(self):
        self.assertEqual(sorted(ITEMS), sorted(read_items()))

    @unittest.skipUnless(PAPER.exists(), f"{PAPER} is absent")
    def test_the_list_of_items_is_the_papers(self):
        text = PAPER.read_text(encoding="utf-8")
        headings = re.findall(r"^(?:#+ |\*\*)(\d(?:\.\d)*)\.? ", text.replace("\n ", "\n"),
                              re.MULTILINE)
        self.assertEqual(sorted(SECTIONS), sorted(set(headings)))
        equations = re.findall(r"(?:\\tag\{|\\quad \(|\\tag\{)(\d+)[)}]", text)
        self.assertEqual([str(n) for n in range(1, 17)], sorted(set(equations), key=int))
        figures = re.findall(r"^\s*\*\*Figure (\d+)\.\*\*", text, re.MULTILINE)
        self.assertEqual([str(n) for n in range(1, 15)], sorted(set(figures), key=int))
        self.assertEqual({"1", "2"}, set(re.findall(r"\*?Algorithm (\d)\*?", text)))
        self.assertEqual({"1"}, set(re.findall(r"\*\*Table (\d)\.\*\*", text)))

    def test_every_item_names_a_file_and_a_symbol(self):
        for item, text in read_items().items():
            with self.subTest(item):
                self.assertTrue(find_symbols(text), f"{item} names no `file`: `symbol`")

    def test_each_named_file_contains_its_symbols(self):
        for item, text in read_items().items():
            for path, symbol in find_symbols(text):
                with self.subTest(f"{item}: {path}: {symbol}"):
                    self.assertTrue((ROOT / path).is_file(), f"{item}: there is no {path}")
                    self.assertTrue(contains((ROOT / path).read_text(encoding="utf-8"), symbol),
                                    f"{item}: {path} does not contain {symbol}")

    def test_a_symbol_that_is_elsewhere_is_found_missing(self):
        text = "`a/b.h`: `Farm::Step`, and `kMoves`. `c/d.py`: `run`."
        self.assertEqual([("a/b.h", "Farm::Step"), ("a/b.h", "kMoves"), ("c/d.py", "run")],
                         find_symbols(text))
        self.assertTrue(contains("void Farm::Step(int a)", "Farm::Step"))
        self.assertFalse(contains("void Farm::StepAll(int a)", "Farm::Step"))


if __name__ == "__main__":
    rosunit.unitrun("aquafarm_bringup", "model_map", ModelMapTest, sys.argv)
