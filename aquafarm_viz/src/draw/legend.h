// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend at the bottom of the panel. From top to bottom: the key of risks, the key of signs,
/// symbols, and the north arrow with the scale bar. Private to this package.

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

/// A ring whose wind is given.
struct NamedRing {
  std::int32_t wind_kt{};  ///< min wind within the ring [kn]
  double risk{};           ///< rounded risk within the ring
  std::uint8_t kind{};     ///< kind of the storm (DisasterState.kind)
};

/// The rings that the key of risks names. An empty list: the key shows the risks of all rings
/// without names.
using RiskKey = std::vector<NamedRing>;

/// Returns the rings that have a radius now or later, of all drawn disasters. The rings of one
/// disaster are in order, the weakest first. Equal rings of several disasters are listed once.
/// Returns an empty key if a drawn disaster has no given winds, or if there are more than four
/// rings.
RiskKey MakeRiskKey(const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses);

/// Returns the name of a ring and its wind, "hurricane force (64 kt)". If that is wider than
/// `width_px`, shortens the name to its first word, "hurricane (64 kt)".
std::string FittingRingName(std::int32_t wind_kt, int width_px, const Font& font);

/// A symbol of the map that the key of signs explains.
enum class Sign {
  kAtRisk,        ///< pattern of the rings, unless the key of risks shows it
  kInDanger,      ///< circle around a device in danger, in the colour of its worst ring
  kFirstReached,  ///< two circles around a device that is the first in danger
  kDelivered,     ///< small device at a port
  kFetched,       ///< outline in the former cell of a fetched device
  kPath,          ///< path of a self-propelled device
  kLoadedPath,    ///< path of a rescue ship with a device aboard
  kEmptyPath,     ///< path of a rescue ship with nothing aboard
  kHeading,       ///< arrow along the motion of a disaster
  kPointer,       ///< triangle towards a centre outside the map
  kDirection,     ///< arrow of a legal move at a port
  kSight          ///< sensor range of a ship
};

/// Returns the signs that a picture contains, each once.
/// @param key  key of risks; if it is not empty, it shows the patterns, and kAtRisk is left out
std::vector<Sign> SignsOf(const aquafarm_msgs::FarmSpec& spec,
                          const aquafarm_msgs::FarmState& state, const Overlays& overlays,
                          const Outlook& outlook, const RiskKey& key, const Layout& layout);

/// Returns the text of a sign in the key.
const char* SignWords(Sign sign);

/// Returns the number of columns that a sign takes in the key.
int SignSpan(Sign sign);

/// Returns the height of the whole legend [pixels].
int LegendPx(const RiskKey& key, const std::vector<Sign>& signs, const Layout& layout);

/// Draws the constant part of the legend: symbols, north arrow and scale bar.
void DrawLegend(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                const Fonts& fonts);

/// Draws the key of signs above the constant part.
void DrawSigns(cv::Mat& image, const std::vector<Sign>& signs,
               const aquafarm_msgs::FarmState& state, const Layout& layout, const Fonts& fonts);

/// Returns the rings of all drawn disasters that have a radius now or later, without their winds,
/// the mildest first. Of several rings with the same rounded risk, the first is listed.
RiskKey RingsWithoutNames(const aquafarm_msgs::FarmState& state,
                          const std::vector<Course>& courses);

/// Draws the key of risks above the key of signs. With an empty key it shows the rings `unnamed` in
/// one row, or the colour scale of all risks if there are none or more than four.
void DrawRiskKey(cv::Mat& image, const RiskKey& key, const RiskKey& unnamed,
                 const std::vector<Sign>& signs, const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
