// SPDX-License-Identifier: BSD-3-Clause
#include "deep_policy.h"

#include "aquafarm/check.h"

namespace aquafarm::agents {

void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network) {
  const EnvironmentSpec& own = checkpoint.spec;
  const auto compare = [&](const std::string& what, std::int32_t got, std::int32_t expected) {
    if (got == expected) return;
    throw InputError("policy: " + checkpoint.algorithm + " of scenario " + own.scenario_name +
                     " does not fit scenario " + spec.scenario_name + ": " + what + ": it knows " +
                     std::to_string(got) + ", the farm has " + std::to_string(expected));
  };
  compare("agents", own.agents, spec.agents);
  if (network == NetworkKind::kCnn) {
    compare("planes", own.plane_count, spec.plane_count);
    compare("width", own.width, spec.width);
    compare("height", own.height, spec.height);
  } else {
    compare("features", own.feature_count, spec.feature_count);
  }
}

}  // namespace aquafarm::agents
