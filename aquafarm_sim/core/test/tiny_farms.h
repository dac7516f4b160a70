// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Small farms for tests with manually computed expectations.

#include <memory>
#include <vector>

#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/validate.h"

namespace aquafarm::test {

inline std::uint8_t Act(Action action) { return static_cast<std::uint8_t>(action); }

/// A farm of 5 × 5 cells without a disaster: an island block from (0, 0) to (1, 1), a rock at
/// (3, 3), a port at (2, 0), and a device of value 80 at (2, 2).
///
///   4 . . . . .
///   3 . . . o .
///   2 . . D . .
///   1 # # . . .
///   0 # # P . .
///     0 1 2 3 4
inline Scenario TinyScenario() {
  Scenario scenario;
  scenario.name = "tiny";
  scenario.hash = 1;
  scenario.width = 5;
  scenario.height = 5;
  scenario.islands = {{{0, 0}, 2, 2}};
  scenario.rocks.cells = {{3, 3}};
  scenario.rocks.reward = {-4.0F, -4.0F};
  scenario.ports.cells = {{2, 0}};
  scenario.devices.placement = DevicePlacement::kExplicit;
  scenario.devices.sites = {{{2, 2}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.damage.exposure_damage = 0.0F;
  return scenario;
}

/// Returns a disaster at (x, y) that does not move.
inline DisasterSpec StillDisaster(float x, float y, std::vector<float> radii,
                                  std::vector<float> risks) {
  DisasterSpec disaster;
  disaster.radii = std::move(radii);
  disaster.risks = std::move(risks);
  disaster.speed = 0.0F;
  disaster.heading_deg = 0;
  disaster.turn_probability = 0.0F;
  disaster.start = {{x, y}};
  return disaster;
}

/// A random farm with rocks, an island, and several ports, devices and disasters.
inline Scenario CrowdedScenario(std::int32_t ships, std::int32_t self_propelled = 1) {
  Scenario scenario;
  scenario.name = "crowded";
  scenario.hash = 2;
  scenario.width = 12;
  scenario.height = 9;
  scenario.layout = LayoutMode::kPerEpisode;
  scenario.islands = {{{4, 3}, 2, 2}};
  scenario.rocks.count = {5, 9};
  scenario.ports.count = 2;
  scenario.ships = {ships, 2};
  scenario.devices.count = 5;
  scenario.devices.self_propelled = self_propelled;
  scenario.damage.crash_probability = 0.5F;
  scenario.damage.exposure_damage = 0.01F;
  DisasterSpec storm;
  storm.radii = {1.0F, 2.5F};
  storm.risks = {-15.0F, -6.0F};
  storm.turn_probability = 0.3F;
  storm.duration = 120;
  DisasterSpec tide = storm;
  tide.kind = DisasterKind::kRedTide;
  tide.speed = 0.05F;
  tide.radius_growth = 0.02F;
  tide.border = Border::kWrap;
  tide.duration = 150;
  scenario.disasters = {storm, tide};
  scenario.step_limit = 200;
  return scenario;
}

inline Farm MakeFarm(Scenario scenario) {
  ValidateScenario(scenario);
  return Farm(std::make_shared<const Scenario>(std::move(scenario)));
}

/// Executes one step of a farm with one ship and returns the ship.
inline const Ship& StepOne(Farm& farm, Action action) {
  const std::uint8_t code = Act(action);
  farm.Step(&code);
  return farm.ships()[0];
}

/// Executes up to `steps` steps with random actions of all ships, until the episode ends.
inline void RandomSteps(Farm& farm, int steps, std::uint64_t seed) {
  RandomStream rng({seed, 0, RngStream::kExploration, 1});
  std::vector<std::uint8_t> codes(farm.ships().size());
  for (int i = 0; i < steps; ++i) {
    for (std::uint8_t& code : codes) {
      code = static_cast<std::uint8_t>(rng.Below(kActionCount));
    }
    if (!farm.over()) farm.Step(codes.data());
  }
}

}  // namespace aquafarm::test
