// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A simple policy that reads entity tokens (token_layout.h). It follows the route to the target
/// with the least cost, and evades the risk of the next step. PPO may imitate it (teacher.h).
///
///   targets   with free capacity: deployed devices that can be brought home in time;
///             with a device aboard: ports
///   cost      steps of the route (at most 64) + sum of |risk| over its first 32 steps
///   move      the allowed move with the least |risk| + deviation from the route [octants]
///   action    at the target: pickup or drop-off

#include <cstddef>
#include <cstdint>
#include <optional>

#include "aquafarm/grid/action.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

class RouteRule {
 public:
  /// @throws InputError if the features are not entity tokens
  explicit RouteRule(const TokenLayout& layout);

  /// Returns the action of the rule.
  /// @param tokens one row of features
  /// @param allowed actions to choose from, with at least one move
  std::uint8_t ActionOf(const float* tokens, ActionMask allowed) const;

  /// Returns the action of the rule if the route to the target has no more risk per step than the
  /// safest open cell within 3 cells of the ship. Returns nullopt if it has more, or if there is no
  /// target.
  std::optional<std::uint8_t> SafeActionOf(const float* tokens, ActionMask allowed) const;

 private:
  // The target with the least cost.
  struct Target {
    const float* token{};  // first feature of its token; null: there is no target
    float cost{};
    bool is_port{};
  };
  Target NearestTarget(const float* tokens) const;
  std::uint8_t ActionTo(const float* tokens, const Target& target, ActionMask allowed) const;
  void Consider(const float* tokens, TokenKind kind, Target& best) const;
  float LeastRisk(const float* tokens) const;
  std::uint8_t MoveTo(const float* tokens, const Target& target, ActionMask allowed) const;

  const TokenLayout layout_;
  // Offsets of features within the token of the ship.
  const std::size_t risk_, near_blocked_, near_risk_;
  // Offsets within the token of a device or port.
  const std::size_t here_, next_, distance_, route_risk_, has_space_, has_cargo_;
  // Offsets within the token of a device.
  const std::size_t deployed_, slack_;
};

}  // namespace aquafarm::agents
