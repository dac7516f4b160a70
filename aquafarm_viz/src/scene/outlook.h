// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Which ring of a disaster reaches which device, and when; private to this package.

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

/// A ring that reaches a device.
struct RingArrival {
  double steps{};          ///< from now, above 0
  double risk{};           ///< risk within the ring, below 0
  std::size_t disaster{};  ///< index in FarmState.disasters
  std::int32_t wind_kt{};  ///< of the ring; 0: not given
};

/// The danger to one deployed device.
struct DeviceOutlook {
  std::int32_t id{};
  double risk_now{};                  ///< risk at its cell; 0 outside all rings
  std::size_t disaster_now{};         ///< index of the disaster with this risk; 0 outside all rings
  std::int32_t wind_now_kt{};         ///< of that ring; 0: not given
  std::vector<RingArrival> arrivals;  ///< each worse than the one before and than risk_now
};

/// The danger to all deployed devices.
struct Outlook {
  bool is_known{};                 ///< false: too many devices to compute it; nothing can be said
  bool is_extrapolated{};          ///< true: at least one course is the present motion continued
  std::vector<std::string> names;  ///< of the state's disasters, see NameNow
  /// Steps from now until which all courses are known; infinite: until the disasters end.
  double known_until{std::numeric_limits<double>::infinity()};
  std::vector<DeviceOutlook> devices;  ///< deployed devices, the soonest danger first: those in a
                                       ///< ring now, then by first arrival; at equal times the
                                       ///< worse risk first, then the sooner next arrival
};

/// Computes the outlook along the courses of the drawn disasters.
/// @param courses  one per disaster of the state, see CourseOf
Outlook ComputeOutlook(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const std::vector<Course>& courses);

/// Returns when the first ring of a disaster covers a part of the farm [steps from now]: 0 if one
/// does so now; infinite if none does along the course.
double StepsToFarm(const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the name of the strongest wind that a disaster has over a part of the farm, such as
/// "gale"; empty if no ring covers a part of it, or if the winds of the rings are not given.
/// @param at  a point of the course
const char* WindOverFarm(const aquafarm_msgs::FarmSpec& spec, const Course& course,
                         const TrackPoint& at);

/// Returns the worst risk that a disaster has over a part of the farm now: "risk -5".
std::string RiskOverFarm(const aquafarm_msgs::FarmSpec& spec, const Course& course);

/// Returns a time ahead: "6.5 h" in a farm with a start time, else "12 steps".
std::string AheadText(const aquafarm_msgs::FarmSpec& spec, double steps);

/// Returns the outlook in one sentence: the ring over the first device and others, the next ring
/// that reaches any device, and the worst one, such as "typhoon, risk -10, reaches F3 in 6.5 h",
/// "typhoon: risk -5 over F2 now, risk -20 in 6.5 h", or where the winds of the rings are given
/// "typhoon In-Fa: gale over F0 and F1 now, gale reaches F5 in 8 min, storm reaches F0 in 6.5 h".
/// "no device is deployed" if all are aboard or delivered. Without a danger "no danger to devices
/// known until +12 h" if a course ends before its disaster; else empty, also if the outlook is not
/// known.
std::string OutlookText(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                        const Outlook& outlook);

/// Returns the risk of the worst ring that covers or reaches a device; 0 if none does.
double WorstRisk(const DeviceOutlook& device);

/// Returns whether a ring covers or reaches a device.
bool IsInDanger(const Outlook& outlook);

/// Returns the number of devices that a ring covers or reaches.
std::size_t CountInDanger(const Outlook& outlook);

/// Returns OutlookText in a few characters, such as "F2: risk -20 now".
std::string ShortOutlookText(const aquafarm_msgs::FarmSpec& spec, const Outlook& outlook);

/// Returns the danger to a device in a few characters: "risk -10 in 6.5 h", "risk -5 now" if a ring
/// covers it, "risk -5 now, -20 in 6.5 h" if worse ones follow, of which the next and the worst are
/// named; empty if none reaches it. Where
/// the winds of the rings are given: "gale now, storm in 6.5 h", and the worst ring to come if it
/// is another one: ", hurricane in 9 h".
std::string DangerText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns the worst ring to come: "hurricane force in 9 h"; DangerText if its wind is not given.
std::string WorstText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns WorstText after the ring that covers the device now: "gale now, hurricane in 9 h".
std::string NowAndWorstText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device);

/// Returns DangerText without names of winds and without the word "risk".
/// @param between  text between risk and time
std::string RiskText(const aquafarm_msgs::FarmSpec& spec, const DeviceOutlook& device,
                     const char* between = " in ");

/// Returns the name of a device, with its kind where there is space, and its danger, for a row of a
/// list: the longest texts that `fits` accepts, else the shortest.
/// @param kind  DeviceName
std::pair<std::string, std::string> NameAndDanger(
    const aquafarm_msgs::FarmSpec& spec, const std::string& kind, const DeviceOutlook& device,
    const std::function<bool(const std::string& name, const std::string& danger)>& fits);

/// Returns where the centre of a disaster outside the farm is: "typhoon, centre 89 km SE", or with
/// its strength "typhoon 37 m/s (72 kt), centre 89 km SE".
std::string CentreText(const aquafarm_msgs::FarmSpec& spec,
                       const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the present motion of a disaster: "now moving NW at 13 km/h", or "stands still".
std::string MotionNow(const aquafarm_msgs::FarmSpec& spec,
                      const aquafarm_msgs::DisasterState& disaster);

/// Returns the motion of a disaster and, where its course is given and comes nearer, its closest
/// approach: "NW at 13 km/h, closest 29 km S in 11 h".
std::string ApproachText(const aquafarm_msgs::FarmSpec& spec,
                         const aquafarm_msgs::DisasterState& disaster, const Course& course);

}  // namespace aquafarm_viz
