// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <string>

namespace aquafarm::python {

/// Returns a Python argument as messages quote it: the first 60 bytes of its repr.
std::string Given(pybind11::handle argument);

/// Converts a whole number from Python (int, NumPy integer or any object with __index__).
/// @param where start of the message, such as "FarmBatch: farms"
/// @param next end of the message: what the user can do
/// @throws InputError "where: got -3, expected a whole number in [low, high]; next"
std::uint64_t WholeNumber(pybind11::handle argument, const std::string& where, std::uint64_t low,
                          std::uint64_t high, const std::string& next);

}  // namespace aquafarm::python
