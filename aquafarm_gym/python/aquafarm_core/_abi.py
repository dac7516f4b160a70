# SPDX-License-Identifier: BSD-3-Clause
"""Checks at import that the native module and NumPy use the same array layout.

A module built with pybind11 before 2.12 misreads the item sizes of NumPy 2. The arrays that it
makes then have strides 0, so that all entries share the memory of the first entry. No error is
raised.
"""
from typing import Any

NEXT = ("install the wheel (pip install ./aquafarm_gym), build with pybind11 >= 2.12, or use "
        "numpy < 2")
DTYPES = ("bool", "uint8", "uint16", "float32", "uint32", "uint64")


def numpy_fault(native: Any, numpy: Any) -> str:
    """Returns why this NumPy cannot be used with this native module; "" if it can be used."""
    made_with = ".".join(map(str, native.PYBIND11))
    where = "aquafarm_core: "
    if int(numpy.__version__.split(".")[0]) >= 2 and tuple(native.PYBIND11) < (2, 12):
        return (f"{where}got numpy {numpy.__version__} with a module built with pybind11 "
                f"{made_with}, expected numpy < 2; {NEXT}")
    for dtype in DTYPES:
        array = native._made_array(dtype, [2, 3])
        expected = numpy.zeros((2, 3), dtype)
        if array.strides != expected.strides or array.nbytes != expected.nbytes:
            return (f"{where}got {dtype} arrays with strides {array.strides} from numpy "
                    f"{numpy.__version__} and pybind11 {made_with}, expected {expected.strides}; "
                    f"{NEXT}")
        expected.view(numpy.uint8)[:] = 0
        native._write_last(expected, 1)
        if not expected.view(numpy.uint8).ravel()[-1] or numpy.count_nonzero(expected) != 1:
            return (f"{where}got {dtype} entries that share memory from numpy {numpy.__version__} "
                    f"and pybind11 {made_with}, expected one entry written; {NEXT}")
    return ""
