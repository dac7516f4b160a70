# SPDX-License-Identifier: BSD-3-Clause
"""The compile commands of a build, one for each source."""
import json
import pathlib
import re

ONLY_FOR_FOLDERS = " -Wno-subobject-linkage"  # clang does not know it
INCLUDED = re.compile(r'^#include "(.*\.cpp)"$', re.MULTILINE)


def split(entry):
    """Returns an entry for each source that a file of CMake's unity build includes."""
    path = pathlib.Path(entry["file"])
    command = entry["command"].replace(ONLY_FOR_FOLDERS, "")
    if path.parent.name != "Unity":
        return [dict(entry, command=command)]
    return [dict(entry, file=source, command=command.replace(f"-c {path}", f"-c {source}"))
            for source in INCLUDED.findall(path.read_text(encoding="utf-8"))]


def read(build):
    """Returns the entries of a build folder; each has directory, command and file.

    Raises ValueError with one line if the folder has none.
    """
    path = pathlib.Path(build) / "compile_commands.json"
    try:
        return [one for entry in json.loads(path.read_text()) for one in split(entry)]
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: {error}; expected the compile commands of a build with "
                         "CMAKE_EXPORT_COMPILE_COMMANDS=ON") from None
