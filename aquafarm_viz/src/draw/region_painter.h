// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include "aquafarm_viz/draw/style.h"

namespace aquafarm_viz {

/// Draws the region around a farm with its disasters and their courses (DrawWideRegion), without
/// the farm's own picture. Private to this package.
class RegionPainter {
 public:
  /// @param style  must outlive the painter
  explicit RegionPainter(const Style& style = DarkStyle());
  ~RegionPainter();

  /// Draws a region. The returned 8-bit BGR picture is valid until the next call.
  /// @param spec, state  must pass CheckSpec and CheckState
  /// @param size  [pixels], at least 1 x 1
  const cv::Mat& Draw(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      cv::Size size);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace aquafarm_viz
