// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Land and water of a ranch, from charts: GeoJSON coasts (coast.h), map_server maps (map_file.h)
/// and ASCII grids (ascii_grid.h).
///
///   share of land in a cell   0 ........ kRockShare ........ kLandShare ........ 1
///   type of the cell            water             rock               island
///
/// [decided]: our choice where the paper gives no value, see docs/model.md.

#include <vector>

#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Fraction of land of each cell [0, 1], [H, W].
using LandShare = Grid<float>;

/// Min land share of an island cell. [decided]
inline constexpr float kLandShare = 0.4F;
/// Min land share of a rock: too little land for an island, too much to sail over. [decided]
inline constexpr float kRockShare = 0.05F;

/// Cell types of a ranch for a scenario, in which all water is connected.
struct Terrain {
  Grid<std::uint8_t> land;          ///< [H, W]; 1: island
  std::vector<Cell> rocks;          ///< south to north, west to east
  std::int32_t filled{};            ///< unreachable water cells that were converted to land
  std::int32_t WaterCells() const;  ///< neither island nor rock
};

/// Converts land shares to islands and rocks. Water that is not connected to the largest body of
/// water by the eight moves becomes land.
/// @throws InputError when there is no water
Terrain ToTerrain(const LandShare& share);

/// Returns a small set of blocks that cover exactly the land, as used in scenario files.
std::vector<IslandBlock> ToIslands(const Grid<std::uint8_t>& land);

/// Returns the shore cell nearest to `wanted` that is not in `taken`. A shore cell is water with
/// land among its eight neighbours. Ties are resolved from the south-west.
/// @throws InputError when there is no land in the chart, or no such cell left
Cell NearestShore(const Terrain& terrain, Cell wanted, const std::vector<Cell>& taken);

/// Returns up to `count` shore cells that are far from one another: first the cell nearest to the
/// middle, then repeatedly the cell farthest from those chosen. Returns fewer if the shore has
/// fewer cells, and an empty list without land.
std::vector<Cell> SpreadPorts(const Terrain& terrain, std::int32_t count);

}  // namespace aquafarm
