// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Finds places at which labels cover as little of the map as possible; private to this package.

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

/// What a label may cover. kPaths allows the paths of ships, kPathsAndLand also islands and rocks.
/// No label covers symbols or other labels.
enum class Cover : std::uint8_t { kNothing, kPaths, kPathsAndLand };

/// The free space of a map for each Cover.
class LabelSpace {
 public:
  /// @param symbols  the space that symbols leave free, see BlockSymbols
  LabelSpace(const FreeSpace& symbols, const aquafarm_msgs::FarmSpec& spec, const Layout& layout);

  /// Blocks the paths of the ships for labels with Cover::kNothing.
  void BlockPaths(const aquafarm_msgs::FarmState& state, const Trail& paths, const Layout& layout);

  /// Finds the free place that is nearest to a point and blocks it; see FreeSpace::Find.
  std::optional<cv::Rect> Take(Cover cover, cv::Size size, cv::Point2d near, double farthest);
  /// Does the same with the first Cover that has a free place within reach.
  std::optional<cv::Rect> Take(cv::Size size, cv::Point2d near, double farthest);

  /// Returns the free space, for a caller that has other conditions for a place.
  const FreeSpace& space(Cover cover) const { return spaces_[std::size_t(cover)]; }
  /// Blocks a place for all later labels.
  void Add(cv::Rect place);

  /// Blocks a line between a symbol and its label. Returns false and blocks nothing if the line
  /// crosses another label.
  bool AddLine(cv::Point2d from, cv::Point2d to, cv::Rect label, int width);

 private:
  std::array<FreeSpace, 3> spaces_;  // by Cover
};

}  // namespace aquafarm_viz
