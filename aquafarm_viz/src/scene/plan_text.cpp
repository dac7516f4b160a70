// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/plan_text.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::RescueDeadline;
using aquafarm_msgs::RescueOrder;
using aquafarm_msgs::RescuePlan;

// A share of a sample is never certain.
std::string Percent(double share) {
  if (share >= 0.995) return "> 99 %";
  if (share < 0.005) return "< 1 %";
  return std::to_string(std::lround(100.0 * share)) + " %";
}

template <typename Message>
std::string NameOf(const std::vector<Message>& list, std::int32_t id) {
  const auto index = static_cast<std::size_t>(id);
  return id >= 0 && index < list.size() ? list[index].name : "?";
}

std::string PortOf(const RescuePlan& plan, const RescueOrder& order) {
  return order.port < 0 ? "its position" : NameOf(plan.ports, order.port);
}

std::string OrderText(const RescuePlan& plan, const RescueOrder& order) {
  switch (order.action) {
    case RescueOrder::LEAVE:
      return "leave " + PortOf(plan, order);
    case RescueOrder::FETCH:
      return "fetch " + NameOf(plan.devices, order.device);
    case RescueOrder::DELIVER: {
      std::string names;
      for (const std::int32_t id : order.devices) {
        names += (names.empty() ? "" : ", ") + NameOf(plan.devices, id);
      }
      return "deliver " + names + " at " + PortOf(plan, order);
    }
    default:
      return "wait";
  }
}

std::string DeadlineText(const RescuePlan& plan, const RescueDeadline& deadline) {
  if (plan.result == RescuePlan::STORM_UNKNOWN) return "unknown";
  if (!deadline.possible) return "none";
  return deadline.open ? "no limit" : PlanTime(plan, deadline.leave);
}

// What a ship without a route does. A ship at sea is never told to stay.
std::string WithoutRoute(const RescuePlan& plan, const aquafarm_msgs::RescueShip& ship) {
  for (const auto& warning : plan.warnings) {
    const bool is_of_ship = warning.text.rfind(ship.name + " has ", 0) == 0;
    if (warning.code == "devices_aboard" && is_of_ship) return "deliver first";
  }
  const bool in_port = std::any_of(plan.ports.begin(), plan.ports.end(), [&ship](const auto& port) {
    return port.cell.x == ship.cell.x && port.cell.y == ship.cell.y;
  });
  return in_port ? "stay" : "return to port";
}

}  // namespace

std::string PlanHeadline(const RescuePlan& plan) {
  std::string text = "plan: " + plan.text;
  if (!plan.no_departure_after.isZero()) {
    text += " No ship should leave after " + PlanTime(plan, plan.no_departure_after) + ".";
  }
  for (const auto& warning : plan.warnings) {
    if (warning.severity == "stop" && warning.text != plan.text) text += " " + warning.text;
  }
  if (!plan.fault.empty()) text += " OUTDATED: " + plan.fault;
  return text;
}

const PlanRow& PlanShipColumns() {
  static const PlanRow columns{"ship", "next order", "time", "chance"};
  return columns;
}

const PlanRow& PlanDeviceColumns() {
  static const PlanRow columns{"device", "comes home", "leave by: 95 %", "80 %", "50 %"};
  return columns;
}

std::vector<PlanRow> PlanShips(const RescuePlan& plan, ros::Time now) {
  std::vector<PlanRow> rows;
  for (const auto& ship : plan.ships) {
    PlanRow row{ship.name, WithoutRoute(plan, ship), "", ""};
    for (const auto& route : plan.routes) {
      if (route.ship != ship.id) continue;
      const auto next = std::find_if(route.orders.begin(), route.orders.end(),
                                     [now](const auto& order) { return order.stamp >= now; });
      row[1] = next == route.orders.end() ? "all done" : OrderText(plan, *next);
      if (next == route.orders.end()) continue;
      row[2] = PlanTime(plan, next->stamp);
      row[3] = Percent(static_cast<double>(next->probability));
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<PlanRow> PlanDevices(const RescuePlan& plan) {
  std::vector<PlanRow> rows;
  const bool is_unknown = plan.result == RescuePlan::STORM_UNKNOWN;
  for (const auto& device : plan.devices) {
    const std::string home = is_unknown         ? "unknown"
                             : device.ship >= 0 ? Percent(static_cast<double>(device.home))
                             : device.left_reason == "safe_in_place" ? "stays"
                                                                     : "left behind";
    PlanRow row{device.name, home, "", "", ""};
    for (const RescueDeadline& deadline : device.deadlines) {
      const double share = static_cast<double>(deadline.probability);
      const std::size_t column = share > 0.9 ? 2 : share > 0.65 ? 3 : 4;
      row[column] = DeadlineText(plan, deadline);
    }
    rows.push_back(row);
  }
  return rows;
}

std::string PlanTime(const RescuePlan& plan, ros::Time time) {
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

}  // namespace aquafarm_viz
