// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/scenario.h"

#include <algorithm>

namespace aquafarm {

std::int32_t Scenario::SelfPropelledCount() const {
  if (devices.placement != DevicePlacement::kExplicit) return devices.self_propelled;
  return static_cast<std::int32_t>(
      std::count_if(devices.sites.begin(), devices.sites.end(),
                    [](const DeviceSite& site) { return site.self_propelled; }));
}

}  // namespace aquafarm
