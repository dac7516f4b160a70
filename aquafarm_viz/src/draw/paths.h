// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes and draws the paths of ships on the map; private to this package.

#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "aquafarm_viz/scene/trail.h"

namespace aquafarm_viz {

struct Layout;

/// One move of a ship on the map.
struct Moved {
  cv::Point2d from;  ///< [pixels]
  cv::Point2d to;
  bool is_dashed{};  ///< the ship had nothing aboard
  double age{};      ///< in (0, 1): lowest for the newest move, highest for the oldest
};

/// Returns the index of the cell of a trail at which the drawn part begins. It is 0 if there is
/// only one ship, or if the episode has ended. Else it is the cell of the last drop-off of the ship
/// (0 before its first drop-off), because all trips of all ships would hide each other.
std::size_t DrawnFrom(const aquafarm_msgs::FarmState& state, const ShipTrail& way);

/// Returns the moves of a ship that are drawn (DrawnFrom), the oldest first. They run to the right
/// of the cells' centres, so that moves in opposite directions do not cover each other. At a sharp
/// turn, an additional short move joins the ends of the two moves. If there are several ships,
/// their paths have different distances from the centres.
std::vector<Moved> MovesOf(const aquafarm_msgs::FarmState& state, std::int32_t ship,
                           const ShipTrail& way, const Layout& layout);

/// Draws the trails or routes of the ships (MovesOf). Older parts have a colour that is closer to
/// that of the sea. Moves of a rescue ship with nothing aboard are dashed.
void DrawPaths(cv::Mat& map, const aquafarm_msgs::FarmState& state, const Trail& paths,
               const Layout& layout);

/// Draws a short line that looks like a path, for the legend.
void DrawPathSample(cv::Mat& image, cv::Point2d from, cv::Point2d to, bool is_dashed,
                    const aquafarm_msgs::FarmState& state, const Layout& layout);

}  // namespace aquafarm_viz
