// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/gae.h"

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

void EstimateAdvantages(const std::vector<float>& rewards, const std::vector<float>& values,
                        const std::vector<StepEnd>& ends, std::size_t entries, float gamma,
                        float lambda, std::vector<float>& advantages) {
  AQUAFARM_CHECK_EQ(rewards.size(), ends.size());
  AQUAFARM_CHECK_EQ(values.size(), ends.size() + entries);
  advantages.assign(ends.size(), 0.0F);
  const float decay = gamma * lambda;
  for (std::size_t slot = ends.size(); slot-- > 0;) {
    const StepEnd end = ends[slot];
    if (end == StepEnd::kNoTransition) continue;
    const float next_value = end == StepEnd::kTerminated ? 0.0F : values[slot + entries];
    const bool has_next = end == StepEnd::kContinues && slot + entries < ends.size();
    const float next_advantage = has_next ? advantages[slot + entries] : 0.0F;
    advantages[slot] = rewards[slot] + gamma * next_value - values[slot] + decay * next_advantage;
  }
}

}  // namespace aquafarm::agents
