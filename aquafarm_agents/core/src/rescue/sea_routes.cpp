// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/sea_routes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "aquafarm/grid/action.h"

namespace aquafarm::agents {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Distances from one cell to all cells, with the previous cell on each route (Dijkstra 1959).
class Distances {
 public:
  Distances(const Grid<std::uint8_t>& water, Cell from)
      : water_(water),
        length_(static_cast<std::size_t>(water.size()), kFar),
        previous_(length_.size(), kNone) {
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    length_[Index(from)] = 0.0;
    queue.push({0.0, from.y * Width() + from.x});
    while (!queue.empty()) {
      const auto [length, index] = queue.top();
      queue.pop();
      if (length > length_[static_cast<std::size_t>(index)]) continue;
      for (const Cell by : kMoves) {
        const Cell to{index % Width() + by.x, index / Width() + by.y};
        if (!IsWater(to)) continue;
        const double next = length + std::hypot(by.x, by.y);
        if (next >= length_[Index(to)]) continue;
        length_[Index(to)] = next;
        previous_[Index(to)] = index;
        queue.push({next, to.y * Width() + to.x});
      }
    }
  }

  SeaRoute To(Cell cell) const {
    SeaRoute route;
    if (length_[Index(cell)] == kFar) return route;
    for (std::int32_t at = cell.y * Width() + cell.x; at != kNone;
         at = previous_[static_cast<std::size_t>(at)]) {
      route.cells.push_back({at % Width(), at / Width()});
      route.length.push_back(length_[static_cast<std::size_t>(at)]);
    }
    std::reverse(route.cells.begin(), route.cells.end());
    std::reverse(route.length.begin(), route.length.end());
    return route;
  }

 private:
  using Entry = std::pair<double, std::int32_t>;
  std::int32_t Width() const { return static_cast<std::int32_t>(water_.cols()); }
  std::size_t Index(Cell cell) const { return static_cast<std::size_t>(cell.y * Width() + cell.x); }
  bool IsWater(Cell cell) const {
    return cell.x >= 0 && cell.y >= 0 && cell.x < Width() && cell.y < water_.rows() &&
           water_(cell.y, cell.x) != 0;
  }

  const Grid<std::uint8_t>& water_;
  std::vector<double> length_;
  std::vector<std::int32_t> previous_;
};

}  // namespace

SeaRoutes::SeaRoutes(const Grid<std::uint8_t>& water, const std::vector<Cell>& places)
    : places_(places.size()) {
  for (const Cell from : places) {
    const Distances distances(water, from);
    for (const Cell to : places) routes_.push_back(distances.To(to));
  }
}

double SeaRoutes::Length(std::size_t from, std::size_t to) const {
  const SeaRoute& route = Between(from, to);
  return route.cells.empty() ? kFar : route.length.back();
}

}  // namespace aquafarm::agents
