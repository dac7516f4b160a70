// SPDX-License-Identifier: BSD-3-Clause
#include "networks/farm_rows.h"

#include <algorithm>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {

void CheckFits(const Checkpoint& checkpoint, const EnvironmentSpec& spec, NetworkKind network) {
  const EnvironmentSpec& own = checkpoint.spec;
  const auto refuse = [&](const std::string& what, const std::string& got,
                          const std::string& expected) {
    throw InputError(
        "policy: " + checkpoint.algorithm + " of scenario " + own.scenario_name +
        " does not fit scenario " + spec.scenario_name + ": " + what + ": the policy has " + got +
        ", the farm has " + expected +
        (what == "agents" ? "; give policy:=planner, or policy:=none to hold the ships" : ""));
  };
  const auto compare = [&](const std::string& what, std::int32_t got, std::int32_t expected) {
    if (got != expected) refuse(what, std::to_string(got), std::to_string(expected));
  };
  compare("agents", own.agents, spec.agents);
  if (network == NetworkKind::kCnn) {
    compare("planes", own.plane_count, spec.plane_count);
    compare("width", own.width, spec.width);
    compare("height", own.height, spec.height);
  } else {
    compare("features", own.feature_count, spec.feature_count);
    const auto [mine, theirs] = std::mismatch(own.feature_names.begin(), own.feature_names.end(),
                                              spec.feature_names.begin(), spec.feature_names.end());
    if (mine == own.feature_names.end() || theirs == spec.feature_names.end()) return;
    const auto number = mine - own.feature_names.begin();
    refuse("feature " + std::to_string(number), *mine, *theirs);
  }
}

}  // namespace aquafarm::agents
