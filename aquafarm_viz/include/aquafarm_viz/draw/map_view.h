// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Maps cells to pixels. The origin of an image is its top left pixel. The origin of the farm is
/// the centre of its south-west cell. Rows of the image are numbered from north to south, but the y
/// axis of the farm points north. In the diagram, H is the height of the farm in cells.
///
///       picture                     farm
///   (0,0)--> column               ^ y (north)
///     |  .-----------.            |  .-----------.
///     v  |  (x, H-1) |   ToPixel  |  | (x, H-1)  |
///    row |  (x, 0)   |  <-------- |  | (x, 0)    |
///        '-----------'            +--'-----------'--> x (east)

#include <opencv2/core/types.hpp>

namespace aquafarm_viz {

/// Maps cells of a farm of `width` x `height` cells to pixels of a map with the same aspect
/// ratio.
class MapView {
 public:
  MapView() = default;
  /// @param cell_px  side length of a cell [pixels], above 0; may be fractional
  MapView(int width, int height, double cell_px)
      : width_(width), height_(height), cell_px_(cell_px) {}

  /// Converts a point in cells to pixels. Integer coordinates in cells are centres of cells, and
  /// integer coordinates in pixels are centres of pixels.
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
