// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Types shared by the planners: the assumed future, tasks, plans, and cells reserved by other
/// ships.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Max number of (cell, devices) states of one plan.
inline constexpr std::size_t kMaxPlanStates = 50'000'000;

/// The future of the disasters that a plan assumes.
enum class Foresight : std::uint8_t {
  kOracle,       ///< the true future
  kPersistence,  ///< the scenario's forecast, else straight motion with the present heading
};

/// Cells reserved by ships with earlier plans, so that a plan avoids them. For each step they
/// contain the ship's cell and the cell that it blocks because ships move in order. Ports are never
/// blocked.
class Reservations {
 public:
  void Clear() { taken_.clear(); }
  /// Reserves `path[k]` for ship `id` at step first + k; k = 0 is the present step.
  void Add(std::int32_t id, std::int32_t first, const std::vector<std::int32_t>& path);
  /// Returns whether ship `id` in `cell` at `step` would conflict with another ship's reservation.
  bool IsTaken(std::int32_t id, std::int32_t step, std::int32_t cell) const;

 private:
  // The ship is there at the step (offset 0), one step later (+1), or was one step before (-1).
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
  std::int32_t ship{0};
  /// Devices that it fetches or carries, or the device that it is; at most `max_devices` of
  /// Planner.
  std::vector<std::int32_t> devices;
  /// Last step of a plan that only avoids risks because the ship has no work; else 0.
  std::int32_t until{0};
  const Reservations* others{};  ///< nullptr if no ship is in the way
};

/// Sets the assumed motion of a farm's disasters from now on.
/// @returns the tracks that they follow
std::vector<Track> Foresee(const Farm& farm, Foresight foresight, std::vector<Disaster>& disasters);

/// Actions from a farm's present step on.
struct Plan {
  std::vector<std::uint8_t>
      actions;               ///< one per step, until the episode ends or the work is complete
  double expected_return{};  ///< from the present step on, in the assumed future
};

}  // namespace aquafarm::agents
