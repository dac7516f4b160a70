// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where things stand: ports, rocks, islands and devices, drawn from (Scenario, seed, episode) so
/// that water always connects every device and port (§2.4; breadth-first check).

#include <cstdint>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/farm/route_table.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// A device as it stands at an episode's start.
struct PlacedDevice {
  Cell cell{};
  DeviceKind kind{};
  float value{};
  bool self_propelled{};
};

/// A chart with everything placed on it.
struct Layout {
  Grid<std::uint8_t> cells;     ///< [H, W] CellBits
  Grid<float> crash_reward;     ///< [H, W]; 0 on water, negative on rocks and islands
  Grid<std::uint8_t> obstacle;  ///< [H, W]; 255 · min(1, |crash_reward| / 20): an image plane
  std::vector<Cell> ports;
  std::vector<Cell> rocks;
  std::vector<PlacedDevice> devices;
  /// [H, W, way_count()] with ViewSpec::waterways the ways from each cell to each port and then to
  /// each device that can be fetched, in their orders; else empty.
  std::vector<Way> ways;

  std::size_t way_count() const { return ways.size() / static_cast<std::size_t>(cells.size()); }
  std::uint8_t bits(Cell cell) const { return cells(cell.y, cell.x); }
};

/// Draws layouts; keeps its scratch memory, so that drawing the next one into the same Layout
/// allocates nothing. Ports come first, then devices, then rocks on what water is left:
///   uniform  one device near the middle of each of `count` equal parts of the map
///   linear   devices in straight rows, west to east or south to north
///   random   anywhere on free water
///   explicit where the scenario says
class LayoutGenerator {
 public:
  /// Keeps a reference to the scenario, which must have passed ValidateScenario.
  explicit LayoutGenerator(const Scenario& scenario);

  /// Draws the layout of one episode into `layout`, reusing its memory. With LayoutMode::kFixed
  /// the draw depends on layout_seed alone.
  /// @throws InputError when no connected layout was found in a bounded number of tries, naming
  ///         the crowded parameter
  void Generate(std::uint64_t seed, std::uint64_t episode, Layout& layout);

 private:
  /// Places everything once; on failure crowded_ names the parameter to change.
  bool TryPlace(std::uint64_t seed, std::uint64_t episode, std::uint32_t attempt, Layout& layout);
  void Reserve(Layout& layout) const;
  void PlaceIslands(Layout& layout) const;
  void PlaceExplicit(Layout& layout) const;
  bool DrawPorts(RandomStream& chance, Layout& layout);
  bool DrawDevices(RandomStream& chance, Layout& layout);
  bool DrawRocks(RandomStream& chance, Layout& layout);
  void Spread(RandomStream& chance, Layout& layout);
  void LineUp(RandomStream& chance, Layout& layout);
  void Scatter(RandomStream& chance, Layout& layout);
  void AddPort(Cell cell, Layout& layout) const;
  void AddDevice(Cell cell, Layout& layout) const;
  void AddRock(Cell cell, float reward, Layout& layout) const;
  void ChartAllWays(Layout& layout);
  bool AtShore(const Layout& layout, Cell cell) const;
  /// The free cell nearest to a wanted one, found ring by ring; x = kNone when there is none.
  Cell NearestFree(const Layout& layout, Cell wanted) const;
  /// Whether water that is in no cell of `blocked` connects every port and device.
  bool Connected(const Layout& layout, std::uint8_t blocked);
  /// A drawn one of the candidates left, which it takes out.
  Cell TakeCandidate(RandomStream& chance);
  void CollectFree(const Layout& layout);

  const Scenario& scenario_;
  std::vector<std::int32_t> candidates_;  // linear indices a thing may still be put on
  std::vector<std::int32_t> queue_;       // of the breadth-first search
  Grid<std::int32_t> way_steps_;          // of the charting of ways
  std::vector<Cell> way_queue_;           // of the same
  std::vector<std::uint8_t> reached_;     // with a border of one cell all round
  const char* crowded_{""};
};

}  // namespace aquafarm
