// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Land and water of a ranch, from charts: GeoJSON coasts (coast.h), map_server maps (map_file.h)
/// and ASCII grids (ascii_grid.h).
///
///   share of land in a cell   0 ........ kRockShare ........ kLandShare ........ 1
///   what it becomes             water             rock               island

#include <vector>

#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Part of each cell that is land [0, 1], [H, W].
using LandShare = Grid<float>;

/// From here on a cell is an island. [decided]
inline constexpr float kLandShare = 0.4F;
/// From here on it is a rock: too little land for an island, too much to sail over. [decided]
inline constexpr float kRockShare = 0.05F;

/// What the cells of a ranch are, fit for a scenario: all water is one body.
struct Terrain {
  Grid<std::uint8_t> land;          ///< [H, W]; 1: island
  std::vector<Cell> rocks;          ///< south to north, west to east
  std::int32_t filled{};            ///< water cells made land, for no ship could come there
  std::int32_t WaterCells() const;  ///< neither island nor rock
};

/// Turns shares of land into islands and rocks. Water that the largest body of water does not
/// reach, by moves to all eight sides, becomes land.
/// @throws InputError when there is no water
Terrain ToTerrain(const LandShare& share);

/// Few blocks that cover exactly the land, as scenario files have them.
std::vector<IslandBlock> ToIslands(const Grid<std::uint8_t>& land);

/// The shore water cell nearest to a wanted one, by distance, then from the south-west: water with
/// land on one of its eight sides, not in `taken`.
/// @throws InputError when there is no land in the chart, or no such cell left
Cell NearestShore(const Terrain& terrain, Cell wanted, const std::vector<Cell>& taken);

/// Up to `count` shore cells far from one another: the one nearest to the middle first, then always
/// the farthest from those chosen. Fewer where the shore has fewer; none without land.
std::vector<Cell> SpreadPorts(const Terrain& terrain, std::int32_t count);

}  // namespace aquafarm
