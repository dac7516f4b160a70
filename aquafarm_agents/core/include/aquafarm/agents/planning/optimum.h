// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compares a policy with the clairvoyant optimum of the same episodes (planner.h).

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/farm/farm.h"

namespace aquafarm::agents {

/// Comparison over the episodes that could be planned.
struct OptimumShare {
  std::size_t planned{};    ///< number of planned episodes
  std::size_t too_large{};  ///< number of episodes not planned: too many states or devices
  double mean_return{};     ///< mean return of the policy
  double mean_optimum{};    ///< mean return of the best plans
  double share{};           ///< mean_return / mean_optimum; 0 if no episode was planned
  /// Bounds of the 95 % interval of `share`, by bootstrap over episodes. Resamples whose mean
  /// optimum is not positive are left out. NaN if no resample remains, 0 if no episode was planned.
  double low{};
  double high{};
  std::size_t solvable{};  ///< planned episodes in which the best plan delivers every device
  std::size_t solved{};    ///< solvable episodes in which the policy also delivered every device
};

/// Compares the returns of a policy with those of the best plans of the same episodes. The plans
/// use the disasters' true future.
/// @param episodes played by the policy, on farms with one agent
/// @param make_farm makes the farm at the start of an episode
/// @param max_states max number of states of a plan (Planner::state_count); an episode with more
///   states counts as too large
/// @param seed seed of the random numbers of the bootstrap
/// @param stop the comparison ends early if the flag is true; may be null
/// @throws InputError if the mean return of the best plans is not positive, if a farm has several
///   agents, or if the planner does not support the rewards
OptimumShare CompareWithOptimum(
    const std::vector<EpisodeSummary>& episodes,
    const std::function<Farm(std::uint64_t seed, std::uint64_t episode)>& make_farm,
    std::size_t max_states, std::uint64_t seed, const std::atomic<bool>* stop);

}  // namespace aquafarm::agents
