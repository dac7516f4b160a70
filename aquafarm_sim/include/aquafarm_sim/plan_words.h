// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Words for the fields of a rescue plan, the same in the panel and in rviz. Header only, so that a
/// package needs no more than the messages.

#include <aquafarm_msgs/RescuePlan.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

namespace aquafarm_sim {

/// Returns a probability for people: "> 99 %", "87 %", "< 1 %". A share of a sample is never
/// certain. @param probability [0, 1]; NaN: "unknown"
inline std::string PercentText(double probability) {
  if (std::isnan(probability)) return "unknown";
  if (probability >= 0.995) return "> 99 %";
  if (probability < 0.005) return "< 1 %";
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

/// Returns a local time, with day if it is not that of the plan's start: "14:05", "25 Jul 02:10".
/// @param time UTC
inline std::string LocalText(const aquafarm_msgs::RescuePlan& plan, ros::Time time) {
  const auto local = [&plan](ros::Time utc) {
    const std::time_t seconds = static_cast<std::time_t>(utc.sec) + 60 * plan.utc_offset_min;
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    return parts;
  };
  const std::tm start = local(plan.start);
  const std::tm at = local(time);
  const bool same_day = start.tm_yday == at.tm_yday && start.tm_year == at.tm_year;
  char text[32];
  return {text, std::strftime(text, sizeof(text), same_day ? "%H:%M" : "%d %b %H:%M", &at)};
}

/// Returns what a ship without a route does. A ship at sea never gets the order to stay, and one
/// with devices aboard has a route unless it reaches no port.
inline std::string WithoutRouteText(const aquafarm_msgs::RescuePlan& plan,
                                    const aquafarm_msgs::RescueShip& ship) {
  const bool in_port = std::any_of(plan.ports.begin(), plan.ports.end(), [&ship](const auto& port) {
    return port.cell.x == ship.cell.x && port.cell.y == ship.cell.y;
  });
  if (!ship.aboard.empty()) return in_port ? "stay, no port in reach" : "no port in reach";
  return in_port ? "stay" : "return to port";
}

}  // namespace aquafarm_sim
