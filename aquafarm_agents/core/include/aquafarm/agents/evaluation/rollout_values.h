// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// V_π measured by rollouts (Fig. 10 and Eq. 10 of the paper). Each rollout is an episode that
/// starts with ship 0 in a given cell. The value of this cell is the mean return of its rollouts.
/// The return is summed over all agents and discounted if the discount is below 1. These values
/// need no value network, so planners have them, too.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/evaluation/route.h"

namespace aquafarm::agents {

/// Rollout values of a farm's cells.
struct RolloutValues {
  std::int32_t width{};
  std::int32_t height{};
  std::uint64_t seed{};     ///< EvaluationSeed of the episodes
  std::uint64_t episode{};  ///< number of the first episode
  std::int32_t episodes{};  ///< number of episodes played from each cell
  /// [H, W] row by row from the south-west, mean over the episodes. NaN if ship 0 cannot start in
  /// the cell in one or more episodes.
  std::vector<double> value;
  double discount{1.0};       ///< γ of Eq. 10, per step; 1: undiscounted
  std::vector<Cell> ports;    ///< cells of the ports in the first episode
  std::vector<Cell> devices;  ///< cells of the devices at the start of the first episode
};

/// Plays `episodes` episodes of EvaluationSeed(seed), the first of which has the number `episode`.
/// Each of them is played once from every free cell.
/// @param scenario with at most kMaxCells cells; several episodes require a fixed layout
/// @param stop may be set by a signal handler; the values are then invalid. Null if the function
///        cannot be stopped
/// @param discount in [0, 1]
/// @throws InputError if the farm has too many cells, if several episodes are requested without a
///   fixed layout, if the scenario does not support the observation types, or if the policy does
///   not fit the scenario
RolloutValues PlayValues(const std::shared_ptr<const Scenario>& scenario,
                         std::uint8_t observation_types, const MakePolicyFor& make_policy,
                         std::uint64_t seed, std::uint64_t episode, std::int32_t episodes,
                         const std::atomic<bool>* stop = nullptr, double discount = 1.0);

/// Writes a JSON file with the values, the cells [x, y] of ports and devices, and the sea layers of
/// the scenario. The first row is the southern one; cells without a value are null.
/// @throws StorageError
void WriteValues(const std::string& path, const RolloutValues& values, const std::string& policy,
                 const Scenario& scenario);

}  // namespace aquafarm::agents
