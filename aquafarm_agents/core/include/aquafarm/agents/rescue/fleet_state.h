// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Replaces the layout, ships and devices of a case by those of a running ranch, to make a new
/// plan.

#include <cmath>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"

namespace aquafarm::agents {

/// A rescue ship of a running ranch.
struct ShipNow {
  Cell cell{};
  std::vector<std::int32_t> aboard;  ///< ids of the devices aboard
  bool operator==(const ShipNow& other) const {
    return cell == other.cell && aboard == other.aboard;
  }
};

/// A device of a running ranch.
struct DeviceNow {
  bool is_deployed{true};  ///< false: aboard a ship, or in port
  bool self_propelled{};   ///< true: the device moves by itself and is not part of plans
  double health{1.0};      ///< [0, 1]
  bool operator==(const DeviceNow& other) const {
    const bool same_health =
        health == other.health || (std::isnan(health) && std::isnan(other.health));
    return is_deployed == other.is_deployed && self_propelled == other.self_propelled &&
           same_health;
  }
};

/// State of a running ranch.
struct FleetState {
  std::uint64_t seed{};        ///< seed of the episode
  std::uint64_t episode{};     ///< number of the episode; with the seed it determines the layout
  std::vector<ShipNow> ships;  ///< by id, rescue ships only
  std::vector<DeviceNow> devices;  ///< by id, all devices
  bool operator==(const FleetState& other) const {
    return seed == other.seed && episode == other.episode && ships == other.ships &&
           devices == other.devices;
  }
};

/// Replaces the layout, the ships and the devices of a case by those of a running ranch.
///
/// Devices keep their names F0, F1, … by id. Devices that are in port or self-propelled are left
/// out; notes (RescueWarning) name them. A device aboard gets the cell of its ship. A ship with
/// devices aboard may leave at the start of the plan, even before `request.depart_s`. A
/// RescueWarning states whether this ship reaches an open port. Its severity is `note` if the ship
/// does, and `stop` if it does not. `damage_before` is 1 minus the health of the device.
///
/// @param request request of the case; must not name files of devices or ships
/// @throws InputError if the state does not fit the scenario, or if the request names such files
void UseFleet(const RescueRequest& request, const FleetState& fleet, RescueCase& rescue);

}  // namespace aquafarm::agents
