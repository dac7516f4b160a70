// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <optional>

namespace aquafarm::internal {

/// Returns the offset at which the values of a classic netCDF file (CDF-1, 2 or 5) end [bytes],
/// without the padding of the last variable. The offset follows from the header. Returns infinity
/// if the file ends within its header, and nullopt if the header is invalid. Source: NetCDF classic
/// format specification.
/// @param file at its first byte
std::optional<double> EndOfClassicValues(std::istream& file);

}  // namespace aquafarm::internal
