// SPDX-License-Identifier: BSD-3-Clause
// Conversions of storms in geographic coordinates, as announced by bulletins.
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {
namespace {

constexpr std::size_t kMaxFixes = 10000;
constexpr std::size_t kMaxRings = 8;  // per fix

void CheckNumber(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;  // the condition is false for NaN
  char text[120];
  std::snprintf(text, sizeof(text), ": got %g, expected a number in [%g, %g]", value, low, high);
  throw aquafarm::InputError(name + text);
}

void CheckCount(const std::string& name, std::size_t count, std::size_t max) {
  if (count <= max) return;
  throw aquafarm::InputError(name + ": got " + std::to_string(count) +
                             " entries, expected at most " + std::to_string(max));
}

std::optional<double> IfSaid(float value) {
  return value > 0.0F ? std::optional<double>(static_cast<double>(value)) : std::nullopt;
}

aquafarm::StormFix FixFrom(const aquafarm_msgs::StormFix& message, const std::string& name) {
  CheckNumber(name + ".latitude_deg", message.latitude_deg, -90.0, 90.0);
  CheckNumber(name + ".longitude_deg", message.longitude_deg, -180.0, 180.0);
  CheckNumber(name + ".grade", message.grade, 0.0, aquafarm_msgs::StormFix::SUPER_TY);
  CheckNumber(name + ".wind_mps", static_cast<double>(message.wind_mps), 0.0, 150.0);
  CheckNumber(name + ".pressure_hpa", static_cast<double>(message.pressure_hpa), 0.0, 1100.0);
  CheckNumber(name + ".averaging_min", message.averaging_min, 0.0, 60.0);
  CheckNumber(name + ".max_wind_radius_km", static_cast<double>(message.max_wind_radius_km), 0.0,
              5000.0);
  CheckCount(name + ".rings", message.rings.size(), kMaxRings);
  aquafarm::StormFix fix;
  fix.time = message.stamp.sec;
  fix.position = {message.latitude_deg, message.longitude_deg};
  fix.wind_mps = IfSaid(message.wind_mps);
  fix.averaging_min = message.averaging_min;
  fix.pressure_hpa = IfSaid(message.pressure_hpa);
  fix.max_wind_radius_km = IfSaid(message.max_wind_radius_km);
  fix.grade = static_cast<aquafarm::StormGrade>(message.grade);
  if (message.grade == aquafarm_msgs::StormFix::UNKNOWN && fix.wind_mps) {
    fix.grade = aquafarm::GradeOfWind(*fix.wind_mps);
  }
  if (message.has_motion != 0) {
    CheckNumber(name + ".heading_deg", static_cast<double>(message.heading_deg), 0.0, 360.0);
    CheckNumber(name + ".speed_kmh", static_cast<double>(message.speed_kmh), 0.0, 300.0);
    fix.heading_deg = message.heading_deg < 360.0F ? static_cast<double>(message.heading_deg) : 0.0;
    fix.speed_kmh = static_cast<double>(message.speed_kmh);
  }
  for (std::size_t i = 0; i < message.rings.size(); ++i) {
    const std::string here = name + ".rings[" + std::to_string(i) + "]";
    CheckNumber(here + ".wind_kt", message.rings[i].wind_kt, 1.0, 200.0);
    if (fix.Ring(message.rings[i].wind_kt) != nullptr) {
      throw aquafarm::InputError(here + ".wind_kt: got " +
                                 std::to_string(message.rings[i].wind_kt) +
                                 " twice, expected one ring per wind");
    }
    aquafarm::WindRing ring;
    ring.wind_kt = message.rings[i].wind_kt;
    for (std::size_t q = 0; q < ring.radius_km.size(); ++q) {
      ring.radius_km[q] = static_cast<double>(message.rings[i].radius_km[q]);
      CheckNumber(here + ".radius_km[" + std::to_string(q) + "]", ring.radius_km[q], 0.0, 5000.0);
    }
    fix.rings.push_back(ring);
  }
  std::sort(fix.rings.begin(), fix.rings.end(),
            [](const auto& a, const auto& b) { return a.wind_kt < b.wind_kt; });
  return fix;
}

// @param after the first fix must be later than this time
std::vector<aquafarm::StormFix> FixesFrom(const std::vector<aquafarm_msgs::StormFix>& messages,
                                          const std::string& name, std::int64_t after) {
  CheckCount(name, messages.size(), kMaxFixes);
  std::vector<aquafarm::StormFix> fixes;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const std::string here = name + "[" + std::to_string(i) + "]";
    fixes.push_back(FixFrom(messages[i], here));
    if (fixes.back().time <= after) {
      throw aquafarm::InputError(here + ".stamp: got " + std::to_string(fixes.back().time) +
                                 ", expected a time after " + std::to_string(after));
    }
    after = fixes.back().time;
  }
  return fixes;
}

aquafarm_msgs::StormFix FixTo(const aquafarm::StormFix& fix) {
  aquafarm_msgs::StormFix message;
  message.stamp.sec = static_cast<std::uint32_t>(std::max<std::int64_t>(fix.time, 0));
  message.latitude_deg = fix.position.latitude;
  message.longitude_deg = fix.position.longitude;
  message.grade = static_cast<std::uint8_t>(fix.grade);
  message.wind_mps = static_cast<float>(fix.wind_mps.value_or(0.0));
  message.averaging_min = static_cast<std::uint8_t>(std::clamp(fix.averaging_min, 0, 60));
  message.pressure_hpa = static_cast<float>(fix.pressure_hpa.value_or(0.0));
  message.max_wind_radius_km = static_cast<float>(fix.max_wind_radius_km.value_or(0.0));
  message.has_motion = fix.heading_deg && fix.speed_kmh;
  message.heading_deg = static_cast<float>(fix.heading_deg.value_or(0.0));
  message.speed_kmh = static_cast<float>(fix.speed_kmh.value_or(0.0));
  for (const aquafarm::WindRing& ring : fix.rings) {
    message.rings.emplace_back();
    message.rings.back().wind_kt = ring.wind_kt;
    for (std::size_t q = 0; q < ring.radius_km.size(); ++q) {
      message.rings.back().radius_km[q] = static_cast<float>(ring.radius_km[q]);
    }
  }
  return message;
}

}  // namespace

aquafarm::StormTrack FromMsg(const aquafarm_msgs::Storm& message) {
  aquafarm::StormTrack track;
  track.name = message.name;
  track.fixes = FixesFrom(message.fixes, "storm.fixes", -1);
  if (track.fixes.empty()) {
    throw aquafarm::InputError("storm.fixes: got none, expected at least one position");
  }
  const std::int64_t now = track.fixes.back().time;
  if (!message.forecast.empty()) {
    track.forecasts.push_back({"", now, FixesFrom(message.forecast, "storm.forecast", now)});
  }
  return track;
}

aquafarm_msgs::Storm ToMsg(const aquafarm::StormTrack& track) {
  aquafarm_msgs::Storm message;
  message.name = track.name.empty() ? track.id : track.name;
  for (const aquafarm::StormFix& fix : track.fixes) message.fixes.push_back(FixTo(fix));
  if (const aquafarm::StormForecast* newest = aquafarm::NewestForecast(track)) {
    for (const aquafarm::StormFix& fix : newest->fixes) {
      if (fix.time > track.fixes.back().time) message.forecast.push_back(FixTo(fix));
    }
  }
  return message;
}

}  // namespace aquafarm_sim
