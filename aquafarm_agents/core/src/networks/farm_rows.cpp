// SPDX-License-Identifier: BSD-3-Clause
#include "networks/farm_rows.h"

#include <algorithm>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network) {
  const EnvironmentSpec& own = checkpoint.spec;
  const auto compare = [&](const std::string& what, std::int32_t got, std::int32_t expected) {
    CheckFit(checkpoint, spec, what, got, expected);
  };
  compare("agents", own.agents, spec.agents);
  if (network != NetworkKind::kCnn) return CheckFeaturesFit(checkpoint, spec);
  compare("planes", own.plane_count, spec.plane_count);
  compare("width", own.width, spec.width);
  compare("height", own.height, spec.height);
}

void CheckFeaturesFit(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  const EnvironmentSpec& own = checkpoint.spec;
  CheckFit(checkpoint, spec, "features", own.feature_count, spec.feature_count);
  const auto [mine, theirs] = std::mismatch(own.feature_names.begin(), own.feature_names.end(),
                                            spec.feature_names.begin(), spec.feature_names.end());
  if (mine == own.feature_names.end() || theirs == spec.feature_names.end()) return;
  const auto number = mine - own.feature_names.begin();
  CheckFit(checkpoint, spec, "feature " + std::to_string(number), *mine, *theirs);
}

}  // namespace aquafarm::agents
