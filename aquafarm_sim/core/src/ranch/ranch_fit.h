// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Whether the inputs of a ranch fit one another: a chart and a field of the sea that cover it.

#include <optional>
#include <string>

#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/coast.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/sea/sea_field.h"

namespace aquafarm::internal {

/// A ranch on the globe.
struct RanchArea {
  GeoFrame frame;
  std::int32_t width{};  ///< cells
  std::int32_t height{};
};

/// @throws InputError when no land of a coast lies within the ranch's latitudes and longitudes
void NeedCover(const Coast& coast, const RanchArea& ranch, const std::string& path);
/// Counts the cells of the ranch whose centre lies outside a grid in degrees; they become land.
/// @returns a warning, or "" @throws InputError when all do
std::string NeedCover(const AsciiGrid& grid, const RanchArea& ranch, const std::string& path);
/// @throws InputError when a field has no value on the ranch, with the reason
void NeedValues(const SeaField& field, const Layer& layer, const RanchArea& ranch,
                const std::string& path);
/// A warning when a field is of another time than the start of the ranch, or "".
std::string CheckTime(const SeaField& field, std::optional<std::int64_t> start,
                      const std::string& path);
/// A warning when a port was asked for outside the ranch, or "".
std::string CheckPort(GeoPoint wanted, const RanchArea& ranch);

}  // namespace aquafarm::internal
