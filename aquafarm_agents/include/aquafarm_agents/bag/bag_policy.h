// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compares a recorded bag with a saved policy, which is queried for its actions at every state of
/// the bag except the last of an episode:
///
///   spec ----> scenario, seed, episode --> farm --> the same hash as state k? --> policy
///   state k -> recorded actions --> does the policy agree? --> the farm takes the step

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
  std::uint64_t choices{};  ///< number of recorded actions of active ships
  std::uint64_t agreed{};   ///< how many of them the policy chooses, too
  float value_at_start{};   ///< V_π summed over ships; NaN if the policy has no values
  double mean_value{};      ///< mean over all states of V_π summed over ships; NaN if undefined
  float episode_return{};   ///< as recorded
};

struct BagChoices {
  std::vector<EpisodeChoices> episodes;
  /// The first difference between the recording and its simulation, where the comparison ends;
  /// empty if there is none.
  std::string difference;
  std::string no_maps;  ///< reason why requested value maps were not written; empty if they were
};

struct BagPolicyOptions {
  std::string ns;      ///< namespace of the ranch; empty: the only one in the bag
  std::string output;  ///< bag to write: a copy with the topics choice and values; empty: none
  std::uint64_t values_every{10};     ///< steps between two value maps in the output; 0: no maps
  std::set<std::uint64_t> values_at;  ///< steps with a value map; empty: use values_every
};

/// Compares a bag with a policy.
/// @param bag path of the bag
/// @throws aquafarm::InputError if the bag or the policy cannot be used
/// @throws aquafarm::agents::StorageError if the output cannot be written
BagChoices AskAlong(const std::string& bag, const aquafarm::agents::SavedPolicy& policy,
                    const BagPolicyOptions& options);

}  // namespace aquafarm_agents
