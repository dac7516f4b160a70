// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/route_rule.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aquafarm::agents {
namespace {

// Units of the features (docs/generalist.md).
constexpr float kUnitLength = 16.0F;     // of distances [cells]
constexpr float kUnitRisk = 20.0F;       // of risks [reward]
constexpr float kUnitRouteSteps = 8.0F;  // divisor of the risk that is summed along a route
constexpr float kRouteSteps = 32.0F;     // max number of steps in that sum
constexpr float kTolerance = 1.0001F;    // factor that allows for rounding of these sums

constexpr int kOctants = 8;
// Direction of each move in octants, clockwise from north.
constexpr std::array<int, kMoveCount> kOctantOf{0, 4, 6, 2, 7, 1, 5, 3};

}  // namespace

RouteRule::RouteRule(const TokenLayout& layout)
    : layout_(layout),
      risk_(layout.PlaceOf(TokenKind::kShip, "ship.risk.north")),
      near_blocked_(layout.PlaceOf(TokenKind::kShip, "ship.near_blocked.-3.-3")),
      near_risk_(layout.PlaceOf(TokenKind::kShip, "ship.near_risk.-3.-3")),
      here_(layout.PlaceOf(TokenKind::kDevice, "device0.here")),
      next_(layout.PlaceOf(TokenKind::kDevice, "device0.next.north")),
      distance_(layout.PlaceOf(TokenKind::kDevice, "device0.distance")),
      route_risk_(layout.PlaceOf(TokenKind::kDevice, "device0.route_risk")),
      has_space_(layout.PlaceOf(TokenKind::kDevice, "device0.has_space")),
      has_cargo_(layout.PlaceOf(TokenKind::kDevice, "device0.has_cargo")),
      deployed_(layout.PlaceOf(TokenKind::kDevice, "device0.deployed")),
      slack_(layout.PlaceOf(TokenKind::kDevice, "device0.slack")) {}

void RouteRule::Consider(const float* tokens, TokenKind kind, Target& best) const {
  const TokenGroup& group = layout_.of(kind);
  const bool is_port = kind == TokenKind::kPort;
  for (std::size_t slot = 0; slot < group.slots; ++slot) {
    const float* const token = tokens + group.begin + slot * group.size;
    if (token[0] == 0.0F) continue;
    const bool is_wanted =
        is_port ? token[has_cargo_] != 0.0F
                : token[deployed_] != 0.0F && token[has_space_] != 0.0F && token[slack_] >= 0.0F;
    if (!is_wanted) continue;
    const float cost =
        token[distance_] * kUnitLength + token[route_risk_] * kUnitRouteSteps * kUnitRisk;
    if (best.token == nullptr || cost < best.cost) best = {token, cost, is_port};
  }
}

// Returns the least |risk| of the open cells near the ship, in units of kUnitRisk.
float RouteRule::LeastRisk(const float* tokens) const {
  float least = std::numeric_limits<float>::infinity();
  const std::size_t cells = near_risk_ - near_blocked_;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (tokens[near_blocked_ + cell] == 0.0F) least = std::min(least, tokens[near_risk_ + cell]);
  }
  return least;  // finite, because the ship's own cell is open
}

// Returns the allowed move with the least sum of |risk| and deviation from the route. Without a
// route only the risk counts.
std::uint8_t RouteRule::MoveTo(const float* tokens, const Target& target,
                               ActionMask allowed) const {
  int wanted = kNone;
  for (std::size_t move = 0; target.token != nullptr && move < kMoves.size(); ++move) {
    if (target.token[next_ + move] != 0.0F) wanted = kOctantOf[move];
  }
  std::uint8_t best = 0;
  float lowest = std::numeric_limits<float>::infinity();
  for (std::uint8_t move = 0; move < kMoveCount; ++move) {
    if ((allowed & MaskOf(static_cast<Action>(move))) == 0) continue;
    const int apart = std::abs(kOctantOf[move] - wanted);
    const int octants = wanted == kNone ? 0 : std::min(apart, kOctants - apart);
    const float cost = static_cast<float>(octants) + tokens[risk_ + move] * kUnitRisk;
    if (cost >= lowest) continue;
    lowest = cost;
    best = move;
  }
  return best;
}

RouteRule::Target RouteRule::NearestTarget(const float* tokens) const {
  Target target;
  Consider(tokens, TokenKind::kDevice, target);
  Consider(tokens, TokenKind::kPort, target);
  return target;
}

std::uint8_t RouteRule::ActionOf(const float* tokens, ActionMask allowed) const {
  return ActionTo(tokens, NearestTarget(tokens), allowed);
}

std::optional<std::uint8_t> RouteRule::SafeActionOf(const float* tokens, ActionMask allowed) const {
  const Target target = NearestTarget(tokens);
  if (target.token == nullptr) return std::nullopt;
  const float steps = std::min(kRouteSteps, target.token[distance_] * kUnitLength);
  const float waiting = LeastRisk(tokens) * steps;
  if (target.token[route_risk_] * kUnitRouteSteps > waiting * kTolerance) return std::nullopt;
  return ActionTo(tokens, target, allowed);
}

std::uint8_t RouteRule::ActionTo(const float* tokens, const Target& target,
                                 ActionMask allowed) const {
  if (target.token != nullptr && target.token[here_] != 0.0F) {
    const Action action = target.is_port ? Action::kDropOff : Action::kPickup;
    if ((allowed & MaskOf(action)) != 0) return static_cast<std::uint8_t>(action);
  }
  return MoveTo(tokens, target, allowed);
}

}  // namespace aquafarm::agents
