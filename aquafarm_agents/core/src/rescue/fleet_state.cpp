// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/fleet_state.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/track.h"
#include "rescue/case_parts.h"
#include "rescue/sea_routes.h"

namespace aquafarm::agents {
namespace {

std::string NameOfDevice(std::size_t id) { return "D" + std::to_string(id + 1); }

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

// Sends a ship with devices aboard to the nearest open port first.
void DeliverFirst(const ShipNow& now, RescueShip& ship, RescueCase& rescue) {
  const RescueProblem& problem = rescue.problem;
  std::vector<Cell> places{now.cell};
  for (const RescuePort& port : problem.ports) places.push_back(port.cell);
  const SeaRoutes routes(problem.water, places);
  std::size_t nearest = 0;
  for (std::size_t port = 1; port < places.size(); ++port) {
    const bool is_nearer = nearest == 0 || routes.Length(0, port) < routes.Length(0, nearest);
    if (problem.ports[port - 1].is_open && is_nearer) nearest = port;
  }
  std::string names;
  for (const std::int32_t device : now.aboard) {
    Append(names, NameOfDevice(static_cast<std::size_t>(device)));
  }
  if (nearest == 0 || !std::isfinite(routes.Length(0, nearest))) {
    rescue.warnings.push_back({"devices_aboard", "stop",
                               ship.name + " has " + names + " aboard and reaches no open port.",
                               "Open a port that it can reach."});
    return;
  }
  const double pace = 1000.0 * problem.cell_size_km / (ship.speed_kn * kMpsPerKnot);
  const double in_port_s = routes.Length(0, nearest) * pace + problem.handling_s;
  ship.cell = places[nearest];
  ship.ready_s = std::max(ship.ready_s, in_port_s);
  rescue.warnings.push_back({"devices_aboard", "stop",
                             ship.name + " has " + names + " aboard and first delivers at " +
                                 problem.ports[nearest - 1].name + ", by " +
                                 FormatUtc(rescue.start + std::llround(in_port_s)) +
                                 ". The plan begins after that and does not contain these devices.",
                             ""});
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
    if (!now.aboard.empty()) DeliverFirst(now, ship, rescue);
  }
}

void KeepDeployed(const FleetState& fleet, RescueCase& rescue) {
  std::vector<RescueDevice> devices = std::exchange(rescue.problem.devices, {});
  std::string in_port;
  std::string self_propelled;
  std::vector<std::int32_t> aboard;
  for (const ShipNow& ship : fleet.ships) {
    aboard.insert(aboard.end(), ship.aboard.begin(), ship.aboard.end());
  }
  for (std::size_t id = 0; id < devices.size(); ++id) {
    const DeviceNow& now = fleet.devices[id];
    const bool is_aboard =
        std::find(aboard.begin(), aboard.end(), static_cast<std::int32_t>(id)) != aboard.end();
    if (now.self_propelled) {
      Append(self_propelled, devices[id].name);
    } else if (now.is_deployed) {
      devices[id].damage_before = std::clamp(1.0 - now.health, 0.0, 1.0);
      rescue.problem.devices.push_back(std::move(devices[id]));
    } else if (!is_aboard) {
      Append(in_port, devices[id].name);
    }
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
  KeepDeployed(fleet, rescue);
}

}  // namespace aquafarm::agents
