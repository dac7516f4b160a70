// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shortest routes by water. A straight move has the length 1 cell, a diagonal move √2 cells.

#include <cstdint>
#include <vector>

#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm::agents {

/// A route.
struct SeaRoute {
  std::vector<Cell> cells;     ///< all cells, including both ends; empty if there is no route
  std::vector<double> length;  ///< by cell: length of the route up to this cell [cells]
};

/// Routes between given places.
class SeaRoutes {
 public:
  /// @param water [H, W] 1: ships can go there
  /// @param places cells between which the routes are computed
  SeaRoutes(const Grid<std::uint8_t>& water, const std::vector<Cell>& places);

  /// Returns the route between two places. @param from, to indices of places
  const SeaRoute& Between(std::size_t from, std::size_t to) const {
    return routes_[from * places_ + to];
  }
  /// Returns the length of a route [cells]; infinity if there is no route.
  double Length(std::size_t from, std::size_t to) const;

 private:
  std::size_t places_;            // number of places
  std::vector<SeaRoute> routes_;  // [from, to]
};

}  // namespace aquafarm::agents
