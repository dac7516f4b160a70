// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The eight rotations and reflections of the grid. A turned ranch gives turned entity tokens: each
/// token of a turned ranch is one of the plain ranch, with its sign kept or changed.
///
///   symmetry = 4 · swap east and north + 2 · reflect north + reflect east        (swap first)
///
///   MOVE             blocked, risk and course of the ship; the next move to a device or port
///   X.Y              cells near the ship
///   east, north      positions, and the motions of disasters

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/grid/action.h"
#include "ppo/token_layout.h"

namespace aquafarm::agents {

inline constexpr std::size_t kSymmetries = 8;  ///< 0 is the identity

class TokenSymmetry {
 public:
  /// @param symmetry below kSymmetries
  TokenSymmetry(const TokenLayout& layout, std::size_t symmetry);

  /// Writes the tokens of the turned ranch. @param tokens one row of the plain ranch
  void Turn(const float* tokens, float* turned) const;
  /// Returns the actions of the turned ranch that correspond to those of the plain one.
  ActionMask Turn(ActionMask plain) const;
  /// Returns the action of the turned ranch. @param plain action of the plain ranch
  std::uint8_t Turn(std::uint8_t plain) const { return turned_[plain]; }
  /// Returns the action of the plain ranch. @param turned action of the turned ranch
  std::uint8_t TurnBack(std::uint8_t turned) const { return plain_[turned]; }

 private:
  std::vector<std::uint32_t> source_;  // by feature of the turned ranch
  std::vector<float> sign_;
  std::array<std::uint8_t, kActionCount> turned_{};
  std::array<std::uint8_t, kActionCount> plain_{};
};

/// Returns all symmetries, by their number.
std::vector<TokenSymmetry> AllSymmetries(const TokenLayout& layout);

}  // namespace aquafarm::agents
