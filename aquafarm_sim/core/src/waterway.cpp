// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/waterway.h"

#include <limits>

#include "aquafarm/layout.h"

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

void ChartWaterway(const Grid<std::uint8_t>& cells, Cell target, Waterway& way,
                   std::vector<Cell>& queue) {
  StepsByWater(cells, &target, 1, way.steps, queue);
  way.move.resize(cells.rows(), cells.cols());
  way.move.setConstant(kNoMove);
  for (const Cell at : queue) {
    const std::int32_t left = way.steps(at.y, at.x);
    std::int32_t nearest = std::numeric_limits<std::int32_t>::max();
    for (std::uint8_t move = 0; move < kMoveCount; ++move) {
      const Cell to{at.x + kMoves[move].x, at.y + kMoves[move].y};
      if (!IsOnMap(cells, to) || way.steps(to.y, to.x) != left - 1) continue;
      const std::int32_t dx = target.x - to.x;
      const std::int32_t dy = target.y - to.y;
      if (dx * dx + dy * dy >= nearest) continue;
      nearest = dx * dx + dy * dy;
      way.move(at.y, at.x) = move;
    }
  }
}

}  // namespace aquafarm
