// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Texts for the fields of a rescue plan. The panel and the rviz markers use them. All functions
/// are inline, so that a program that uses them need not link a library of aquafarm_sim.

#include <aquafarm_msgs/RescuePlan.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

namespace aquafarm_sim {

/// Returns a probability as text: "> 99 %", "87 %" or "< 1 %". The text is never "100 %" or "0 %",
/// because the probability is estimated from a finite number of possible storms.
/// @param probability in [0, 1]; for NaN the text is "unknown"
inline std::string PercentText(double probability) {
  if (std::isnan(probability)) return "unknown";
  if (probability >= 0.995) return "> 99 %";
  if (probability < 0.005) return "< 1 %";
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

/// Returns a time as local time of the ranch: "14:05" on the day on which the plan starts, "25 Jul
/// 02:10" on another day.
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

/// Returns the instruction for a ship without a route. Without devices aboard it is "stay" in a
/// port and "return to port" at sea. A ship with devices aboard has no route if it cannot reach an
/// open port, or if winds stop it on the way. Its instruction is "stay, no safe way to a port" in a
/// port and "no safe way to a port" at sea.
inline std::string WithoutRouteText(const aquafarm_msgs::RescuePlan& plan,
                                    const aquafarm_msgs::RescueShip& ship) {
  const bool in_port = std::any_of(plan.ports.begin(), plan.ports.end(), [&ship](const auto& port) {
    return port.cell.x == ship.cell.x && port.cell.y == ship.cell.y;
  });
  if (!ship.aboard.empty())
    return in_port ? "stay, no safe way to a port" : "no safe way to a port";
  return in_port ? "stay" : "return to port";
}

}  // namespace aquafarm_sim
