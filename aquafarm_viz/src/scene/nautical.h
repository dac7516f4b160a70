// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Distances, bearings and times as words; private to this package.

#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/FarmSpec.h>

#include <ctime>
#include <string>

#include "scene/storm_track.h"

namespace aquafarm_viz {

/// Returns a distance such as "850 m", "1.8 km" or "89 km".
std::string DistanceText(double metres);

/// Returns the largest of 1, 2 and 5 times a power of ten that is at most `max_m`, above 0: the
/// length of a scale.
double RoundLength(double max_m);

/// Returns the compass point from the middle of the farm to a point [cells], such as "SE".
std::string PointFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y);

/// Returns the distance from the middle of the farm to a point [m]; x and y in cells.
double MetresFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y);

/// Returns the hours by which the nautical time zone of a longitude is ahead of UTC, [-12, 12]. It
/// may differ from the legal time.
int NauticalZone(double longitude_deg);

/// Returns a time in UTC by a format of strftime.
std::string TimeText(std::time_t utc, const char* format);

/// Returns a time in the farm's nautical time zone by a format of strftime, and the zone, such as
/// "19 Jul 13:58 UTC+8"; in UTC for a farm without a geographic position.
std::string LocalTimeText(const aquafarm_msgs::FarmSpec& spec, std::time_t utc, const char* format);

/// Returns the compass bearing and the speed of a moving centre, such as "NW at 18 km/h"; in cells
/// per step on a farm whose steps have no duration; "stands still" at speed 0.
std::string MotionText(const aquafarm_msgs::FarmSpec& spec, int heading_deg, double cells_a_step);

/// Returns a disaster's max sustained wind, such as "38 m/s"; empty if it is not given.
std::string WindText(const TrackPoint& point);

/// Returns the kind of a disaster and, where it has one, its name: "typhoon In-Fa". For a typhoon
/// whose wind is given it is the class until it is over, such as "tropical storm" (Typhoon
/// Committee Operational Manual, WMO TD 196: from 17.2, 24.5 and 32.7 m/s).
std::string NameNow(const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns WindText also in knots, after a space: " 37 m/s (72 kt)"; empty if not given.
std::string StrengthText(const TrackPoint& point);

/// Returns a time in hours and minutes: local time, or since the start of the farm's world.
std::string TimeOfDay(const aquafarm_msgs::FarmSpec& spec, std::int64_t at_s);

/// Returns a duration such as "31 h" or "4.5 h".
std::string HoursText(double seconds);

/// Returns the name of the time zone of LocalTimeText: "UTC+8", or "UTC".
std::string ZoneText(const aquafarm_msgs::FarmSpec& spec);

/// Returns the time of a state: on a farm with a place and a start time the local time, and that of
/// UTC with its own date, "2019-10-01 00:03 UTC+8 (30 Sep 16:03 UTC)"; else ClockText.
std::string WorldTimeText(const aquafarm_msgs::FarmSpec& spec,
                          const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
