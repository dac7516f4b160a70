// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes the actions of one ship by dynamic programming over time and states. A state is the
/// cell of the ship and a status of each device. With the true future of the disasters, the plan
/// has the exact max return of a seeded episode. This is the clairvoyant optimum, the reference of
/// paper §4.2 (see docs/model.md). A policy may also plan again at each step (receding horizon). It
/// then plans from the issued forecast or, without a forecast, from the current heading of each
/// disaster. Such a plan uses information that an operator has at that time. In addition, it uses
/// the step in which each disaster ends, and which crashes will cause damage.
///
/// Health is computed exactly. The health of a deployed device depends only on time. The health of
/// a device aboard depends on the route. Each pickup is therefore planned in two ways, paid and
/// unpaid. If it is paid, the value is credited at pickup, losses are subtracted as they occur, and
/// the device must be delivered. If it is unpaid, neither value nor losses count, and the device
/// may be delivered for the drop-off reward alone. The better of the two plans has the exact value
/// of the device, which is never negative.
///
/// The search runs forward in time and keeps the max return so far of each state. It prunes a state
/// if an upper bound of its return does not exceed the return of the best complete plan found so
/// far. The bound uses the min number of moves that complete the work, and the best reward that any
/// cell has in each step.

#include <cstdint>
#include <memory>

#include "aquafarm/agents/planning/plan.h"
#include "aquafarm/agents/planning/risk_source.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

class PlannerSolver;

/// Plans for farms of one scenario. Reuses its memory for each plan.
class Planner {
 public:
  /// @param scenario must outlive the planner
  /// @param max_devices max number of devices of a task; 0: the number of devices of the scenario
  /// @throws InputError if the reward of steps or of illegal actions is positive, if the max number
  ///   of devices exceeds kMaxPlanDevices, or if there are more than kMaxPlanStates states
  explicit Planner(const Scenario& scenario, std::int32_t max_devices = 0);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  /// Number of states, at most kMaxPlanStates.
  std::size_t state_count() const;

  /// Returns the best plan from the farm's present state. The plan is empty if the episode is over,
  /// or if reserved cells (Task::others) exclude every plan.
  /// @param risks risks of the steps after the farm's present one
  Plan Solve(const Farm& farm, RiskSource& risks, const Task& task);
  /// Does the same with the risks of the farm's own disasters.
  Plan Solve(const Farm& farm, Foresight foresight, const Task& task);
  /// Does the same for a farm with one agent, which does all the work.
  Plan Solve(const Farm& farm, Foresight foresight);

 private:
  std::unique_ptr<PlannerSolver> solver_;
};

}  // namespace aquafarm::agents
