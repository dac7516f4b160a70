// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "aquafarm/agents/planning/planner_policy.h"

namespace aquafarm::agents::test {

/// Returns the planner that knows the true future of the disasters.
inline std::unique_ptr<Policy> Plan(const EnvironmentSpec& spec) {
  return std::make_unique<PlannerPolicy>(spec, Foresight::kOracle);
}

}  // namespace aquafarm::agents::test
