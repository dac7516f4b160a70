// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The money of an episode, in whole cents, so that sums are exact. These equations apply to each
/// device, to each kind of device and to the episode:
///
///   insured = saved + damaged + lost
///   loss    = damaged + lost
///
/// The remaining value of a device is insured - damaged. The three parts of a device's insured
/// value are:
///
///   damaged   the share of its initial health that the device has lost, times its insured value
///   lost      0 if the device was delivered to a port, else the remaining value times
///             money.at_sea_loss
///   saved     the remaining value minus `lost`
///
/// For each device, `damaged` is rounded to cents before `lost` is computed and rounded. The costs
/// of ships and energy are not in the ledger and are not part of the loss.

#include <array>
#include <cstdint>

#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Amount of money in hundredths of the scenario's currency.
using Cents = std::int64_t;

/// Converts an amount of the scenario's currency to cents, rounded to the nearest.
Cents ToCents(double amount);

/// The insured value of devices and its three parts.
struct Ledger {
  Cents insured{};
  Cents saved{};
  Cents damaged{};
  Cents lost{};

  /// Returns the part of the insured value that is damaged or lost.
  Cents Loss() const { return damaged + lost; }
  Ledger& operator+=(const Ledger& other);
  bool operator==(const Ledger& other) const;
};

/// Money of one episode.
struct Accounts {
  std::array<Ledger, kDeviceKindCount> by_kind{};  ///< indexed by DeviceKind
  Cents ship_cost{};    ///< hours in which rescue ships are not moored × MoneySpec::ship_hour
  Cents energy_cost{};  ///< energy of all agents × MoneySpec::kwh

  /// Returns the sum of the ledgers of all kinds.
  Ledger Total() const;
  /// Returns the cost of ships and energy.
  Cents OperatingCost() const { return ship_cost + energy_cost; }
};

/// Returns the insured value of a device: DeviceSite::insured_value if set, else the value of its
/// kind in MoneySpec::device_values.
/// @param site entry of the device in an explicit placement; nullptr for other placements
Cents InsuredValue(const MoneySpec& money, DeviceKind kind, const DeviceSite* site);

/// Returns the ledger of one device at the end of an episode.
/// @param health at the end of the episode, [0, 1]
/// @param initial_health at the start of the episode, (0, 1]
/// @param in_port whether the device was delivered
Ledger Settle(const MoneySpec& money, Cents insured, float health, float initial_health,
              bool in_port);

}  // namespace aquafarm
