// SPDX-License-Identifier: BSD-3-Clause
// Writes plan.json, which aquafarm_bringup/python/aquafarm_plan/plan.schema.json specifies.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/base/angle.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/tracks/track.h"
#include "aquafarm/tracks/wind_name.h"
#include "rescue/case_parts.h"
#include "rescue/plan_values.h"

namespace aquafarm::agents {
namespace {

class JsonReport {
 public:
  JsonReport(const RescueCase& rescue, const Ensemble& ensemble, const PlanReport& report)
      : case_(rescue), ensemble_(ensemble), report_(report) {}

  Json Make(const PlanProvenance& provenance) const {
    return {{"format", "aquafarm_plan"},
            {"version", 1},
            {"provenance", Provenance(provenance)},
            {"outcome", Outcome()},
            {"warnings", WarningsOf(case_)},
            {"clock", Clock()},
            {"ranch", Ranch()},
            {"rings", Rings()},
            {"storm", Storm()},
            {"ensemble", Members()},
            {"hazard", Hazard()},
            {"ports", Ports()},
            {"ships", Ships()},
            {"devices", Devices()},
            {"plan", Plan()},
            {"loss", Loss()},
            {"deadlines", AllDeadlines()},
            {"what_if", Changes()},
            {"assumptions", AssumptionsOf(case_)}};
  }

 private:
  std::string Time(double time_s) const { return FormatUtc(case_.start + std::llround(time_s)); }
  Json TimeOrNull(std::optional<double> time_s) const {
    return time_s ? Json(Time(*time_s)) : Json(nullptr);
  }
  Json PlaceOf(Cell cell) const { return OfPlace(case_.frame.ToGeo(cell.x, cell.y)); }
  double StepTime(std::int32_t step) const { return step * ensemble_.options().step_s; }
  Json Kwh(double kwh) const {
    return case_.problem.energy ? Json(Rounded(kwh, 0.001)) : Json(nullptr);
  }
  // Returns `value`; null for kStormUnknown. In this case the members' winds reach cells too late
  // or not at all, so the value would show too little danger.
  Json Known(Json value) const { return AreWindsUnknown() ? Json(nullptr) : std::move(value); }
  Json Chance(double share) const { return Known(Share(share)); }
  Json MemberShare(std::int32_t count) const {
    return Chance(static_cast<double>(count) / ensemble_.members());
  }
  bool AreWindsUnknown() const { return report_.result == PlanResult::kStormUnknown; }

  Json Provenance(const PlanProvenance& provenance) const {
    Json inputs = Json::array();
    for (const auto& [role, path] : provenance.inputs) {
      inputs.push_back({{"role", role}, {"path", path}, {"hash", Hex(HashBytes(ReadFile(path)))}});
    }
    return {{"program_version", kVersion},
            {"command", provenance.command},
            {"computed_at", FormatUtc(provenance.computed_at)},
            {"compute_s", Rounded(provenance.compute_s, 0.001)},
            {"seed", ensemble_.options().seed},
            {"scenario_name", case_.scenario->name},
            {"scenario_hash", Hex(case_.scenario->hash)},
            {"inputs", inputs}};
  }

  Json Outcome() const {
    const char* kind = "plan";
    switch (report_.result) {
      case PlanResult::kNothingSaved:
        kind = "nothing_can_be_saved";
        break;
      case PlanResult::kStormStaysAway:
        kind = "storm_stays_away";
        break;
      case PlanResult::kStormUnknown:
        kind = "storm_unknown";
        break;
      default:
        break;
    }
    return {{"kind", kind},
            {"exit_code", static_cast<int>(report_.ExitCode())},
            {"text", report_.text},
            {"unknown", AreWindsUnknown() ? Json(WhyUnknown(case_)) : Json(nullptr)}};
  }

  Json Clock() const {
    return {{"start", Time(0.0)},
            {"end", Time(StepTime(ensemble_.steps() - 1))},
            {"step_s", ensemble_.options().step_s},
            {"utc_offset_min", case_.utc_offset_min},
            {"zone", ZoneName(case_.utc_offset_min)}};
  }

  Json Ranch() const {
    const Scenario& scenario = *case_.scenario;
    Json land = Json::array();
    Json rocks = Json::array();
    for (std::int32_t y = 0; y < scenario.height; ++y) {
      for (std::int32_t x = 0; x < scenario.width; ++x) {
        const std::uint8_t bits = case_.layout.bits({x, y});
        if ((bits & kIslandBit) != 0) land.push_back(OfCell({x, y}));
        if ((bits & kRockBit) != 0) rocks.push_back(OfCell({x, y}));
      }
    }
    const double east = scenario.width - 0.5;
    const double north = scenario.height - 0.5;
    Json corners = Json::array();
    for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {east, -0.5}, {east, north}, {-0.5, north}}) {
      corners.push_back(OfPlace(case_.frame.ToGeo(x, y)));
    }
    return {{"name", scenario.name},
            {"description", scenario.description},
            {"width", scenario.width},
            {"height", scenario.height},
            {"cell_size_m", scenario.cell_size_m},
            {"origin", OfPlace(*scenario.origin)},
            {"corners", corners},
            {"land", land},
            {"rocks", rocks}};
  }

  Json Rings() const {
    Json list = Json::array();
    const StormPath& path = case_.forecast.path;
    const StormPoint& first = path.points.front();
    const auto& row =
        case_.forecast.risks[static_cast<std::size_t>(DisasterGrade(first.grade) - 1)];
    for (std::size_t ring = 0; ring < path.rings; ++ring) {
      const std::int32_t wind = path.wind_kt[ring];
      const std::size_t weaker = path.rings - 1 - ring;
      const float risk = weaker < row.size() ? row[row.size() - 1 - weaker] : row.front();
      list.push_back({{"id", std::to_string(wind) + "kt"},
                      {"name", RingName(wind)},
                      {"wind_kt", wind},
                      {"risk", risk}});
    }
    return list;
  }

  Json StormPoints() const {
    Json list = Json::array();
    for (const StormWaypoint& at : case_.storm.rings.waypoints) {
      if (!case_.frame.Faces(at.position)) continue;
      const std::array<double, 2> cell = case_.frame.ToGrid(at.position);
      Json radii = Json::array();
      for (const double km : at.radii_km) {
        radii.push_back(at.silent ? Json(nullptr) : Json(Rounded(km, 0.1)));
      }
      const char* source = !at.forecast                                            ? "recorded"
                           : case_.storm.is_hindcast || case_.storm.is_persistence ? "assumed"
                                                                                   : "forecast";
      const char* radii_source = at.silent      ? "none"
                                 : at.estimated ? "estimated"
                                 : at.forecast  ? "forecast"
                                                : "recorded";
      list.push_back(
          {{"time", FormatUtc(at.time)},
           {"source", source},
           {"position", OfPlace(at.position)},
           {"at", {Rounded(cell[0], 0.01), Rounded(cell[1], 0.01)}},
           {"wind_mps", at.wind_mps ? Json(*at.wind_mps) : Json(nullptr)},
           {"wind_minutes", at.averaging_min > 0 ? Json(at.averaging_min) : Json(nullptr)},
           {"pressure_hpa", at.pressure_hpa ? Json(*at.pressure_hpa) : Json(nullptr)},
           {"grade", at.silent ? Json(nullptr) : Json(DisasterGrade(at.grade))},
           {"radii_km", radii},
           {"radii_source", radii_source}});
    }
    return list;
  }

  Json Storm() const {
    const StormRecord& storm = case_.storm;
    Json closest = nullptr;
    if (const auto at = storm.rings.At(storm.passage.nearest_time)) {
      const std::array<double, 2> cell = case_.frame.ToGrid(at->position);
      const double east = cell[0] - (case_.scenario->width - 1) / 2.0;
      const double north = cell[1] - (case_.scenario->height - 1) / 2.0;
      const double bearing = std::atan2(east, north) / kRadiansPerDegree;
      closest = {{"time", FormatUtc(storm.passage.nearest_time)},
                 {"distance_km", Rounded(storm.passage.nearest_km, 0.1)},
                 {"bearing_deg", Rounded(bearing < 0.0 ? bearing + 360.0 : bearing, 0.1)}};
    }
    const bool has_forecast = storm.known_until && *storm.known_until > storm.recorded_until;
    return {{"kind", "typhoon"},
            {"name", storm.name},
            {"agency", storm.agency},
            {"file", storm.file},
            {"issued", storm.issued ? Json(FormatUtc(*storm.issued)) : Json(nullptr)},
            {"age_h", Rounded(storm.age_h, 0.01)},
            {"hindcast", storm.is_hindcast},
            {"recorded_until", FormatUtc(storm.recorded_until)},
            {"forecast_until", has_forecast ? Json(FormatUtc(*storm.known_until)) : Json(nullptr)},
            {"points", StormPoints()},
            {"closest_approach", closest}};
  }

  // Returns whether a point of the ensemble is also a point of the storm's track. (ToFineRings adds
  // points between those of the track.)
  bool IsPointOfForecast(const EnsembleSpread& at) const {
    const std::int64_t time = case_.start + std::llround(at.time_s);
    const auto& points = case_.storm.rings.waypoints;
    return std::any_of(points.begin(), points.end(),
                       [time](const StormWaypoint& point) { return point.time == time; });
  }

  Json Members() const {
    Json errors = Json::array();
    for (const EnsembleSpread& at : ensemble_.spread()) {
      if (at.lead_h < 0.0 || !IsPointOfForecast(at)) continue;
      errors.push_back({{"lead_h", Rounded(at.lead_h, 0.01)},
                        {"time", Time(at.time_s)},
                        {"centre", {Rounded(at.center[0], 0.01), Rounded(at.center[1], 0.01)}},
                        {"along_km", Rounded(at.along_km, 0.1)},
                        {"across_km", Rounded(at.across_km, 0.1)},
                        {"radius70_km", Rounded(at.radius70_km, 0.1)},
                        {"wind_mps", Known(Rounded(at.wind_mps, 0.01))},
                        {"size_log", Known(Rounded(at.size_log, 0.001))}});
    }
    return {
        {"members", ensemble_.members()}, {"seed", ensemble_.options().seed}, {"errors", errors}};
  }

  // Returns steps about `hours` apart, from step 0 on.
  std::vector<std::int32_t> StepsEvery(double hours) const {
    std::vector<std::int32_t> steps;
    const auto by =
        std::max(1, static_cast<std::int32_t>(hours * 3600.0 / ensemble_.options().step_s));
    for (std::int32_t step = 0; step < ensemble_.steps(); step += by) steps.push_back(step);
    return steps;
  }

  Json Hazard() const {
    Json timeline = Json::array();
    for (const std::int32_t step : StepsEvery(1.0)) {
      Json shares = Json::array();
      for (std::int32_t ring = 0; ring < ensemble_.rings(); ++ring) {
        shares.push_back(MemberShare(ensemble_.Touching(ring, step)));
      }
      timeline.push_back({{"time", Time(StepTime(step))}, {"probability", shares}});
    }
    Json frames = Json::array();
    for (const std::int32_t step : StepsEvery(2.0)) {
      if (AreWindsUnknown()) break;  // no frames: an empty grid would mean 0 % everywhere
      Json percents = Json::array();
      for (std::int32_t ring = 0; ring < ensemble_.rings(); ++ring) {
        percents.push_back(Percents(ring, step));
      }
      frames.push_back({{"time", Time(StepTime(step))}, {"percent", percents}});
    }
    return {{"timeline", timeline}, {"frames", frames}};
  }

  Json Percents(std::int32_t ring, std::int32_t step) const {
    Json grid = Json::array();
    if (ensemble_.Touching(ring, step) == 0) return grid;
    const std::uint16_t* covered = ensemble_.Covered(ring, step);
    const std::int32_t cells = ensemble_.options().width * ensemble_.options().height;
    for (std::int32_t cell = 0; cell < cells; ++cell) {
      grid.push_back(std::lround(100.0 * covered[cell] / ensemble_.members()));
    }
    return grid;
  }

  Json Ports() const {
    Json list = Json::array();
    for (const RescuePort& port : case_.problem.ports) {
      list.push_back({{"id", list.size()},
                      {"name", port.name},
                      {"cell", OfCell(port.cell)},
                      {"position", PlaceOf(port.cell)}});
    }
    return list;
  }

  std::int32_t PortAt(Cell cell) const {
    const auto& ports = case_.problem.ports;
    for (std::size_t port = 0; port < ports.size(); ++port) {
      if (ports[port].cell == cell) return static_cast<std::int32_t>(port);
    }
    return kNone;
  }

  Json Ships() const {
    Json list = Json::array();
    for (const RescueShip& ship : case_.problem.ships) {
      list.push_back({{"id", list.size()},
                      {"name", ship.name},
                      {"cell", OfCell(ship.cell)},
                      {"position", PlaceOf(ship.cell)},
                      {"port", OfId(PortAt(ship.cell))},
                      {"speed_kn", Rounded(ship.speed_kn, 0.01)},
                      {"capacity", ship.capacity},
                      {"ready", Time(ship.ready_s)},
                      {"aboard", ship.aboard}});
    }
    return list;
  }

  Json Arrivals(Cell site) const {
    Json list = Json::array();
    for (std::int32_t ring = 0; ring < ensemble_.rings(); ++ring) {
      const std::int16_t* arrival = ensemble_.Arrival(ring, site);
      std::vector<std::int16_t> sorted(arrival, arrival + ensemble_.members());
      std::sort(sorted.begin(), sorted.end());
      const auto reached = std::lower_bound(sorted.begin(), sorted.end(), Ensemble::kNoArrival);
      const auto at = [&](double share) {
        const auto rank = static_cast<std::size_t>(
            std::max(0.0, std::ceil(share * static_cast<double>(sorted.size())) - 1.0));
        return sorted[rank] == Ensemble::kNoArrival ? Json(nullptr)
                                                    : Known(Time(StepTime(sorted[rank])));
      };
      list.push_back(
          {{"probability", MemberShare(static_cast<std::int32_t>(reached - sorted.begin()))},
           {"q05", at(0.05)},
           {"q50", at(0.5)},
           {"q95", at(0.95)}});
    }
    return list;
  }

  Json DeadlinesOf(std::size_t device) const {
    Json list = Json::array();
    for (const Deadline& one : report_.deadlines[device]) {
      list.push_back({{"probability", one.probability},
                      {"leave", Known(TimeOrNull(one.leave_s))},
                      {"open", one.is_open && !AreWindsUnknown()},
                      {"ship", Known(OfId(one.ship))}});
    }
    return list;
  }

  Json Devices() const {
    Json list = Json::array();
    for (std::size_t d = 0; d < case_.problem.devices.size(); ++d) {
      const RescueDevice& device = case_.problem.devices[d];
      const DeviceOutcome& outcome = report_.plan.devices[d];
      Json order = nullptr;
      if (outcome.ship != kNone) {
        order = {{"ship", outcome.ship},
                 {"fetch", Time(outcome.fetch_s)},
                 {"deliver", Time(outcome.deliver_s)},
                 {"port", outcome.port}};
      }
      Json before = Json::array();
      for (const double share : outcome.home_before) before.push_back(Chance(share));
      const double damage = device.value > 0.0 ? outcome.mean_loss / device.value : 0.0;
      list.push_back({{"id", d},
                      {"name", device.name},
                      {"kind", device.kind},
                      {"cell", OfCell(device.cell)},
                      {"position", PlaceOf(device.cell)},
                      {"value", Money(device.value)},
                      {"damage_before", Share(device.damage_before)},
                      {"order", order},
                      {"odds", {{"home", Chance(outcome.home)}, {"home_before", before}}},
                      {"arrival", Arrivals(device.cell)},
                      {"expected_damage", Chance(damage)},
                      {"expected_loss", Known(Money(std::max(0.0, outcome.mean_loss)))},
                      {"expected_loss_idle", Known(Money(outcome.mean_loss_idle))},
                      {"deadlines", DeadlinesOf(d)}});
    }
    return list;
  }

  Json Orders(const ShipRoute& route) const {
    Json list = Json::array();
    for (const RescueOrder& order : route.orders) {
      Json one{{"action", ToString(order.kind)},
               {"time", Time(order.time_s)},
               {"cell", OfCell(order.cell)},
               {"position", PlaceOf(order.cell)},
               {"device", OfId(order.device)},
               {"port", OfId(order.port)},
               {"km", Km(order.km)},
               {"kwh", Kwh(order.kwh)},
               {"probability", Chance(order.probability)}};
      if (order.kind == OrderKind::kDeliver) one["devices"] = order.devices;
      list.push_back(std::move(one));
    }
    return list;
  }

  Json Plan() const {
    Json routes = Json::array();
    for (const ShipRoute& route : report_.plan.routes) {
      Json path = Json::array();
      for (const TimedCell& at : route.path) {
        path.push_back({at.cell.x, at.cell.y, Rounded(at.time_s, 0.1)});
      }
      routes.push_back({{"ship", route.ship},
                        {"km", Km(route.km)},
                        {"kwh", Kwh(route.kwh)},
                        {"orders", Orders(route)},
                        {"path", path}});
    }
    return {{"objective", ObjectiveOf(case_.problem)},
            {"method", MethodOf(case_.problem, report_.plan)},
            {"expected_value", Known(Money(report_.plan.saved))},
            {"bound", Known(Money(std::max(report_.plan.bound, report_.plan.saved)))},
            {"routes", routes},
            {"left_behind", LeftBehindOf(case_, report_)}};
  }

  Json Loss() const {
    double insured = 0.0;
    for (const RescueDevice& device : case_.problem.devices) insured += device.value;
    return {{"currency", case_.currency.empty() ? Json(nullptr) : Json(case_.currency)},
            {"insured", Money(insured)},
            {"operating_cost",
             IsPriced(case_.problem) ? Known(Money(report_.plan.cost)) : Json(nullptr)},
            {"with_plan", AreWindsUnknown() ? UnknownLoss() : LossOf(report_.plan.loss)},
            {"idle", AreWindsUnknown() ? UnknownLoss() : LossOf(report_.plan.loss_idle)}};
  }

  Json AllDeadlines() const {
    std::optional<double> first;
    for (const ShipRoute& route : report_.plan.routes) {
      const double leave_s = route.orders.front().time_s;
      if (!first || leave_s < *first) first = leave_s;
    }
    const LastDeparture last = LastDepartureOf(case_.problem, report_);
    return {{"first_departure", TimeOrNull(first)},
            {"no_departure_after", TimeOrNull(last.none_after_s)},
            {"not_known_beyond", TimeOrNull(last.not_known_beyond_s)},
            {"rule",
             "the latest departure that still brings a device from its place to port with a "
             "chance of at least 50 %"}};
  }

  Json Changes() const {
    Json list = Json::array();
    for (const WhatIf& row : report_.what_if) {
      Json one{{"change", row.change}, {"text", row.text}, {"possible", row.is_possible}};
      const bool is_known = row.is_possible && !AreWindsUnknown();
      const auto or_null = [&](double value) { return is_known ? Json(value) : Json(nullptr); };
      one["mean_loss"] = or_null(Money(row.loss.mean));
      one["q95"] = or_null(Money(row.loss.q95));
      one["devices_home"] = or_null(Money(row.devices_home));
      one["all_home"] = or_null(Share(row.all_home));
      one["difference"] = nullptr;
      if (is_known) {
        one["difference"] = {{"mean", Money(row.difference)},
                             {"low", Money(row.difference_low)},
                             {"high", Money(row.difference_high)}};
      }
      list.push_back(std::move(one));
    }
    return list;
  }

  const RescueCase& case_;
  const Ensemble& ensemble_;
  const PlanReport& report_;
};

}  // namespace

std::string ToJson(const RescueCase& rescue, const Ensemble& ensemble, const PlanReport& report,
                   const PlanProvenance& provenance) {
  return JsonReport(rescue, ensemble, report).Make(provenance).dump(1) + "\n";
}

}  // namespace aquafarm::agents
