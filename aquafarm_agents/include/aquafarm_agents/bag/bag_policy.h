// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compares a recorded bag with a saved policy. The policy is queried for its actions at every
/// state of the bag in which the episode has not ended:
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
  std::uint64_t steps{};    ///< step of the last compared state
  std::uint64_t choices{};  ///< number of recorded actions of active ships
  std::uint64_t agreed{};   ///< number of these actions that the policy chooses, too
  float value_at_start{};   ///< V_π summed over ships; NaN if the policy has no values
  double mean_value{};      ///< mean over all states of V_π summed over ships; NaN if undefined
  float episode_return{};   ///< return of the recording up to `steps`
};

struct BagChoices {
  std::vector<EpisodeChoices> episodes;
  /// First difference between the recording and its simulation; empty if there is none. The
  /// comparison ends there, and no output is written.
  std::string difference;
  std::string no_maps;  ///< reason why requested value maps are missing; empty if none is missing
};

struct BagPolicyOptions {
  std::string ns;  ///< namespace of the ranch; empty: the only one in the bag
  /// Bag to write: a copy with the topics choice, values and values/points; empty: no output.
  std::string output;
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
