// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The eight rotations and reflections of the grid, applied to entity tokens. *Plain* refers to the
/// observed ranch, *turned* to the ranch after the rotation or reflection. Each feature of the
/// turned ranch equals a feature of the plain ranch, possibly with the opposite sign.
///
///   number of a symmetry = 4 · swap + 2 · reflect north + reflect east
///   swap exchanges east and north, before the reflections
///
/// Features that change place or sign, by the end of their names:
///
///   .MOVE            blocked, risk and course of the ship; the next move to a device or port
///   .X.Y             cells near the ship
///   east, north      positions, and the motions of disasters

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/grid/action.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

inline constexpr std::size_t kSymmetries = 8;  ///< symmetry 0 is the identity

class TokenSymmetry {
 public:
  /// @param symmetry below kSymmetries
  TokenSymmetry(const TokenLayout& layout, std::size_t symmetry);

  /// Writes the features of the turned ranch.
  /// @param tokens one row of features of the plain ranch
  /// @param turned receives one row of features
  void Turn(const float* tokens, float* turned) const;
  /// Converts a mask of actions of the plain ranch to the turned ranch.
  ActionMask Turn(ActionMask plain) const;
  /// Converts an action of the plain ranch to the turned ranch.
  std::uint8_t Turn(std::uint8_t plain) const { return turned_[plain]; }
  /// Converts an action of the turned ranch to the plain ranch.
  std::uint8_t TurnBack(std::uint8_t turned) const { return plain_[turned]; }

 private:
  std::vector<std::uint32_t> source_;  // by feature of the turned ranch: index in the plain ranch
  std::vector<float> sign_;            // by feature of the turned ranch: 1 or −1
  std::array<std::uint8_t, kActionCount> turned_{};  // by action of the plain ranch
  std::array<std::uint8_t, kActionCount> plain_{};   // by action of the turned ranch
};

/// Returns all symmetries in the order of their numbers.
std::vector<TokenSymmetry> AllSymmetries(const TokenLayout& layout);

}  // namespace aquafarm::agents
