# SPDX-License-Identifier: BSD-3-Clause
"""Lines that show how far a run of tests is: which test ended, its number of all, the time left."""
import time


class Progress:
    """Counts ended tests. Slow tests weigh by their usual time, the others by one mean of theirs."""

    USUAL_S = 4  # of a test whose time is not known

    def __init__(self, group, names, usual_s=None):
        self._group = group
        known = usual_s or {}
        self._left = {name: known.get(name, self.USUAL_S) for name in names}
        self._all_s, self._total = sum(self._left.values()), len(self._left)
        self._began = time.monotonic()

    def end(self, name):
        """Prints the line of a test that ended; a test counts once."""
        if self._left.pop(name, None) is None:
            return
        left_s = sum(self._left.values())
        ended_s = self._all_s - left_s
        left_min = (time.monotonic() - self._began) * left_s / ended_s / 60
        print(f"aquafarm: {self._group}: test {self._total - len(self._left)} of {self._total}: {name}; "
              f"about {left_min:.0f} min left", flush=True)

    def waited_for(self):
        """Returns the names of the tests that have not ended."""
        return sorted(self._left)

    def total(self):
        return self._total
