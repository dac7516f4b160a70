// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Texts for distances, bearings, winds and times; private to this package.

#include <aquafarm_msgs/DisasterState.h>
#include <aquafarm_msgs/FarmSpec.h>

#include <ctime>
#include <string>

#include "scene/storm_track.h"

namespace aquafarm_viz {

/// Returns a distance such as "850 m", "1.8 km" or "89 km".
std::string DistanceText(double metres);

/// Returns the length of a scale bar: the largest of …, 1, 2, 5, 10, 20, 50, … that is at most
/// `max_m`, which must be above 0.
double RoundLength(double max_m);

/// Returns the compass point from the middle of the farm to a point [cells], such as "SE".
std::string PointFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y);

/// Returns where a point [cells] is, seen from the middle of the farm, such as "89 km SE".
std::string WhereText(const aquafarm_msgs::FarmSpec& spec, double x, double y);

/// Returns the distance from the middle of the farm to a point [m]; x and y in cells.
double MetresFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y);

/// Returns the hours by which the nautical time zone of a longitude is ahead of UTC, [-12, 12]. The
/// zones are 15 degrees wide, so legal time may differ.
int NauticalZone(double longitude_deg);

/// Returns a time as UTC. @param format format of strftime
std::string TimeText(std::time_t utc, const char* format);

/// Returns a time in the nautical time zone of the farm, without the name of the zone (ZoneText).
/// The zone of a farm without a geographic position is UTC.
/// @param format format of strftime
std::string LocalTimeText(const aquafarm_msgs::FarmSpec& spec, std::time_t utc, const char* format);

/// Returns the compass point and the speed of a motion, such as "NW at 18 km/h". If the steps of
/// the farm have no duration, the text has the form "NW, 0.25 cells a step". At speed 0 it is
/// "stands still".
std::string MotionText(const aquafarm_msgs::FarmSpec& spec, int heading_deg, double cells_a_step);

/// Returns the max sustained wind of a disaster, such as "38 m/s"; empty if it is not given.
std::string WindText(const TrackPoint& point);

/// Returns the kind of a disaster and, if it has one, its name: "typhoon In-Fa". If the wind of a
/// typhoon is given, the class of this wind replaces the kind until the typhoon ends: "tropical
/// depression", from 17.2 m/s on "tropical storm", from 24.5 m/s on "severe tropical storm", and
/// from 32.7 m/s on "typhoon" (Typhoon Committee Operational Manual, WMO TD 196).
std::string NameNow(const aquafarm_msgs::DisasterState& disaster, const Course& course);

/// Returns the max sustained wind in two units, after a space: " 37 m/s (72 kt)"; empty if it is
/// not given.
std::string StrengthText(const TrackPoint& point);

/// Returns a world time in hours and minutes, such as "13:58". This is the local time
/// (LocalTimeText) or, if the scenario has no start time, the time since the start of the episode.
/// @param at_s world time [s]
std::string TimeOfDay(const aquafarm_msgs::FarmSpec& spec, std::int64_t at_s);

/// Returns a duration such as "31 h" or "4.5 h".
std::string HoursText(double seconds);

/// Returns the name of the time zone of LocalTimeText: "UTC+8", or "UTC".
std::string ZoneText(const aquafarm_msgs::FarmSpec& spec);

/// Returns the world time of a state in local time and UTC, "2019-10-01 00:03 UTC+8 (30 Sep 16:03
/// UTC)". Returns ClockText if the farm has no start time or geographic position, or if its zone is
/// UTC.
std::string WorldTimeText(const aquafarm_msgs::FarmSpec& spec,
                          const aquafarm_msgs::FarmState& state);

}  // namespace aquafarm_viz
