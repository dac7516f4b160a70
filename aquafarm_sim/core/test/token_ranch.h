// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An asymmetric ranch, its turned and reflected forms, and their entity tokens.

#include <memory>
#include <vector>

#include "aquafarm/observation/encoder.h"
#include "tiny_farms.h"

namespace aquafarm::test {

inline constexpr std::int32_t kTokenSide = 24;
inline constexpr Cell kTokenShip{11, 10};

/// A ranch of 24 × 24 cells with a disaster that moves west. All objects are at least 8 cells from
/// the border, so that tests can move and turn the ranch.
inline Scenario TokenScenario() {
  Scenario scenario;
  scenario.name = "open";
  scenario.hash = 1;
  scenario.width = scenario.height = kTokenSide;
  scenario.islands = {{{11, 14}, 2, 1}};
  scenario.rocks.cells = {{9, 11}};
  scenario.ports.cells = {{15, 12}, {9, 15}};
  scenario.devices.placement = DevicePlacement::kExplicit;
  scenario.devices.sites = {{{13, 9}, DeviceKind::kMonitoring, 80.0F, false},
                            {{8, 13}, DeviceKind::kBreedingRelease, 60.0F, false}};
  scenario.damage.exposure_damage = 0.01F;
  scenario.view.tokens = true;
  scenario.disasters = {StillDisaster(13.0F, 11.0F, {1.5F, 3.5F}, {-20.0F, -6.0F})};
  scenario.disasters[0].speed = 0.25F;
  scenario.disasters[0].heading_deg = 270;
  return scenario;
}

/// Returns TokenScenario with every object at place(cell) instead of its cell.
/// @param place symmetry of the map: Cell(Cell)
template <typename Place>
Scenario TurnedTokenScenario(const Place& place) {
  Scenario scenario = TokenScenario();
  scenario.islands = {{place({11, 14}), 1, 1}, {place({12, 14}), 1, 1}};
  for (Cell& cell : scenario.rocks.cells) cell = place(cell);
  for (Cell& cell : scenario.ports.cells) cell = place(cell);
  for (DeviceSite& site : scenario.devices.sites) site.cell = place(site.cell);
  const Cell centre = place({13, 11});
  const Cell next = place({12, 11});
  scenario.disasters[0].start = {{static_cast<float>(centre.x), static_cast<float>(centre.y)}};
  scenario.disasters[0].heading_deg = next.x > centre.x   ? 90
                                      : next.x < centre.x ? 270
                                      : next.y > centre.y ? 0
                                                          : 180;
  return scenario;
}

/// Returns the features of ship 0 at a cell, in the order of the encoder.
inline std::vector<float> TokensOf(const Scenario& scenario, Cell ship) {
  ValidateScenario(scenario);
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.PlaceShip(0, ship);
  View view;
  Observe(farm, 0, view);
  const Encoder encoder(scenario);
  std::vector<float> tokens(static_cast<std::size_t>(encoder.feature_count()), -99.0F);
  encoder.Features(view, tokens.data());
  return tokens;
}

}  // namespace aquafarm::test
