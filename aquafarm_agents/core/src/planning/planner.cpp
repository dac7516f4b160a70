// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/planner.h"

#include "aquafarm/base/check.h"
#include "planning/planner_solver.h"

namespace aquafarm::agents {

Planner::Planner(const Scenario& scenario, std::int32_t max_devices)
    : solver_(std::make_unique<PlannerSolver>(scenario, max_devices)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;
std::size_t Planner::state_count() const { return solver_->state_count(); }

Plan Planner::Solve(const Farm& farm, RiskSource& risks, const Task& task) {
  return solver_->Solve(farm, risks, task);
}
Plan Planner::Solve(const Farm& farm, Foresight foresight, const Task& task) {
  DisasterRisk risks(farm, foresight);
  return Solve(farm, risks, task);
}
Plan Planner::Solve(const Farm& farm, Foresight foresight) {
  AQUAFARM_CHECK_EQ(farm.ships().size(), 1U);
  Task task;
  for (std::size_t id = 0; id < farm.devices().size(); ++id) {
    task.devices.push_back(static_cast<std::int32_t>(id));
  }
  return Solve(farm, foresight, task);
}

}  // namespace aquafarm::agents
