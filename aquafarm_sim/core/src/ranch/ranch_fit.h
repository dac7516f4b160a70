// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Checks that the inputs of a ranch fit together: its chart and its sea fields must cover it.

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

/// @throws InputError if no land of a coast is within the ranch's latitudes and longitudes
void NeedCover(const Coast& coast, const RanchArea& ranch, const std::string& path);
/// Counts the cells of the ranch whose centre is outside a grid in degrees; they become land.
/// @returns a warning, or "" @throws InputError if all cells are outside
std::string NeedCover(const AsciiGrid& grid, const RanchArea& ranch, const std::string& path);
/// @throws InputError with the reason if a field has no value on the ranch
void NeedValues(const SeaField& field, const Layer& layer, const RanchArea& ranch,
                const std::string& path);
/// Returns a warning if the time of a field differs from the start of the ranch, else "".
std::string CheckTime(const SeaField& field, std::optional<std::int64_t> start,
                      const std::string& path);
/// Returns a warning if a requested port is outside the ranch or on land, else "". Refuses such a
/// port if the request has exact ports.
/// @param shore cell of the nearest shore
std::string CheckPort(GeoPoint wanted, Cell shore, const RanchRequest& request,
                      const RanchArea& ranch, const Terrain& terrain);

}  // namespace aquafarm::internal
