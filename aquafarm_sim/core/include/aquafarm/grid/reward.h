// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace aquafarm {

/// The reward of one ship in one step, by term (paper §2.5, see docs/model.md).
struct RewardTerms {
  float crash{};     ///< the reward of the rock or island hit
  float disaster{};  ///< the risk at the ship's cell after it acted
  float pickup{};
  float drop_off{};  ///< includes health × value of each device delivered
  float illegal{};
  float collision{};
  float step{};    ///< applied only when no other term applies, except energy
  float energy{};  ///< -weight × the energy of the step; 0 without EnergySpec

  /// Returns the sum of the terms, added in declaration order.
  float Total() const {
    return crash + disaster + pickup + drop_off + illegal + collision + step + energy;
  }
};
inline constexpr int kRewardTermCount = 8;
static_assert(sizeof(RewardTerms) == kRewardTermCount * sizeof(float));

/// Names of the terms, in declaration order.
inline constexpr std::array<std::string_view, kRewardTermCount> kRewardTermNames{
    "crash", "disaster", "pickup", "drop_off", "illegal", "collision", "step", "energy"};

}  // namespace aquafarm
