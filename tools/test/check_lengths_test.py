#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_lengths accepts this checkout and refuses long files and functions."""
import pathlib
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
FILLER = "  ++count;\n"


class CheckLengthsTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def check(self, **files):
        for name, text in files.items():
            (self.root / name.replace("_dot_", ".")).write_text(text, encoding="utf-8")
        return subprocess.run([TOOLS / "check_lengths", "--root", self.root], capture_output=True,
                              text=True, check=False, timeout=60)

    def assert_refused(self, *lines, **files):
        done = self.check(**files)
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        for line in lines:
            self.assertIn(line, done.stderr)
        self.assertEqual(len(lines), len(done.stderr.splitlines()), done.stderr)

    def assert_accepted(self, functions, longest, **files):
        done = self.check(**files)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn(f"{functions} functions, the longest has {longest} lines", done.stdout)

    def test_a_function_of_60_lines_passes_and_one_of_61_does_not(self):
        self.assert_accepted(1, 60, a_dot_cpp="int Run() {\n" + 58 * FILLER + "}\n")
        self.assert_refused("a.cpp:3: Run has 61 lines, expected at most 60",
                            a_dot_cpp="\n\nint Run() {\n" + 59 * FILLER + "}\n")

    def test_a_file_of_501_lines_is_refused(self):
        self.assert_refused("a.h: got 501 lines, expected at most 500",
                            a_dot_h="void Do() {}\n" + 500 * "// text\n")

    def test_methods_constructors_operators_and_tests_are_functions(self):
        body = "{\n" + 60 * FILLER + "}\n"
        self.assert_refused(
            "a.cpp:3: Farm::Farm has", "a.cpp:66: operator< has", "a.cpp:128: TEST_F has",
            a_dot_cpp="namespace a {\nclass B {};\nFarm::Farm(int count)\n    : count_{count} " +
            body + "bool operator<(B, B) " + body + "TEST_F(Sea, IsCalm) " + body + "}\n")

    def test_a_template_with_a_trailing_return_type_counts_from_its_first_line(self):
        self.assert_refused("a.h:1: Do has 63 lines",
                            a_dot_h="template <typename T>\nauto Do(T count) -> int {\n" +
                            60 * FILLER + "}\n")

    def test_braces_in_strings_comments_and_macros_are_text(self):
        self.assert_accepted(2, 5, a_dot_cpp='''// {
#define OPEN {
const char* const kText = R"(}{)";
int Run() {
  const char* text = "{";  /* { */
  const char mark = '{';
  return text[0] + mark + 1'000;
}
int Other() { return 0; }
''')

    def test_classes_and_tables_may_be_longer_than_functions(self):
        self.assert_accepted(1, 1, a_dot_h="class Long {\n" + 70 * "  int member_{};\n" +
                             "  int Get() { return 1; }\n};\nconst int kTable[] = {\n" +
                             70 * "    1,\n" + "};\n")

    def test_functions_of_python_and_bash_count_as_well(self):
        self.assert_refused("a.py:2: run has 61 lines", "b.sh:1: build has 62 lines",
                            a_dot_py="\ndef run():\n" + 60 * "    count()\n",
                            b_dot_sh="build() {\n" + 60 * "  make\n" + "}\n")

    def test_a_folder_without_functions_is_refused(self):
        self.assert_refused("found no function", notes_dot_txt="text\n")

    def test_this_checkout_passes(self):
        done = subprocess.run([TOOLS / "check_lengths"], capture_output=True, text=True,
                              check=False, timeout=60)
        self.assertEqual(0, done.returncode, done.stderr)


if __name__ == "__main__":
    unittest.main()
