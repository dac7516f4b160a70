// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What a rescue plan is made for: a ranch, its devices, ships and ports, and an ensemble of
/// storms.
///
/// A ship moves at its own speed from cell to cell; a diagonal is √2 cells long, unlike in the
/// farm, where it takes one step. A pickup and a drop-off take `handling_s` each.
///
/// **When a ship fails.** A ship stops all work of its plan as soon as winds of `abort_ring` have
/// reached the cell that it is in, at sea or in port, at any time since the start of the plan. It
/// then fetches and delivers nothing more. What it has delivered is safe. A device that it has not
/// delivered, also one aboard, takes the damage of the whole storm at its own site. A plan does not
/// continue after the storm, nor beyond the time until which the storm is known.
///
/// **Damage.** Each step, a device in a risk r loses the share `exposure_damage` · |r| of its
/// value, times the factor of its kind in a typhoon, at its site until it is delivered, at most
/// what is left of its value.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/agents/rescue/ensemble.h"
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
  double ready_s{};  ///< after the start of the plan
};

/// Inputs of PlanRescue.
struct RescueProblem {
  Grid<std::uint8_t> water;  ///< [H, W] 1: ships can go there
  double cell_size_km{};
  std::vector<RescueDevice> devices;  ///< device i is site i of the ensemble
  std::vector<RescuePort> ports;      ///< at least one
  std::vector<RescueShip> ships;
  double handling_s{};
  std::int32_t abort_ring{};  ///< ring of the ensemble whose winds stop a ship
  double exposure_damage{};   ///< share of the value per step of the ensemble and unit of |risk|
  double risk_averse{};       ///< 0: max mean; else the share of worst members whose mean counts
};

}  // namespace aquafarm::agents
