// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/charts/chart.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

enum Kind : std::uint8_t { kWater, kIsland, kRock };

bool OnMap(const Grid<std::uint8_t>& grid, Cell cell) {
  return cell.x >= 0 && cell.x < grid.cols() && cell.y >= 0 && cell.y < grid.rows();
}

std::int64_t DistanceSquared(Cell a, Cell b) {
  const std::int64_t dx = a.x - b.x;
  const std::int64_t dy = a.y - b.y;
  return dx * dx + dy * dy;
}

// Sets `body` to `number` in all cells of the body of water that contains `from`. Returns how many
// cells these are.
std::int32_t Paint(const Grid<std::uint8_t>& kind, Cell from, std::int32_t number,
                   Grid<std::int32_t>& body) {
  std::vector<Cell> queue{from};
  body(from.y, from.x) = number;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const Cell move : kMoves) {
      const Cell next{queue[i].x + move.x, queue[i].y + move.y};
      if (!OnMap(kind, next) || kind(next.y, next.x) != kWater || body(next.y, next.x) != 0) {
        continue;
      }
      body(next.y, next.x) = number;
      queue.push_back(next);
    }
  }
  return static_cast<std::int32_t>(queue.size());
}

// Converts all water to land except the largest body of water. Returns the number of converted
// cells.
// @throws InputError if there is no water
std::int32_t FillEnclosed(Grid<std::uint8_t>& kind) {
  Grid<std::int32_t> body = Grid<std::int32_t>::Zero(kind.rows(), kind.cols());
  std::int32_t bodies = 0;
  std::int32_t largest = 0;
  std::int32_t largest_size = 0;
  for (std::int32_t y = 0; y < kind.rows(); ++y) {
    for (std::int32_t x = 0; x < kind.cols(); ++x) {
      if (kind(y, x) != kWater || body(y, x) != 0) continue;
      const std::int32_t size = Paint(kind, {x, y}, ++bodies, body);
      if (size <= largest_size) continue;
      largest_size = size;
      largest = bodies;
    }
  }
  if (largest == 0) throw InputError("got a chart without water, expected at least one water cell");
  std::int32_t filled = 0;
  for (Eigen::Index i = 0; i < kind.size(); ++i) {
    if (kind.data()[i] != kWater || body.data()[i] == largest) continue;
    kind.data()[i] = kIsland;
    ++filled;
  }
  return filled;
}

std::vector<Cell> Shore(const Terrain& terrain) {
  Grid<std::uint8_t> blocked = terrain.land;
  for (const Cell rock : terrain.rocks) blocked(rock.y, rock.x) = 1;
  std::vector<Cell> shore;
  for (std::int32_t y = 0; y < blocked.rows(); ++y) {
    for (std::int32_t x = 0; x < blocked.cols(); ++x) {
      const bool at_land = std::any_of(kMoves.begin(), kMoves.end(), [&](Cell move) {
        const Cell next{x + move.x, y + move.y};
        return OnMap(blocked, next) && terrain.land(next.y, next.x) != 0;
      });
      if (blocked(y, x) == 0 && at_land) shore.push_back({x, y});
    }
  }
  return shore;
}

}  // namespace

std::int32_t Terrain::WaterCells() const {
  return static_cast<std::int32_t>((land == 0).count()) - static_cast<std::int32_t>(rocks.size());
}

Terrain ToTerrain(const LandShare& share) {
  Grid<std::uint8_t> kind(share.rows(), share.cols());
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    const float land = share.data()[i];
    kind.data()[i] = land >= kLandShare ? kIsland : land >= kRockShare ? kRock : kWater;
  }
  Terrain terrain;
  terrain.filled = FillEnclosed(kind);
  terrain.land = (kind == static_cast<std::uint8_t>(kIsland)).cast<std::uint8_t>();
  for (std::int32_t y = 0; y < kind.rows(); ++y) {
    for (std::int32_t x = 0; x < kind.cols(); ++x) {
      if (kind(y, x) == kRock) terrain.rocks.push_back({x, y});
    }
  }
  return terrain;
}

std::vector<IslandBlock> ToIslands(const Grid<std::uint8_t>& land) {
  Grid<std::uint8_t> left = land;
  std::vector<IslandBlock> blocks;
  for (std::int32_t y = 0; y < left.rows(); ++y) {
    for (std::int32_t x = 0; x < left.cols(); ++x) {
      if (left(y, x) == 0) continue;
      std::int32_t width = 1;
      while (x + width < left.cols() && left(y, x + width) != 0) ++width;
      std::int32_t height = 1;
      while (y + height < left.rows() && left.block(y + height, x, 1, width).all()) ++height;
      left.block(y, x, height, width) = 0;
      blocks.push_back({{x, y}, width, height});
    }
  }
  return blocks;
}

Cell NearestShore(const Terrain& terrain, Cell wanted, const std::vector<Cell>& taken) {
  const Cell* nearest = nullptr;
  const std::vector<Cell> shore = Shore(terrain);
  for (const Cell& cell : shore) {
    if (std::find(taken.begin(), taken.end(), cell) != taken.end()) continue;
    if (nearest == nullptr || DistanceSquared(cell, wanted) < DistanceSquared(*nearest, wanted)) {
      nearest = &cell;
    }
  }
  if (nearest == nullptr) {
    throw InputError("port: got (" + std::to_string(wanted.x) + ", " + std::to_string(wanted.y) +
                     "), expected free water at a shore; the chart has none" +
                     (taken.empty() ? "" : " left"));
  }
  return *nearest;
}

std::vector<Cell> SpreadPorts(const Terrain& terrain, std::int32_t count) {
  const std::vector<Cell> shore = Shore(terrain);
  std::vector<Cell> ports;
  const Cell middle{static_cast<std::int32_t>(terrain.land.cols() / 2),
                    static_cast<std::int32_t>(terrain.land.rows() / 2)};
  if (shore.empty() || count < 1) return ports;
  ports.push_back(NearestShore(terrain, middle, {}));
  const auto to_nearest_port = [&ports](Cell cell) {
    std::int64_t nearest = DistanceSquared(cell, ports[0]);
    for (const Cell port : ports) nearest = std::min(nearest, DistanceSquared(cell, port));
    return nearest;
  };
  while (static_cast<std::int32_t>(ports.size()) < count) {
    const Cell farthest = *std::max_element(shore.begin(), shore.end(), [&](Cell a, Cell b) {
      return to_nearest_port(a) < to_nearest_port(b);
    });
    if (to_nearest_port(farthest) == 0) break;
    ports.push_back(farthest);
  }
  return ports;
}

}  // namespace aquafarm
