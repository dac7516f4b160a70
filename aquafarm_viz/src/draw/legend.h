// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The legend at the bottom of the panel, or below the map if that has space (Layout::key). It
/// consists of the key of risks, the key of signs, and the north arrow with the scale bar. Private
/// to this package.

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

/// A ring of a disaster in the key of risks.
struct KeyRing {
  std::int32_t wind_kt{};  ///< min wind within the ring [kn]; 0: not given
  double risk{};           ///< rounded risk within the ring
  std::uint8_t kind{};     ///< kind of the disaster (DisasterState.kind)
};

/// The rings that the key of risks shows. If the list is empty, the key shows the colours of all
/// risks.
using RiskKey = std::vector<KeyRing>;

/// Returns the rings that have a radius now or later, of all drawn disasters, each once. If every
/// drawn disaster has given winds and there are at most four rings, the rings have their winds; the
/// rings of one disaster are in order, the weakest first. Else the rings have no winds, those with
/// the same rounded risk are listed once, and the mildest is first. Returns an empty key if these
/// are more than four.
RiskKey MakeRiskKey(const aquafarm_msgs::FarmState& state, const std::vector<Course>& courses);

/// Returns the name of a ring and its wind, "hurricane force (64 kt)". If that is wider than
/// `width_px`, shortens the name to its first word, "hurricane (64 kt)".
std::string FittingRingName(std::int32_t wind_kt, int width_px, const Font& font);

/// A symbol of the map that the key of signs explains.
enum class Sign {
  kAtRisk,        ///< pattern of the rings, unless the key of risks shows it
  kInDanger,      ///< circle around a device in danger, in the colour of its worst ring
  kFirstReached,  ///< two circles around a device that is hit first
  kDelivered,     ///< small device at a port
  kFetched,       ///< outline in the former cell of a fetched device
  kPath,          ///< path of a self-propelled device
  kLoadedPath,    ///< path of a rescue ship with a device aboard
  kEmptyPath,     ///< path of a rescue ship with nothing aboard
  kHeading,       ///< arrow along the motion of a disaster
  kPointer,       ///< triangle towards a centre outside the map
  kDirection,     ///< arrow of a legal move at a port
  kSight,         ///< sensor range of a ship
  kPort,          ///< circle of a port
  kRock,          ///< rock
  kHealth         ///< bar above a device: its health
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

/// Returns whether the picture has a legend: it has a panel, or space for the legend below the map.
bool HasLegend(const Layout& layout);

/// Returns the height of the whole legend in the panel [pixels]; 0 if the legend is below the map.
/// @param key  If it is null, there is no key of risks.
int LegendPx(const RiskKey* key, const std::vector<Sign>& signs, const Layout& layout);

/// Draws the constant part of the legend: north arrow and scale bar.
void DrawLegend(cv::Mat& image, const aquafarm_msgs::FarmSpec& spec, const Layout& layout,
                const Fonts& fonts);

/// Draws the key of risks and, below it, the key of signs. In the panel they have a heading. Rings
/// with winds have a row each in the panel, others are in one row. If the key of risks is empty,
/// draws the colour scale of all risks instead.
/// @param key  If it is null, there is no key of risks.
/// @param is_filled  see DrawRiskSample
void DrawKeys(cv::Mat& image, const RiskKey* key, bool is_filled, const std::vector<Sign>& signs,
              const aquafarm_msgs::FarmState& state, const Layout& layout, const Fonts& fonts);

}  // namespace aquafarm_viz
