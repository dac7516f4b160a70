// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The reward terms and their weights, each listed once. The lists serve the farm, scenario files,
/// messages, pictures and Python. Add a term at the end: saved episodes name only later terms.

#include <array>
#include <string_view>

namespace aquafarm {

/// Calls visit(name, member…) for every reward term, with its member of each of the given records:
/// RewardTerms or the message RewardTerms.
template <typename Visit, typename... Records>
constexpr void VisitRewardTerms(const Visit& visit, Records&... records) {
  visit("crash", records.crash...);
  visit("disaster", records.disaster...);
  visit("pickup", records.pickup...);
  visit("drop_off", records.drop_off...);
  visit("illegal", records.illegal...);
  visit("collision", records.collision...);
  visit("step", records.step...);
  visit("energy", records.energy...);
}

inline constexpr int kRewardTermCount = [] {
  int count = 0;
  VisitRewardTerms([&count](const char*) { ++count; });
  return count;
}();

/// Names of the terms, in the order of the list.
inline constexpr std::array<std::string_view, kRewardTermCount> kRewardTermNames = [] {
  std::array<std::string_view, kRewardTermCount> names{};
  std::size_t next = 0;
  VisitRewardTerms([&](const char* name) { names[next++] = name; });
  return names;
}();

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

  /// Returns the sum of the terms, added in the order of the list.
  float Total() const {
    float total = 0.0F;
    VisitRewardTerms([&total](const char*, float term) { total += term; }, *this);
    return total;
  }
};
static_assert(sizeof(RewardTerms) == kRewardTermCount * sizeof(float));

/// Rewards that a scenario sets (paper §2.5). A crash into a rock earns the reward of the rock, and
/// energy has its weight in EnergySpec.
struct RewardWeights {
  float island_crash{-20.0F};
  float pickup{20.0F};
  float drop_off{20.0F};
  float illegal{-10.0F};
  float collision{-5.0F};  // [decided]
  float step{-1.0F};
};

/// A reward as a key of scenario files.
struct RewardKey {
  const char* name;
  bool is_penalty{};  ///< may not be positive
};

/// Calls visit(key, member…) for every weight, with its member of each of the given records:
/// RewardWeights or the message RewardTable.
template <typename Visit, typename... Records>
constexpr void VisitRewardWeights(const Visit& visit, Records&... records) {
  visit(RewardKey{"island_crash", true}, records.island_crash...);
  visit(RewardKey{"pickup"}, records.pickup...);
  visit(RewardKey{"drop_off"}, records.drop_off...);
  visit(RewardKey{"illegal"}, records.illegal...);
  visit(RewardKey{"collision"}, records.collision...);
  visit(RewardKey{"step"}, records.step...);
}

}  // namespace aquafarm
