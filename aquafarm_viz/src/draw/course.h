// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws the past and the expected course of a disaster; private to this package.

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

/// Maps a point in cells to pixels of an image.
using ToPixel = std::function<cv::Point2d(double x, double y)>;

/// A mark on a course at a lead time.
struct CourseMark {
  cv::Point2d at;      ///< [pixels]
  std::string text;    ///< such as "+6 h"
  std::string longer;  ///< such as "+6 h 38 m/s", used if it fits at every mark; may be empty
};

/// Draws a course: the past as a solid line, the future as a dashed line with marks at round lead
/// times, and the mean forecast error as a cone. Draws nothing for an extrapolated course.
/// @return the marks, for LabelMarks
std::vector<CourseMark> DrawCourse(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec,
                                   const Course& course, const ToPixel& to_pixel,
                                   const Layout& layout);

/// Blocks the positions of the marks, so that no label covers them.
void BlockMarks(const std::vector<CourseMark>& marks, FreeSpace& space, const Layout& layout);

/// Writes the text of each mark next to the mark, or farther away with a line to the mark. Omits a
/// text if there is no free space for it. Blocks the space of the written texts. Writes `longer`
/// only if it fits at every mark.
void LabelMarks(cv::Mat& image, const std::vector<CourseMark>& marks, FreeSpace& space,
                const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
