// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The coasts of the region around a farm (data/README.md); private to this package.

#include <aquafarm_msgs/FarmSpec.h>

#include <opencv2/core.hpp>
#include <vector>

namespace aquafarm_viz {

/// The closed outline of an area of land.
struct CoastRing {
  std::vector<cv::Point2d> corners;  ///< [cells], at least 3
  cv::Rect2d box;                    ///< contains all corners [cells]
};

/// Returns the land within about 60 degrees of arc of a farm. If a ring extends farther, straight
/// lines replace the part beyond this distance. Empty if HasGraticule (graticule.h) is false.
std::vector<CoastRing> CoastAround(const aquafarm_msgs::FarmSpec& spec);

}  // namespace aquafarm_viz
