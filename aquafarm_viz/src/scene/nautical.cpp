// SPDX-License-Identifier: BSD-3-Clause
#include "scene/nautical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "aquafarm/tracks/track.h"
#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/base/text.h"
#include "aquafarm_viz/scene/labels.h"

namespace aquafarm_viz {
namespace {

int ZoneOf(const aquafarm_msgs::FarmSpec& spec) {
  return spec.has_origin ? NauticalZone(spec.origin_longitude_deg) : 0;
}

// Returns the class of a typhoon that has not ended, if its wind is given. In all other cases,
// returns the name of the kind.
std::string ClassNow(const aquafarm_msgs::DisasterState& disaster, const Course& course) {
  const bool has_class = disaster.kind == aquafarm_msgs::DisasterState::TYPHOON &&
                         disaster.steps_left > 0 && !course.ahead.empty() &&
                         course.ahead.front().wind_mps;
  if (!has_class) return DisasterName(disaster.kind);
  const double wind_mps = *course.ahead.front().wind_mps;
  return wind_mps < 17.2   ? "tropical depression"
         : wind_mps < 24.5 ? "tropical storm"
         : wind_mps < 32.7 ? "severe tropical storm"
                           : DisasterName(disaster.kind);
}

}  // namespace

double RoundLength(double max_m) {
  const double power = std::pow(10.0, std::floor(std::log10(max_m)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= max_m) return factor * power;
  }
  return power;
}

std::string DistanceText(double metres) {
  return metres >= 10000.0  ? Number(metres / 1000.0, 0) + " km"
         : metres >= 1000.0 ? Number(metres / 1000.0, 1) + " km"
                            : Number(metres, 0) + " m";
}

std::string PointFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y) {
  const double east = x - (spec.width - 1) / 2.0;
  const double north = y - (spec.height - 1) / 2.0;
  return CompassPoint(static_cast<int>(std::lround(std::atan2(east, north) * 180.0 / CV_PI)));
}

double MetresFromFarm(const aquafarm_msgs::FarmSpec& spec, double x, double y) {
  return spec.cell_size_m * std::hypot(x - (spec.width - 1) / 2.0, y - (spec.height - 1) / 2.0);
}

std::string WhereText(const aquafarm_msgs::FarmSpec& spec, double x, double y) {
  return DistanceText(MetresFromFarm(spec, x, y)) + " " + PointFromFarm(spec, x, y);
}

int NauticalZone(double longitude_deg) {
  return std::clamp(static_cast<int>(std::lround(longitude_deg / 15.0)), -12, 12);
}

std::string TimeText(std::time_t utc, const char* format) {
  std::tm parts{};
  gmtime_r(&utc, &parts);
  std::array<char, 48> text{};
  std::strftime(text.data(), text.size(), format, &parts);
  return text.data();
}

std::string LocalTimeText(const aquafarm_msgs::FarmSpec& spec, std::time_t utc,
                          const char* format) {
  constexpr int kHour = 3600;
  return TimeText(utc + ZoneOf(spec) * kHour, format);
}

std::string ZoneText(const aquafarm_msgs::FarmSpec& spec) {
  const int zone = ZoneOf(spec);
  return "UTC" + (zone == 0 ? "" : (zone > 0 ? "+" : "") + std::to_string(zone));
}

std::string WorldTimeText(const aquafarm_msgs::FarmSpec& spec,
                          const aquafarm_msgs::FarmState& state) {
  const std::string clock = ClockText(spec, state);
  if (!spec.has_start_time || !spec.has_origin || ZoneOf(spec) == 0) return clock;
  const std::time_t utc = state.world_time.sec;
  return LocalTimeText(spec, utc, "%Y-%m-%d %H:%M ") + ZoneText(spec) +
         TimeText(utc, " (%d %b %H:%M UTC)");
}

std::string MotionText(const aquafarm_msgs::FarmSpec& spec, int heading_deg, double cells_a_step) {
  if (!(cells_a_step > 0.0)) return "stands still";
  const std::string point = CompassPoint(heading_deg);
  if (!(spec.step_duration_s > 0.0)) {
    return point + ", " + Number(cells_a_step, 2) + " cells a step";
  }
  const double km_h = cells_a_step * spec.cell_size_m / 1000.0 / (spec.step_duration_s / kHour_s);
  return point + " at " + Number(km_h, km_h < 10.0 ? 1 : 0) + " km/h";
}

std::string WindText(const TrackPoint& point) {
  return point.wind_mps ? Number(*point.wind_mps, 0) + " m/s" : "";
}

std::string NameNow(const aquafarm_msgs::DisasterState& disaster, const Course& course) {
  return ClassNow(disaster, course) + (course.name.empty() ? "" : " " + course.name);
}

std::string StrengthText(const TrackPoint& point) {
  if (!point.wind_mps) return "";
  return " " + WindText(point) + " (" + Number(*point.wind_mps / aquafarm::kMpsPerKnot, 0) + " kt)";
}

std::string TimeOfDay(const aquafarm_msgs::FarmSpec& spec, std::int64_t at_s) {
  if (spec.has_start_time) return LocalTimeText(spec, at_s, "%H:%M");
  const std::string minutes = std::to_string(at_s / 60 % 60);
  return std::to_string(at_s / 3600) + ":" + (minutes.size() < 2 ? "0" : "") + minutes;
}

std::string HoursText(double seconds) {
  const double hours = seconds / kHour_s;
  return Number(hours, hours < 10.0 ? 1 : 0) + " h";
}

}  // namespace aquafarm_viz
