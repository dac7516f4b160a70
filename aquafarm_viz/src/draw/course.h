// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws where a disaster came from and where it goes; private to this package.

#include <aquafarm_msgs/FarmSpec.h>

#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scene/storm_track.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;
class FreeSpace;

/// Maps a point [cells] to a pixel.
using ToPixel = std::function<cv::Point2d(double x, double y)>;

/// A mark on the way ahead.
struct CourseMark {
  cv::Point2d at;      ///< [pixels]
  std::string text;    ///< such as "+6 h"
  std::string longer;  ///< such as "+6 h 38 m/s", used if there is space for it; may be empty
};

/// Draws a course: the past as a solid line, the way ahead dashed with marks at round hours and
/// winds, and the mean forecast error as a cone. Draws nothing for an extrapolated course.
/// @return the marks, for labels
std::vector<CourseMark> DrawCourse(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
                                   const Course& course, const ToPixel& to_pixel,
                                   const Layout& layout);

/// Keeps the places of marks free of labels.
void BlockMarks(const std::vector<CourseMark>& marks, FreeSpace& space, const Layout& layout);

/// Labels marks of a course where there is free space.
void LabelMarks(cv::Mat& image, const std::vector<CourseMark>& marks, FreeSpace& space,
                const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
