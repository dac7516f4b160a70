// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/layout.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "aquafarm/base/check.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

constexpr std::uint32_t kMaxTries = 100;
// Ports, devices and rocks have separate random streams, so that the draws of one part do not
// affect those of another.
enum Part : std::uint32_t { kPortPart, kDevicePart, kRockPart, kPartCount };
static_assert(kMaxTries * kPartCount < (1U << 24U), "RandomStream streams");

constexpr const char* kIslandsKey = "layout.islands";
constexpr const char* kRocksKey = "layout.rocks.count";
constexpr const char* kRockCellsKey = "layout.rocks.cells";
constexpr const char* kPortsKey = "layout.ports.count";
constexpr const char* kDevicesKey = "layout.devices.count";
constexpr std::int32_t kLongestRow = 8;  // max devices in a row, unless the map has too few rows

// Returns the value of Layout::obstacle for a crash reward.
std::uint8_t ObstacleLevel(float reward) {
  return static_cast<std::uint8_t>(255.0F * std::min(1.0F, -reward / 20.0F) + 0.5F);
}

// Returns the smallest n with n * n >= value.
std::int32_t CeilSqrt(std::int64_t value) {
  std::int32_t root = 0;
  while (static_cast<std::int64_t>(root) * root < value) ++root;
  return root;
}

std::int32_t CeilDiv(std::int32_t a, std::int32_t b) { return (a + b - 1) / b; }

// Divides a side into `parts` equal parts. Returns the middle of part i plus a random offset of up
// to a quarter of a part in either direction.
std::int32_t NearMiddle(RandomStream& rng, std::int32_t i, std::int32_t parts, std::int32_t side) {
  const std::int32_t middle = (2 * i + 1) * side / (2 * parts);
  const std::int32_t slack = side / (4 * parts);
  const auto off = static_cast<std::int32_t>(rng.Below(static_cast<std::uint32_t>(2 * slack + 1)));
  return std::min(side - 1, std::max(0, middle - slack + off));
}

}  // namespace

LayoutGenerator::LayoutGenerator(const Scenario& scenario) : scenario_(scenario) {
  const auto cells = static_cast<std::size_t>(scenario.CellCount());
  candidates_.reserve(cells);
  queue_.resize(cells);
  reached_.resize(static_cast<std::size_t>((scenario.width + 2) * (scenario.height + 2)));
}

void LayoutGenerator::Generate(std::uint64_t seed, std::uint64_t episode, Layout& layout) {
  if (scenario_.layout == LayoutMode::kFixed) {
    seed = scenario_.layout_seed;
    episode = 0;
  }
  Reserve(layout);
  for (std::uint32_t attempt = 0; attempt < kMaxTries; ++attempt) {
    if (!TryPlace(seed, episode, attempt, layout)) continue;
    if (scenario_.view.NeedsRoutes()) ChartAllWays(layout);
    return;
  }
  throw InputError(std::string(crowded_) + ": too crowded: no layout of " +
                   std::to_string(scenario_.width) + " x " + std::to_string(scenario_.height) +
                   " cells with every device and port connected by water in " +
                   std::to_string(kMaxTries) + " tries (seed " + std::to_string(seed) +
                   ", episode " + std::to_string(episode) +
                   "); use fewer objects or a larger grid");
}

bool LayoutGenerator::TryPlace(std::uint64_t seed, std::uint64_t episode, std::uint32_t attempt,
                               Layout& layout) {
  layout.cells.setZero();
  layout.crash_reward.setZero();
  layout.obstacle.setZero();
  layout.ports.clear();
  layout.rocks.clear();
  layout.devices.clear();
  const auto stream = [&](Part part) {
    return RandomStream({seed, episode, RngStream::kLayout, attempt * kPartCount + part});
  };
  RandomStream ports = stream(kPortPart);
  RandomStream devices = stream(kDevicePart);
  RandomStream rocks = stream(kRockPart);
  PlaceIslands(layout);
  PlaceExplicit(layout);
  if (!DrawPorts(ports, layout) || !DrawDevices(devices, layout) || !DrawRocks(rocks, layout)) {
    return false;
  }
  if (Connected(layout, kBlockedBits)) return true;
  crowded_ = !Connected(layout, kIslandBit)  ? kIslandsKey
             : scenario_.rocks.cells.empty() ? kRocksKey
                                             : kRockCellsKey;
  return false;
}

void LayoutGenerator::ChartAllWays(Layout& layout) {
  const std::size_t places =
      layout.ports.size() + static_cast<std::size_t>(scenario_.FetchableCount());
  route_queue_.reserve(static_cast<std::size_t>(scenario_.CellCount()));
  layout.routes.resize(static_cast<std::size_t>(scenario_.CellCount()) * places);
  RouteEntry* routes = layout.routes.data();
  for (const Cell port : layout.ports) {
    ComputeRoutes(layout.cells, port, routes++, places, route_steps_, route_queue_);
  }
  for (const PlacedDevice& device : layout.devices) {
    if (device.self_propelled) continue;
    ComputeRoutes(layout.cells, device.cell, routes++, places, route_steps_, route_queue_);
  }
}

void LayoutGenerator::Reserve(Layout& layout) const {
  layout.cells.resize(scenario_.height, scenario_.width);
  layout.crash_reward.resize(scenario_.height, scenario_.width);
  layout.obstacle.resize(scenario_.height, scenario_.width);
  layout.ports.reserve(
      std::max(scenario_.ports.cells.size(), static_cast<std::size_t>(scenario_.ports.count)));
  layout.rocks.reserve(
      std::max(scenario_.rocks.cells.size(), static_cast<std::size_t>(scenario_.rocks.count.max)));
  layout.devices.reserve(static_cast<std::size_t>(scenario_.devices.Total()));
}

void LayoutGenerator::PlaceIslands(Layout& layout) const {
  const float reward = scenario_.rewards.island_crash;
  for (const IslandBlock& island : scenario_.islands) {
    const Cell corner = island.south_west;
    layout.cells.block(corner.y, corner.x, island.height, island.width) = kIslandBit;
    layout.crash_reward.block(corner.y, corner.x, island.height, island.width) = reward;
    layout.obstacle.block(corner.y, corner.x, island.height, island.width) = ObstacleLevel(reward);
  }
}

// Places the ports, rocks and devices whose cells the scenario specifies. DrawRocks sets the crash
// rewards of the rocks later.
void LayoutGenerator::PlaceExplicit(Layout& layout) const {
  for (const Cell cell : scenario_.ports.cells) AddPort(cell, layout);
  for (const Cell cell : scenario_.rocks.cells) layout.cells(cell.y, cell.x) |= kRockBit;
  if (scenario_.devices.placement != DevicePlacement::kExplicit) return;
  for (const DeviceSite& site : scenario_.devices.sites) AddDevice(site.cell, layout);
}

bool LayoutGenerator::DrawPorts(RandomStream& rng, Layout& layout) {
  if (!scenario_.ports.cells.empty()) return true;
  candidates_.clear();
  for (std::int32_t y = 0; y < scenario_.height; ++y) {
    for (std::int32_t x = 0; x < scenario_.width; ++x) {
      if (layout.bits({x, y}) != 0 || !AtShore(layout, {x, y})) continue;
      candidates_.push_back(LinearIndex({x, y}, scenario_.width));
    }
  }
  crowded_ = kPortsKey;
  if (candidates_.size() < static_cast<std::size_t>(scenario_.ports.count)) return false;
  for (std::int32_t i = 0; i < scenario_.ports.count; ++i) AddPort(TakeCandidate(rng), layout);
  return true;
}

bool LayoutGenerator::DrawDevices(RandomStream& rng, Layout& layout) {
  const DeviceSpec& spec = scenario_.devices;
  crowded_ = kDevicesKey;
  switch (spec.placement) {
    case DevicePlacement::kUniform:
      Spread(rng, layout);
      break;
    case DevicePlacement::kLinear:
      LineUp(rng, layout);
      break;
    case DevicePlacement::kRandom:
      Scatter(rng, layout);
      break;
    case DevicePlacement::kExplicit:
      break;
  }
  if (layout.devices.size() < static_cast<std::size_t>(spec.Total())) return false;
  const auto count = static_cast<std::size_t>(spec.Total());
  for (std::size_t i = 0; i < count; ++i) {
    PlacedDevice& device = layout.devices[i];
    device.value = rng.Uniform(spec.value.min, spec.value.max);
    if (scenario_.seas && !scenario_.seas->device_value.empty()) {
      const std::int32_t cell = LinearIndex(device.cell, scenario_.width);
      const float value = scenario_.seas->device_value[static_cast<std::size_t>(cell)];
      if (!std::isnan(value)) device.value = value;
    }
    if (spec.placement == DevicePlacement::kExplicit) {
      const DeviceSite& site = spec.sites[i];
      device.kind = site.kind;
      device.value = site.value.value_or(device.value);
      device.self_propelled = site.self_propelled;
    } else {
      device.kind = spec.kinds[i % spec.kinds.size()];
      device.self_propelled = i + static_cast<std::size_t>(spec.self_propelled) >= count;
    }
    if (scenario_.money) {
      const bool has_site = spec.placement == DevicePlacement::kExplicit;
      device.insured =
          InsuredValue(*scenario_.money, device.kind, has_site ? &spec.sites[i] : nullptr);
    }
  }
  return true;
}

bool LayoutGenerator::DrawRocks(RandomStream& rng, Layout& layout) {
  const RockSpec& spec = scenario_.rocks;
  if (!spec.cells.empty()) {
    for (const Cell cell : spec.cells) {
      AddRock(cell, rng.Uniform(spec.reward.min, spec.reward.max), layout);
    }
    return true;
  }
  const auto spread = static_cast<std::uint32_t>(spec.count.max - spec.count.min + 1);
  const std::int32_t count = spec.count.min + static_cast<std::int32_t>(rng.Below(spread));
  crowded_ = kRocksKey;
  CollectFree(layout);
  if (candidates_.size() < static_cast<std::size_t>(count)) return false;
  for (std::int32_t i = 0; i < count; ++i) {
    const Cell cell = TakeCandidate(rng);
    AddRock(cell, rng.Uniform(spec.reward.min, spec.reward.max), layout);
  }
  return true;
}

void LayoutGenerator::Spread(RandomStream& rng, Layout& layout) {
  const std::int32_t count = scenario_.devices.count;
  // The number of rows is chosen such that the parts are about square: rows² = count · height /
  // width.
  const std::int32_t rows = std::min({count, scenario_.height,
                                      std::max(1, CeilSqrt(static_cast<std::int64_t>(count) *
                                                           scenario_.height / scenario_.width))});
  for (std::int32_t row = 0; row < rows; ++row) {
    const std::int32_t in_row = count * (row + 1) / rows - count * row / rows;
    for (std::int32_t i = 0; i < in_row; ++i) {
      const std::int32_t x = NearMiddle(rng, i, in_row, scenario_.width);
      const std::int32_t y = NearMiddle(rng, row, rows, scenario_.height);
      const Cell cell = NearestFree(layout, {x, y});
      if (cell.x == kNone) return;
      AddDevice(cell, layout);
    }
  }
}

void LayoutGenerator::LineUp(RandomStream& rng, Layout& layout) {
  const std::int32_t count = scenario_.devices.count;
  const bool eastward = rng.Below(2) == 0;
  const std::int32_t along = eastward ? scenario_.width : scenario_.height;
  const std::int32_t across = eastward ? scenario_.height : scenario_.width;
  const std::int32_t longest = std::min(kLongestRow, along);
  const std::int32_t rows = std::min(across, std::max(1, CeilDiv(count, longest)));
  for (std::int32_t row = 0; row < rows; ++row) {
    const std::int32_t in_row = count * (row + 1) / rows - count * row / rows;
    const std::int32_t b = NearMiddle(rng, row, rows, across);
    for (std::int32_t i = 0; i < in_row; ++i) {
      const std::int32_t a = (2 * i + 1) * along / (2 * in_row);
      const Cell cell = NearestFree(layout, eastward ? Cell{a, b} : Cell{b, a});
      if (cell.x == kNone) return;
      AddDevice(cell, layout);
    }
  }
}

void LayoutGenerator::Scatter(RandomStream& rng, Layout& layout) {
  CollectFree(layout);
  const auto count = static_cast<std::size_t>(scenario_.devices.count);
  while (layout.devices.size() < count && !candidates_.empty()) {
    AddDevice(TakeCandidate(rng), layout);
  }
}

void LayoutGenerator::AddPort(Cell cell, Layout& layout) const {
  layout.cells(cell.y, cell.x) |= kPortBit;
  layout.ports.push_back(cell);
}

void LayoutGenerator::AddDevice(Cell cell, Layout& layout) const {
  layout.cells(cell.y, cell.x) |= kDeviceSiteBit;
  layout.devices.push_back({cell, DeviceKind{}, 0.0F, false});
}

void LayoutGenerator::AddRock(Cell cell, float reward, Layout& layout) const {
  layout.cells(cell.y, cell.x) |= kRockBit;
  layout.crash_reward(cell.y, cell.x) = reward;
  layout.obstacle(cell.y, cell.x) = ObstacleLevel(reward);
  layout.rocks.push_back(cell);
}

bool LayoutGenerator::AtShore(const Layout& layout, Cell cell) const {
  if (scenario_.islands.empty()) {
    return cell.x == 0 || cell.y == 0 || cell.x == scenario_.width - 1 ||
           cell.y == scenario_.height - 1;
  }
  for (const Cell move : kMoves) {
    const Cell to{cell.x + move.x, cell.y + move.y};
    const bool on_map = to.x >= 0 && to.x < scenario_.width && to.y >= 0 && to.y < scenario_.height;
    if (on_map && (layout.bits(to) & kIslandBit) != 0) return true;
  }
  return false;
}

Cell LayoutGenerator::NearestFree(const Layout& layout, Cell wanted) const {
  const std::int32_t farthest = std::max(scenario_.width, scenario_.height);
  for (std::int32_t ring = 0; ring < farthest; ++ring) {
    for (std::int32_t dy = -ring; dy <= ring; ++dy) {
      const std::int32_t y = wanted.y + dy;
      if (y < 0 || y >= scenario_.height) continue;
      // The first and last rows of the ring are searched completely, the other rows only at both
      // ends.
      const std::int32_t stride = dy == -ring || dy == ring ? 1 : 2 * ring;
      for (std::int32_t dx = -ring; dx <= ring; dx += stride) {
        const std::int32_t x = wanted.x + dx;
        if (x >= 0 && x < scenario_.width && layout.bits({x, y}) == 0) return {x, y};
      }
    }
  }
  return {kNone, kNone};
}

bool LayoutGenerator::Connected(const Layout& layout, std::uint8_t blocked) {
  const std::int32_t width = scenario_.width;
  const std::int32_t stride = width + 2;
  std::fill(reached_.begin(), reached_.end(), std::uint8_t{1});
  for (std::int32_t y = 0; y < scenario_.height; ++y) {
    const std::uint8_t* row = layout.cells.data() + y * width;
    std::uint8_t* to = reached_.data() + (y + 1) * stride + 1;
    for (std::int32_t x = 0; x < width; ++x) to[x] = (row[x] & blocked) != 0 ? 1 : 0;
  }
  const auto padded = [stride](Cell cell) { return (cell.y + 1) * stride + cell.x + 1; };
  const std::array<std::int32_t, kMoveCount> steps{
      stride, -stride, -1, 1, stride - 1, stride + 1, -stride - 1, -stride + 1};
  std::size_t end = 0;
  std::int32_t start = padded(layout.ports.front());
  reached_[static_cast<std::size_t>(start)] = 2;
  queue_[end++] = start;
  for (std::size_t begin = 0; begin < end; ++begin) {
    for (const std::int32_t step : steps) {
      const auto next = static_cast<std::size_t>(queue_[begin] + step);
      if (reached_[next] != 0) continue;
      reached_[next] = 2;
      queue_[end++] = static_cast<std::int32_t>(next);
    }
  }
  const auto reached = [&](Cell cell) {
    return reached_[static_cast<std::size_t>(padded(cell))] == 2;
  };
  return std::all_of(layout.ports.begin(), layout.ports.end(), reached) &&
         std::all_of(layout.devices.begin(), layout.devices.end(),
                     [&](const PlacedDevice& device) { return reached(device.cell); });
}

Cell LayoutGenerator::TakeCandidate(RandomStream& rng) {
  const std::uint32_t i = rng.Below(static_cast<std::uint32_t>(candidates_.size()));
  const std::int32_t cell = candidates_[i];
  candidates_[i] = candidates_.back();
  candidates_.pop_back();
  return {cell % scenario_.width, cell / scenario_.width};
}

void LayoutGenerator::CollectFree(const Layout& layout) {
  candidates_.clear();
  const std::uint8_t* cells = layout.cells.data();
  for (std::int32_t i = 0; i < scenario_.CellCount(); ++i) {
    if (cells[i] == 0) candidates_.push_back(i);
  }
}

}  // namespace aquafarm
