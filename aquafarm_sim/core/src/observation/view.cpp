// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/view.h"

#include <algorithm>
#include <vector>

#include "aquafarm/farm/forecast.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/observation/disaster_slots.h"

namespace aquafarm {
namespace {

float SquaredDistance(Cell a, float x, float y) {
  const float dx = static_cast<float>(a.x) - x;
  const float dy = static_cast<float>(a.y) - y;
  return dx * dx + dy * dy;
}

// Returns whether any sensor sees a thing at a point. @param reach radius of the thing [cells]
bool IsSeen(const std::vector<Sensor>& sensors, float x, float y, float reach) {
  return std::any_of(sensors.begin(), sensors.end(), [&](const Sensor& sensor) {
    const float range = sensor.radius + reach;
    return SquaredDistance(sensor.cell, x, y) <= range * range;
  });
}

bool IsSeen(const std::vector<Sensor>& sensors, Cell cell) {
  return IsSeen(sensors, static_cast<float>(cell.x), static_cast<float>(cell.y), 0.0F);
}

// In full view the sensors are not used.
void CollectSensors(const Farm& farm, Cell self, std::vector<Sensor>& sensors) {
  const ViewSpec& view = farm.scenario().view;
  sensors.clear();
  sensors.push_back({self, view.sensor_radius});
  for (const Ship& ship : farm.ships()) {
    if (view.shared_sight && ship.in_play) sensors.push_back({ship.cell, view.sensor_radius});
  }
  if (view.monitoring_radius == 0.0F) return;
  for (const Device& device : farm.devices()) {
    const bool in_place = device.status == DeviceStatus::kDeployed && !device.self_propelled;
    if (device.kind == DeviceKind::kMonitoring && in_place && device.health > 0.0F) {
      sensors.push_back({device.cell, view.monitoring_radius});
    }
  }
}

// Restores rings, risks and grade to the time of the last bulletin, because later changes are not
// observable out of sight.
void RestoreBulletin(const std::vector<Waypoint>& track, const Bulletin& told,
                     ObservableDisaster& belief) {
  if (!track.empty()) {
    belief.waypoint = 0;
    FollowTrack(belief, track, 0);
    FollowTrack(belief, track, told.step);
    return;
  }
  if (belief.radius_growth == 0.0F) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(belief.rings); ++k) {
    if (belief.by_quadrant) {
      SetRing(belief, k,
              {told.quadrant[0][k], told.quadrant[1][k], told.quadrant[2][k], told.quadrant[3][k]});
    } else {
      SetRing(belief, k, told.radius[k]);
    }
  }
}

// Replaces the current motion by the motion of the forecast, if there is one.
void ApplyForecast(const Farm& farm, std::size_t id, KnownDisaster& known) {
  const auto disaster = static_cast<std::int32_t>(id);
  const std::int32_t issued = farm.step() - known.age;
  if (!HasForecast(farm, disaster, issued)) return;
  const auto there = ForecastAt(farm, disaster, issued, farm.step() + kForecastSteps);
  const auto lead = static_cast<float>(known.age + kForecastSteps);
  known.belief.dx = (there[0] - known.belief.x) / lead;
  known.belief.dy = (there[1] - known.belief.y) / lead;
}

// Sets the forecast positions at the lead times of the scenario, from the motion of the last
// information if there is no forecast.
void ApplyLeads(const Farm& farm, std::size_t id, KnownDisaster& known) {
  const Scenario& scenario = farm.scenario();
  const auto disaster = static_cast<std::int32_t>(id);
  const std::int32_t issued = farm.step() - known.age;
  ExtrapolateMotion(scenario, known);
  if (!HasForecast(farm, disaster, issued)) return;
  for (std::size_t lead = 0; lead < known.forecast.size(); ++lead) {
    known.forecast[lead] =
        ForecastAt(farm, disaster, issued, farm.step() + LeadSteps(scenario, lead));
  }
}

void ObserveDisaster(const Farm& farm, std::size_t id, bool full,
                     const std::vector<Sensor>& sensors, KnownDisaster& known) {
  const Disaster& disaster = farm.disasters()[id];
  known.belief = disaster;
  known.age = 0;
  // A ship observes a disaster if its edge is within sensor range ([decided], see docs/model.md).
  known.visible = full || IsSeen(sensors, disaster.x, disaster.y, disaster.reach());
  known.known = known.visible || disaster.bulletin.step != kNone;
  if (known.visible || !known.known) return;
  const Bulletin& bulletin = disaster.bulletin;
  known.age = farm.step() - bulletin.step;
  RestoreBulletin(*farm.tracks()[id], bulletin, known.belief);
  known.belief.x = bulletin.x;
  known.belief.y = bulletin.y;
  known.belief.speed = bulletin.speed;
  known.belief.heading_deg = bulletin.heading_deg;
  const auto direction = HeadingVector(bulletin.heading_deg);
  known.belief.dx = direction[0] * bulletin.speed;
  known.belief.dy = direction[1] * bulletin.speed;
}

}  // namespace

void Observe(const Farm& farm, std::int32_t ship, View& view) {
  const Scenario& scenario = farm.scenario();
  const std::vector<Ship>& ships = farm.ships();
  const Ship& self = ships[static_cast<std::size_t>(ship)];
  const bool full = scenario.view.mode == ViewMode::kFull;
  view.ship = ship;
  view.self = self.cell;
  view.in_play = self.in_play;
  view.step = farm.step();
  view.aboard = self.aboard;
  view.energy = self.episode_energy;
  view.capacity = scenario.ships.capacity;
  view.scenario = &scenario;
  view.layout = &farm.layout();
  CollectSensors(farm, view.self, view.sensors);

  view.others.resize(ships.size() - 1);
  for (std::size_t id = 0, k = 0; id < ships.size(); ++id) {
    if (static_cast<std::int32_t>(id) == ship) continue;
    KnownShip& known = view.others[k++];
    known.id = static_cast<std::int32_t>(id);
    known.cell = ships[id].cell;
    known.aboard = ships[id].aboard;
    known.visible = ships[id].in_play && (full || IsSeen(view.sensors, known.cell));
  }

  view.devices.resize(farm.devices().size());
  for (std::size_t id = 0; id < view.devices.size(); ++id) {
    const Device& device = farm.devices()[id];
    KnownDevice& known = view.devices[id];
    const Cell cell = farm.CellOf(static_cast<std::int32_t>(id));
    const bool visible = full || IsSeen(view.sensors, cell);
    // Out of sight only the cell where the device was deployed is known.
    known.cell = visible ? cell : view.layout->devices[id].cell;
    known.kind = device.kind;
    known.status = device.status;
    known.aboard_self = device.carrier == ship;
    known.self_propelled = device.self_propelled;
    known.health_known = visible;
    known.health = known.health_known ? device.health : 1.0F;
    known.value = device.value;
  }

  view.disasters.resize(farm.disasters().size());
  for (std::size_t id = 0; id < view.disasters.size(); ++id) {
    ObserveDisaster(farm, id, full, view.sensors, view.disasters[id]);
    KnownDisaster& known = view.disasters[id];
    if (!known.known) continue;
    if (scenario.view.disaster_slots > 0) ApplyLeads(farm, id, known);
    ApplyForecast(farm, id, known);
  }
  if (scenario.view.disaster_slots > 0) RankByDanger(view);
}

}  // namespace aquafarm
