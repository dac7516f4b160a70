// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/plan_text.h"

#include <algorithm>

#include "aquafarm_sim/plan_words.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::RescueDeadline;
using aquafarm_msgs::RescueOrder;
using aquafarm_msgs::RescuePlan;
using aquafarm_sim::LocalText;
using aquafarm_sim::PercentText;
using aquafarm_sim::WithoutRouteText;

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

// If the winds are unknown, the plan has no probabilities (RescuePlan.STORM_UNKNOWN).
std::string ChanceText(const RescuePlan& plan, float chance) {
  return plan.result == RescuePlan::STORM_UNKNOWN ? "unknown"
                                                  : PercentText(static_cast<double>(chance));
}

std::string DeadlineText(const RescuePlan& plan, const RescueDeadline& deadline) {
  if (plan.result == RescuePlan::STORM_UNKNOWN) return "unknown";
  if (!deadline.possible) return "none";
  return (deadline.open ? "not known beyond " : "") + LocalText(plan, deadline.leave);
}

// Returns a sentence about the time until which ships may leave; empty if that time is unknown.
std::string LastDepartureText(const RescuePlan& plan) {
  if (plan.result == RescuePlan::STORM_UNKNOWN) return "";
  if (!plan.no_departure_after.isZero()) {
    return " No ship should leave after " + LocalText(plan, plan.no_departure_after) + ".";
  }
  if (plan.not_known_beyond.isZero()) return "";
  return " Ships may leave at least until " + LocalText(plan, plan.not_known_beyond) +
         ". What follows is not known: plan again at the next bulletin.";
}

}  // namespace

std::string PlanHeadline(const RescuePlan& plan, double silent_s) {
  std::string text = "plan: " + plan.text;
  text += LastDepartureText(plan);
  for (const auto& warning : plan.warnings) {
    if (warning.severity == "stop" && warning.text != plan.text) text += " " + warning.text;
  }
  if (!plan.fault.empty()) text += " OUTDATED: " + plan.fault;
  if (silent_s >= kPlanSilence_s) {
    text += " NOT RENEWED: plan_node has sent nothing for " +
            std::to_string(static_cast<std::int64_t>(silent_s)) +
            " s; start it again, unless it is still planning (that may take more than 60 s).";
  }
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
    PlanRow row{ship.name, WithoutRouteText(plan, ship), "", ""};
    for (const auto& route : plan.routes) {
      if (route.ship != ship.id) continue;
      const auto next = std::find_if(route.orders.begin(), route.orders.end(),
                                     [now](const auto& order) { return order.stamp >= now; });
      row[1] = next == route.orders.end() ? "all done" : OrderText(plan, *next);
      if (next == route.orders.end()) continue;
      row[2] = LocalText(plan, next->stamp);
      row[3] = ChanceText(plan, next->probability);
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<PlanRow> PlanDevices(const RescuePlan& plan) {
  std::vector<PlanRow> rows;
  const bool is_unknown = plan.result == RescuePlan::STORM_UNKNOWN;
  for (const auto& device : plan.devices) {
    const std::string home = is_unknown                              ? "unknown"
                             : device.ship >= 0                      ? ChanceText(plan, device.home)
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

}  // namespace aquafarm_viz
