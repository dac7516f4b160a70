// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The size of texts around the map in rviz; private to this package.

#include <aquafarm_msgs/FarmSpec.h>

#include <algorithm>

namespace aquafarm_viz {

/// Returns the relative size of texts: 1 on wide farms, up to 1.2 on square and tall farms. The
/// height of the view limits the scale of a square farm. Without this factor its texts would be
/// smaller than those of a wide farm.
inline double TextScale(const aquafarm_msgs::FarmSpec& spec) {
  return std::clamp(0.2 + double(spec.height) / std::max(1, spec.width), 1.0, 1.2);
}

}  // namespace aquafarm_viz
