// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Computes which rings of disasters reach which devices and when; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <cstdint>
#include <limits>
#include <string>
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

/// The nearest approach of a ring to a device that it does not cover.
struct RingMiss {
  double cells{std::numeric_limits<double>::infinity()};  ///< distance from the ring, above 0
  double steps{};                                         ///< steps from now, 0 or more
  double risk{};                                          ///< risk within the ring, below 0
  std::int32_t device{};                                  ///< id of the device
  std::size_t disaster{};                                 ///< index in FarmState.disasters
  std::int32_t wind_kt{};  ///< min wind within the ring [kn]; 0: not given
  bool comes_nearer{};     ///< the ring is still approaching where the outlook ends
};

/// The danger to one deployed device.
struct DeviceOutlook {
  std::int32_t id{};
  double risk_now{};           ///< risk at its cell; 0 outside all rings
  std::size_t disaster_now{};  ///< index of the disaster with this risk; 0 outside all rings
  std::int32_t wind_now_kt{};  ///< min wind within that ring [kn]; 0: not given
  /// In order of time. Each risk is worse than the one before; the first is worse than risk_now.
  std::vector<RingArrival> arrivals;
};

/// The danger to all deployed devices.
struct Outlook {
  bool is_known{};                 ///< false: not computed, because there are too many devices
  bool is_extrapolated{};          ///< true: at least one course is extrapolated (Course::Kind)
  std::vector<std::string> names;  ///< names of the disasters of the state, see NameNow
  /// Compass points from the farm to the disasters of the state; empty if the centre is in the
  /// farm.
  std::vector<std::string> directions;
  /// Number of steps from now for which all courses are known and computed; infinite if they are
  /// known and computed until the disasters end.
  double known_until{std::numeric_limits<double>::infinity()};
  /// Deployed devices inside the grid, the most urgent first: by the time at which the first ring
  /// covers them, then by the risk in that ring, by the next arrival, and by the worst risk.
  std::vector<DeviceOutlook> devices;
  /// The nearest approach of a ring to any device; the earliest one if there are several. `cells`
  /// is infinite if no ring comes nearer than the length of the farm's diagonal. The member has no
  /// meaning if a device is in danger.
  RingMiss miss;
};

/// Computes the outlook along the courses of the known disasters that have not ended, at most 1000
/// steps ahead.
/// @param courses  one per disaster of the state, see CourseOf
Outlook ComputeOutlook(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                       const std::vector<Course>& courses);

/// Returns when a ring of a disaster first covers a part of the farm [steps from now]: 0 if one
/// does now; infinite if none does along the course, or if the disaster is unknown or has ended.
double StepsToFarm(const aquafarm_msgs::FarmSpec& spec,
                   const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the name of the wind of the worst ring that covers a part of the farm, such as "gale";
/// empty if no ring does, or if the winds of the rings are not given.
/// @param at  a point of the course
const char* WindOverFarm(const aquafarm_msgs::FarmSpec& spec, const Course& course,
                         const TrackPoint& at);

/// Returns the worst ring that covers a part of the farm now: "gale over the ranch", or "gale over
/// part of the ranch" if it does not cover all of it. If its wind is not given, the text begins
/// with its risk, such as "risk -5". Empty if no ring covers a part of the farm.
std::string OverFarmText(const aquafarm_msgs::FarmSpec& spec, const Course& course);

/// Returns the risk of the worst ring that covers a device now or reaches it later; 0 if none does.
double WorstRisk(const DeviceOutlook& device);

/// Returns the risk of the worst ring that covers any device now or reaches one later; 0 if none
/// does.
double WorstRisk(const Outlook& outlook);

/// Returns whether a ring covers any device now or reaches one later.
bool IsInDanger(const Outlook& outlook);

/// Returns the number of devices that a ring covers now or reaches later.
std::size_t CountInDanger(const Outlook& outlook);

}  // namespace aquafarm_viz
