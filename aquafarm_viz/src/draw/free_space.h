// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Finds positions at which labels cover neither symbols nor other labels; private to this package.

#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace aquafarm_viz {

/// Returns the square with sides of 2 * radius around a point.
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
  /// Everything is free at first. @param size  size of the map [pixels]
  explicit FreeSpace(cv::Size size);

  // Clones `used_`, because copies of a cv::Mat share their data.
  FreeSpace(const FreeSpace& other)
      : used_(other.used_.clone()), labels_(other.labels_), size_(other.size_) {}
  FreeSpace& operator=(const FreeSpace&) = delete;
  FreeSpace(FreeSpace&&) = default;
  FreeSpace& operator=(FreeSpace&&) = default;
  ~FreeSpace() = default;

  /// Marks a rectangle as used. Its part outside the map is ignored.
  void Block(cv::Rect part);

  /// Marks squares along a line as used, at most 501 of them. If the line is longer than 500
  /// widths, parts between the squares therefore stay free.
  /// @param width  width of the line [pixels]
  void BlockLine(cv::Point2d from, cv::Point2d to, int width);

  /// Returns whether a whole rectangle is on the map and free.
  bool IsFree(cv::Rect part) const;

  /// Returns whether a line crosses a label that was added with Add or Take and is not `own`.
  bool CrossesLabel(cv::Point2d from, cv::Point2d to, cv::Rect own) const;

  /// Finds the free rectangle of the given size whose middle is nearest to a point. Tries middles
  /// that are 3 pixels apart.
  /// @param near       the point [pixels]
  /// @param farthest   the distance of the middle from the point must be below this [pixels]
  /// @return nullopt if no rectangle within this distance is free
  std::optional<cv::Rect> Find(cv::Size size, cv::Point2d near, double farthest) const;
  /// Marks the rectangle of a label, with a margin, as used.
  void Add(cv::Rect label);
  /// Calls Find. Calls Add if a rectangle was found.
  std::optional<cv::Rect> Take(cv::Size size, cv::Point2d near, double farthest);

 private:
  // Returns the entries of `used_` that a rectangle of the map touches.
  cv::Rect Blocks(cv::Rect part) const;

  static constexpr int kBlock = 3;  // an entry of `used_` is a square with this side [pixels]
  cv::Mat1b used_;                  // 1: used
  std::vector<cv::Rect> labels_;    // added with Add
  cv::Size size_;
};

}  // namespace aquafarm_viz
