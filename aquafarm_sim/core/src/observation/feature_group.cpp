// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/feature_group.h"

#include <algorithm>

namespace aquafarm {

float HorizonOf(const Scenario& scenario) {
  std::int32_t horizon = 0;
  for (const DisasterSpec& disaster : scenario.disasters) {
    horizon = std::max(horizon, disaster.duration);
  }
  if (horizon == 0) return static_cast<float>(scenario.step_limit);
  return static_cast<float>(std::min(horizon, scenario.step_limit));
}

}  // namespace aquafarm
