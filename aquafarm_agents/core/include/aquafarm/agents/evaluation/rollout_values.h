// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// V_π measured by rollouts (Fig. 10, Eq. 10): the return of all agents, discounted on request, in
/// an episode that starts with ship 0 in a given cell, found by playing the episode to its end from
/// every cell. It is a measured return, not an estimate, and is defined for learners and planners
/// alike.

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
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::int32_t episodes{};
  /// [H, W] from the south-west, mean over episodes; NaN in cells that ship 0 cannot occupy
  std::vector<double> value;
  double discount{1.0};       ///< γ of Eq. 10, by step of the episode; 1: undiscounted
  std::vector<Cell> ports;    ///< of the first episode
  std::vector<Cell> devices;  ///< of the first episode, where they are at its start
};

/// Plays `episodes` episodes of EvaluationSeed(seed) from every free cell.
/// @param scenario has at most kMaxCells cells; several episodes require a fixed layout
/// @param stop may be set by a signal handler: the values are then incomplete; null if it cannot be
///        stopped
/// @param discount in [0, 1]
/// @throws InputError if the scenario or the policy does not fit
RolloutValues PlayValues(const std::shared_ptr<const Scenario>& scenario,
                         std::uint8_t observation_types, const MakePolicyFor& make_policy,
                         std::uint64_t seed, std::uint64_t episode, std::int32_t episodes,
                         const std::atomic<bool>* stop = nullptr, double discount = 1.0);

/// Writes JSON with the values, the cells [x, y] of ports and devices, and the sea layers of the
/// scenario. Rows start in the south; cells without a value are null. @throws StorageError
void WriteValues(const std::string& path, const RolloutValues& values, const std::string& policy,
                 const Scenario& scenario);

}  // namespace aquafarm::agents
