// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/plan_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm_agents {
namespace {

using Json = nlohmann::json;
using aquafarm_msgs::RescuePlan;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

double Number(const Json& value) { return value.is_null() ? kNaN : value.get<double>(); }
float Single(const Json& value) { return static_cast<float>(Number(value)); }
std::int32_t Id(const Json& value) { return value.is_null() ? -1 : value.get<std::int32_t>(); }
std::string Text(const Json& value) { return value.is_null() ? "" : value.get<std::string>(); }

ros::Time FromUnix(std::int64_t time) {
  if (time < 0 || time > std::numeric_limits<std::uint32_t>::max()) {
    throw std::out_of_range("a time before 1970 or after 2106, which ROS cannot represent");
  }
  return {static_cast<std::uint32_t>(time), 0};
}

ros::Time Time(const Json& value) {
  return value.is_null() ? ros::Time()
                         : FromUnix(aquafarm::ParseUtc("time", value.get<std::string>()));
}

aquafarm_msgs::Cell CellOf(const Json& value) {
  aquafarm_msgs::Cell cell;
  cell.x = value.at(0).get<std::int32_t>();
  cell.y = value.at(1).get<std::int32_t>();
  return cell;
}

// Fills cell, latitude_deg and longitude_deg.
template <typename Message>
void SetPlace(const Json& from, Message& message) {
  message.cell = CellOf(from.at("cell"));
  message.latitude_deg = Number(from.at("position").at("latitude"));
  message.longitude_deg = Number(from.at("position").at("longitude"));
}

std::vector<float> Singles(const Json& list) {
  std::vector<float> numbers;
  for (const Json& one : list) numbers.push_back(Single(one));
  return numbers;
}

// Converts each entry of a list.
template <typename Message, typename Fill>
void Convert(const Json& list, std::vector<Message>& messages, Fill fill) {
  for (const Json& one : list) {
    messages.emplace_back();
    fill(one, messages.back());
  }
}

void SetProvenance(const Json& from, RescuePlan& plan) {
  plan.version = from.at("program_version").get<std::string>();
  plan.command = from.at("command").get<std::string>();
  plan.computed_at = Time(from.at("computed_at"));
  plan.compute_s = Number(from.at("compute_s"));
  plan.scenario_name = from.at("scenario_name").get<std::string>();
  plan.scenario_hash = std::stoull(from.at("scenario_hash").get<std::string>(), nullptr, 16);
  Convert(from.at("inputs"), plan.inputs, [](const Json& one, auto& input) {
    input.role = one.at("role").get<std::string>();
    input.path = one.at("path").get<std::string>();
    input.hash = one.at("hash").get<std::string>();
  });
}

void SetRanch(const Json& document, RescuePlan& plan) {
  const Json& clock = document.at("clock");
  plan.start = Time(clock.at("start"));
  plan.end = Time(clock.at("end"));
  plan.step_s = Number(clock.at("step_s"));
  plan.utc_offset_min = clock.at("utc_offset_min").get<std::int32_t>();
  const Json& ranch = document.at("ranch");
  plan.width = ranch.at("width").get<std::int32_t>();
  plan.height = ranch.at("height").get<std::int32_t>();
  plan.cell_size_m = Number(ranch.at("cell_size_m"));
  plan.origin_latitude_deg = Number(ranch.at("origin").at("latitude"));
  plan.origin_longitude_deg = Number(ranch.at("origin").at("longitude"));
}

void SetStormPoint(const Json& from, aquafarm_msgs::RescueStormPoint& point) {
  using Point = aquafarm_msgs::RescueStormPoint;
  const auto source = from.at("source").get<std::string>();
  point.stamp = Time(from.at("time"));
  point.source = source == "recorded"   ? Point::RECORDED
                 : source == "forecast" ? Point::FORECAST
                                        : Point::ASSUMED;
  point.x = Number(from.at("at").at(0));
  point.y = Number(from.at("at").at(1));
  point.latitude_deg = Number(from.at("position").at("latitude"));
  point.longitude_deg = Number(from.at("position").at("longitude"));
  point.wind_mps = Single(from.at("wind_mps"));
  point.pressure_hpa = Single(from.value("pressure_hpa", Json()));
  const Json grade = from.value("grade", Json());
  point.grade = grade.is_null() ? 0 : grade.get<std::int32_t>();
  point.radii_km = Singles(from.at("radii_km"));
  point.radii_estimated = from.at("radii_source").get<std::string>() == "estimated";
}

void SetStorm(const Json& document, RescuePlan& plan) {
  const Json& storm = document.at("storm");
  plan.storm_name = storm.at("name").get<std::string>();
  plan.agency = storm.at("agency").get<std::string>();
  plan.storm_file = storm.at("file").get<std::string>();
  plan.issued = Time(storm.at("issued"));
  plan.age_h = Single(storm.at("age_h"));
  plan.hindcast = storm.at("hindcast").get<bool>();
  plan.recorded_until = Time(storm.at("recorded_until"));
  plan.forecast_until = Time(storm.at("forecast_until"));
  Convert(storm.at("points"), plan.storm, SetStormPoint);
  const Json& closest = storm.at("closest_approach");
  plan.closest_km = plan.closest_bearing_deg = kNaN;
  if (!closest.is_null()) {
    plan.closest_stamp = Time(closest.at("time"));
    plan.closest_km = Single(closest.at("distance_km"));
    plan.closest_bearing_deg = Single(closest.at("bearing_deg"));
  }
  Convert(document.at("rings"), plan.rings, [](const Json& one, auto& ring) {
    ring.id = one.at("id").get<std::string>();
    ring.name = one.at("name").get<std::string>();
    ring.wind_kt = Single(one.at("wind_kt"));
    ring.risk = Single(one.at("risk"));
  });
}

void SetEnsemble(const Json& document, RescuePlan& plan) {
  const Json& ensemble = document.at("ensemble");
  plan.seed = ensemble.at("seed").get<std::uint64_t>();
  plan.members = ensemble.at("members").get<std::uint32_t>();
  Convert(ensemble.at("errors"), plan.forecast_error, [](const Json& one, auto& spread) {
    spread.stamp = Time(one.at("time"));
    spread.lead_h = Single(one.at("lead_h"));
    spread.x = Number(one.at("centre").at(0));
    spread.y = Number(one.at("centre").at(1));
    spread.along_km = Single(one.at("along_km"));
    spread.across_km = Single(one.at("across_km"));
    spread.radius70_km = Single(one.at("radius70_km"));
    spread.wind_mps = Single(one.at("wind_mps"));
    spread.size_log = Single(one.at("size_log"));
  });
  Convert(document.at("hazard").at("timeline"), plan.hazard, [](const Json& one, auto& hazard) {
    hazard.stamp = Time(one.at("time"));
    hazard.probability = Singles(one.at("probability"));
  });
}

void SetFleet(const Json& document, RescuePlan& plan) {
  Convert(document.at("ports"), plan.ports, [](const Json& one, auto& port) {
    port.id = Id(one.at("id"));
    port.name = one.at("name").get<std::string>();
    SetPlace(one, port);
  });
  Convert(document.at("ships"), plan.ships, [](const Json& one, auto& ship) {
    ship.id = Id(one.at("id"));
    ship.name = one.at("name").get<std::string>();
    SetPlace(one, ship);
    ship.port = Id(one.at("port"));
    ship.speed_kn = Single(one.at("speed_kn"));
    ship.capacity = one.at("capacity").get<std::int32_t>();
    ship.ready = Time(one.at("ready"));
    ship.aboard = one.value("aboard", std::vector<std::int32_t>{});
  });
}

void SetDeadline(const Json& from, aquafarm_msgs::RescueDeadline& deadline) {
  deadline.probability = Single(from.at("probability"));
  deadline.possible = !from.at("leave").is_null();
  deadline.leave = Time(from.at("leave"));
  deadline.open = from.value("open", false);
  deadline.ship = Id(from.value("ship", Json()));
}

void SetDevice(const Json& from, aquafarm_msgs::RescueDevice& device) {
  device.id = Id(from.at("id"));
  device.name = from.at("name").get<std::string>();
  device.kind = from.at("kind").get<std::string>();
  SetPlace(from, device);
  device.value = Number(from.at("value"));
  device.damage_before = Single(from.at("damage_before"));
  device.ship = device.port = -1;
  const Json& order = from.at("order");
  if (!order.is_null()) {
    device.ship = Id(order.at("ship"));
    device.fetch = Time(order.at("fetch"));
    device.deliver = Time(order.at("deliver"));
    device.port = Id(order.at("port"));
  }
  device.home = Single(from.at("odds").at("home"));
  device.home_before = Singles(from.at("odds").at("home_before"));
  Convert(from.at("arrival"), device.arrival, [](const Json& one, auto& arrival) {
    arrival.probability = Single(one.at("probability"));
    arrival.q05 = Time(one.at("q05"));
    arrival.q50 = Time(one.at("q50"));
    arrival.q95 = Time(one.at("q95"));
  });
  device.expected_damage = Single(from.at("expected_damage"));
  device.expected_loss = Number(from.at("expected_loss"));
  device.expected_loss_idle = Number(from.at("expected_loss_idle"));
  Convert(from.at("deadlines"), device.deadlines, SetDeadline);
}

std::uint8_t ActionOf(const std::string& name) {
  using Order = aquafarm_msgs::RescueOrder;
  if (name == "leave") return Order::LEAVE;
  if (name == "fetch") return Order::FETCH;
  if (name == "deliver") return Order::DELIVER;
  return Order::WAIT;
}

void SetOrder(const Json& from, aquafarm_msgs::RescueOrder& order) {
  order.action = ActionOf(from.at("action").get<std::string>());
  order.stamp = Time(from.at("time"));
  SetPlace(from, order);
  order.device = Id(from.at("device"));
  if (from.contains("devices")) order.devices = from.at("devices").get<std::vector<std::int32_t>>();
  order.port = Id(from.at("port"));
  order.km = Single(from.at("km"));
  order.kwh = Single(from.at("kwh"));
  order.probability = Single(from.at("probability"));
}

void SetRoutes(const Json& from, RescuePlan& plan) {
  plan.objective = from.at("objective").get<std::string>();
  plan.method = from.value("method", "");
  plan.expected_value = Number(from.at("expected_value"));
  plan.bound = Number(from.at("bound"));
  Convert(from.at("routes"), plan.routes, [&plan](const Json& one, auto& route) {
    route.ship = Id(one.at("ship"));
    route.km = Single(one.at("km"));
    route.kwh = Single(one.at("kwh"));
    Convert(one.at("orders"), route.orders, SetOrder);
    for (const Json& at : one.at("path")) {
      aquafarm_msgs::Cell cell;
      cell.x = static_cast<std::int32_t>(std::lround(at.at(0).get<double>()));
      cell.y = static_cast<std::int32_t>(std::lround(at.at(1).get<double>()));
      route.path.push_back(cell);
      route.path_stamps.push_back(plan.start + ros::Duration(at.at(2).get<double>()));
    }
  });
  for (const Json& left : from.at("left_behind")) {
    auto& device = plan.devices.at(left.at("device").get<std::size_t>());
    device.left_reason = left.at("reason").get<std::string>();
    device.left_text = left.at("text").get<std::string>();
  }
}

void SetLossOf(const Json& from, aquafarm_msgs::RescueLoss& loss) {
  loss.mean = Number(from.at("mean"));
  loss.standard_error = Number(from.at("standard_error"));
  loss.q05 = Number(from.at("q05"));
  loss.q50 = Number(from.at("q50"));
  loss.q95 = Number(from.at("q95"));
  loss.cvar05 = Number(from.at("cvar05"));
  for (const Json& point : from.at("exceedance")) {
    loss.exceedance_loss.push_back(Number(point.at(0)));
    loss.exceedance_probability.push_back(Number(point.at(1)));
  }
}

void SetMoney(const Json& document, RescuePlan& plan) {
  const Json& loss = document.at("loss");
  plan.currency = Text(loss.at("currency"));
  plan.insured = Number(loss.at("insured"));
  plan.operating_cost = Number(loss.value("operating_cost", Json()));
  SetLossOf(loss.at("with_plan"), plan.loss);
  SetLossOf(loss.at("idle"), plan.loss_idle);
  Convert(document.at("what_if"), plan.what_if, [](const Json& one, auto& change) {
    change.change = one.at("change").get<std::string>();
    change.text = one.at("text").get<std::string>();
    change.possible = one.at("possible").get<bool>();
    change.mean_loss = Number(one.at("mean_loss"));
    change.q95 = Number(one.at("q95"));
    change.devices_home = Single(one.at("devices_home"));
    change.all_home = Single(one.at("all_home"));
    change.difference = change.difference_low = change.difference_high = kNaN;
    const Json& difference = one.at("difference");
    if (difference.is_null()) return;
    change.difference = Number(difference.at("mean"));
    change.difference_low = Number(difference.at("low"));
    change.difference_high = Number(difference.at("high"));
  });
}

void SetWords(const Json& document, RescuePlan& plan) {
  plan.result = document.at("outcome").at("exit_code").get<std::uint8_t>();
  plan.text = document.at("outcome").at("text").get<std::string>();
  plan.unknown = Text(document.at("outcome").value("unknown", Json()));
  Convert(document.at("warnings"), plan.warnings, [](const Json& one, auto& warning) {
    warning.code = one.at("code").get<std::string>();
    warning.severity = one.at("severity").get<std::string>();
    warning.text = one.at("text").get<std::string>();
    warning.advice = one.at("advice").get<std::string>();
    warning.ship = Id(one.value("ship", Json()));
  });
  Convert(document.at("assumptions"), plan.assumptions, [](const Json& one, auto& assumption) {
    assumption.what = one.at("what").get<std::string>();
    assumption.value = one.at("value").get<std::string>();
    assumption.basis = one.at("basis").get<std::string>();
    assumption.source = one.at("source").get<std::string>();
  });
  const Json& deadlines = document.at("deadlines");
  plan.first_departure = Time(deadlines.value("first_departure", Json()));
  plan.no_departure_after = Time(deadlines.at("no_departure_after"));
  plan.not_known_beyond = Time(deadlines.value("not_known_beyond", Json()));
  plan.no_departure_rule = deadlines.at("rule").get<std::string>();
}

nav_msgs::OccupancyGrid ChartOf(const Json& ranch, const RescuePlan& plan) {
  nav_msgs::OccupancyGrid chart;
  chart.info.resolution = static_cast<float>(plan.cell_size_m);
  chart.info.width = static_cast<std::uint32_t>(plan.width);
  chart.info.height = static_cast<std::uint32_t>(plan.height);
  chart.info.origin.position.x = chart.info.origin.position.y = -0.5 * plan.cell_size_m;
  chart.info.origin.orientation.w = 1.0;
  chart.data.assign(static_cast<std::size_t>(chart.info.width) * chart.info.height, 0);
  for (const char* kind : {"land", "rocks"}) {
    for (const Json& one : ranch.at(kind)) {
      const aquafarm_msgs::Cell cell = CellOf(one);
      chart.data.at(static_cast<std::size_t>(cell.y * plan.width + cell.x)) = 100;
    }
  }
  return chart;
}

}  // namespace

PlanMessages ReadPlan(const std::string& json, const std::string& where) {
  try {
    const Json document = Json::parse(json);
    if (document.at("version") != 1) throw std::out_of_range("version: got another version than 1");
    PlanMessages messages;
    RescuePlan& plan = messages.plan;
    SetProvenance(document.at("provenance"), plan);
    SetRanch(document, plan);
    SetStorm(document, plan);
    SetEnsemble(document, plan);
    SetFleet(document, plan);
    Convert(document.at("devices"), plan.devices, SetDevice);
    SetRoutes(document.at("plan"), plan);
    SetMoney(document, plan);
    SetWords(document, plan);
    messages.chart = ChartOf(document.at("ranch"), plan);
    return messages;
  } catch (const std::exception& error) {  // for example from nlohmann::json or ParseUtc
    throw aquafarm::InputError(where + ": " + error.what() +
                               "; expected a plan file of version 1, make it again with "
                               "aquafarm_plan --json");
  }
}

nav_msgs::Path PathOfShip(const RescuePlan& plan, std::int32_t ship) {
  nav_msgs::Path path;
  path.header = plan.header;
  for (const auto& route : plan.routes) {
    if (route.ship != ship) continue;
    for (std::size_t i = 0; i < route.path.size(); ++i) {
      geometry_msgs::PoseStamped pose;
      pose.header = plan.header;
      pose.header.stamp = route.path_stamps[i];
      pose.pose.position.x = route.path[i].x * plan.cell_size_m;
      pose.pose.position.y = route.path[i].y * plan.cell_size_m;
      const std::size_t next = std::min(i + 1, route.path.size() - 1);
      const double yaw =
          std::atan2(route.path[next].y - route.path[i].y, route.path[next].x - route.path[i].x);
      pose.pose.orientation.z = std::sin(yaw / 2.0);
      pose.pose.orientation.w = std::cos(yaw / 2.0);
      path.poses.push_back(pose);
    }
  }
  return path;
}

}  // namespace aquafarm_agents
