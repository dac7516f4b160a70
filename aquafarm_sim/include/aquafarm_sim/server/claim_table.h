// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace aquafarm_sim {

/// Which node has claimed which ship. A claim expires after a time without a command of its holder.
/// Not thread-safe.
class ClaimTable {
 public:
  ClaimTable(std::int32_t ships, double timeout_s);

  /// Returns true if another node than `caller` holds the ship. An expired claim is removed.
  /// @param is_waiting true if a command of the holder waits for other ships: it is present
  bool IsHeldByAnother(std::int32_t ship, const std::string& caller, bool is_waiting);
  /// Makes `holder` the holder of the ship; an empty name releases it.
  void SetHolder(std::int32_t ship, const std::string& holder);
  /// Restarts the ship's time without a command.
  void MarkPresent(std::int32_t ship);
  /// @return name of the node that holds the ship; empty if no node does
  const std::string& holder(std::int32_t ship) const;
  /// @return number of claims that have expired
  std::uint64_t expired() const { return expired_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Claim {
    std::string holder;
    Clock::time_point present_at;  // time of the holder's last command or claim
  };

  std::chrono::duration<double> timeout_;
  std::vector<Claim> claims_;  // by ship
  std::uint64_t expired_{};
};

}  // namespace aquafarm_sim
