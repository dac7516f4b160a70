#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Adds up JUnit-style results (gtest, ctest, rostest, nosetests) under the given folders.

Lists each failed case with the last lines of its report, each skipped case, and the slowest test
programs. The last line is 'N passed, N failed, N skipped'. Exits with 1 if a case failed, a file is
not readable XML, or no case passed.
catkin_test_results is not used because it ignores unreadable files and does not support ctest
results.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

LAST_LINES = 12


def outcome(case):
    """Returns 'failed', 'skipped' or 'passed' for one <testcase>."""
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("status") in ("notrun", "disabled"):
        return "skipped"
    return "passed"


def last_lines(case):
    """Returns the last lines of the report of a failed <testcase>."""
    texts = [(one.text or "").strip() or one.get("message") or ""
             for kind in ("failure", "error") for one in case.iter(kind)]
    if texts == ["Failed"] or texts == [""]:  # ctest reports the output in another element
        texts = [case.findtext("system-out") or ""]
    return [line for line in "\n".join(texts).splitlines() if line.strip()][-LAST_LINES:]


def cases_of(path, stems):
    """Returns (outcome, name, lines) of each case in a result file. `lines` is empty unless the
    case failed. An unreadable file counts as one failed case."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        return [("failed", f"no readable result ({error})", [])]
    found = [(outcome(case), f"{case.get('classname', '')}.{case.get('name', '')}", case)
             for case in root.iter("testcase")]
    # rostest reports the result of a test program in addition to the program's own results in
    # rosunit-*. A pass in rostest-* is redundant, but a failure may be recorded only there.
    if path.name.startswith("rostest-"):
        found = [entry for entry in found if entry[0] == "failed"]
    # ctest reports an executable as one case. This case counts only if the executable wrote no
    # gtest results.
    if path.name.startswith("ctest-"):
        found = [entry for entry in found if entry[2].get("name") not in stems]
    # A failure before the first case (setUpClass) appears only in the suite's counters.
    reported = int(root.get("errors") or 0) + int(root.get("failures") or 0)
    unlisted = reported - sum(entry[0] == "failed" for entry in found)
    if not path.name.startswith("ctest-"):
        found += [("failed", "outside its cases", ElementTree.Element("testcase"))] * max(0, unlisted)
    return [(result, name, last_lines(case)) for result, name, case in found]


def seconds_of(path):
    """Returns (seconds, name) of each test program in a result file."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError:
        return []
    if path.name.startswith("ctest-"):
        return [(float(case.get("time") or 0), case.get("name")) for case in root.iter("testcase")]
    if path.name.startswith("rostest-") or path.parent.parent.name == "test_results" and \
            path.parent.name.endswith("core"):
        return []  # counted by the program's own file or by ctest
    spent = sum(float(case.get("time") or 0) for case in root.iter("testcase"))
    return [(spent, f"{path.parent.name} {path.stem}")]


def show_slowest(paths):
    slowest = sorted((entry for path in paths for entry in seconds_of(path)), reverse=True)[:10]
    if slowest and slowest[0][0] >= 1:
        print("slowest: " + ", ".join(f"{name} {seconds:.0f} s" for seconds, name in slowest))


def main(folders):
    paths = sorted(p for folder in folders for p in pathlib.Path(folder).rglob("*.xml"))
    stems = {path.stem for path in paths}
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for path in paths:
        for result, name, lines in cases_of(path, stems):
            counts[result] += 1
            if result != "passed":
                print(f"{result.upper()} {name} ({path})", *lines, sep="\n    ")
    show_slowest(paths)
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
