// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend below the lists of the panel: the key of risks, symbols, north and scale; private to
/// this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "scene/storm_track.h"

namespace aquafarm_viz {

struct Fonts;
struct Layout;

/// A ring of a storm whose wind is given.
struct NamedRing {
  std::int32_t wind_kt{};
  double risk{};
};

/// The rings that the key of risks names, the weakest first; empty: the scale of all risks.
using RiskKey = std::vector<NamedRing>;

/// Returns the rings of the drawn disasters; empty if one has rings without a given wind, or if
/// there are too many.
RiskKey MakeRiskKey(const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses);

/// Returns the height of the whole legend [pixels].
int LegendPx(const RiskKey& key, const Layout& layout);

/// Draws the constant part: symbols, north arrow and scale bar.
void DrawLegend(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                const Fonts& fonts);

/// Draws the key of risks above the constant part.
void DrawRiskKey(cv::Mat& image, const RiskKey& key, const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
