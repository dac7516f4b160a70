// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes which rings of disasters reach which devices and when, and formats that as text;
/// private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "scene/storm_track.h"

namespace aquafarm_viz {

/// The arrival of a ring at a device.
struct RingArrival {
  double steps{};          ///< steps from now, above 0
  double risk{};           ///< risk within the ring, below 0
  std::size_t disaster{};  ///< index in FarmState.disasters
  std::int32_t wind_kt{};  ///< min wind within the ring [kn]; 0: not given
};

/// The danger to one deployed device.
struct DeviceOutlook {
  std::int32_t id{};
  double risk_now{};                  ///< risk at its cell; 0 outside all rings
  std::size_t disaster_now{};         ///< index of the disaster with this risk; 0 outside all rings
  std::int32_t wind_now_kt{};         ///< min wind within that ring [kn]; 0: not given
  std::vector<RingArrival> arrivals;  ///< by time; each is worse than those before and now
};

/// The danger to all deployed devices.
struct Outlook {
  bool is_known{};                 ///< false: not computed, because there are too many devices
  bool is_extrapolated{};          ///< true: at least one course is extrapolated (Course::Kind)
  std::vector<std::string> names;  ///< names of the disasters of the state, see NameNow
  /// Steps from now until which all courses are known; infinite if they are known until the
  /// disasters end.
  double known_until{std::numeric_limits<double>::infinity()};
  /// Deployed devices inside the grid, the most urgent first: by the time at which the first ring
  /// covers them, then by the risk in that ring, by the next arrival, and by the worst risk.
  std::vector<DeviceOutlook> devices;
};

/// Computes the outlook along the courses of the known disasters that have not ended, at most 1000
/// steps ahead.
/// @param courses  one per disaster of the state, see CourseOf
Outlook ComputeOutlook(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const std::vector<Course>& courses);

/// Returns when a ring of a disaster first covers a part of the farm [steps from now]: 0 if one
/// does now; infinite if none does along the course.
double StepsToFarm(const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the name of the strongest wind of the rings that cover a part of the farm, such as
/// "gale"; empty if no ring does, or if the winds of the rings are not given.
/// @param at  a point of the course
const char* WindOverFarm(const aquafarm_msgs::FarmSpec& spec, const Course& course,
                         const TrackPoint& at);

/// Returns the worst risk of the rings that cover a part of the farm now: "risk -5"; "risk 0" if no
/// ring does.
std::string RiskOverFarm(const aquafarm_msgs::FarmSpec& spec, const Course& course);

/// Returns a time ahead: "48 min", "6.5 h" or "12 h"; "12 steps" if the steps of the farm have no
/// duration.
std::string AheadText(const aquafarm_msgs::FarmSpec& spec, double steps);

/// Returns the outlook in one sentence: the ring that covers the most urgent device now and all
/// devices in that ring, the next ring that reaches any device, and the worst ring to come.
/// Examples: "typhoon, risk -10, reaches F3 in 6.5 h" and "typhoon: risk -5 over F2 now, risk -20
/// in 6.5 h". If the winds of the rings are given: "typhoon In-Fa: gale over F0 and F1 now, gale
/// reaches F5 in 8 min, storm reaches F0 in 6.5 h". On a farm with a start time, the local time
/// follows each arrival that is at least an hour away, the first one with its zone.
///
/// If the farm has devices but none is deployed, the text is "no device is deployed". If no ring
/// covers or reaches a device, the text is empty, or "no known danger to devices until +12 h" if a
/// course is known only until then. The text is also empty if the outlook is not known.
std::string OutlookText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                        const Outlook& outlook);

/// Returns the outlook as headlines, the longest first: OutlookText with the direction of each
/// disaster outside the farm, OutlookText, and the danger to the most urgent device. Empty if the
/// outlook is not known or if there is nothing to report.
std::vector<std::string> Headlines(const aquafarm_msgs::FarmSpec& spec,
                                   const aquafarm_msgs::FarmState& state, const Outlook& outlook);

/// Returns the risk of the worst ring that covers or reaches a device; 0 if none does.
double WorstRisk(const DeviceOutlook& device);

/// Returns whether a ring covers or reaches any device.
bool IsInDanger(const Outlook& outlook);

/// Returns the number of devices that a ring covers or reaches.
std::size_t CountInDanger(const Outlook& outlook);

/// Returns a short form of OutlookText: the danger to the most urgent device, such as "F2: risk -20
/// now". Without a danger, returns the text about the known time, or an empty text.
std::string ShortOutlookText(const aquafarm_msgs::FarmSpec& spec, const Outlook& outlook);

/// Returns the danger to a device: the ring that covers it now, the next worse ring and the worst
/// ring to come. Examples: "risk -10 in 6.5 h", "risk -5 now", "risk -5 now, -20 in 6.5 h". If the
/// winds of the rings are given: "gale now, storm in 6.5 h, hurricane force in 9 h". Returns an
/// empty text if no ring covers or reaches the device.
std::string DangerText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns the worst ring to come: "hurricane force in 9 h". Returns DangerText if its wind is not
/// given or no worse ring comes.
std::string WorstText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns the ring that covers the device now and the worst ring to come: "gale now, hurricane in
/// 9 h". Returns WorstText if one of the two is missing or has no wind.
std::string NowAndWorstText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns DangerText with risks instead of names of winds, and without the word "risk": "-5 now,
/// -20 in 6.5 h".
/// @param between  text between risk and time
std::string RiskText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device,
                     const char* between = " in ");

/// Returns the two texts of a row about a device: its label, with its kind if there is space, and
/// its danger. Tries texts from the longest to the shortest until `fits` accepts both. If it
/// accepts none, returns the shortest.
/// @param kind  DeviceName of the device
std::pair<std::string, std::string> NameAndDanger(
    const aquafarm_msgs::FarmSpec& spec, const std::string& kind, const DeviceOutlook& device,
    const std::function<bool(const std::string& name, const std::string& danger)>& fits);

/// Returns where the centre of a disaster is, seen from the middle of the farm: "typhoon, centre 89
/// km SE", or with its wind, if that is given, "typhoon 37 m/s (72 kt), centre 89 km SE".
std::string CentreText(const aquafarm_msgs::FarmSpec& spec,
                       const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the present motion of a disaster: "now moving NW at 13 km/h", or "stands still".
std::string MotionNow(const aquafarm_msgs::FarmSpec& spec,
                      const aquafarm_msgs::DisasterState& disaster);

/// Returns the closest approach of a disaster: "29 km S in 11 h". Returns "" if its course is
/// extrapolated or does not come nearer.
std::string ClosestText(const aquafarm_msgs::FarmSpec& spec, const Course& course);

/// Returns the present motion of a disaster, "NW at 13 km/h". If its course is not extrapolated and
/// comes nearer, the closest approach follows: "NW at 13 km/h, closest 29 km S in 11 h".
std::string ApproachText(const aquafarm_msgs::FarmSpec& spec,
                         const aquafarm_msgs::DisasterState& disaster, const Course& course);

}  // namespace aquafarm_viz
