// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where a cell lies in a picture. Images start at the top and the farm at the south-west corner:
/// this is the one place that flips y.
///
///       picture                     farm
///   (0,0)--> column               ^ y (north)
///     |  .-----------.            |  .-----------.
///     v  |  (x, H-1) |   ToPixel  |  | (x, H-1)  |
///    row |  (x, 0)   |  <-------- |  | (x, 0)    |
///        '-----------'            +--'-----------'--> x (east)

#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// Maps cells of a farm of `width` x `height` cells to pixels of a map of the same shape.
class MapView {
 public:
  MapView() = default;
  /// @param cell_px  side of a cell in pixels, above 0; need not be whole.
  MapView(int width, int height, double cell_px)
      : width_(width), height_(height), cell_px_(cell_px) {}

  /// The pixel coordinates of a place given in cells; a cell's centre has whole coordinates.
  cv::Point2d ToPixel(double x, double y) const {
    return {(x + 0.5) * cell_px_ - 0.5, (height_ - 0.5 - y) * cell_px_ - 0.5};
  }

  double cell_px() const { return cell_px_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_{1};
  int height_{1};
  double cell_px_{1.0};
};

}  // namespace aquafarm_viz
