// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace aquafarm_sim {

/// The command of one ship: an action and its target step. Two commands are equal if all fields
/// except the caller are equal.
struct ShipCommand {
  std::int32_t ship{};
  std::uint8_t action{};    ///< as aquafarm::Action
  std::uint64_t episode{};  ///< target episode; if episode and step are both 0: the current step
  std::uint64_t step{};     ///< number of steps taken before the command's step
  std::uint64_t token{};    ///< id of the command, equal in a retry; 0: none
  std::string caller{};     ///< name of the calling node; empty if unknown
  friend bool operator==(const ShipCommand& a, const ShipCommand& b) {
    return a.ship == b.ship && a.action == b.action && a.episode == b.episode && a.step == b.step &&
           a.token == b.token;
  }
  /// Returns false if episode, step and token are all 0. A retry of such a command cannot be
  /// distinguished from a new command.
  bool IsIdentified() const { return episode != 0 || step != 0 || token != 0; }
};

/// Identifies a request of a client. Each client has its own sequence numbers.
struct RequestKey {
  std::uint64_t sequence{};  ///< 0: the request has no number
  std::string caller;        ///< name of the calling node
  friend bool operator==(const RequestKey& a, const RequestKey& b) {
    return a.sequence == b.sequence && a.caller == b.caller;
  }
  bool IsIdentified() const { return sequence != 0; }
};

}  // namespace aquafarm_sim
