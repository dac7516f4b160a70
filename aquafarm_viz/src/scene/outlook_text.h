// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Formats an outlook, and the position and motion of a disaster, as text; private to this package.

#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/outlook.h"
#include "scene/storm_track.h"

namespace aquafarm_viz {

/// Returns a time ahead: "48 min", "6.5 h" or "12 h"; "12 steps" if the steps of the farm have no
/// duration.
std::string AheadText(const aquafarm_msgs::FarmSpec& spec, double steps);

/// Returns the outlook in one sentence: the ring that covers the most urgent device now and all
/// devices in that ring, the next ring that reaches any device, and the worst ring to come.
/// Examples: "typhoon: risk -10 reaches F3 in 6.5 h" and "typhoon: risk -5 over F2 now, risk -20
/// in 6.5 h". If the winds of the rings are given: "typhoon In-Fa: gale over F0 and F1 now, gale
/// reaches F5 in 8 min, storm reaches F0 in 6.5 h". If the scenario has a start time, the local
/// time follows the next and the worst arrival, unless the arrival is less than an hour away. Only
/// the first local time in the sentence has its time zone.
///
/// If no worse ring comes, the devices that the same ring reaches later follow: "typhoon: near
/// gale reaches F0 and F1 in 2.0 h, F2 in 2.2 h".
///
/// If no ring covers or reaches a device, the text contains the nearest ring (Outlook::miss) and
/// the time until which the courses are known: "typhoon: risk -5 is 900 m from F2 now; no known
/// danger to devices for the next 3.0 h". A part that does not apply is left out, so the text can
/// be empty. If the farm has devices but none is deployed, the text is "no device is deployed". The
/// text is also empty if the outlook is not known.
std::string OutlookText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                        const Outlook& outlook);

/// Returns a text whose first letter is a capital.
std::string Capitalized(std::string text);

/// Returns the outlook as headlines. Each begins with a capital letter. Empty if ShortOutlookText
/// is empty. The order is:
///
/// 1. OutlookText with the direction of each disaster outside the farm, and OutlookText;
/// 2. the same two without times of day, and with "no danger known for 3.0 h" instead of "no known
///    danger to devices for the next 3.0 h";
/// 3. ShortOutlookText and, without a danger, its form with fewer words: "Risk -5 is 900 m from F2
///    now; no danger known for 3.0 h".
std::vector<std::string> Headlines(const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, const Outlook& outlook);

/// Returns a short form of OutlookText: the danger to the most urgent device, such as "F2: risk -20
/// now". Without a danger, returns OutlookText without the name of the disaster. Returns an empty
/// text if no device is deployed or the outlook is not known.
std::string ShortOutlookText(const aquafarm_msgs::FarmSpec& spec, const Outlook& outlook);

/// Returns whether a ring covers or reaches a device at the same time as the most urgent device,
/// with the same risk. Times are the same if AheadText returns the same text for them. Returns
/// false if this applies to all devices in danger, because none of them is then ahead of the
/// others.
bool IsHitFirst(const aquafarm_msgs::FarmSpec& spec, const Outlook& outlook,
                const DeviceOutlook& device);

/// Returns whether IsHitFirst is true for any device.
bool HasHitFirst(const aquafarm_msgs::FarmSpec& spec, const Outlook& outlook);

/// A ring in a text about the danger to a device.
struct DangerPart {
  std::string text;  ///< "storm in 6.5 h"
  double risk{};     ///< risk within the ring
};
using DangerParts = std::vector<DangerPart>;

/// Returns the danger to a device: the ring that covers it now, the next worse ring and the worst
/// ring to come. Examples: "risk -10 in 6.5 h", "risk -5 now", "-20 in 6.5 h". If the winds of the
/// rings are given: "gale now", "storm in 6.5 h", "hurricane force in 9.0 h". Empty if no ring
/// covers or reaches the device.
/// @param is_brief  true: the wind replaces "hurricane force", "64 kt in 9.0 h"
DangerParts PartsOf(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device,
                    bool is_brief);

/// Returns parts with commas between them.
std::string Joined(const DangerParts& parts);

/// Returns all PartsOf as one text: "gale now, storm in 6.5 h, hurricane force in 9.0 h".
std::string DangerText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns the first part of PartsOf and the worst ring to come: "gale now, storm in 9.0 h". With
/// two parts, the wind replaces "hurricane force": "gale now, 64 kt in 9.0 h".
std::string FirstAndWorstText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns a row about a device: its label, with its kind if there is space, and its danger. Tries
/// forms of the danger from the longest to the shortest until `fits` accepts both texts. If `fits`
/// accepts none, returns the label and the worst risk.
/// @param kind  DeviceName of the device
std::pair<std::string, DangerParts> NameAndDanger(
    const aquafarm_msgs::FarmSpec& spec, const std::string& kind, const DeviceOutlook& device,
    const std::function<bool(const std::string& name, const std::string& danger)>& fits);

/// Returns the position of the centre of a disaster, relative to the middle of the farm: "typhoon,
/// centre 89 km SE". If its wind is given: "typhoon 37 m/s (72 kt), centre 89 km SE".
std::string CentreText(const aquafarm_msgs::FarmSpec& spec,
                       const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the motion of a disaster: "NW at 13 km/h now", or "stands still". The text has no "now"
/// if the disaster has ended or is out of sight, because the motion is then the last known one.
std::string MotionNow(const aquafarm_msgs::FarmSpec& spec,
                      const aquafarm_msgs::DisasterState& disaster);

/// Returns the closest approach of a disaster: "29 km S in 11 h". Returns "" if its course is
/// extrapolated or does not come nearer. The text is "29 km S in about 11 h" if the course is known
/// only until an earlier step.
std::string ClosestText(const aquafarm_msgs::FarmSpec& spec, const Course& course);

/// Returns MotionNow of a disaster, "NW at 13 km/h now". If its course is not extrapolated and
/// comes nearer, the closest approach follows: "NW at 13 km/h now, closest 29 km S in 11 h".
std::string ApproachText(const aquafarm_msgs::FarmSpec& spec,
                         const aquafarm_msgs::DisasterState& disaster, const Course& course);

}  // namespace aquafarm_viz
