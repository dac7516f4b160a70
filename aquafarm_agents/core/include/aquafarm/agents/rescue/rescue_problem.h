// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Inputs and rules of a rescue plan. The inputs are a ranch with its devices, ships and ports, and
/// an ensemble of storms.
///
/// A ship moves at its own speed from cell to cell. A diagonal move is √2 cells long and takes √2
/// times as long as a straight move. (In the farm, both take one step.) A pickup and a drop-off
/// take `handling_s` each.
///
/// **When a ship fails.** A ring of a storm is the area of winds above a threshold. A ship stops
/// all work of its plan as soon as it is in a cell that the ring `abort_ring` has covered at any
/// time since the start of the plan. This is also true in port. From then on it fetches and
/// delivers nothing, and it does not resume work after the storm. Delivered devices are safe. A
/// device that is not delivered, even if it is aboard, takes the damage of the whole storm at its
/// own site. A trip fails in all members if it ends after the time until which the storm is known.
///
/// **Devices aboard at the start.** A ship that starts with devices aboard gets the order to
/// deliver them, even if no winds are expected, and even if winds stop it in all members. There are
/// two exceptions: a ship in a port stays there if winds stop it in all members, and a ship that
/// can reach no open port gets no order. The site of these devices is the cell of the ship at the
/// start of the plan.
///
/// **Damage.** Until it is delivered, a device loses in each step of the ensemble the share
/// `exposure_damage` · |r| · `damage_factor` of its undamaged value, where r is the risk at its
/// site. It never loses more than the value that it still has.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/ensemble.h"
#include "aquafarm/grid/action.h"
#include "aquafarm/grid/cell.h"
#include "aquafarm/grid/grid.h"

namespace aquafarm::agents {

/// A device of the plan.
struct RescueDevice {
  std::string name;
  std::string kind;           ///< name of its DeviceKind
  Cell cell{};                ///< its site
  double value{};             ///< undamaged value, in a currency or in units of the reward
  double damage_before{};     ///< share of the value that was lost before the plan, [0, 1]
  double damage_factor{1.0};  ///< damage factor of its kind in a typhoon (DamageSpec::kinds)
};

/// Returns whether a rescue can save a part of the value of a device.
inline bool HasValueLeft(const RescueDevice& device) {
  return device.value > 0.0 && device.damage_before < 1.0;
}

/// A port of the ranch.
struct RescuePort {
  std::string name;
  Cell cell{};
  bool is_open{true};  ///< false: ships cannot deliver devices here
};

/// A ship of the plan.
struct RescueShip {
  std::string name;
  Cell cell{};                         ///< cell at the start of the plan
  double speed_kn{};                   ///< speed with and without devices aboard
  std::int32_t capacity{1};            ///< max number of devices aboard
  double ready_s{};                    ///< earliest departure [s after the start of the plan]
  std::vector<std::int32_t> aboard{};  ///< indices of the devices aboard at the start
};

/// Energy and cost of the ships. The energy is computed as in the ranch (farm/energy.h), but
/// without the additional energy in rough sea.
///
///   kWh  = per_km · km · (1 + per_device · devices aboard) + idle_kw · hours
///   cost = per_kwh · kWh + per_hour · hours
///
/// A ship that waits for its next departure consumes and costs nothing.
struct RescueEnergy {
  double per_km{};      ///< [kWh/km]
  double per_device{};  ///< relative increase of per_km for each device aboard
  double idle_kw{};     ///< power of a ship under way or at work, independent of its speed
  double per_kwh{};     ///< price of a kWh in the currency of the devices' values; 0: no cost
  double per_hour{};    ///< price of an hour of a ship under way or at work; 0: no cost
};

/// Inputs of PlanRescue.
struct RescueProblem {
  Grid<std::uint8_t> water;  ///< [H, W] 1: ships can go there
  double cell_size_km{};
  std::vector<RescueDevice> devices;  ///< device i is site i of the ensemble
  std::vector<RescuePort> ports;      ///< at least one
  std::vector<RescueShip> ships;
  double handling_s{};  ///< duration of a pickup or drop-off [s]
  /// CompareChanges adds a ship to the plan. If all ships have devices aboard, this is the earliest
  /// departure of the added ship [s after the start of the plan]. If not, the added ship is ready
  /// at the same time as the first ship without devices aboard.
  double depart_s{};
  std::int32_t abort_ring{};  ///< ring of the ensemble whose winds stop a ship
  double exposure_damage{};   ///< share of value lost per step of the ensemble and unit of |risk|
  /// Fraction of the members that count as the worst ones, [0, 1]. Above 0: the plan minimizes the
  /// cost plus the mean loss of these members. 0: it maximizes the mean value saved over all
  /// members minus the cost.
  double risk_averse{};
  std::optional<RescueEnergy> energy{};  ///< nullopt: energy and costs are unknown

  /// Returns the ship that has `device` aboard at the start; kNone if no ship has it.
  std::int32_t CarrierOf(std::size_t device) const;
};

}  // namespace aquafarm::agents
