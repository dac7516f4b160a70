// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// V_π as it is played (Fig. 10): what an episode pays from its start on if ship 0 began in a cell,
/// by playing it to its end from every cell. It holds for whatever plays, learner or planner, and
/// is no estimate but the return of that episode itself; undiscounted, all agents' rewards.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/evaluation/route.h"

namespace aquafarm::agents {

/// The values of a farm's cells.
struct PlayedValues {
  std::int32_t width{};
  std::int32_t height{};
  std::uint64_t seed{};
  std::uint64_t episode{};
  std::int32_t episodes{};
  /// [H, W] from the south-west, the mean over episodes; NaN where ship 0 cannot be
  std::vector<double> value;
};

/// Plays `episodes` episodes of EvaluationSeed(seed) from every free cell.
/// @param scenario at most kMaxCells cells, of a fixed layout where there are several episodes
/// @param stop may be set by a signal handler: the values are then not complete; null: never
/// @throws InputError when the scenario or the policy do not fit
PlayedValues PlayValues(const std::shared_ptr<const Scenario>& scenario, std::uint8_t encodings,
                        const MakePolicyFor& make_policy, std::uint64_t seed, std::uint64_t episode,
                        std::int32_t episodes, const std::atomic<bool>* stop = nullptr);

/// Writes them as JSON beside the layers of the scenario's sea, rows from the south, null where
/// there is no value. @throws StorageError
void WriteValues(const std::string& path, const PlayedValues& values, const std::string& policy,
                 const Scenario& scenario);

}  // namespace aquafarm::agents
