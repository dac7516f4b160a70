// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace aquafarm {

/// The reward of one ship in one step, itemised (§2.5).
struct RewardTerms {
  float crash{};     ///< the rock's own, or the island's
  float disaster{};  ///< the risk at the ship's cell after it acted
  float pickup{};
  float drop_off{};  ///< with health × value of each device delivered
  float illegal{};
  float collision{};
  float step{};  ///< only when no other term was triggered

  /// Sum of the terms, added in the order of their declaration.
  float Total() const { return crash + disaster + pickup + drop_off + illegal + collision + step; }
};
inline constexpr int kRewardTermCount = 7;
static_assert(sizeof(RewardTerms) == kRewardTermCount * sizeof(float));

/// Names of the terms, in the order of declaration.
inline constexpr std::array<std::string_view, kRewardTermCount> kRewardTermNames{
    "crash", "disaster", "pickup", "drop_off", "illegal", "collision", "step"};

}  // namespace aquafarm
