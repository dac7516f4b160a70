// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Positions of ports, rocks, islands and devices, drawn from (Scenario, seed, episode). A
/// breadth-first search ensures that water connects all devices and ports (paper §2.4, see
/// docs/model.md).

#include <cstdint>
#include <vector>

#include "aquafarm/base/rng.h"
#include "aquafarm/farm/accounts.h"
#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/farm/route_table.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/grid.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// A device at the start of an episode.
struct PlacedDevice {
  Cell cell{};
  DeviceKind kind{};
  float value{};
  bool self_propelled{};
  Cents insured{};  ///< 0 if the scenario has no money
};

/// A chart and the objects on it.
struct Layout {
  Grid<std::uint8_t> cells;     ///< [H, W] CellBits
  Grid<float> crash_reward;     ///< [H, W]; 0 on water, negative on rocks and islands
  Grid<std::uint8_t> obstacle;  ///< [H, W] image plane; 255 · min(1, |crash_reward| / 20)
  std::vector<Cell> ports;
  std::vector<Cell> rocks;
  std::vector<PlacedDevice> devices;
  /// [H, W, route_count()] Routes from each cell to each port and then to each fetchable device, in
  /// id order; empty without ViewSpec::routes and ViewSpec::tokens.
  std::vector<RouteEntry> routes;

  std::size_t route_count() const { return routes.size() / static_cast<std::size_t>(cells.size()); }
  std::uint8_t bits(Cell cell) const { return cells(cell.y, cell.x); }
};

/// Draws layouts. Keeps its scratch memory, so drawing into the same Layout again does not
/// allocate. Ports are placed first, then devices, then rocks on the remaining water. Placements:
///   uniform  one device near the middle of each of `count` equal parts of the map
///   linear   devices in straight rows, west to east or south to north
///   random   anywhere on free water
///   explicit at the cells given in the scenario
class LayoutGenerator {
 public:
  /// Keeps a reference to the scenario, which must have passed ValidateScenario.
  explicit LayoutGenerator(const Scenario& scenario);

  /// Draws the layout of one episode into `layout`, reusing its memory. With LayoutMode::kFixed
  /// the draw depends on layout_seed alone.
  /// @throws InputError when no connected layout is found within a bounded number of attempts; the
  ///         message names the parameter that is too large
  void Generate(std::uint64_t seed, std::uint64_t episode, Layout& layout);

 private:
  /// Makes one attempt to place all objects; on failure crowded_ names the parameter to reduce.
  bool TryPlace(std::uint64_t seed, std::uint64_t episode, std::uint32_t attempt, Layout& layout);
  void Reserve(Layout& layout) const;
  void PlaceIslands(Layout& layout) const;
  void PlaceExplicit(Layout& layout) const;
  bool DrawPorts(RandomStream& rng, Layout& layout);
  bool DrawDevices(RandomStream& rng, Layout& layout);
  bool DrawRocks(RandomStream& rng, Layout& layout);
  void Spread(RandomStream& rng, Layout& layout);
  void LineUp(RandomStream& rng, Layout& layout);
  void Scatter(RandomStream& rng, Layout& layout);
  void AddPort(Cell cell, Layout& layout) const;
  void AddDevice(Cell cell, Layout& layout) const;
  void AddRock(Cell cell, float reward, Layout& layout) const;
  void ChartAllWays(Layout& layout);
  bool AtShore(const Layout& layout, Cell cell) const;
  /// Returns the free cell nearest to `wanted`, searched ring by ring; x = kNone if there is none.
  Cell NearestFree(const Layout& layout, Cell wanted) const;
  /// Returns whether cells without any bit of `blocked` connect all ports and devices.
  bool Connected(const Layout& layout, std::uint8_t blocked);
  /// Removes a random candidate and returns it.
  Cell TakeCandidate(RandomStream& rng);
  void CollectFree(const Layout& layout);

  const Scenario& scenario_;
  std::vector<std::int32_t> candidates_;  // linear indices of cells still available
  std::vector<std::int32_t> queue_;       // scratch of the breadth-first search
  Grid<std::int32_t> route_steps_;        // scratch of ComputeRoutes
  std::vector<Cell> route_queue_;         // scratch of ComputeRoutes
  std::vector<std::uint8_t> reached_;     // with a border of one cell on every side
  const char* crowded_{""};
};

}  // namespace aquafarm
