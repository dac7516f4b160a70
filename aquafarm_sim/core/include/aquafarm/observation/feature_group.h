// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Consecutive features and their scales, for features.h and tokens.h.

#include <string>
#include <vector>

#include "aquafarm/observation/view.h"

namespace aquafarm {

inline constexpr float kValueScale = 1.0F / 100.0F;  ///< 1 / max device value of the paper

/// Factors that scale features to about [-1, 1].
struct FeatureScales {
  float length{};  ///< 1 / longer side [1/cells]
  float time{};    ///< max length of an episode [steps]
  /// 1 / energy of a ship that moves straight, without load and in calm water, for that time
  /// [1/kWh]; 0 without energy
  float energy{};
};

/// Consecutive features that one function writes.
struct FeatureGroup {
  std::string name;                ///< of the group, for messages
  std::vector<std::string> names;  ///< of its features, in order; their number is the group's count
  /// Writes the values. @param out [names.size()]
  void (*write)(const FeatureScales& scales, const View& view, float* out){};
};

/// Returns the max length of an episode [steps].
float HorizonOf(const Scenario& scenario);

}  // namespace aquafarm
