# SPDX-License-Identifier: BSD-3-Clause
"""The compile commands of a build."""
import json
import pathlib
import re

ONLY_FOR_FOLDERS = " -Wno-subobject-linkage"  # an option that clang does not have
INCLUDED = re.compile(r'^#include "(.*\.cpp)"$', re.MULTILINE)


def split(entry):
    """Returns one entry for each source of a compilation. A file of CMake's unity build includes
    several sources."""
    path = pathlib.Path(entry["file"])
    if path.parent.name != "Unity":
        return [entry]
    return [dict(entry, file=source, command=entry["command"].replace(f"-c {path}", f"-c {source}"))
            for source in INCLUDED.findall(path.read_text(encoding="utf-8"))]


def read(build, by_folder=False):
    """Returns the entries of a build folder, one for each source; each has directory, command and
    file. With `by_folder`, returns one for each compilation, which may compile all sources of a
    folder together.

    Raises ValueError with one line if compile_commands.json cannot be read.
    """
    path = pathlib.Path(build) / "compile_commands.json"
    try:
        entries = [dict(entry, command=entry["command"].replace(ONLY_FOR_FOLDERS, ""))
                   for entry in json.loads(path.read_text())]
        return entries if by_folder else [one for entry in entries for one in split(entry)]
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: {error}; expected the compile commands of a build with "
                         "CMAKE_EXPORT_COMPILE_COMMANDS=ON") from None
