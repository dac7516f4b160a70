// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Asks a saved policy, at every state of a recorded bag, what it would have done there:
///
///   spec ----> scenario, seed, episode --> farm --> the same hash as state k? --> policy
///   state k -> actions that were taken --> agreed? --> farm steps

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm_agents {

/// What it came to in one recorded episode.
struct EpisodeChoices {
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::uint64_t steps{};    ///< of the recording
  std::uint64_t choices{};  ///< of ships in play whose recorded action is known
  std::uint64_t agreed{};   ///< of them: the policy would have done the same
  float value_at_start{};   ///< V_π summed over ships; NaN: none
  double mean_value{};      ///< the same over all states; NaN: none
  float episode_return{};   ///< as recorded
};

struct BagChoices {
  std::vector<EpisodeChoices> episodes;
  std::string difference;  ///< where a state is not what its actions give; empty: nowhere
  std::string no_maps;     ///< why maps that were asked for were not written; empty: they were
};

struct BagPolicyOptions {
  std::string ns;                  ///< of the ranch; empty: the only one in the bag
  std::string output;              ///< bag to write: the same with `choice` and values; empty: none
  std::uint64_t values_every{10};  ///< steps between two maps of values in it; 0: none
  std::set<std::uint64_t> values_at;  ///< steps that get a map, instead; empty: values_every says
};

/// Goes through a bag.
/// @throws aquafarm::InputError when the bag or the policy cannot be used,
/// aquafarm::agents::StorageError
BagChoices AskAlong(const std::string& bag, const aquafarm::agents::SavedPolicy& policy,
                    const BagPolicyOptions& options);

}  // namespace aquafarm_agents
