// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Finds places for labels that cover neither symbols nor other labels; private to this package.

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace aquafarm_viz {

/// Returns the square around a point.
inline cv::Rect Around(cv::Point2d at, double radius) {
  return {cvFloor(at.x - radius), cvFloor(at.y - radius), cvCeil(2.0 * radius),
          cvCeil(2.0 * radius)};
}

/// Returns the point of a rectangle that is nearest to another point.
inline cv::Point2d NearestIn(cv::Rect box, cv::Point2d to) {
  return {std::clamp(to.x, double(box.x), double(box.br().x)),
          std::clamp(to.y, double(box.y), double(box.br().y))};
}

/// The part of a map that is still free of symbols and labels.
class FreeSpace {
 public:
  /// @param size of the map [pixels]
  explicit FreeSpace(cv::Size size);

  // A copy has its own pixels; copies of cv::Mat share them.
  FreeSpace(const FreeSpace& other)
      : used_(other.used_.clone()), labels_(other.labels_), size_(other.size_) {}
  FreeSpace& operator=(const FreeSpace&) = delete;
  FreeSpace(FreeSpace&&) = default;
  FreeSpace& operator=(FreeSpace&&) = default;
  ~FreeSpace() = default;

  /// Marks a part of the map as used. Parts outside the map are ignored.
  void Block(cv::Rect part);

  /// Marks the pixels of a line as used, `width` wide.
  void BlockLine(cv::Point2d from, cv::Point2d to, int width);

  /// Returns whether nothing uses a part of the map. Parts outside the map are not free.
  bool IsFree(cv::Rect part) const;

  /// Returns whether a line crosses a label that Add or Take has added, except `own`.
  bool CrossesLabel(cv::Point2d from, cv::Point2d to, cv::Rect own) const;

  /// Finds the free rectangle of a size that is nearest to a point.
  /// @param near       the middle of the result is as near as possible to it [pixels]
  /// @param farthest   max distance of the middles [pixels]
  /// @return nullopt if all rectangles within reach are used
  std::optional<cv::Rect> Find(cv::Size size, cv::Point2d near, double farthest) const;
  /// Marks the rectangle of a label, with a margin, as used.
  void Add(cv::Rect label);
  /// Finds a rectangle and adds it.
  std::optional<cv::Rect> Take(cv::Size size, cv::Point2d near, double farthest);

 private:
  // Returns the cells of `used_` that a part of the map touches.
  cv::Rect Blocks(cv::Rect part) const;

  static constexpr int kBlock = 3;  // pixels of a side of a cell of `used_`
  cv::Mat1b used_;                  // 1: used, one entry per kBlock x kBlock pixels
  std::vector<cv::Rect> labels_;    // added by Add
  cv::Size size_;
};

}  // namespace aquafarm_viz
