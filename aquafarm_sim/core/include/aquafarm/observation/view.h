// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Observation of a farm by one ship (paper §2.3, see docs/model.md). A full view contains
/// everything. A partial view contains the chart and the cells and status of all devices; it
/// contains health, other ships and disasters only within sensor_radius. For disasters outside of
/// it, the last bulletin and its age apply. Networked agents (shared_sight) use the sensors of all
/// agents in play and know their cells. A monitoring device in place (deployed, not self-propelled,
/// health above 0) sees for all ships within monitoring_radius.

#include <array>
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

/// A place from which a ship observes.
struct Sensor {
  Cell cell{};
  float radius{};  ///< [cells]
};

struct KnownDevice {
  Cell cell{};
  DeviceKind kind{};
  DeviceStatus status{};
  bool aboard_self{};  ///< aboard the observing ship
  bool self_propelled{};
  bool health_known{};
  float health{1.0F};  ///< 1 while not known
  float value{};
};

struct KnownDisaster {
  bool known{};               ///< seen or in a bulletin; if false, all else is meaningless
  bool visible{};             ///< seen now; if false, from the last bulletin
  std::int32_t age{};         ///< age of the information [steps]; 0 when visible
  ObservableDisaster belief;  ///< last known state; its centre is not dead-reckoned
  /// Forecast positions at view.forecast_leads_h from now; empty without view.disaster_slots.
  std::vector<std::array<float, 2>> forecast;
};

/// View of one ship. Its memory is reused from step to step.
struct View {
  std::int32_t ship{};
  Cell self{};
  bool active{true};
  std::int32_t step{};
  std::int32_t aboard{};
  std::int32_t capacity{};
  double energy{};                ///< consumed in this episode [kWh]
  std::vector<KnownShip> others;  ///< in id order, without the observing ship
  std::vector<KnownDevice> devices;
  std::vector<KnownDisaster> disasters;
  /// Ids of the known disasters that have not ended, the most dangerous first (RankByDanger);
  /// empty without view.disaster_slots.
  std::vector<std::int32_t> by_danger;
  const Scenario* scenario{};
  const Layout* layout{};
  /// Its own, those of networked agents and of monitoring devices; none in full view.
  std::vector<Sensor> sensors;
};

/// Fills `view` with the current observation of `ship`.
void Observe(const Farm& farm, std::int32_t ship, View& view);

/// Returns lead time `lead` of view.forecast_leads_h in steps, at least 1.
std::int32_t LeadSteps(const Scenario& scenario, std::size_t lead);

/// Sets the forecast positions of a disaster to those of its present motion.
void ExtrapolateMotion(const Scenario& scenario, KnownDisaster& known);

/// Returns the worst risk of a disaster's rings at any place; 0 if it has no ring.
float WorstRisk(const ObservableDisaster& disaster);

/// Fills View::by_danger from the disasters and their forecast positions. The danger of a disaster
/// for a ship is |worst risk| / (1 + gap / longer side of the map). The gap is the smallest
/// distance from the ship to the edge of the disaster, now or at one of the lead times; 0 inside.
/// At equal danger the lower id comes first. [decided], see docs/scenario.md
void RankByDanger(View& view);

/// Returns the worst risk at a cell according to the view.
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
