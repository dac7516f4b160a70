// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compares a recorded bag with a saved policy. The recorded episodes are simulated again. The
/// policy chooses its actions in each recorded state in which the episode is running:
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
  std::uint64_t steps{};    ///< step of the last simulated state
  std::uint64_t choices{};  ///< number of recorded actions of active agents
  std::uint64_t agreed{};   ///< number of these actions that the policy also chose
  float value_at_start{};   ///< sum over agents of V_π in the first compared state; NaN: no V_π
  double mean_value{};      ///< mean of this sum over the compared states; NaN: no V_π
  float episode_return{};   ///< return of the episode up to step `steps`
};

/// Comparison of a bag with the policy.
struct BagChoices {
  std::vector<EpisodeChoices> episodes;  ///< in the order of the bag
  /// First difference between the recording and its simulation; empty if there is none. The
  /// comparison ends at the difference, and no output is written.
  std::string difference;
  std::string no_maps;  ///< why requested value maps are missing; empty if none is missing
};

struct BagPolicyOptions {
  std::string ns;  ///< namespace of the ranch; empty: the bag must contain exactly one ranch
  /// Path of the output, a copy of the bag with new messages on the topics choice, values and
  /// values/points. The new messages replace those of the bag on these topics. Empty: no output.
  std::string output;
  /// The output contains a value map at each step that is a multiple of this number; 0: no maps.
  std::uint64_t values_every{10};
  std::set<std::uint64_t> values_at;  ///< steps with a value map; empty: values_every selects them
};

/// Compares a bag with a policy.
/// @param bag path of the bag
/// @throws aquafarm::InputError if the bag or the policy cannot be used, or if the output is the
///         input
/// @throws aquafarm::agents::StorageError if the output cannot be written
BagChoices AskAlong(const std::string& bag, const aquafarm::agents::SavedPolicy& policy,
                    const BagPolicyOptions& options);

}  // namespace aquafarm_agents
