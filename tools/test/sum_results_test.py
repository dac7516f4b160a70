# SPDX-License-Identifier: BSD-3-Clause
"""tools/sum_results.py lists failed cases with the reason and counts all cases."""
import pathlib
import subprocess

PROGRAM = pathlib.Path(__file__).resolve().parent.parent / "sum_results.py"
PASSED = '<testsuite><testcase classname="farm" name="steps"/></testsuite>'
FAILED = """<testsuite failures="1"><testcase classname="bag" name="opens">
<failure type="AssertionError">Traceback
{}
AssertionError: 0 != 1</failure></testcase>
<testcase classname="bag" name="on_windows"><skipped/></testcase></testsuite>"""


def add_up(folder, **files):
    for name, text in files.items():
        (folder / f"{name}.xml").write_text(text, encoding="utf-8")
    done = subprocess.run([PROGRAM, folder], capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stdout.splitlines()


def test_the_last_line_has_the_counts(tmp_path):
    assert add_up(tmp_path, farm=PASSED) == (0, ["1 passed, 0 failed, 0 skipped"])


def test_a_failed_case_shows_the_last_lines_of_its_report(tmp_path):
    code, lines = add_up(tmp_path, farm=PASSED, bag=FAILED.format("frame\n" * 100))
    assert code == 1
    assert lines[0] == f"FAILED bag.opens ({tmp_path}/bag.xml)"
    assert lines[12:] == ["    AssertionError: 0 != 1", f"SKIPPED bag.on_windows ({tmp_path}/bag.xml)",
                          "1 passed, 1 failed, 1 skipped"]


def test_no_test_and_an_unreadable_result_are_failures(tmp_path):
    assert add_up(tmp_path)[0] == 1
    code, lines = add_up(tmp_path, farm=PASSED, bag="<testsuite>")
    assert code == 1
    assert lines[0].startswith("FAILED no readable result (")
    assert lines[-1] == "1 passed, 1 failed, 0 skipped"


def test_a_failure_before_the_first_case_counts(tmp_path):
    code, lines = add_up(tmp_path, bag='<testsuite errors="1"></testsuite>')
    assert (code, lines[-1]) == (1, "0 passed, 1 failed, 0 skipped")


def test_a_core_program_counts_once(tmp_path):
    ctest = '<testsuite><testcase classname="c" name="farm"/><testcase name="sh"/></testsuite>'
    assert add_up(tmp_path, **{"ctest-core": ctest, "farm": PASSED})[1] == [
        "2 passed, 0 failed, 0 skipped"]
