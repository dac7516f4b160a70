// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A storm that passes over a ranch of 12 × 10 cells from west to east, and a small rescue problem.

#include <string>

#include "aquafarm/agents/rescue/rescue_plan.h"
#include "aquafarm/tracks/wind_radii.h"

namespace aquafarm::agents::test {

inline const std::string kScenarios = AQUAFARM_SCENARIO_DIR;

/// Returns a storm whose centre moves 40 cells of 5 km to the east in 60 steps of 10 minutes, along
/// the row y = 5 of the ranch.
inline CentralForecast PassingStorm() {
  CentralForecast forecast;
  StormPath& path = forecast.path;
  path.wind_kt = {64, 50, 34};
  path.rings = 3;
  path.cell_size_km = 5.0;
  path.step_duration_s = 600.0;
  for (int i = 0; i < 3; ++i) {
    StormPoint point;
    point.step = 30.0 * i;
    point.x = -20.0 + 20.0 * i;
    point.y = 5.0;
    point.east = 1.0;
    point.north = 0.0;
    point.latitude = 30.0;
    point.wind_mps = 40.0;
    point.averaging_min = 2;
    point.grade = StormGrade::kTyphoon;
    point.radius = {3.0, 6.0, 9.0};
    for (std::size_t ring = 0; ring < path.rings; ++ring) {
      point.median_km[ring] =
          EstimateRadius(path.wind_kt[ring], point.wind_mps, point.latitude, point.averaging_min)
              .median_km;
    }
    path.points.push_back(point);
    forecast.lead_h.push_back(5.0 * i);
  }
  forecast.risks.assign(4, {-20.0F, -10.0F, -5.0F});
  return forecast;
}

inline EnsembleOptions SmallEnsemble(std::int32_t members) {
  EnsembleOptions options;
  options.members = members;
  options.width = 12;
  options.height = 10;
  options.cell_size_km = 5.0;
  options.step_s = 600.0;
  options.steps = 61;
  return options;
}

/// Returns a problem with three devices, two ports and two ships on a map without land.
inline RescueProblem SmallRescue() {
  RescueProblem problem;
  problem.water.setOnes(10, 12);
  problem.cell_size_km = 5.0;
  problem.devices = {{"F1", "monitoring", {3, 2}, 100.0, 0.0},
                     {"F2", "monitoring", {6, 8}, 70.0, 0.1},
                     {"F3", "monitoring", {9, 4}, 40.0, 0.0}};
  problem.ports = {{"port A", {11, 0}, true}, {"port B", {11, 9}, true}};
  problem.ships = {{"ship 1", {11, 0}, 60.0, 1, 0.0}, {"ship 2", {11, 9}, 45.0, 1, 1200.0}};
  problem.handling_s = 600.0;
  problem.abort_ring = 2;
  problem.exposure_damage = 0.004;
  return problem;
}

inline std::vector<Cell> SitesOf(const RescueProblem& problem) {
  std::vector<Cell> sites;
  for (const RescueDevice& device : problem.devices) sites.push_back(device.cell);
  return sites;
}

}  // namespace aquafarm::agents::test
