// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/plan_markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "aquafarm/base/angle.h"
#include "aquafarm_sim/plan_words.h"

namespace aquafarm_agents {
namespace {

using aquafarm::kPi;
using aquafarm_msgs::RescuePlan;
using aquafarm_msgs::RescueStormPoint;
using aquafarm_sim::LocalText;
using aquafarm_sim::PercentText;
using aquafarm_sim::WithoutRouteText;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr int kCircleCorners = 72;
// Heights [m]. They exceed those of the markers of the ranch. The view from above in rviz clips at
// 500 m.
constexpr double kLine_m = 100.0;
constexpr double kText_m = 120.0;

struct Color {
  float red;
  float green;
  float blue;
};
// The palette of Okabe and Ito (2008), Color universal design, without black and blue.
constexpr std::array<Color, 6> kShipColors{{{0.84F, 0.37F, 0.0F},
                                            {0.34F, 0.71F, 0.91F},
                                            {0.80F, 0.47F, 0.65F},
                                            {0.94F, 0.89F, 0.26F},
                                            {0.0F, 0.62F, 0.45F},
                                            {0.90F, 0.62F, 0.0F}}};
constexpr Color kWhite{1.0F, 1.0F, 1.0F};
constexpr Color kStorm{0.95F, 0.35F, 0.75F};
constexpr Color kWarning{1.0F, 0.8F, 0.2F};

geometry_msgs::Point PointAt(const RescuePlan& plan, double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x * plan.cell_size_m;
  point.y = y * plan.cell_size_m;
  point.z = z;
  return point;
}

// Creates the markers of one plan.
class Maker {
 public:
  explicit Maker(const RescuePlan& plan)
      : plan_(plan),
        // On large maps the unit of lines and letters exceeds a cell, so that they stay visible.
        unit_m_(plan.cell_size_m * std::max(1.0, std::max(plan.width, plan.height) / 30.0)) {}

  Marker Make(const char* space, int id, int type, Color color) const {
    Marker marker;
    marker.header = plan_.header;
    marker.ns = space;
    marker.id = id;
    marker.type = type;
    marker.action = Marker::ADD;
    marker.pose.orientation.w = 1.0;
    marker.color.r = color.red;
    marker.color.g = color.green;
    marker.color.b = color.blue;
    marker.color.a = 1.0F;
    return marker;
  }
  Marker Line(const char* space, int id, Color color, double width) const {
    Marker line = Make(space, id, Marker::LINE_STRIP, color);
    line.scale.x = width * unit_m_;
    return line;
  }
  Marker Text(const char* space, int id, double x, double y, const std::string& text, double size,
              Color color) const {
    Marker marker = Make(space, id, Marker::TEXT_VIEW_FACING, color);
    marker.pose.position = PointAt(plan_, x, y, kText_m);
    marker.scale.z = size * unit_m_;
    marker.text = text;
    return marker;
  }
  double unit_cells() const { return unit_m_ / plan_.cell_size_m; }

 private:
  const RescuePlan& plan_;
  double unit_m_;
};

Color ColorOf(std::int32_t ship) {
  return kShipColors[static_cast<std::size_t>(ship) % kShipColors.size()];
}

void AddRoutes(const RescuePlan& plan, const Maker& maker, MarkerArray& array) {
  for (const auto& route : plan.routes) {
    if (route.path.size() < 2) continue;
    Marker line = maker.Line("plan_route", route.ship, ColorOf(route.ship), 0.18);
    // Three consecutive ships have different shifts, so that their routes through the same cells
    // are all visible.
    const double shift = 0.12 * maker.unit_cells() * (route.ship % 3 - 1);
    for (const auto& cell : route.path) {
      line.points.push_back(PointAt(plan, cell.x + shift, cell.y + shift, kLine_m));
    }
    array.markers.push_back(line);
  }
  for (const auto& ship : plan.ships) {
    const auto route = std::find_if(plan.routes.begin(), plan.routes.end(),
                                    [&](const auto& one) { return one.ship == ship.id; });
    const std::string text =
        ship.name + (route == plan.routes.end() || route->orders.empty()
                         ? "\n" + WithoutRouteText(plan, ship)
                         : "\nleaves " + LocalText(plan, route->orders.front().stamp));
    array.markers.push_back(maker.Text("plan_ship", ship.id, ship.cell.x,
                                       ship.cell.y + 0.9 * maker.unit_cells(), text, 0.6,
                                       ColorOf(ship.id)));
  }
}

std::string DeviceText(const RescuePlan& plan, const aquafarm_msgs::RescueDevice& device) {
  if (plan.result == RescuePlan::STORM_UNKNOWN) return device.name + "\nodds unknown";
  if (device.ship < 0) {
    return device.name + (device.left_reason == "safe_in_place" ? "\nstays" : "\nleft behind");
  }
  return device.name + "  " + PercentText(device.home) + "\n" +
         plan.ships.at(static_cast<std::size_t>(device.ship)).name + " " +
         LocalText(plan, device.fetch);
}

void AddPlaces(const RescuePlan& plan, const Maker& maker, MarkerArray& array) {
  for (const auto& device : plan.devices) {
    array.markers.push_back(maker.Text(
        "plan_device", device.id, device.cell.x, device.cell.y - 0.9 * maker.unit_cells(),
        DeviceText(plan, device), 0.6, device.ship < 0 ? kWarning : ColorOf(device.ship)));
  }
  for (const auto& port : plan.ports) {
    array.markers.push_back(maker.Text("plan_port", port.id, port.cell.x,
                                       port.cell.y - 0.6 * maker.unit_cells(), port.name, 0.5,
                                       kWhite));
  }
}

void AddStorm(const RescuePlan& plan, const Maker& maker, MarkerArray& array) {
  Marker recorded = maker.Line("plan_track", 0, kStorm, 0.2);
  Marker later = maker.Line("plan_track", 1, kStorm, 0.1);
  for (const RescueStormPoint& point : plan.storm) {
    const geometry_msgs::Point at = PointAt(plan, point.x, point.y, kLine_m);
    if (point.source == RescueStormPoint::RECORDED) {
      recorded.points.push_back(at);
      later.points = {at};
    } else {
      later.points.push_back(at);
    }
  }
  for (Marker* line : {&recorded, &later}) {
    if (line->points.size() > 1) array.markers.push_back(*line);
  }
  for (std::size_t i = 0; i < plan.forecast_error.size(); ++i) {
    const auto& spread = plan.forecast_error[i];
    const double radius = 1000.0 * static_cast<double>(spread.radius70_km) / plan.cell_size_m;
    Marker circle = maker.Line("plan_cone", static_cast<int>(i), kStorm, 0.08);
    circle.color.a = 0.7F;
    for (int corner = 0; corner <= kCircleCorners; ++corner) {
      const double angle = 2.0 * kPi * corner / kCircleCorners;
      circle.points.push_back(PointAt(plan, spread.x + radius * std::cos(angle),
                                      spread.y + radius * std::sin(angle), kLine_m));
    }
    array.markers.push_back(circle);
    char lead[32];
    std::snprintf(lead, sizeof(lead), "+%.0f h  ", static_cast<double>(spread.lead_h));
    array.markers.push_back(maker.Text("plan_hour", static_cast<int>(i), spread.x,
                                       spread.y + radius, lead + LocalText(plan, spread.stamp), 0.8,
                                       kStorm));
  }
}

}  // namespace

MarkerArray PlanMarkers(const RescuePlan& plan) {
  MarkerArray array;
  const Maker maker(plan);
  Marker clear = maker.Make("", 0, Marker::CUBE, kWhite);
  clear.action = Marker::DELETEALL;
  array.markers.push_back(clear);
  if (plan.width < 1) return array;  // there is no plan yet
  AddStorm(plan, maker, array);
  AddPlaces(plan, maker, array);
  AddRoutes(plan, maker, array);
  const bool is_stop = !plan.warnings.empty() && plan.warnings.front().severity == "stop";
  array.markers.push_back(
      maker.Text("plan_outcome", 0, 0.5 * (plan.width - 1), plan.height + maker.unit_cells(),
                 plan.text + (plan.fault.empty() ? "" : "\nOUTDATED: " + plan.fault), 0.8,
                 is_stop || !plan.fault.empty() ? kWarning : kWhite));
  return array;
}

}  // namespace aquafarm_agents
