// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/agents/training/algorithm.h"

namespace aquafarm::agents {

/// All algorithms, in the order in which they are listed to users: those of this package, then
/// those of other packages (register_learner.h), which the first call loads.
/// @throws InputError if a learner of another package cannot be loaded
const std::vector<Algorithm>& Algorithms();

/// Finds it by name. @throws InputError "algorithm: got 'dqm', expected one of: random, …"
const Algorithm& FindAlgorithm(const std::string& name);

/// Returns the steps of a training without a limit: the algorithm's default, or eight per state of
/// a table if that is more. (Measured for Q-learning, docs/data.md; used for SARSA, too.)
std::uint64_t DefaultSteps(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options);

/// Returns a line about a table that needs at least 256 MB, with its size and the alternative;
/// empty for smaller tables and for networks.
std::string LargeTableNote(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options);

/// The name for which ChooseAlgorithm selects the algorithm.
inline constexpr const char* kAutoAlgorithm = "auto";

struct Choice {
  std::string algorithm;
  std::string reason;  ///< one line for people
};

/// Selects an algorithm by device intelligence, network and number of squads, as in Fig. 6 of the
/// paper:
///
///   non-intelligent devices, one squad        a single-agent learner
///   several squads, or networked devices      a multi-agent learner
///   intelligent devices without a network     a single-agent learner for each
///
/// A device is intelligent if it is self-propelled, and networked if view.shared_sight is set.
Choice ChooseAlgorithm(const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
