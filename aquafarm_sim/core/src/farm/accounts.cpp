// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/accounts.h"

#include <algorithm>
#include <cmath>

namespace aquafarm {
namespace {

// Returns amount × share, rounded to cents, with the share clamped to [0, 1]. The result is exact
// for shares of 0 and 1.
Cents Share(Cents amount, double share) {
  return std::llround(static_cast<double>(amount) * std::clamp(share, 0.0, 1.0));
}

}  // namespace

Cents ToCents(double amount) { return std::llround(amount * 100.0); }

Ledger& Ledger::operator+=(const Ledger& other) {
  insured += other.insured;
  saved += other.saved;
  damaged += other.damaged;
  lost += other.lost;
  return *this;
}

bool Ledger::operator==(const Ledger& other) const {
  return insured == other.insured && saved == other.saved && damaged == other.damaged &&
         lost == other.lost;
}

Ledger Accounts::Total() const {
  Ledger total;
  for (const Ledger& ledger : by_kind) total += ledger;
  return total;
}

Cents InsuredValue(const MoneySpec& money, DeviceKind kind, const DeviceSite* site) {
  if (site != nullptr && site->insured_value) return ToCents(*site->insured_value);
  return ToCents(money.device_values[static_cast<std::size_t>(kind)]);
}

Ledger Settle(const MoneySpec& money, Cents insured, float health, float initial_health,
              bool in_port) {
  const double kept = static_cast<double>(health) / static_cast<double>(initial_health);
  Ledger ledger;
  ledger.insured = insured;
  ledger.damaged = Share(insured, 1.0 - kept);
  const Cents left = insured - ledger.damaged;
  ledger.lost = in_port ? 0 : Share(left, money.at_sea_loss);
  ledger.saved = left - ledger.lost;
  return ledger;
}

}  // namespace aquafarm
