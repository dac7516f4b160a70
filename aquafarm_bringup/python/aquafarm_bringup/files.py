# SPDX-License-Identifier: BSD-3-Clause
"""Files that are written completely or not at all."""
import contextlib
import os
import pathlib


@contextlib.contextmanager
def open_atomically(path, mode="w"):
    """Yields a new file in the folder of a path; it replaces the path if the block succeeds.

    Otherwise the new file is removed. Text is UTF-8.
    """
    path = pathlib.Path(path)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    file = open(part, mode, encoding=None if "b" in mode else "utf-8")
    try:
        with file:
            yield file
        os.replace(part, path)
    except BaseException:
        part.unlink()
        raise
