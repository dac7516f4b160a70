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

/// Fraction of land in each cell, [H, W], in [0, 1].
using LandShare = Grid<float>;

/// Min land share of an island cell ([decided]).
inline constexpr float kLandShare = 0.4F;
/// Min land share of a rock cell ([decided]). A rock cell has too little land for an island cell
/// and too much for ships.
inline constexpr float kRockShare = 0.05F;

/// Cell types of a ranch. All water is connected.
struct Terrain {
  Grid<std::uint8_t> land;          ///< [H, W]; 1: island
  std::vector<Cell> rocks;          ///< row by row from the south, each row from the west
  std::int32_t filled{};            ///< number of unreachable water cells that became land
  std::int32_t WaterCells() const;  ///< number of cells that are neither island nor rock
};

/// Converts land shares to islands and rocks. Only the largest body of water remains water; other
/// bodies of water become islands. A body of water is a set of water cells that the eight moves
/// connect.
/// @throws InputError if there is no water
Terrain ToTerrain(const LandShare& share);

/// Returns a small set of island blocks that together cover all land cells and no other cell.
std::vector<IslandBlock> ToIslands(const Grid<std::uint8_t>& land);

/// Returns the shore cell nearest to `wanted` that is not in `taken`. A shore cell is a water cell
/// with land among its eight neighbours. Of several nearest cells, returns the southernmost, and of
/// several southernmost the westernmost.
/// @throws InputError if no shore cell is left
Cell NearestShore(const Terrain& terrain, Cell wanted, const std::vector<Cell>& taken);

/// Returns up to `count` shore cells that are far from one another. The first is nearest to the
/// middle of the chart. Each later one is the shore cell that is farthest from its nearest chosen
/// cell. Returns fewer cells if the shore has fewer, and an empty list if there is no shore.
std::vector<Cell> SpreadPorts(const Terrain& terrain, std::int32_t count);

}  // namespace aquafarm
