// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Queries a saved policy for its choice at every state of a recorded bag:
///
///   spec ----> scenario, seed, episode --> farm --> the same hash as state k? --> policy
///   state k -> actions that were taken --> agreed? --> farm steps

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm_agents {

/// Comparison of one recorded episode with the policy.
struct EpisodeChoices {
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::uint64_t steps{};    ///< steps of the recording
  std::uint64_t choices{};  ///< choices of ships in play with a known recorded action
  std::uint64_t agreed{};   ///< choices in which the policy agrees with the recording
  float value_at_start{};   ///< V_π summed over ships; NaN if the policy has no values
  double mean_value{};      ///< mean over all states of V_π summed over ships; NaN if undefined
  float episode_return{};   ///< as recorded
};

struct BagChoices {
  std::vector<EpisodeChoices> episodes;
  std::string difference;  ///< first state that the actions do not reproduce; empty if none
  std::string no_maps;     ///< reason why requested maps were not written; empty if they were
};

struct BagPolicyOptions {
  std::string ns;      ///< namespace of the ranch; empty: the only one in the bag
  std::string output;  ///< bag to write: a copy with `choice` and values; empty to write none
  std::uint64_t values_every{10};     ///< steps between two value maps in the output; 0: no maps
  std::set<std::uint64_t> values_at;  ///< steps with a value map; empty: use values_every
};

/// Compares a bag with a policy.
/// @throws aquafarm::InputError if the bag or the policy cannot be used;
///         aquafarm::agents::StorageError
BagChoices AskAlong(const std::string& bag, const aquafarm::agents::SavedPolicy& policy,
                    const BagPolicyOptions& options);

}  // namespace aquafarm_agents
