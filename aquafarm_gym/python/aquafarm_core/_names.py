# SPDX-License-Identifier: BSD-3-Clause
"""Former names of buffers. They still work, with a warning that contains the present name."""
import warnings

NEW_NAMES = {"in_play": "active", "reasons": "end_reasons", "started": "is_first"}


def _warn(name, stacklevel):
    warnings.warn(f"buffer '{name}' is now '{NEW_NAMES[name]}'; use that name",
                  DeprecationWarning, stacklevel=stacklevel + 1)


def current(name):
    """Returns the present name of a buffer. Warns if `name` is a former name."""
    if name not in NEW_NAMES:
        return name
    _warn(name, stacklevel=2)
    return NEW_NAMES[name]


class Buffers(dict):
    """The arrays by name. A former name refers to the same array as the present name."""

    def __contains__(self, name):
        return dict.__contains__(self, name) or dict.__contains__(self, NEW_NAMES.get(name))

    def __missing__(self, name):
        if name not in self:
            raise KeyError(name)
        _warn(name, stacklevel=2)
        return self[NEW_NAMES[name]]

    def get(self, name, default=None):
        """Like dict.get. `name` may also be a former name."""
        if name in self and not dict.__contains__(self, name):
            _warn(name, stacklevel=2)
            name = NEW_NAMES[name]
        return dict.get(self, name, default)
