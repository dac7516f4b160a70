// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Planning for one rescue ship by dynamic programming over (time, cell, devices aboard and
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
#include <vector>

#include "aquafarm/farm.h"

namespace aquafarm::agents {

/// Which future of the disasters a plan is made for.
enum class Foresight : std::uint8_t {
  kClairvoyant,   ///< as they will really move
  kHeadingHolds,  ///< straight on at the present heading, speed and growth
};

/// What to do from a farm's present step on.
struct Plan {
  std::vector<std::uint8_t> actions;  ///< one per step, to the end of the episode or of all work
  double expected_return{};           ///< from the present step on, in the assumed future
};

/// Plans for farms of one scenario; keeps its memory between plans.
class Planner {
 public:
  /// @param scenario must outlive the planner
  /// @throws InputError when the scenario has more than one agent, pays for dawdling,
  /// self-propelled devices, or more
  ///         devices than fit a table (kMaxStates)
  explicit Planner(const Scenario& scenario);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Number of (cell, devices) states that a plan may visit at most, and the limit of it.
  std::size_t state_count() const;
  inline static constexpr std::size_t kMaxStates = 50'000'000;

  /// The best plan from the farm's present state; empty when its episode is over.
  Plan Solve(const Farm& farm, Foresight foresight);

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace aquafarm::agents
