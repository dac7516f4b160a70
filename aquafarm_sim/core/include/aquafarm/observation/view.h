// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Observation of a farm by one ship (paper §2.3, see docs/model.md). A full view contains the
/// chart, all devices, all active ships and the current state of all disasters.
///
/// A partial view always contains the chart, and the initial cell and the status of every device.
/// It contains another ship, and the health of a device, only if the ship or the device is in range
/// of a sensor (View::sensors). The ship's own sensor has the range view.sensor_radius. The view
/// contains the current state of a disaster if a part of the disaster is in range. For a disaster
/// out of range, it contains the last bulletin and its age. Networked agents (view.shared_sight)
/// use the sensors of all active agents, and so know their cells.
///
/// In partial view, all ships also use the sensors of deployed monitoring devices, with the range
/// view.monitoring_radius. A device that is self-propelled or has health 0 has no such sensor.

#include <array>
#include <cstdint>
#include <vector>

#include "aquafarm/farm/farm.h"

namespace aquafarm {

struct KnownShip {
  std::int32_t id{};
  Cell cell{};  ///< valid only if `visible`
  bool visible{};
  std::int32_t aboard{};  ///< devices aboard; valid only if `visible`
};

/// A place from which a ship observes.
struct Sensor {
  Cell cell{};
  float radius{};  ///< [cells]
};

struct KnownDevice {
  Cell cell{};  ///< current cell in full view or sensor range, else that at the episode's start
  DeviceKind kind{};
  DeviceStatus status{};
  bool aboard_self{};  ///< aboard the observing ship
  bool self_propelled{};
  bool health_known{};
  float health{1.0F};  ///< 1 if it is not known
  float value{};
};

struct KnownDisaster {
  bool known{};        ///< visible or in a bulletin; if false, the other fields are not valid
  bool visible{};      ///< in full view or sensor range now; if false, the last bulletin applies
  std::int32_t age{};  ///< age of the information [steps]; 0 if visible
  /// State `age` steps ago: the centre is not extrapolated to now. Only steps_left is counted from
  /// now. If agents receive a forecast, dx and dy are the mean motion of the forecast in the period
  /// from `age` steps ago until kForecastSteps after now.
  ObservableDisaster belief;
  /// Forecast positions [cells], one per lead time of view.forecast_leads_h. Lead times are counted
  /// from now. Empty without view.disaster_slots.
  std::vector<std::array<float, 2>> forecast;
};

/// View of one ship. Observe reuses the memory of its lists.
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
  /// Ids of the known disasters that have not ended, in the order of RankByDanger. Empty without
  /// view.disaster_slots.
  std::vector<std::int32_t> by_danger;
  const Scenario* scenario{};
  const Layout* layout{};
  /// Sensors of the ship, of networked agents and of monitoring devices; empty in full view.
  std::vector<Sensor> sensors;
};

/// Fills `view` with the current observation of `ship`. The view points to the farm's scenario and
/// layout.
void Observe(const Farm& farm, std::int32_t ship, View& view);

/// Returns view.forecast_leads_h[lead] in steps, rounded to a whole number, at least 1.
std::int32_t LeadSteps(const Scenario& scenario, std::size_t lead);

/// Sets known.forecast to the positions that result from the motion dx, dy of known.belief.
void ExtrapolateMotion(const Scenario& scenario, KnownDisaster& known);

/// Returns the worst risk, 0 or negative, of the rings whose radius is positive; 0 if there is no
/// such ring.
float WorstRisk(const ObservableDisaster& disaster);

/// Fills View::by_danger, the most dangerous disaster first. The danger of a disaster for a ship is
/// |worst risk| / (1 + gap / longer side of the map). The gap is the smallest distance from the
/// ship to the edge of the disaster at its last known position and at its forecast positions; 0
/// inside. At equal danger the lower id comes first. The paper does not define this order;
/// docs/scenario_disasters.md explains it.
void RankByDanger(View& view);

/// Returns the worst risk of the sea and of the disasters of the view at a cell, 0 or negative.
/// Each disaster is at its last known position.
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
