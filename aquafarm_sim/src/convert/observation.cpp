// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/convert/observation.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"

namespace aquafarm_sim {
namespace {

// @throws InputError if the message is not a ship's observation of a farm of `scenario`
void CheckObservation(const aquafarm_msgs::FarmState& message, const aquafarm::Scenario& scenario,
                      const aquafarm::Layout& layout) {
  const auto ship = static_cast<std::size_t>(message.observer);
  if (message.observer < 0 || ship >= message.ships.size() ||
      message.ships.size() != static_cast<std::size_t>(scenario.AgentCount()) ||
      message.devices.size() != layout.devices.size()) {
    throw aquafarm::InputError("observation: got observer " + std::to_string(message.observer) +
                               " of " + std::to_string(message.ships.size()) + " ships and " +
                               std::to_string(message.devices.size()) + " devices, expected " +
                               std::to_string(scenario.AgentCount()) + " and " +
                               std::to_string(layout.devices.size()));
  }
  const auto refuse_off_map = [&scenario](const std::string& what, std::int32_t x, std::int32_t y) {
    if (x >= 0 && y >= 0 && x < scenario.width && y < scenario.height) return;
    throw aquafarm::InputError("observation: got " + what + " at (" + std::to_string(x) + ", " +
                               std::to_string(y) + "), expected a cell of " +
                               std::to_string(scenario.width) + " x " +
                               std::to_string(scenario.height));
  };
  for (const aquafarm_msgs::ShipState& one : message.ships) {
    refuse_off_map("ship " + std::to_string(one.id), one.x, one.y);
  }
  for (std::size_t id = 0; id < message.devices.size(); ++id) {
    const aquafarm_msgs::DeviceState& device = message.devices[id];
    refuse_off_map("device " + std::to_string(id), device.x, device.y);
    if ((device.self_propelled != 0) == layout.devices[id].self_propelled) continue;
    throw aquafarm::InputError("observation: device " + std::to_string(id) +
                               (device.self_propelled != 0
                                    ? " is self-propelled, expected one that a ship fetches"
                                    : " is fetched by a ship, expected a self-propelled one"));
  }
  if (message.disasters.size() < scenario.disasters.size()) {
    throw aquafarm::InputError("observation: got " + std::to_string(message.disasters.size()) +
                               " disasters, expected " + std::to_string(scenario.disasters.size()));
  }
}

}  // namespace

aquafarm::KnownDisaster FromMsg(const aquafarm_msgs::DisasterState& message) {
  aquafarm::KnownDisaster known;
  known.known = message.known != 0;
  known.visible = message.visible != 0;
  known.age = message.age;
  aquafarm::ObservableDisaster& belief = known.belief;
  const std::size_t rings = std::min(
      {message.radii.size(), message.risks.size(), static_cast<std::size_t>(aquafarm::kMaxRings)});
  belief.kind = static_cast<aquafarm::DisasterKind>(message.kind);
  belief.grade = message.grade;
  belief.rings = static_cast<std::int32_t>(rings);
  belief.by_quadrant = message.quadrants.size() == 4 * rings && rings > 0;
  for (std::size_t k = 0; k < rings; ++k) {
    belief.risk[k] = message.risks[k];
    const float* const of_ring = message.quadrants.data() + 4 * k;
    if (belief.by_quadrant) {
      SetRing(belief, k, {of_ring[0], of_ring[1], of_ring[2], of_ring[3]});
    } else {
      SetRing(belief, k, message.radii[k]);
    }
  }
  belief.x = message.x;
  belief.y = message.y;
  belief.dx = message.motion_x;
  belief.dy = message.motion_y;
  belief.speed = message.speed;
  belief.heading_deg = message.heading_deg;
  belief.steps_left = message.steps_left;
  return known;
}

void FromMsg(const aquafarm_msgs::FarmState& message, const aquafarm::Scenario& scenario,
             const aquafarm::Layout& layout, aquafarm::View& view) {
  CheckObservation(message, scenario, layout);
  const aquafarm_msgs::ShipState& self = message.ships[static_cast<std::size_t>(message.observer)];
  view.ship = message.observer;
  view.self = {self.x, self.y};
  view.active = self.active != 0;
  view.step = static_cast<std::int32_t>(message.step);
  view.aboard = static_cast<std::int32_t>(self.aboard.size());
  view.capacity = scenario.ships.capacity;
  view.energy = self.episode_energy;
  view.scenario = &scenario;
  view.layout = &layout;
  view.others.clear();
  for (const aquafarm_msgs::ShipState& other : message.ships) {
    if (other.id == message.observer) continue;
    view.others.push_back({other.id,
                           {other.x, other.y},
                           other.visible && other.active,
                           static_cast<std::int32_t>(other.aboard.size())});
  }
  view.devices.resize(message.devices.size());
  for (std::size_t id = 0; id < message.devices.size(); ++id) {
    const aquafarm_msgs::DeviceState& device = message.devices[id];
    view.devices[id] = {{device.x, device.y},
                        layout.devices[id].kind,
                        static_cast<aquafarm::DeviceStatus>(device.status),
                        device.carrier == message.observer,
                        device.self_propelled != 0,
                        device.health_known != 0,
                        device.health,
                        device.value};
  }
  view.disasters.resize(message.disasters.size());
  for (std::size_t id = 0; id < message.disasters.size(); ++id) {
    view.disasters[id] = FromMsg(message.disasters[id]);
    if (scenario.view.disaster_slots > 0) ExtrapolateMotion(scenario, view.disasters[id]);
  }
  if (scenario.view.disaster_slots > 0) RankByDanger(view);
}

}  // namespace aquafarm_sim
