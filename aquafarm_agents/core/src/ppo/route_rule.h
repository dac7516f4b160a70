// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// A simple rule that plays by entity tokens (token_layout.h). It takes the route to the target
/// that is nearest in steps and risk, and evades risk in the next step. PPO may imitate it at
/// first:
///
///   targets   devices that can be brought home in time, while there is space; ports, with cargo
///   cost      steps of the route + |risk| along it
///   move      of all open moves that with the least |risk| + deviation from the route in octants

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

  /// Returns the rule's action, one of `allowed`. @param tokens one row of features
  std::uint8_t ActionOf(const float* tokens, ActionMask allowed) const;

  /// As ActionOf, if the route to the target has no more risk per step than the safest cell near
  /// the ship, for example none. Nothing if it has more, or if there is no target.
  std::optional<std::uint8_t> SafeActionOf(const float* tokens, ActionMask allowed) const;

 private:
  // The nearest target in steps and risk.
  struct Target {
    const float* token{};
    float cost{};
    bool is_port{};
  };
  Target NearestTarget(const float* tokens) const;
  std::uint8_t ActionTo(const float* tokens, const Target& target, ActionMask allowed) const;
  void Consider(const float* tokens, TokenKind kind, Target& best) const;
  float LeastRisk(const float* tokens) const;
  std::uint8_t MoveTo(const float* tokens, const Target& target, ActionMask allowed) const;

  const TokenLayout layout_;
  // Places of features: of the ship, and of a device or port.
  const std::size_t risk_, near_blocked_, near_risk_;
  const std::size_t here_, next_, distance_, route_risk_, has_space_, has_cargo_;
  const std::size_t deployed_, slack_;  // of a device
};

}  // namespace aquafarm::agents
