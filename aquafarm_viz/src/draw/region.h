// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws the inset with the region around the farm: disasters, rings and courses; private to this
/// package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scene/coast.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// The heading above the inset and two lines below it.
struct RegionWords {
  std::string heading{"REGION"};
  std::array<std::string, 2> lines;
  bool is_urgent{};  ///< true: no ring covers a part of the farm now, but one will later
};

/// Returns the words about the most urgent disaster: the disaster whose ring is the first to cover
/// a part of the farm. If several disasters are equal in this, or no ring will cover a part of the
/// farm, a disaster that comes nearer precedes one that does not. If they are still equal, the
/// disaster with the nearest closest approach is chosen. Therefore "MOVING AWAY" also means that no
/// ring of any disaster will cover a part of the farm along the courses, and that no disaster comes
/// nearer.
/// @param courses  one per disaster of the state, see CourseOf
RegionWords RegionText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const std::vector<Course>& courses);

/// Draws the heading of RegionText, below it the inset, and below the inset the lines of
/// RegionText. The inset is a map of the region around the farm with its coasts, and with the
/// centre, the rings and the course of each disaster (IsDrawn). Some parts are left out:
/// - the coasts, if the inset is less than 300 km wide, because they are not exact enough for it;
/// - the inset, if no centre is outside the farm, or if `room` is too small for the inset;
/// - the lines, if they do not fit in addition to the inset, unless they describe a course that is
///   not extrapolated, or the arrival of a ring;
/// - everything, if `room` has less than three rows;
/// - everything, if the inset is left out and either there is no disaster or the course of the most
///   urgent disaster is extrapolated.
/// @param room  the part of the image that may be used [pixels]
/// @param courses  one per disaster of the state, see CourseOf
/// @param coast  CoastAround of the farm
void DrawRegion(cv::Mat& image, cv::Rect room, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                const std::vector<CoastRing>& coast, const Layout& layout, const Fonts& fonts);

/// Returns whether a disaster has its centre outside the farm (IsDrawn), so that an inset is drawn.
bool HasRegion(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state);

/// Draws the inset in the left part of an image that is wide and low, and the heading and the lines
/// of RegionText in the right part. Draws nothing if HasRegion is false.
void DrawWideRegion(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
                    const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses,
                    const std::vector<CoastRing>& coast, const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
