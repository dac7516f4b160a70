// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Plans for one ship by dynamic programming over (time, cell, devices aboard and delivered). With
/// the true future of the disasters the plan has the exact max return of a seeded episode: the
/// clairvoyant optimum, the reference of paper §4.2 (see docs/model.md). If it plans again at each
/// step (receding horizon), from the issued forecast or, without one, from the disaster's present
/// heading, it uses only what an operator knows at that time.
///
/// Health is computed exactly. The health of a deployed device depends only on time; aboard, its
/// loss accumulates along the route. Each pickup is therefore planned as paid or unpaid. Paid: the
/// value is credited at pickup, losses are subtracted as they occur, and the device must be
/// delivered. Unpaid: it may be delivered for the drop-off reward only. The better of the two
/// equals the value clamped at zero.
///
/// The search runs forward in time and keeps the max return so far of each state. It prunes a state
/// that cannot beat the best complete plan: completing the work needs a min number of moves, and
/// each step earns at most the best reward that any cell has in that step.

#include <cstdint>
#include <memory>

#include "aquafarm/agents/planning/plan.h"
#include "aquafarm/agents/planning/risk_source.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

class PlannerSolver;

/// Plans for farms of one scenario; reuses its memory for each plan.
class Planner {
 public:
  /// @param scenario must outlive the planner
  /// @param max_devices of a task; 0: all devices of the scenario
  /// @throws InputError if the reward of steps or of illegal actions is positive, or if there are
  ///   too many devices or states (kMaxPlanStates)
  explicit Planner(const Scenario& scenario, std::int32_t max_devices = 0);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Number of (cell, devices) states, at most kMaxPlanStates.
  std::size_t state_count() const;

  /// Returns the best plan from the farm's present state; empty if its episode is over.
  /// @param risks of the steps after the farm's present one; see risk_source.h
  Plan Solve(const Farm& farm, RiskSource& risks, const Task& task);
  /// As above, with the risks of the farm's own disasters.
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
  /// As above, for the only ship of a farm, which does all the work.
  Plan Solve(const Farm& farm, Foresight foresight);

 private:
  std::unique_ptr<PlannerSolver> solver_;
};

}  // namespace aquafarm::agents
