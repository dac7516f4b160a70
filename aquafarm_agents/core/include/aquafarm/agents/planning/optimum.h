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

/// Means over the episodes that are planned; the other ones are too large (`max_states`).
struct OptimumShare {
  std::size_t planned{};
  std::size_t too_large{};
  double mean_return{};
  double mean_optimum{};
  double share{};  ///< mean_return / mean_optimum
  double low{};    ///< 95 % interval of the share, by bootstrap over episodes, in those resamples
                   ///< whose optimum is more than 0; NaN if there are none
  double high{};
  std::size_t solvable{};  ///< episodes in which the optimum delivers every device
  std::size_t solved{};    ///< those of them in which the policy delivered every device
};

/// Plans each episode with the disasters' true future.
/// @param episodes of farms with one ship
/// @param make_farm makes the farm at the start of an episode
/// @param max_states of (cell, devices) of a plan; larger episodes are left out
/// @param seed of the bootstrap @param stop ends early if set; may be null
OptimumShare CompareWithOptimum(
    const std::vector<EpisodeSummary>& episodes,
    const std::function<Farm(std::uint64_t seed, std::uint64_t episode)>& make_farm,
    std::size_t max_states, std::uint64_t seed, const std::atomic<bool>* stop);

}  // namespace aquafarm::agents
