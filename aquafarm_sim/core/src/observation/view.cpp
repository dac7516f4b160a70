// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/view.h"

#include <algorithm>
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

// Returns whether a point is within `radius` of any sensor.
bool IsSeen(const std::vector<Cell>& sensor_positions, float x, float y, float radius) {
  return std::any_of(sensor_positions.begin(), sensor_positions.end(),
                     [&](Cell eye) { return SquaredDistance(eye, x, y) <= radius * radius; });
}

bool IsSeen(const std::vector<Cell>& sensor_positions, Cell cell, float radius) {
  return IsSeen(sensor_positions, static_cast<float>(cell.x), static_cast<float>(cell.y), radius);
}

void CollectSensorPositions(const Farm& farm, Cell self, std::vector<Cell>& sensor_positions) {
  sensor_positions.clear();
  sensor_positions.push_back(self);
  if (!farm.scenario().view.shared_sight) return;
  for (const Ship& ship : farm.ships()) {
    if (ship.in_play) sensor_positions.push_back(ship.cell);
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

void ObserveDisaster(const Farm& farm, std::size_t id, bool full,
                     const std::vector<Cell>& sensor_positions, KnownDisaster& known) {
  const Disaster& disaster = farm.disasters()[id];
  const ViewSpec& view = farm.scenario().view;
  known.belief = disaster;
  known.age = 0;
  // A ship observes a disaster if its edge is within sensor range ([decided], see docs/model.md).
  const float range = view.sensor_radius + disaster.reach();
  known.visible = full || IsSeen(sensor_positions, disaster.x, disaster.y, range);
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
  const float radius = scenario.view.sensor_radius;
  view.ship = ship;
  view.self = self.cell;
  view.in_play = self.in_play;
  view.step = farm.step();
  view.aboard = self.aboard;
  view.capacity = scenario.ships.capacity;
  view.scenario = &scenario;
  view.layout = &farm.layout();
  CollectSensorPositions(farm, view.self, view.sensor_positions);

  view.others.resize(ships.size() - 1);
  for (std::size_t id = 0, k = 0; id < ships.size(); ++id) {
    if (static_cast<std::int32_t>(id) == ship) continue;
    KnownShip& known = view.others[k++];
    known.id = static_cast<std::int32_t>(id);
    known.cell = ships[id].cell;
    known.aboard = ships[id].aboard;
    known.visible =
        ships[id].in_play && (full || IsSeen(view.sensor_positions, known.cell, radius));
  }

  view.devices.resize(farm.devices().size());
  for (std::size_t id = 0; id < view.devices.size(); ++id) {
    const Device& device = farm.devices()[id];
    KnownDevice& known = view.devices[id];
    const Cell cell = farm.CellOf(static_cast<std::int32_t>(id));
    const bool visible = full || IsSeen(view.sensor_positions, cell, radius);
    // Out of sight only the cell where the device was deployed is known.
    known.cell = visible ? cell : view.layout->devices[id].cell;
    known.status = device.status;
    known.aboard_self = device.carrier == ship;
    known.self_propelled = device.self_propelled;
    known.health_known = visible;
    known.health = known.health_known ? device.health : 1.0F;
    known.value = device.value;
  }

  view.disasters.resize(farm.disasters().size());
  for (std::size_t id = 0; id < view.disasters.size(); ++id) {
    ObserveDisaster(farm, id, full, view.sensor_positions, view.disasters[id]);
    if (view.disasters[id].known) ApplyForecast(farm, id, view.disasters[id]);
  }
}

}  // namespace aquafarm
