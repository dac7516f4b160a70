// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The inset with the region around the farm: storm, rings and track; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <opencv2/core.hpp>
#include <vector>

#include "scene/storm_track.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// Draws the region around the farm with the centre, rings and course of each disaster, and writes
/// the closest approach below. Draws no map if no centre is far outside the farm or if `room` is
/// too small, and nothing if no course is known either.
/// @param courses  one per disaster of the state, see CourseOf
void DrawRegion(cv::Mat& image, cv::Rect room, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
