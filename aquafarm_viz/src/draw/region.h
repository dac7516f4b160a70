// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The inset with the region around the farm: storm, rings and track; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scene/storm_track.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// The heading above the inset and two lines below it.
struct RegionWords {
  std::string heading{"REGION"};
  std::array<std::string, 2> lines;
  bool is_urgent{};  ///< a ring reaches the farm later
};

/// Returns the words for the disaster whose ring is first over the farm; if none ever is, for one
/// that comes nearer, else for the nearest. "MOVING AWAY" means that no ring of any disaster covers
/// a part of the farm along its course, that none comes nearer, and that this one moves away.
/// @param courses  one per disaster of the state, see CourseOf
RegionWords RegionText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const std::vector<Course>& courses);

/// Draws the region around the farm with the centre, rings and course of each disaster, and writes
/// the closest approach below. Draws no map if no centre is far outside the farm or if `room` is
/// too small, and nothing if no course is known either.
/// @param courses  one per disaster of the state, see CourseOf
void DrawRegion(cv::Mat& image, cv::Rect room, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
