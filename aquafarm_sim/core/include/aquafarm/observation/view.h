// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What one ship may know of a farm (§2.3). Full view: everything. Partial view: the chart and the
/// places and status of devices are known; health, other ships and disasters only within
/// sensor_radius; between sightings the last bulletin stands, with its age. Networked agents
/// (shared_sight) see with the sensors of all that are in play and know where each of them is.

#include <cstdint>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

struct KnownShip {
  std::int32_t id{};
  Cell cell{};  ///< meaningless when not visible
  bool visible{};
  std::int32_t aboard{};  ///< devices aboard; meaningless when not visible
};

struct KnownDevice {
  Cell cell{};
  DeviceStatus status{};
  bool aboard_self{};  ///< aboard the observing ship
  bool self_propelled{};
  bool health_known{};
  float health{1.0F};  ///< 1 while not known
  float value{};
};

struct KnownDisaster {
  bool known{};               ///< neither seen nor in a bulletin so far: all else is meaningless
  bool visible{};             ///< seen now; else from the last bulletin
  std::int32_t age{};         ///< steps since it was known so; 0 when visible
  ObservableDisaster belief;  ///< as far as known; its centre is not dead-reckoned
};

/// One ship's view; its memory is reused from step to step.
struct View {
  std::int32_t ship{};
  Cell self{};
  bool in_play{true};
  std::int32_t step{};
  std::int32_t aboard{};
  std::int32_t capacity{};
  std::vector<KnownShip> others;  ///< in id order, without the observing ship
  std::vector<KnownDevice> devices;
  std::vector<KnownDisaster> disasters;
  const Scenario* scenario{};
  const Layout* layout{};
  std::vector<Cell>
      eyes;  ///< where it is seen from: its own cell, or those of all networked agents
};

/// Fills `view` with what `ship` knows now.
void Observe(const Farm& farm, std::int32_t ship, View& view);

/// Worst risk that the view knows of at a cell.
inline float KnownRiskAt(const View& view, Cell cell) {
  float worst = view.scenario->SeaRiskAt(cell);
  for (const KnownDisaster& known : view.disasters) {
    if (!known.known) continue;
    const float risk = RiskOf(known.belief, static_cast<float>(cell.x), static_cast<float>(cell.y));
    worst = risk < worst ? risk : worst;
  }
  return worst;
}

}  // namespace aquafarm
