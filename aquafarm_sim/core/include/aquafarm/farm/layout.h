// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The layout of an episode: the islands of the scenario, and the positions of ports, rocks and
/// devices. The scenario sets these positions, or they are drawn from (scenario, seed, episode). A
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
  Cents insured{};  ///< insured value; 0 if the scenario has no money
};

/// The chart of an episode and the objects on it.
struct Layout {
  Grid<std::uint8_t> cells;     ///< [H, W] CellBits
  Grid<float> crash_reward;     ///< [H, W]; 0 on water, 0 or negative on rocks and islands
  Grid<std::uint8_t> obstacle;  ///< [H, W] image plane; 255 · min(1, |crash_reward| / 20)
  std::vector<Cell> ports;
  std::vector<Cell> rocks;
  std::vector<PlacedDevice> devices;
  /// [H, W, route_count()]. For each cell, the routes to all ports and then to all devices that
  /// ships must fetch, both in id order. Empty unless ViewSpec::NeedsRoutes().
  std::vector<RouteEntry> routes;

  /// Returns the number of targets in `routes`.
  std::size_t route_count() const { return routes.size() / static_cast<std::size_t>(cells.size()); }
  /// Returns the CellBits of a cell.
  std::uint8_t bits(Cell cell) const { return cells(cell.y, cell.x); }
};

/// Draws layouts. Keeps its scratch memory, so drawing into the same Layout again does not
/// allocate. First places the islands, and the objects whose cells the scenario sets. Then places
/// random ports, devices and rocks, in this order. Placements of devices:
///   uniform  divides the map into `count` parts of about equal size; one device near the middle of
///            each part
///   linear   devices in straight rows, all from west to east or all from south to north
///   random   anywhere on free water
///   explicit at the cells that the scenario sets
class LayoutGenerator {
 public:
  /// Keeps a reference to the scenario, which must have passed ValidateScenario.
  explicit LayoutGenerator(const Scenario& scenario);

  /// Draws the layout of one episode into `layout` and reuses its memory. With LayoutMode::kFixed
  /// the layout depends only on the scenario: Scenario::layout_seed replaces `seed`, and 0 replaces
  /// `episode`.
  /// @throws InputError if 100 attempts fail, because too few cells are free or because water does
  ///   not connect all ports and devices. The message names a parameter to change.
  void Generate(std::uint64_t seed, std::uint64_t episode, Layout& layout);

 private:
  /// Tries once to place all objects. If it returns false, crowded_ names the parameter to change.
  bool TryPlace(std::uint64_t seed, std::uint64_t episode, std::uint32_t attempt, Layout& layout);
  /// Sizes the grids of a layout and reserves its lists.
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
  /// Returns the first cell without bits in growing squares around `wanted`. If there is no such
  /// cell, the x of the result is kNone.
  Cell NearestFree(const Layout& layout, Cell wanted) const;
  /// Returns whether all ports and devices are connected through cells without the bits in
  /// `blocked`.
  bool Connected(const Layout& layout, std::uint8_t blocked);
  /// Removes a random cell from candidates_ and returns it.
  Cell TakeCandidate(RandomStream& rng);
  /// Sets candidates_ to the cells without bits.
  void CollectFree(const Layout& layout);

  const Scenario& scenario_;
  std::vector<std::int32_t> candidates_;  // linear indices of free cells
  std::vector<std::int32_t> queue_;       // scratch of the breadth-first search
  Grid<std::int32_t> route_steps_;        // scratch of ComputeRoutes
  std::vector<Cell> route_queue_;         // scratch of ComputeRoutes
  std::vector<std::uint8_t> reached_;     // by cell, with a border of one cell on every side
  const char* crowded_{""};
};

}  // namespace aquafarm
