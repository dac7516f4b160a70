// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/route_table.h"

#include <limits>

#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

bool IsOnMap(const Grid<std::uint8_t>& cells, Cell cell) {
  return cell.x >= 0 && cell.y >= 0 && cell.x < cells.cols() && cell.y < cells.rows();
}

}  // namespace

void StepsByWater(const Grid<std::uint8_t>& cells, const Cell* targets, std::size_t count,
                  Grid<std::int32_t>& steps, std::vector<Cell>& queue) {
  steps.resize(cells.rows(), cells.cols());
  steps.setConstant(kUnreachable);
  queue.assign(targets, targets + count);
  for (const Cell target : queue) steps(target.y, target.x) = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Cell at = queue[head];
    const std::int32_t next = steps(at.y, at.x) + 1;
    for (const Cell by : kMoves) {
      const Cell to{at.x + by.x, at.y + by.y};
      if (!IsOnMap(cells, to) || (cells(to.y, to.x) & kBlockedBits) != 0) continue;
      std::int32_t& known = steps(to.y, to.x);
      if (known <= next) continue;
      known = next;
      queue.push_back(to);
    }
  }
}

void ComputeRoutes(const Grid<std::uint8_t>& cells, Cell target, RouteEntry* routes,
                   std::size_t stride, Grid<std::int32_t>& steps, std::vector<Cell>& queue) {
  StepsByWater(cells, &target, 1, steps, queue);
  const auto count = static_cast<std::size_t>(cells.size());
  for (std::size_t cell = 0; cell < count; ++cell) routes[cell * stride] = {};
  const auto width = static_cast<std::int32_t>(cells.cols());
  for (const Cell at : queue) {
    RouteEntry& route = routes[static_cast<std::size_t>(LinearIndex(at, width)) * stride];
    route.steps = steps(at.y, at.x);
    std::int32_t nearest = std::numeric_limits<std::int32_t>::max();
    for (const Cell by : kMoves) {
      const Cell to{at.x + by.x, at.y + by.y};
      if (!IsOnMap(cells, to) || steps(to.y, to.x) != route.steps - 1) continue;
      const std::int32_t dx = target.x - to.x;
      const std::int32_t dy = target.y - to.y;
      if (dx * dx + dy * dy >= nearest) continue;
      nearest = dx * dx + dy * dy;
      route.east = static_cast<std::int8_t>(by.x);
      route.north = static_cast<std::int8_t>(by.y);
    }
  }
}

}  // namespace aquafarm
