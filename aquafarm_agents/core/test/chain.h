// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents::test {

/// One agent in an environment of three tabular states. The test sets each state and reward.
struct Chain {
  EnvironmentSpec spec;
  StepResults results;
  std::vector<std::uint8_t> actions;

  Chain() {
    spec.farms = spec.agents = 1;
    spec.state_count = 3;
    results.rewards = {0.0F};
    results.legal = {kAllActions};
    results.end_reasons = {0};
    results.is_first = {1};
    results.active = {1};
    results.index = {0};
  }
  template <typename L>
  std::uint8_t Notify(L& learner, std::uint32_t state, float reward,
                      EndReason reason = EndReason::kNone) {
    results.index[0] = state;
    results.rewards[0] = reward;
    results.end_reasons[0] = static_cast<std::uint8_t>(reason);
    learner.Step(results, 0.0, actions);
    results.is_first[0] = 0;
    return actions[0];
  }
};

}  // namespace aquafarm::agents::test
