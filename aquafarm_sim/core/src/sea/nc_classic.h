// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <optional>

namespace aquafarm::internal {

/// Where the values of a netCDF file of a classic kind (CDF-1, 2 or 5) end [bytes], as its header
/// says: what fills up the last variable may be missing behind. Infinity: the file ends before its
/// header does; none: the header makes no sense. (NetCDF classic format specification)
std::optional<double> EndOfClassicValues(std::istream& file);

}  // namespace aquafarm::internal
