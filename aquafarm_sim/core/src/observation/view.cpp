// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "aquafarm/farm/forecast.h"
#include "aquafarm/grid/action.h"

namespace aquafarm {
namespace {

float SquaredDistance(Cell a, float x, float y) {
  const float dx = static_cast<float>(a.x) - x;
  const float dy = static_cast<float>(a.y) - y;
  return dx * dx + dy * dy;
}

// Returns whether a circle around (x, y) touches the range of any sensor. @param reach radius of
// the circle [cells]
bool IsSeen(const std::vector<Sensor>& sensors, float x, float y, float reach) {
  return std::any_of(sensors.begin(), sensors.end(), [&](const Sensor& sensor) {
    const float range = sensor.radius + reach;
    return SquaredDistance(sensor.cell, x, y) <= range * range;
  });
}

bool IsSeen(const std::vector<Sensor>& sensors, Cell cell) {
  return IsSeen(sensors, static_cast<float>(cell.x), static_cast<float>(cell.y), 0.0F);
}

// Collects the sensors of the view of a ship at `self`. A full view has no sensors.
void CollectSensors(const Farm& farm, Cell self, std::vector<Sensor>& sensors) {
  const ViewSpec& view = farm.scenario().view;
  sensors.clear();
  if (view.mode == ViewMode::kFull) return;
  sensors.push_back({self, view.sensor_radius});
  for (const Ship& ship : farm.ships()) {
    if (view.shared_sight && ship.active) sensors.push_back({ship.cell, view.sensor_radius});
  }
  if (view.monitoring_radius == 0.0F) return;
  for (const Device& device : farm.devices()) {
    const bool in_place = device.status == DeviceStatus::kDeployed && !device.self_propelled;
    if (device.kind == DeviceKind::kMonitoring && in_place && device.health > 0.0F) {
      sensors.push_back({device.cell, view.monitoring_radius});
    }
  }
}

// Restores rings, risks and grade as they were at the last bulletin. Later changes are not
// observable without a sensor in range.
void RestoreBulletin(const std::vector<Waypoint>& track, const Bulletin& bulletin,
                     ObservableDisaster& belief) {
  if (!track.empty()) {
    belief.waypoint = 0;
    FollowTrack(belief, track, 0);
    FollowTrack(belief, track, bulletin.step);
    return;
  }
  if (belief.radius_growth == 0.0F) return;
  for (std::size_t k = 0; k < static_cast<std::size_t>(belief.rings); ++k) {
    if (belief.by_quadrant) {
      SetRing(belief, k,
              {bulletin.quadrant[0][k], bulletin.quadrant[1][k], bulletin.quadrant[2][k],
               bulletin.quadrant[3][k]});
    } else {
      SetRing(belief, k, bulletin.radius[k]);
    }
  }
}

// Replaces the motion by the mean motion of the forecast until kForecastSteps after now, if there
// is a forecast.
void ApplyForecast(const Farm& farm, std::size_t id, KnownDisaster& known) {
  const auto disaster = static_cast<std::int32_t>(id);
  const std::int32_t issued = farm.step() - known.age;
  if (!HasForecast(farm, disaster, issued)) return;
  const auto there = ForecastAt(farm, disaster, issued, farm.step() + kForecastSteps);
  const auto lead = static_cast<float>(known.age + kForecastSteps);
  known.belief.dx = (there[0] - known.belief.x) / lead;
  known.belief.dy = (there[1] - known.belief.y) / lead;
}

// Returns the distance from a ship to the edge of a disaster with its centre at (x, y), at least 0.
float Gap(Cell ship, float x, float y, float reach) {
  const float east = x - static_cast<float>(ship.x);
  const float north = y - static_cast<float>(ship.y);
  return std::max(0.0F, std::sqrt(east * east + north * north) - reach);
}

float DangerOf(const View& view, const KnownDisaster& known) {
  const float reach = known.belief.reach();
  float gap = Gap(view.self, known.belief.x, known.belief.y, reach);
  for (const std::array<float, 2>& position : known.forecast) {
    gap = std::min(gap, Gap(view.self, position[0], position[1], reach));
  }
  const auto side = static_cast<float>(std::max(view.scenario->width, view.scenario->height));
  return -WorstRisk(known.belief) / (1.0F + gap / side);
}

// Sets the forecast positions at the lead times of the scenario. Without a forecast, extrapolates
// the last known motion.
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
  // A ship observes a disaster if a part of the disaster is within sensor range (our choice, see
  // docs/model.md).
  known.visible = full || IsSeen(sensors, disaster.x, disaster.y, disaster.reach());
  const Bulletin& bulletin = farm.BulletinOf(id);
  known.known = known.visible || bulletin.step != kNone;
  if (known.visible || !known.known) return;
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

float WorstRisk(const ObservableDisaster& disaster) {
  float worst = 0.0F;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    if (disaster.radius[k] > 0.0F) worst = std::min(worst, disaster.risk[k]);
  }
  return worst;
}

std::int32_t LeadSteps(const Scenario& scenario, std::size_t lead) {
  const double lead_s = static_cast<double>(scenario.view.forecast_leads_h[lead]) * 3600.0;
  const double steps = std::min(lead_s / scenario.step_duration_s, 1.0e7);
  return std::max(1, static_cast<std::int32_t>(steps + 0.5));
}

void ExtrapolateMotion(const Scenario& scenario, KnownDisaster& known) {
  known.forecast.resize(scenario.view.forecast_leads_h.size());
  for (std::size_t lead = 0; lead < known.forecast.size(); ++lead) {
    const auto steps = static_cast<float>(known.age + LeadSteps(scenario, lead));
    known.forecast[lead] = {known.belief.x + steps * known.belief.dx,
                            known.belief.y + steps * known.belief.dy};
  }
}

void RankByDanger(View& view) {
  view.by_danger.clear();
  for (std::size_t id = 0; id < view.disasters.size(); ++id) {
    const KnownDisaster& known = view.disasters[id];
    if (known.known && known.belief.active()) {
      view.by_danger.push_back(static_cast<std::int32_t>(id));
    }
  }
  if (view.by_danger.size() < 2) return;
  const auto danger = [&view](std::int32_t id) {
    return DangerOf(view, view.disasters[static_cast<std::size_t>(id)]);
  };
  std::sort(view.by_danger.begin(), view.by_danger.end(),
            [&danger](std::int32_t a, std::int32_t b) {
              const float of_a = danger(a);
              const float of_b = danger(b);
              return of_a != of_b ? of_a > of_b : a < b;
            });
}

void Observe(const Farm& farm, std::int32_t ship, View& view) {
  const Scenario& scenario = farm.scenario();
  const std::vector<Ship>& ships = farm.ships();
  const Ship& self = ships[static_cast<std::size_t>(ship)];
  const bool full = scenario.view.mode == ViewMode::kFull;
  view.ship = ship;
  view.self = self.cell;
  view.active = self.active;
  view.step = farm.step();
  view.aboard = self.aboard;
  view.energy = self.episode_energy;
  view.capacity = scenario.ships.capacity;
  view.scenario = &scenario;
  view.layout = &farm.layout();
  CollectSensors(farm, view.self, view.sensors);

  // Iterators instead of indices: computing size() costs more than the loop body.
  view.others.resize(ships.size() - 1);
  auto other = view.others.begin();
  for (const Ship& one : ships) {
    if (&one == &self) continue;
    KnownShip& known = *other++;
    known.id = static_cast<std::int32_t>(&one - ships.data());
    known.cell = one.cell;
    known.aboard = one.aboard;
    known.visible = one.active && (full || IsSeen(view.sensors, known.cell));
  }

  view.devices.resize(farm.devices().size());
  auto placed = view.layout->devices.begin();
  auto next = view.devices.begin();
  for (const Device& device : farm.devices()) {
    KnownDevice& known = *next++;
    const Cell cell = farm.CellOf(device);
    const bool visible = full || IsSeen(view.sensors, cell);
    // Out of sensor range, only the cell where the device was deployed is known.
    known.cell = visible ? cell : placed->cell;
    ++placed;
    known.kind = device.kind;
    known.status = device.status;
    known.aboard_self = device.carrier == ship;
    known.self_propelled = device.self_propelled;
    known.health_known = visible;
    known.health = known.health_known ? device.health : 1.0F;
    known.value = device.value;
  }

  view.disasters.resize(farm.disasters().size());
  std::size_t next_id = 0;
  for (KnownDisaster& known : view.disasters) {
    const std::size_t id = next_id++;
    ObserveDisaster(farm, id, full, view.sensors, known);
    if (!known.known) continue;
    if (scenario.view.disaster_slots > 0) ApplyLeads(farm, id, known);
    ApplyForecast(farm, id, known);
  }
  if (scenario.view.disaster_slots > 0) RankByDanger(view);
}

}  // namespace aquafarm
