// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/gae.h"

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

void EstimateAdvantages(const std::vector<float>& rewards, const std::vector<float>& values,
                        const std::vector<StepEnd>& ends, std::size_t slots, float gamma,
                        float lambda, std::vector<float>& advantages) {
  AQUAFARM_CHECK_EQ(rewards.size(), ends.size());
  AQUAFARM_CHECK_EQ(values.size(), ends.size() + slots);
  advantages.assign(ends.size(), 0.0F);
  const float decay = gamma * lambda;
  for (std::size_t sample = ends.size(); sample-- > 0;) {
    const StepEnd end = ends[sample];
    if (end == StepEnd::kNoTransition) continue;
    const float next_value = end == StepEnd::kTerminated ? 0.0F : values[sample + slots];
    const bool has_next = end == StepEnd::kContinues && sample + slots < ends.size();
    const float next_advantage = has_next ? advantages[sample + slots] : 0.0F;
    advantages[sample] =
        rewards[sample] + gamma * next_value - values[sample] + decay * next_advantage;
  }
}

}  // namespace aquafarm::agents
