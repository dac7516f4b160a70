// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The money of an episode, in whole cents, so that sums are exact:
///
///   insured = saved + damaged + lost       for each device, each kind and the episode
///   loss    = damaged + lost
///
///   damaged   the share of its health that a device lost in the episode, times its insured value
///   saved     what is left of a device in a port
///   lost      what is left of a device at sea or aboard at the end of the episode, times
///             money.at_sea_loss; the other part of it is saved
///
/// Amounts of a device are rounded to cents once: damage first, then the loss at sea. Costs of the
/// operation stand next to the ledger and are not part of the loss.

#include <array>
#include <cstdint>

#include "aquafarm/scenario/enums.h"
#include "aquafarm/scenario/scenario.h"

namespace aquafarm {

/// Hundredths of the scenario's currency.
using Cents = std::int64_t;

/// Returns an amount of the scenario's currency in cents, rounded to the nearest.
Cents ToCents(double amount);

/// What became of an insured value.
struct Ledger {
  Cents insured{};
  Cents saved{};
  Cents damaged{};
  Cents lost{};

  /// Returns the part of the insured value that is gone.
  Cents Loss() const { return damaged + lost; }
  Ledger& operator+=(const Ledger& other);
  bool operator==(const Ledger& other) const;
};

/// Money of one episode.
struct Accounts {
  std::array<Ledger, kDeviceKindCount> by_kind{};  ///< indexed by DeviceKind
  Cents ship_cost{};                               ///< ship-hours times their price
  Cents energy_cost{};                             ///< energy times its price

  /// Returns the sum over all kinds.
  Ledger Total() const;
  /// Returns the cost of the operation.
  Cents OperatingCost() const { return ship_cost + energy_cost; }
};

/// Returns the insured value of a device. @param site of an explicit placement; nullptr for others
Cents InsuredValue(const MoneySpec& money, DeviceKind kind, const DeviceSite* site);

/// Returns the ledger of one device at the end of an episode.
/// @param health at the end, [0, 1] @param initial_health at the start, (0, 1]
Ledger Settle(const MoneySpec& money, Cents insured, float health, float initial_health,
              bool in_port);

}  // namespace aquafarm
