// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/server/claim_table.h"

namespace aquafarm_sim {

ClaimTable::ClaimTable(std::int32_t ships, double timeout_s)
    : timeout_(timeout_s), claims_(static_cast<std::size_t>(ships)) {}

bool ClaimTable::IsHeldByAnother(std::int32_t ship, const std::string& caller, bool is_waiting) {
  Claim& claim = claims_[static_cast<std::size_t>(ship)];
  if (claim.holder.empty() || claim.holder == caller) return false;
  if (is_waiting || Clock::now() - claim.present_at < timeout_) return true;
  claim.holder.clear();
  ++expired_;
  return false;
}

void ClaimTable::SetHolder(std::int32_t ship, const std::string& holder) {
  claims_[static_cast<std::size_t>(ship)] = {holder, Clock::now()};
}

void ClaimTable::MarkPresent(std::int32_t ship) {
  claims_[static_cast<std::size_t>(ship)].present_at = Clock::now();
}

const std::string& ClaimTable::holder(std::int32_t ship) const {
  return claims_[static_cast<std::size_t>(ship)].holder;
}

}  // namespace aquafarm_sim
