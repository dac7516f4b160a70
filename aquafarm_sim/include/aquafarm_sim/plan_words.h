// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Texts for the fields of a rescue plan. The panel and the rviz markers share them. All code is in
/// this header, so that including it requires no library but that of the messages.

#include <aquafarm_msgs/RescuePlan.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

namespace aquafarm_sim {

/// Returns a probability as text: "> 99 %", "87 %", "< 1 %". It never returns "100 %" or "0 %",
/// because the probability is a share of a sample.
/// @param probability in [0, 1]; NaN returns "unknown"
inline std::string PercentText(double probability) {
  if (std::isnan(probability)) return "unknown";
  if (probability >= 0.995) return "> 99 %";
  if (probability < 0.005) return "< 1 %";
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

/// Returns a time as local time of the ranch, with the day unless it is the day on which the plan
/// starts: "14:05" or "25 Jul 02:10".
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

/// Returns the instruction for a ship without a route: "stay" in a port, "return to port" at sea. A
/// ship with devices aboard has no route only if it can reach no port, which the text then states.
inline std::string WithoutRouteText(const aquafarm_msgs::RescuePlan& plan,
                                    const aquafarm_msgs::RescueShip& ship) {
  const bool in_port = std::any_of(plan.ports.begin(), plan.ports.end(), [&ship](const auto& port) {
    return port.cell.x == ship.cell.x && port.cell.y == ship.cell.y;
  });
  if (!ship.aboard.empty()) return in_port ? "stay, no port in reach" : "no port in reach";
  return in_port ? "stay" : "return to port";
}

}  // namespace aquafarm_sim
