// SPDX-License-Identifier: BSD-3-Clause
#include "water_distance.h"

#include "aquafarm/grid.h"

namespace aquafarm::agents {

std::vector<std::int32_t> WaterDistance(const Layout& layout, std::int32_t width,
                                        std::int32_t height, const std::vector<Cell>& sources) {
  std::vector<std::int32_t> distance(static_cast<std::size_t>(width * height), kUnreachable);
  std::vector<Cell> queue = sources;
  for (const Cell cell : sources) distance[static_cast<std::size_t>(LinearIndex(cell, width))] = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Cell at = queue[head];
    const std::int32_t next = distance[static_cast<std::size_t>(LinearIndex(at, width))] + 1;
    for (const Cell by : kMoves) {
      const Cell to{at.x + by.x, at.y + by.y};
      const bool on_map = to.x >= 0 && to.y >= 0 && to.x < width && to.y < height;
      if (!on_map || (layout.bits(to) & kBlockedBits) != 0) continue;
      std::int32_t& known = distance[static_cast<std::size_t>(LinearIndex(to, width))];
      if (known <= next) continue;
      known = next;
      queue.push_back(to);
    }
  }
  return distance;
}

}  // namespace aquafarm::agents
