// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Planning for one ship by dynamic programming over (time, cell, devices aboard and
/// delivered). With the disasters' true future it gives the exact best return of a seeded episode:
/// the clairvoyant optimum, the yardstick of §4.2. With the forecast that every disaster holds its
/// present heading it is what a good operator would do, planning again each step.
///
/// Health is kept exactly. A deployed device's health depends on time alone; aboard, its loss adds
/// up along the way. So a device picked up is either *for value* (its worth is paid in at pickup,
/// losses are paid as they come, and it must be delivered) or *for nothing* (it may be delivered
/// for the bare reward): whichever is better equals worth clamped at zero.
///
///   forward in time, best return so far per state ──> pruned where it cannot beat the best
///   complete plan even if no disaster came any more (a bound solved once, without time)

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Which future of the disasters a plan is made for.
enum class Foresight : std::uint8_t {
  kClairvoyant,   ///< as they will really move
  kHeadingHolds,  ///< as the scenario's forecast has it, else straight on as it moves now
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

/// Plans for farms of one scenario; keeps its memory between plans.
class Planner {
 public:
  /// @param scenario must outlive the planner
  /// @param slots most devices of a task; 0: all of the scenario's
  /// @throws InputError when the scenario pays for dawdling, or the states do not fit a table
  ///         (kMaxStates)
  explicit Planner(const Scenario& scenario, std::int32_t slots = 0);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Number of (cell, devices) states that a plan may visit at most, and the limit of it.
  std::size_t state_count() const;
  inline static constexpr std::size_t kMaxStates = 50'000'000;

  /// The best plan from the farm's present state; empty when its episode is over.
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
  /// The same for the one ship of a farm, which does all there is to do.
  Plan Solve(const Farm& farm, Foresight foresight);

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace aquafarm::agents
