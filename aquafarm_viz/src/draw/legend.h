// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend below the lists of the panel: the keys of risks and signs, symbols, north and scale;
/// private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "scene/outlook.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {

class Font;
struct Fonts;
struct Layout;
struct Overlays;

/// A ring of a storm whose wind is given.
struct NamedRing {
  std::int32_t wind_kt{};
  double risk{};
  std::uint8_t kind{};  ///< of the storm, a kind of DisasterState
};

/// The rings that the key of risks names, the weakest first; empty: the scale of all risks.
using RiskKey = std::vector<NamedRing>;

/// Returns the rings of the drawn disasters; empty if one has rings without a given wind, or if
/// there are too many.
RiskKey MakeRiskKey(const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses);

/// Returns the name of a ring and its wind, without the name's further words if they do not fit:
/// "hurricane force (64 kt)" or "hurricane (64 kt)".
std::string FittingRingName(std::int32_t wind_kt, int width_px, const Font& font);

/// A symbol of the map that the lists of the panel do not explain.
enum class Sign {
  kAtRisk,        ///< pattern of the rings, unless the key of risks shows it
  kInDanger,      ///< ring around a device
  kFirstReached,  ///< two rings around a device
  kDelivered,     ///< small device at a port
  kFetched,       ///< outline where a fetched device was
  kPath,          ///< of a ship
  kHeading,       ///< arrow of a disaster
  kPointer,       ///< triangle towards a centre outside the map
  kDirection,     ///< arrow at a port
  kSight
};

/// Returns the signs that a picture shows, each once.
/// @param key  of the picture; if it is not empty, it shows the patterns of areas at risk
std::vector<Sign> SignsOf(const aquafarm_msgs::FarmSpec& spec,
                          const aquafarm_msgs::FarmState& state, const Overlays& overlays,
                          const Outlook& outlook, const RiskKey& key, const Layout& layout);

/// Returns the words of a sign in the key.
const char* SignWords(Sign sign);

/// Returns the height of the whole legend [pixels].
int LegendPx(const RiskKey& key, const std::vector<Sign>& signs, const Layout& layout);

/// Draws the constant part: symbols, north arrow and scale bar.
void DrawLegend(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                const Fonts& fonts);

/// Draws the key of signs above the constant part.
void DrawSigns(cv::Mat& image, const std::vector<Sign>& signs,
               const aquafarm_msgs::FarmState& state, const Layout& layout, const Fonts& fonts);

/// Draws the key of risks above the key of signs.
void DrawRiskKey(cv::Mat& image, const RiskKey& key, const std::vector<Sign>& signs,
                 const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
