// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Inputs of a rescue plan: a ranch with its devices, ships and ports, and an ensemble of storms.
///
/// A ship moves at its own speed from cell to cell; a diagonal is √2 cells long, unlike in the
/// farm, where it takes one step. A pickup and a drop-off take `handling_s` each.
///
/// **When a ship fails.** A ship stops all work of its plan as soon as it is in a cell, at sea or
/// in port, that winds of `abort_ring` have reached at any time since the start of the plan. It
/// then fetches and delivers nothing more. Delivered devices are safe. A device that the ship has
/// not delivered, including one aboard, takes the damage of the whole storm at its own site. A plan
/// continues neither after the storm nor beyond the time until which the storm is known.
///
/// **Devices aboard at the start.** A ship that starts with devices aboard always gets the order to
/// deliver them, also if no winds are expected or if winds stop it in all members. Only a ship in a
/// port that winds stop in all members stays there. The site of these devices is the cell where the
/// plan finds the ship.
///
/// **Damage.** Until it is delivered, a device loses in each step the share
/// `exposure_damage` · |r| · `damage_factor` of its value, where r is the risk at its site. It
/// never loses more than the value that it still has.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/ensemble.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm::agents {

struct RescueDevice {
  std::string name;
  std::string kind;
  Cell cell{};
  double value{};             ///< in a currency, or in units of value
  double damage_before{};     ///< share of the value that was lost before the plan, [0, 1]
  double damage_factor{1.0};  ///< of its kind in a typhoon (DamageSpec::kinds)
};

struct RescuePort {
  std::string name;
  Cell cell{};
  bool is_open{true};  ///< a closed port takes no devices
};

struct RescueShip {
  std::string name;
  Cell cell{};
  double speed_kn{};  ///< with a device in tow, and without
  std::int32_t capacity{1};
  double ready_s{};                    ///< after the start of the plan
  std::vector<std::int32_t> aboard{};  ///< devices that it carries at the start; may be empty
};

/// Energy and cost of the ships. The energy is that of the ranch (farm/energy.h) in calm water; in
/// rough sea a ship needs more:
///
///   kWh  = per_km · km · (1 + per_device · devices aboard) + idle_kw · hours
///   cost = per_kwh · kWh + per_hour · hours
///
/// A ship consumes and costs nothing while it is in a port before a departure.
struct RescueEnergy {
  double per_km{};      ///< [kWh/km]
  double per_device{};  ///< added to a factor of 1 for each device aboard
  double idle_kw{};
  double per_kwh{};   ///< in the currency of the devices' values; 0: the plan ignores energy
  double per_hour{};  ///< the same, of a ship under way or at work
};

/// Inputs of PlanRescue.
struct RescueProblem {
  Grid<std::uint8_t> water;  ///< [H, W] 1: ships can go there
  double cell_size_km{};
  std::vector<RescueDevice> devices;  ///< device i is site i of the ensemble
  std::vector<RescuePort> ports;      ///< at least one
  std::vector<RescueShip> ships;
  double handling_s{};
  double depart_s{};          ///< earliest departure from a port of a ship that is added
  std::int32_t abort_ring{};  ///< ring of the ensemble whose winds stop a ship
  double exposure_damage{};   ///< share of the value per step of the ensemble and unit of |risk|
  double risk_averse{};       ///< 0: max mean; else the share of worst members whose mean counts
  std::optional<RescueEnergy> energy{};  ///< nullopt: energy and costs are not known

  /// Returns the ship that starts with a device aboard; kNone if the device lies at its site.
  std::int32_t CarrierOf(std::size_t device) const;
};

}  // namespace aquafarm::agents
