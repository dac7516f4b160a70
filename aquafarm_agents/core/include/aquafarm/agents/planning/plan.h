// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Types that the planners share: the assumed future, tasks, plans, and reserved cells.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Max number of states of one plan. A state is a cell of the ship and a status of each device.
inline constexpr std::size_t kMaxPlanStates = 50'000'000;
/// Max number of devices that the planner of one ship supports.
inline constexpr std::int32_t kMaxPlanDevices = 12;

/// Which future of the disasters a plan assumes.
enum class Foresight : std::uint8_t {
  kOracle,       ///< the true future
  kPersistence,  ///< the forecast in force; without one, straight motion with the present heading
};

/// Cells and steps that are reserved for ships. The plan of another ship avoids them. In each step,
/// a ship reserves its cell of this step against all other ships. Because ships move in id order,
/// the ship also reserves its cell of the next step against ships with a higher id, and its cell of
/// the previous step against ships with a lower id. A planner does not query cells of ports,
/// because any number of ships may share a port.
class Reservations {
 public:
  void Clear() { taken_.clear(); }
  /// Reserves `path[k]` for ship `id` at step first + k; k = 0 is the present step.
  void Add(std::int32_t id, std::int32_t first, const std::vector<std::int32_t>& path);
  /// Returns whether another ship's reservation excludes ship `id` from `cell` at `step`.
  bool IsTaken(std::int32_t id, std::int32_t step, std::int32_t cell) const;

 private:
  // `ship` occupies the cell at the step of the key plus `offset`, which is -1, 0 or 1.
  struct Visit {
    std::int32_t ship;
    std::int32_t offset;
  };
  static std::uint64_t Key(std::int32_t step, std::int32_t cell) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(step)) << 32U) |
           static_cast<std::uint32_t>(cell);
  }
  std::unordered_map<std::uint64_t, std::vector<Visit>> taken_;
};

/// The part of a farm's work that one ship does.
struct Task {
  std::int32_t ship{0};  ///< id of the ship
  /// Ids of the devices that the ship fetches or carries; for a self-propelled device, its own id.
  /// Their number is at most `max_devices` of the constructor of Planner.
  std::vector<std::int32_t> devices;
  /// Last step of the plan; 0 if the plan ends with the last delivery or with the episode. Must be
  /// above 0 if `devices` is empty; such a plan only avoids risks.
  std::int32_t until{0};
  const Reservations* others{};  ///< cells that the plan avoids; nullptr: no cells
};

/// Changes disasters so that MoveDisaster, called with the returned tracks, moves them as the plan
/// assumes.
/// @param disasters a copy of the farm's present disasters; kOracle leaves it unchanged
/// @returns the assumed track of each disaster
std::vector<Track> Foresee(const Farm& farm, Foresight foresight, std::vector<Disaster>& disasters);

/// Actions of one ship from a farm's present step on.
struct Plan {
  /// One action per step, until the work is complete, the episode ends or Task::until is reached.
  /// Empty if there is no plan.
  std::vector<std::uint8_t> actions;
  double expected_return{};  ///< return from the present step on, in the assumed future
};

}  // namespace aquafarm::agents
