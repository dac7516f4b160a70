// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Slow oracle for the planners: tries every sequence of actions on a tiny farm.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include "aquafarm/agents/planning/planner.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm::agents::test {

// Returns a scenario of 4 × 3 cells with an island, a rock, a port, two devices, one ship and a
// storm.
inline Scenario TinyScenario(std::int32_t duration, float exposure, std::int32_t capacity) {
  Scenario scenario;
  scenario.name = "tiny";
  scenario.width = 4;
  scenario.height = 3;
  scenario.islands = {{{0, 0}, 1, 1}};
  scenario.rocks.cells = {{2, 1}};
  scenario.rocks.reward = {-2.0F, -1.0F};
  scenario.ports.cells = {{1, 0}};
  scenario.ships.capacity = capacity;
  scenario.devices.placement = DevicePlacement::kExplicit;
  scenario.devices.sites = {{{3, 0}, DeviceKind::kMonitoring, 60.0F, false},
                            {{1, 2}, DeviceKind::kMonitoring, 9.0F, false}};
  scenario.damage.exposure_damage = exposure;
  scenario.damage.crash_probability = 0.5F;
  DisasterSpec storm;
  storm.radii = {0.8F, 1.7F};
  storm.risks = {-20.0F, -5.0F};
  storm.turn_probability = 0.4F;
  storm.duration = duration;
  scenario.disasters = {storm};
  ValidateScenario(scenario);
  return scenario;
}

// Returns the max return of all action sequences from the present state on, by trying each of them.
// States with the same future are evaluated once.
// @param seen results by state; empty at the first call of an episode
inline double BruteForce(const Farm& farm, std::map<std::string, double>& seen) {
  if (farm.over()) return 0.0;
  // Farm::Hash includes the return so far, which does not affect the future.
  const Ship& ship = farm.ships()[0];
  std::string name = std::to_string(farm.step()) + ' ' + std::to_string(ship.cell.x) + ' ' +
                     std::to_string(ship.cell.y);
  for (const Device& device : farm.devices()) {
    name +=
        ' ' + std::to_string(static_cast<int>(device.status)) + ' ' + std::to_string(device.health);
  }
  const auto found = seen.find(name);
  if (found != seen.end()) return found->second;
  const std::string saved = farm.Save();
  double best = -1e9;
  for (std::uint8_t action = 0; action < kActionCount; ++action) {
    Farm next(std::make_shared<const Scenario>(farm.scenario()), farm.shared_layout());
    next.Load(saved);
    next.Step(&action);
    best = std::max(best, static_cast<double>(next.ships()[0].reward) + BruteForce(next, seen));
  }
  seen[name] = best;
  return best;
}

// Executes a plan and returns the sum of its rewards.
inline double Play(Farm& farm, const Plan& plan) {
  const float before = farm.ships()[0].episode_return;
  for (const std::uint8_t action : plan.actions) {
    if (!farm.over()) farm.Step(&action);
  }
  return static_cast<double>(farm.ships()[0].episode_return - before);
}

// Compares the plan and the team bound of each episode with brute force.
// @param valid a scenario with one ship
inline void ExpectBruteForce(const Scenario& valid, std::uint64_t episodes) {
  ValidateScenario(valid);
  const auto scenario = std::make_shared<const Scenario>(valid);
  Farm farm(scenario);
  Planner planner(*scenario);
  for (std::uint64_t episode = 0; episode < episodes; ++episode) {
    farm.Reset(5, episode);
    std::map<std::string, double> seen;
    const double expected = BruteForce(farm, seen);
    const Plan plan = planner.Solve(farm, Foresight::kOracle);
    EXPECT_NEAR(plan.expected_return, expected, 1e-3) << "episode " << episode;
    EXPECT_GE(TeamBound(farm), expected - 1e-3) << "episode " << episode;
    EXPECT_NEAR(Play(farm, plan), expected, 1e-3) << "episode " << episode;
  }
}

}  // namespace aquafarm::agents::test
