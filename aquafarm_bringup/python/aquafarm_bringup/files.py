# SPDX-License-Identifier: BSD-3-Clause
"""Writes files either completely or not at all."""
import contextlib
import os
import pathlib
import tempfile


@contextlib.contextmanager
def open_atomically(path, mode="w"):
    """Yields a temporary file, which is renamed to `path` if the block succeeds.

    If the block fails, the temporary file is removed and a file at `path` stays unchanged. Text is
    UTF-8.
    """
    path = pathlib.Path(path)
    handle, part = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    try:
        with open(handle, mode, encoding=None if "b" in mode else "utf-8") as file:
            yield file
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(part, 0o666 & ~mask)  # the permissions that open() would give to a new file
        os.replace(part, path)
    except BaseException:
        pathlib.Path(part).unlink(missing_ok=True)
        raise
