// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>

namespace aquafarm::python {

/// Returns the repr of a Python argument for messages, cut after 60 bytes. "…" marks the cut.
std::string Given(pybind11::handle argument);

/// Converts a whole number from Python (int, NumPy integer or any object with __index__).
/// @param where start of the error message, such as "FarmBatch: farms"
/// @param low, high smallest and largest accepted number
/// @param next end of the error message: what the user can do
/// @throws InputError "where: got -3, expected a whole number in [low, high]; next"
std::uint64_t WholeNumber(pybind11::handle argument, const std::string& where, std::uint64_t low,
                          std::uint64_t high, const std::string& next);

}  // namespace aquafarm::python
