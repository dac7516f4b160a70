// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The feature vector of a ship as a table of groups. The table is the only place that defines the
/// order, the names and the number of the features; Encoder writes one group after the other.

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

/// Returns the scales of a scenario's features.
FeatureScales ScalesOf(const Scenario& scenario);

/// Returns the groups of a scenario's features, in order. Groups without features are left out.
std::vector<FeatureGroup> FeatureGroups(const Scenario& scenario);

}  // namespace aquafarm
