// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Groups of consecutive features, and the scales of features, for features.h and tokens.h.

#include <string>
#include <vector>

#include "aquafarm/observation/view.h"

namespace aquafarm {

inline constexpr float kValueScale = 1.0F / 100.0F;  ///< 1 / max device value of the paper

/// Factors that scale features to about [-1, 1].
struct FeatureScales {
  float length{};  ///< 1 / longer side of the map [1/cells]
  float time{};    ///< HorizonOf(scenario) [steps]
  /// 1 / energy that a ship without load consumes if it moves straight in calm water for `time`
  /// [1/kWh]; 0 if the scenario has no energy.
  float energy{};
};

/// Consecutive features that one function writes.
struct FeatureGroup {
  std::string name;                ///< name of the group, for messages
  std::vector<std::string> names;  ///< names of the features, in order
  /// Writes the values. @param out [names.size()]
  void (*write)(const FeatureScales& scales, const View& view, float* out){};
};

/// Returns the max length of an episode [steps]: the step limit, or the longest duration of the
/// scenario's disasters if that is shorter. A disaster set during an episode may extend it.
float HorizonOf(const Scenario& scenario);

}  // namespace aquafarm
