// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/fleet_state.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "rescue/case_parts.h"
#include "rescue/sea_routes.h"

namespace aquafarm::agents {
namespace {

void Append(std::string& list, const std::string& one) { list += (list.empty() ? "" : ", ") + one; }

void RequireFits(const RescueRequest& request, const FleetState& fleet, const RescueCase& rescue) {
  if (!request.devices.empty() || !request.ships_file.empty()) {
    throw InputError((request.devices.empty() ? "ships_file" : "devices") +
                     std::string(": got a file, expected none: the running ranch reports its own "
                                 "ships and devices"));
  }
  const std::size_t expected = rescue.layout.devices.size();
  if (fleet.devices.size() == expected) return;
  throw InputError("state: got " + std::to_string(fleet.devices.size()) + " devices, expected " +
                   std::to_string(expected) + ", as in " + rescue.scenario->name);
}

// Adds a warning if a ship with devices aboard reaches no open port, else a note.
void RequireWayHome(std::size_t index, const std::string& names, RescueCase& rescue) {
  const RescueProblem& problem = rescue.problem;
  const RescueShip& ship = problem.ships[index];
  std::vector<Cell> places{ship.cell};
  for (const RescuePort& port : problem.ports) places.push_back(port.cell);
  const SeaRoutes routes(problem.water, places);
  bool has_port = false;
  for (std::size_t port = 0; port < problem.ports.size(); ++port) {
    has_port =
        has_port || (problem.ports[port].is_open && std::isfinite(routes.Length(0, port + 1)));
  }
  const auto id = static_cast<std::int32_t>(index);
  if (has_port) {
    rescue.warnings.push_back({"devices_aboard", "note",
                               ship.name + " has " + names + " aboard: its orders deliver them.",
                               "", id});
  } else {
    rescue.warnings.push_back({"no_way_home", "stop",
                               ship.name + " has " + names + " aboard and reaches no open port.",
                               "Open a port that it can reach.", id});
  }
}

void PlaceShips(const FleetState& fleet, RescueCase& rescue) {
  const Grid<std::uint8_t>& water = rescue.problem.water;
  for (std::size_t i = 0; i < fleet.ships.size(); ++i) {
    RescueShip& ship = rescue.problem.ships[i];
    const ShipNow& now = fleet.ships[i];
    const bool on_map = now.cell.x >= 0 && now.cell.y >= 0 && now.cell.x < water.cols() &&
                        now.cell.y < water.rows();
    if (!on_map || water(now.cell.y, now.cell.x) == 0) {
      throw InputError("state: " + ship.name + ": got cell (" + std::to_string(now.cell.x) + ", " +
                       std::to_string(now.cell.y) + "), expected water of " +
                       rescue.scenario->name);
    }
    ship.cell = now.cell;
  }
}

// Returns, by device, the ship that carries it; kNone if no ship carries it.
std::vector<std::int32_t> CarriersOf(const FleetState& fleet) {
  std::vector<std::int32_t> carriers(fleet.devices.size(), kNone);
  for (std::size_t ship = 0; ship < fleet.ships.size(); ++ship) {
    for (const std::int32_t id : fleet.ships[ship].aboard) {
      const auto device = static_cast<std::size_t>(id);
      if (id < 0 || device >= carriers.size() || carriers[device] != kNone) {
        throw InputError("state: ship " + std::to_string(ship + 1) + ": got device " +
                         std::to_string(id) + " aboard, expected ids of devices in [0, " +
                         std::to_string(carriers.size()) + "), each aboard one ship");
      }
      carriers[device] = static_cast<std::int32_t>(ship);
    }
  }
  return carriers;
}

// Keeps the devices aboard ships, and the deployed devices that are not self-propelled. Adds notes
// about the other devices.
void KeepDevices(const FleetState& fleet, RescueCase& rescue) {
  RescueProblem& problem = rescue.problem;
  const std::vector<std::int32_t> carriers = CarriersOf(fleet);
  std::vector<RescueDevice> devices = std::exchange(problem.devices, {});
  std::vector<std::string> aboard(fleet.ships.size());
  std::string in_port;
  std::string self_propelled;
  for (std::size_t id = 0; id < devices.size(); ++id) {
    const DeviceNow& now = fleet.devices[id];
    const bool is_aboard = carriers[id] != kNone;
    if (!is_aboard && now.self_propelled) {
      Append(self_propelled, devices[id].name);
      continue;
    }
    if (!is_aboard && !now.is_deployed) {
      Append(in_port, devices[id].name);
      continue;
    }
    devices[id].damage_before = std::clamp(1.0 - now.health, 0.0, 1.0);
    if (is_aboard) {
      const auto carrier = static_cast<std::size_t>(carriers[id]);
      RescueShip& ship = problem.ships[carrier];
      devices[id].cell = ship.cell;
      ship.ready_s = 0.0;
      ship.aboard.push_back(static_cast<std::int32_t>(problem.devices.size()));
      Append(aboard[carrier], devices[id].name);
    }
    problem.devices.push_back(std::move(devices[id]));
  }
  for (std::size_t ship = 0; ship < aboard.size(); ++ship) {
    if (!aboard[ship].empty()) RequireWayHome(ship, aboard[ship], rescue);
  }
  const auto note = [&](const char* code, const std::string& names, const char* text) {
    if (!names.empty()) rescue.warnings.push_back({code, "note", names + text, ""});
  };
  note("devices_in_port", in_port, ": in port, not in this plan.");
  note("devices_self_propelled", self_propelled, ": self-propelled, not in this plan.");
}

}  // namespace

void UseFleet(const RescueRequest& request, const FleetState& fleet, RescueCase& rescue) {
  RequireFits(request, fleet, rescue);
  LayoutGenerator(*rescue.scenario).Generate(fleet.seed, fleet.episode, rescue.layout);
  rescue.problem.ports.clear();
  rescue.problem.devices.clear();
  rescue.problem.ships.clear();
  RescueRequest counted = request;
  counted.ships = static_cast<std::int32_t>(fleet.ships.size());
  ReadFleet(counted, rescue);
  PlaceShips(fleet, rescue);
  KeepDevices(fleet, rescue);
}

}  // namespace aquafarm::agents
