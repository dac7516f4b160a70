#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""tools/check_locks refuses a member that is used without its mutex. tools/check_workspaces checks the
sources of this project."""
import json
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
HEADERS = TOOLS.parent / "aquafarm_sim/core/include"
SOURCE = """#include "aquafarm/base/mutex.h"
class Counter {
 public:
  int Next() { %s return ++count_; }
 private:
  aquafarm::Mutex mutex_;
  int count_ AQUAFARM_GUARDED_BY(mutex_){};
};
int main() { return Counter().Next(); }
"""


def check_locks(build):
    return subprocess.run([TOOLS / "check_locks", build], capture_output=True, text=True,
                          timeout=1200, check=False)


@unittest.skipUnless(shutil.which("clang++-14") or shutil.which("clang++"), "there is no clang++")
class CheckLocksTest(unittest.TestCase):

    def check(self, lock):
        """Runs the check on one source whose function begins with `lock`."""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "counter.cpp")
            source.write_text(SOURCE % lock, encoding="utf-8")
            command = f"/usr/bin/c++ -O3 -Wall -Werror -I {HEADERS} -o counter.o -c {source}"
            pathlib.Path(folder, "compile_commands.json").write_text(
                json.dumps([{"directory": folder, "file": str(source), "command": command}]),
                encoding="utf-8")
            return check_locks(folder)

    def test_a_guarded_member_under_its_mutex_passes(self):
        done = self.check("const aquafarm::MutexLock lock(mutex_);")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual("check_locks: 1 compilations, 0 with complaints\n", done.stdout)

    def test_a_guarded_member_without_its_mutex_is_refused(self):
        done = self.check("")
        self.assertEqual(1, done.returncode)
        self.assertIn("counter.cpp:4:", done.stderr)
        self.assertIn("requires holding mutex 'mutex_'", done.stderr)

    def test_a_folder_without_compile_commands_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            done = check_locks(folder)
        self.assertEqual(2, done.returncode)
        self.assertIn(f"{folder}/compile_commands.json: ", done.stderr)
        self.assertIn("CMAKE_EXPORT_COMPILE_COMMANDS=ON", done.stderr)


if __name__ == "__main__":
    unittest.main()
