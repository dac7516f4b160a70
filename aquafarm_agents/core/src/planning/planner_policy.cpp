// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/planning/planner_policy.h"

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents {
PlannerPolicy::PlannerPolicy(const EnvironmentSpec& spec, Foresight foresight)
    : scenario_(
          std::make_shared<const Scenario>(ParseScenario(spec.scenario_yaml, spec.scenario_name))),
      foresight_(foresight),
      planner_(*scenario_) {}

void PlannerPolicy::Begin(std::uint64_t, std::int32_t farms) {
  plans_.assign(static_cast<std::size_t>(farms), {});
}

void PlannerPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  AQUAFARM_CHECK_EQ(results.states.size(), plans_.size());
  actions.resize(plans_.size());
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Farm& farm = *results.states[i];
    actions[i] = farm.over() ? 0 : Follow(farm, plans_[i]);
  }
}

std::uint8_t PlannerPolicy::Follow(const Farm& farm, PlanState& course) {
  const bool is_on_course = foresight_ == Foresight::kOracle &&
                            course.next < course.plan.actions.size() &&
                            course.seed == farm.seed() && course.episode == farm.episode() &&
                            course.step == farm.step() && course.cell == farm.ships()[0].cell;
  if (!is_on_course) {
    course.plan = planner_.Solve(farm, foresight_);
    course.next = 0;
    course.seed = farm.seed();
    course.episode = farm.episode();
  }
  if (course.plan.actions.empty()) return 0;
  const std::uint8_t action = course.plan.actions[course.next++];
  course.step = farm.step() + 1;
  Cell cell = farm.ships()[0].cell;
  if (action < kMoveCount) cell = {cell.x + kMoves[action].x, cell.y + kMoves[action].y};
  course.cell = cell;
  return action;
}

}  // namespace aquafarm::agents
