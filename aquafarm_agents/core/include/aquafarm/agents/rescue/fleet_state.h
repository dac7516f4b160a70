// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Replaces the ships and devices of a case by those of a running ranch, to plan again.

#include <cstdint>
#include <vector>

#include "aquafarm/agents/rescue/rescue_case.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"

namespace aquafarm::agents {

/// A rescue ship of a running ranch.
struct ShipNow {
  Cell cell{};
  std::vector<std::int32_t> aboard;  ///< ids of devices
};

/// A device of a running ranch.
struct DeviceNow {
  bool is_deployed{true};  ///< false: aboard a ship, or in port
  bool self_propelled{};   ///< it moves by itself and is not planned
  double health{1.0};      ///< [0, 1]
};

/// State of a running ranch.
struct FleetState {
  std::uint64_t seed{};  ///< of the episode, whose layout is drawn again
  std::uint64_t episode{};
  std::vector<ShipNow> ships;      ///< by id, rescue ships only
  std::vector<DeviceNow> devices;  ///< by id, all devices
};

/// Replaces the layout, the ships and the devices of a case by those of a running ranch.
///
/// Devices keep their names F0, F1, … by id. The plan leaves out devices that are in port or
/// self-propelled; notes name them. A device aboard is at its ship's cell, and the ship may leave
/// at once, whatever `request.depart_s` is (RescueShip::aboard). `damage_before` is 1 minus the
/// device's health.
///
/// @param request of the case; without files of devices and ships
/// @throws InputError if the state does not fit the scenario, or the request names such files
void UseFleet(const RescueRequest& request, const FleetState& fleet, RescueCase& rescue);

}  // namespace aquafarm::agents
