// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/base/check.h"
#include "rescue/case_parts.h"

namespace aquafarm::agents {
namespace {

// Returns the ring whose winds stop ships: the strongest ring whose wind is at most the limit. If
// all are stronger, returns the weakest ring.
std::int32_t AbortRing(const StormPath& path, double limit_kt) {
  for (std::size_t ring = 0; ring < path.rings; ++ring) {
    if (path.wind_kt[ring] <= limit_kt) return static_cast<std::int32_t>(ring);
  }
  return static_cast<std::int32_t>(path.rings) - 1;
}

// Returns the range of the ships' speeds as text, and whether the operator gave the speeds.
std::pair<std::string, bool> SpeedsOf(const RescueRequest& request, const RescueCase& rescue) {
  const auto& ships = rescue.problem.ships;
  if (ships.empty()) return {"no ship", false};
  const auto [slowest, fastest] =
      std::minmax_element(ships.begin(), ships.end(),
                          [](const auto& a, const auto& b) { return a.speed_kn < b.speed_kn; });
  const std::string low = Short(slowest->speed_kn, 1);
  const std::string high = Short(fastest->speed_kn, 1);
  return {low + (low == high ? "" : " to " + high) + " kn",
          request.speed_kn || !request.ships_file.empty()};
}

void ListAssumptions(const RescueRequest& request, RescueCase& rescue) {
  const auto add = [&](const std::string& what, const std::string& value, const std::string& basis,
                       const std::string& source) {
    rescue.assumptions.push_back({what, value, basis, source});
  };
  const StormPath& path = rescue.forecast.path;
  const auto ring = static_cast<std::size_t>(rescue.problem.abort_ring);
  add("A ship stops work for good when winds of this force have reached its cell",
      std::to_string(path.wind_kt[ring]) + " kt",
      request.abort_wind_kt == RescueRequest{}.abort_wind_kt ? "assumed" : "given",
      "--abort-wind " + Short(request.abort_wind_kt, 0) + "; the ring at or below it is used");
  add("Mean position error of the forecast after 24, 48, 72, 96 and 120 h",
      "66.2, 119.5, 176.3, 244.3, 328.5 km", "published",
      "China Meteorological Administration in 2015: Meteorological Monthly 43(4), 2017");
  add("Mean wind error of the forecast after 24, 48 and 72 h", "4.4, 6.5, 7.8 m/s", "published",
      "Middle of four centres in 2012: Chen, Yu and Cao, Meteorological Monthly 39(10), 2013");
  const bool is_reported = std::isfinite(rescue.forecast.size_report_h);
  add("Spread of the radii of a storm's winds",
      is_reported ? "log-normal, one factor per storm, 10 % at the last report with radii, growing"
                  : "log-normal, one factor per storm, the same at all lead times",
      "estimated",
      is_reported
          ? "The deviation from the estimate by wind and latitude decays by a factor e in "
            "165 h: JMA best tracks of 2015 to 2021 (docs/plan.md); 10 % is assumed"
          : "Spread of recorded radii about the estimate by wind and latitude (docs/data.md)");
  if (rescue.storm.held > 0) {
    add("Radii between two points of the track if the wind cannot be interpolated",
        "the larger radii of the two points", "assumed",
        "Chosen to be safe: radii can be estimated only from a wind");
  }
  add("Position errors along and across the track", "normal, equal, correlated by exp(-dt / 48 h)",
      "assumed", "The published statistics contain only mean distances");
  add("Damage of a device at its site",
      Short(100.0 * static_cast<double>(rescue.scenario->damage.exposure_damage), 3) +
          " % of its value per unit of risk and per " + Short(rescue.scenario->step_duration_s, 0) +
          " s",
      "assumed",
      rescue.scenario->damage.DependsOnKinds()
          ? "damage.exposure_damage of the ranch, times damage.kinds of the device in a typhoon"
          : "damage.exposure_damage of the ranch");
  add("A device that is not delivered", "takes the damage of the whole storm at its site",
      "assumed", "Also if it is aboard a ship that stopped");
  const auto [speed, is_given] = SpeedsOf(request, rescue);
  add("Speed of the ships", speed, is_given ? "given" : "assumed",
      "with and without a device in tow; one cell per step of the ranch unless given");
  add("Time for a pickup or a drop-off", Short(rescue.problem.handling_s / 60.0, 0) + " min",
      "assumed", "one step of the ranch");
  add("Local time", ZoneName(rescue.utc_offset_min), request.utc_offset_h ? "given" : "assumed",
      "from the longitude unless given");
}

}  // namespace

bool IsPriced(const RescueProblem& problem) {
  return problem.energy && (problem.energy->per_kwh > 0.0 || problem.energy->per_hour > 0.0);
}

std::string ZoneName(std::int32_t offset_min) {
  const std::int32_t minutes = std::abs(offset_min);
  const std::string rest = std::to_string(100 + minutes % 60).substr(1);  // two digits
  return (offset_min < 0 ? "UTC-" : "UTC+") + std::to_string(minutes / 60) +
         (minutes % 60 == 0 ? "" : ":" + rest);
}

std::string Short(double value, int digits) {
  char text[64];
  const int count = std::snprintf(text, sizeof(text), "%.*f", digits, value);
  std::string result(text, static_cast<std::size_t>(std::max(0, count)));
  const bool is_zero = result.find_first_of("123456789") == std::string::npos;
  if (is_zero && !result.empty() && result[0] == '-') result.erase(0, 1);  // -0.0 becomes 0.0
  return result;
}

RescueCase MakeRescueCase(std::shared_ptr<const Scenario> scenario, const RescueRequest& request) {
  if (!scenario->origin) {
    throw InputError(scenario->name + ": got no grid.origin, expected the place of the ranch");
  }
  RescueCase rescue;
  rescue.scenario = std::move(scenario);
  rescue.frame = GeoFrame(*rescue.scenario->origin, rescue.scenario->cell_size_m);
  rescue.currency = request.currency;
  LayoutGenerator(*rescue.scenario).Generate(0, 0, rescue.layout);
  const double offset_h =
      request.utc_offset_h.value_or(std::round(rescue.scenario->origin->longitude / 15.0));
  rescue.utc_offset_min = static_cast<std::int32_t>(std::lround(60.0 * offset_h));
  ReadStorm(request, rescue);
  ReadFleet(request, rescue);
  rescue.problem.abort_ring = AbortRing(rescue.forecast.path, request.abort_wind_kt);
  ListAssumptions(request, rescue);
  return rescue;
}

}  // namespace aquafarm::agents
