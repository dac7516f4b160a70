// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The reward terms and their weights. The farm, scenario files, messages, pictures and Python use
/// the two lists below. Append new terms at the end, because saved states store the first seven
/// terms by position. Saved states store later terms by name. [decided] marks our choice where the
/// paper gives no value, see docs/model.md.

#include <array>
#include <string_view>

namespace aquafarm {

/// Calls visit(name, member…) for every reward term. `member…` are the members with this name in
/// the given records. Each record is the struct or the message RewardTerms.
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

/// Names of the terms, in the order of VisitRewardTerms.
inline constexpr std::array<std::string_view, kRewardTermCount> kRewardTermNames = [] {
  std::array<std::string_view, kRewardTermCount> names{};
  std::size_t next = 0;
  VisitRewardTerms([&](const char* name) { names[next++] = name; });
  return names;
}();

/// The reward of one ship in one step, by term (paper §2.5, see docs/model.md).
struct RewardTerms {
  float crash{};     ///< crash reward of the rock or island that the ship tried to enter
  float disaster{};  ///< worst risk of disasters and sea at the ship's cell after its action
  float pickup{};
  float drop_off{};  ///< includes health × value of each device delivered
  float illegal{};
  float collision{};
  float step{};    ///< set only if no other term except energy applies
  float energy{};  ///< -EnergySpec::weight × energy of the step; 0 without EnergySpec

  /// Returns the sum of the terms, added in the order of VisitRewardTerms.
  float Total() const {
    float total = 0.0F;
    VisitRewardTerms([&total](const char*, float term) { total += term; }, *this);
    return total;
  }
};
static_assert(sizeof(RewardTerms) == kRewardTermCount * sizeof(float));

/// Rewards that a scenario sets under `rewards` (paper §2.5). Other members of Scenario set the
/// rest: RockSpec::reward for crashes into rocks, the values of devices for deliveries,
/// EnergySpec::weight for energy, and the risks of disasters and sea.
struct RewardWeights {
  float island_crash{-20.0F};
  float pickup{20.0F};
  float drop_off{20.0F};
  float illegal{-10.0F};
  float collision{-5.0F};  // [decided]
  float step{-1.0F};
};

/// Key of a reward in scenario files.
struct RewardKey {
  const char* name;
  bool is_penalty{};  ///< true if the value must not be positive
};

/// Calls visit(key, member…) for every weight. `member…` are the members called key.name in the
/// given records. Each record is a RewardWeights or a message RewardTable.
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
