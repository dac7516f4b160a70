// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/scenario.h"

#include <algorithm>

namespace aquafarm {

GradeRisks RisksByGrade(const DisasterSpec& disaster) {
  GradeRisks risks = disaster.grade_risks;
  if (!risks.empty()) return risks;
  for (const float factor : disaster.grade_factors) {
    std::vector<float>& row = risks.emplace_back(disaster.risks);
    for (float& risk : row) risk = std::clamp(risk * factor, kWorstRisk, kMildestRisk);
  }
  return risks;
}

std::int32_t Scenario::SelfPropelledCount() const {
  if (devices.placement != DevicePlacement::kExplicit) return devices.self_propelled;
  return static_cast<std::int32_t>(
      std::count_if(devices.sites.begin(), devices.sites.end(),
                    [](const DeviceSite& site) { return site.self_propelled; }));
}

}  // namespace aquafarm
