// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace aquafarm_sim {

/// Records which node has claimed which ship. A claim expires if its holder is not marked as
/// present for `timeout_s`. IsHeldByAnother removes an expired claim; until then, holder() still
/// returns the node.
/// Every ship id must be in [0, ships - 1]. Not thread-safe.
class ClaimTable {
 public:
  ClaimTable(std::int32_t ships, double timeout_s);

  /// Returns true if a node other than `caller` holds the ship. Removes an expired claim.
  /// @param is_waiting true if a command of the ship waits for its step: the claim then does not
  ///        expire
  bool IsHeldByAnother(std::int32_t ship, const std::string& caller, bool is_waiting);
  /// Sets the node that holds the ship, and marks it as present. An empty name releases the ship.
  void SetHolder(std::int32_t ship, const std::string& holder);
  /// Marks the ship's holder as present now.
  void MarkPresent(std::int32_t ship);
  /// @return name of the node that holds the ship; empty if no node does
  const std::string& holder(std::int32_t ship) const;
  /// @return number of expired claims that IsHeldByAnother has removed
  std::uint64_t expired() const { return expired_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Claim {
    std::string holder;
    Clock::time_point present_at;  // last time at which the holder was present
  };

  std::chrono::duration<double> timeout_;
  std::vector<Claim> claims_;  // by ship
  std::uint64_t expired_{};
};

}  // namespace aquafarm_sim
