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

#include "aquafarm/agents/planning/plan.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

class PlannerSolver;

/// Plans for farms of one scenario; keeps its memory between plans.
class Planner {
 public:
  /// @param scenario must outlive the planner
  /// @param slots most devices of a task; 0: all of the scenario's
  /// @throws InputError when the scenario pays for steps or illegal actions, or the states do not
  /// fit a
  ///         table (kMaxStates)
  explicit Planner(const Scenario& scenario, std::int32_t slots = 0);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Number of (cell, devices) states that a plan may visit at most, and the limit of it.
  std::size_t state_count() const;
  inline static constexpr std::size_t kMaxStates = kMaxPlanStates;

  /// The best plan from the farm's present state; empty when its episode is over.
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
  /// The same for the one ship of a farm, which does all there is to do.
  Plan Solve(const Farm& farm, Foresight foresight);

 private:
  std::unique_ptr<PlannerSolver> solver_;
};

}  // namespace aquafarm::agents
