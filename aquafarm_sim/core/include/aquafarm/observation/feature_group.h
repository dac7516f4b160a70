// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Groups of consecutive features, and the scales of features. features.h and tokens.h use them.

#include <string>
#include <vector>

#include "aquafarm/observation/view.h"

namespace aquafarm {

inline constexpr float kValueScale = 1.0F / 100.0F;  ///< 1 / max device value of the paper

/// Quantities that scale features to about [-1, 1].
struct FeatureScales {
  float length{};  ///< 1 / longer side of the map [1/cells]
  float time{};    ///< HorizonOf(scenario) [steps]
  /// 1 / energy of `time` straight moves without load in calm water [1/kWh]. The moves are those of
  /// a rescue ship, or of a self-propelled device if there is no rescue ship. 0 if the scenario has
  /// no EnergySpec, or if such moves consume no energy.
  float energy{};
};

/// Consecutive features that one function writes.
struct FeatureGroup {
  std::string name;                ///< name of the group, for messages
  std::vector<std::string> names;  ///< names of the features, in order
  /// Writes the values. @param out [names.size()]
  void (*write)(const FeatureScales& scales, const View& view, float* out){};
};

/// Returns the max length of an episode [steps]: the smaller of the step limit and the longest
/// duration of the scenario's disasters; the step limit without disasters. A disaster that is added
/// during an episode may make the episode longer.
float HorizonOf(const Scenario& scenario);

}  // namespace aquafarm
