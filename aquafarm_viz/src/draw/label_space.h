// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Places for the labels of a map, which cover as little as possible; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "aquafarm_viz/scene/trail.h"
#include "draw/free_space.h"

namespace aquafarm_viz {

struct Layout;

/// What a label may cover. It never covers symbols or other labels.
enum class Cover : std::uint8_t { kNothing, kPaths, kPathsAndLand };

/// The free space of a map for each Cover.
class LabelSpace {
 public:
  /// @param symbols  the space that the symbols leave (BlockSymbols)
  LabelSpace(const FreeSpace& symbols, const aquafarm_msgs::FarmSpec& spec, const Layout& layout);

  /// Blocks the paths of the ships for labels that may cover nothing.
  void BlockPaths(const aquafarm_msgs::FarmState& state, const Trail& paths, const Layout& layout);

  /// Finds and blocks a place, as FreeSpace::Take.
  std::optional<cv::Rect> Take(Cover cover, cv::Size size, cv::Point2d near, double farthest);
  /// The same with the first Cover that has a place within reach.
  std::optional<cv::Rect> Take(cv::Size size, cv::Point2d near, double farthest);

  /// Returns the free space, for a caller with further conditions.
  const FreeSpace& space(Cover cover) const { return spaces_[std::size_t(cover)]; }
  /// Blocks a place that was found in space().
  void Add(cv::Rect place);

  /// Blocks a line to a label. Returns false, and blocks nothing, if it would cross another label.
  bool AddLine(cv::Point2d from, cv::Point2d to, cv::Rect label, int width);

 private:
  std::array<FreeSpace, 3> spaces_;  // by Cover
};

}  // namespace aquafarm_viz
