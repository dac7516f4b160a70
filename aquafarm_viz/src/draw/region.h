// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The inset with the region around the farm: storm, rings and track; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// A position of a disaster's centre: steps since the episode's start, cells.
struct TrackPoint {
  double step{};
  double x{};
  double y{};
};

/// Reads the tracks of a canonical scenario, one for each disaster; empty for a disaster that has
/// none, and for one that draws another storm in each episode. Empty if the text cannot be read.
std::vector<std::vector<TrackPoint>> ReadTracks(const std::string& scenario_yaml);

/// Returns a track's position at a step; at a step outside the track that of the nearest end.
/// @param track  at least one point, steps ascending
TrackPoint TrackAt(const std::vector<TrackPoint>& track, double step);

/// The point of a track at which it is nearest to the middle of a farm, at or after a step.
TrackPoint ClosestApproach(const aquafarm_msgs::FarmSpec& spec,
                           const std::vector<TrackPoint>& track, double from_step);

/// Draws the region around the farm with the centre, rings and track of each disaster whose centre
/// lies outside the farm. Draws nothing if there is none or if `room` is too small. A track is left
/// out where it disagrees with the disaster's position, and where the state is what a ship
/// observes.
void DrawRegion(cv::Mat& image, cv::Rect room, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state,
                const std::vector<std::vector<TrackPoint>>& tracks, const Layout& layout,
                const Fonts& fonts);

}  // namespace aquafarm_viz
