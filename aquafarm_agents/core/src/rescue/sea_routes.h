// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shortest ways by water, in cells; a diagonal move is √2 long.

#include <cstdint>
#include <vector>

#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm::agents {

/// A way from cell to cell, both ends included.
struct SeaRoute {
  std::vector<Cell> cells;
  std::vector<double> length;  ///< by cell: from the start [cells]
};

/// Ways between given places.
class SeaRoutes {
 public:
  /// @param water [H, W], 1: passable @param places ends of the ways
  SeaRoutes(const Grid<std::uint8_t>& water, const std::vector<Cell>& places);

  /// Returns the way between two places; empty if there is none. @param from, to index of a place
  const SeaRoute& Between(std::size_t from, std::size_t to) const {
    return routes_[from * places_ + to];
  }
  /// Returns its length [cells]; infinity if there is none.
  double Length(std::size_t from, std::size_t to) const;

 private:
  std::size_t places_;
  std::vector<SeaRoute> routes_;  // [from, to]
};

}  // namespace aquafarm::agents
