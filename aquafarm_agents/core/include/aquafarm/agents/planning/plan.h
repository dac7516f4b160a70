// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What planners share: the foreseen future, tasks, plans, and the cells that other ships reserve.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Most (cell, devices) states that one plan may visit.
inline constexpr std::size_t kMaxPlanStates = 50'000'000;

/// Which future of the disasters a plan is made for.
enum class Foresight : std::uint8_t {
  kOracle,       ///< as they will really move
  kPersistence,  ///< as the scenario's forecast has it, else straight on as it moves now
};

/// Where ships that have planned before will be, so that a plan keeps out of their way: a ship's
/// cell at each step, its own and the one that the order of moving makes it block. Ports block
/// nobody.
class Reservations {
 public:
  void Clear() { taken_.clear(); }
  /// Ship `id` is in `path[k]` at step first + k, from now (k = 0) on.
  void Add(std::int32_t id, std::int32_t first, const std::vector<std::int32_t>& path);
  /// Whether ship `id` would be in another's way, or another in its, in `cell` at `step`.
  bool IsTaken(std::int32_t id, std::int32_t step, std::int32_t cell) const;

 private:
  // A ship is there then (offset 0), will be a step later (+1), or was a step before (-1).
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

/// What one ship is to do, of the farm's work.
struct Task {
  std::int32_t ship{0};
  /// Devices that it fetches, holds, or is itself; at most Planner::slots().
  std::vector<std::int32_t> devices;
  /// Step up to which it keeps out of harm's way when there is nothing to do; else 0.
  std::int32_t until{0};
  const Reservations* others{};  ///< null: nobody is in the way
};

/// Makes a farm's disasters move as they are foreseen from now on.
/// @returns the tracks that they then follow
std::vector<Track> Foresee(const Farm& farm, Foresight foresight, std::vector<Disaster>& disasters);

/// What to do from a farm's present step on.
struct Plan {
  std::vector<std::uint8_t> actions;  ///< one per step, to the end of the episode or of all work
  double expected_return{};           ///< from the present step on, in the assumed future
};

}  // namespace aquafarm::agents
