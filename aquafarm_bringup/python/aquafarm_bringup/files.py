# SPDX-License-Identifier: BSD-3-Clause
"""Files that are written completely or not at all."""
import contextlib
import os
import pathlib
import tempfile


@contextlib.contextmanager
def open_atomically(path, mode="w"):
    """Yields a new file in the folder of a path; it replaces the path if the block succeeds.

    Otherwise the new file is removed. Text is UTF-8.
    """
    path = pathlib.Path(path)
    handle, part = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    try:
        with open(handle, mode, encoding=None if "b" in mode else "utf-8") as file:
            yield file
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(part, 0o666 & ~mask)  # as of a file that open() creates
        os.replace(part, path)
    except BaseException:
        pathlib.Path(part).unlink(missing_ok=True)
        raise
