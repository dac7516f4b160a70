// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Checks that the chart, the sea fields and the requested ports of a ranch match its position.

#include <optional>
#include <string>

#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/chart.h"
#include "aquafarm/charts/coast.h"
#include "aquafarm/grid/geo_frame.h"
#include "aquafarm/ranch/ranch_request.h"
#include "aquafarm/sea/sea_field.h"

namespace aquafarm::internal {

/// Position and size of a ranch on the globe.
struct RanchArea {
  GeoFrame frame;
  std::int32_t width{};  ///< cells
  std::int32_t height{};
};

/// Checks that the bounding box of a coast overlaps that of the ranch, in latitude and longitude.
/// @param path file of the coast, for messages
/// @throws InputError if the boxes do not overlap
void NeedCover(const Coast& coast, const RanchArea& ranch, const std::string& path);
/// Checks that a grid in degrees contains the centre of at least one cell of the ranch. Cells
/// outside the grid become land.
/// @returns a warning with the number of cells outside, or "" if there are none outside
/// @throws InputError if all cells are outside
std::string NeedCover(const AsciiGrid& grid, const RanchArea& ranch, const std::string& path);
/// Checks that a field has a value in at least one cell of the ranch.
/// @param layer the values of `field` on the cells
/// @param path file of the field, for messages
/// @throws InputError if all values are NaN
void NeedValues(const SeaField& field, const Layer& layer, const RanchArea& ranch,
                const std::string& path);
/// Returns a warning if the time of a field differs from the start by more than two days, else "".
/// Also returns "" if one of the times is unknown.
std::string CheckTime(const SeaField& field, std::optional<std::int64_t> start,
                      const std::string& path);
/// Checks that a requested port is in the ranch and not on land.
/// @param shore shore cell nearest to the port, for messages
/// @returns "" if the port is valid, else a warning
/// @throws InputError instead of the warning if request.exact_ports is set
std::string CheckPort(GeoPoint wanted, Cell shore, const RanchRequest& request,
                      const RanchArea& ranch, const Terrain& terrain);

}  // namespace aquafarm::internal
