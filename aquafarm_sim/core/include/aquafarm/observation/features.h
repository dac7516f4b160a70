// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The feature vector of a ship as a table of groups. Only this table defines the order, the names
/// and the number of the features. Encoder writes the groups in the order of the table.

#include <string>
#include <vector>

#include "aquafarm/observation/feature_group.h"

namespace aquafarm {

/// Returns the scales of a scenario's features.
FeatureScales ScalesOf(const Scenario& scenario);

/// Returns the groups of a scenario's features, in order. Groups without features are left out.
std::vector<FeatureGroup> FeatureGroups(const Scenario& scenario);

}  // namespace aquafarm
