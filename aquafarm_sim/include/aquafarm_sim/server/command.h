// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace aquafarm_sim {

/// The command of one ship: an action and its target step.
struct ShipCommand {
  std::int32_t ship{};
  std::uint8_t action{};
  std::uint64_t episode{};
  std::uint64_t step{};
  std::uint64_t token{};
  std::string caller{};  ///< name of the calling node; empty if unknown
  friend bool operator==(const ShipCommand& a, const ShipCommand& b) {
    return a.ship == b.ship && a.action == b.action && a.episode == b.episode && a.step == b.step &&
           a.token == b.token;
  }
  /// False if the command names neither a step nor a token: a retry looks like a new command.
  bool IsIdentified() const { return episode != 0 || step != 0 || token != 0; }
};

/// Identifies a request of a client. Sequence numbers are per client; 0: not numbered.
struct RequestKey {
  std::uint64_t sequence{};
  std::string caller;
  friend bool operator==(const RequestKey& a, const RequestKey& b) {
    return a.sequence == b.sequence && a.caller == b.caller;
  }
  bool IsIdentified() const { return sequence != 0; }
};

}  // namespace aquafarm_sim
