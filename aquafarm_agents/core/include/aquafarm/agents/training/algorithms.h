// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "aquafarm/agents/training/algorithm.h"

namespace aquafarm::agents {

/// Returns all algorithms in the order in which users see them: the algorithms of this package,
/// then those of other libraries. The first call loads these libraries (register_learner.h).
/// @throws InputError if a learner of another library cannot be loaded, or if two algorithms have
///   the same name
const std::vector<Algorithm>& Algorithms();

/// Finds an algorithm by its name.
/// @throws InputError "algorithm: got 'dqm' (did you mean 'dqn'?), expected one of: random, …"
const Algorithm& FindAlgorithm(const std::string& name);

/// Returns the default limit of a training [farm steps]: Algorithm::default_steps. For an algorithm
/// with a table, the limit is at least eight steps per state, rounded up to whole millions. (This
/// was measured for Q-learning, see docs/real_ranches.md, and is also used for SARSA.)
std::uint64_t DefaultSteps(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options);

/// Returns a line for users if the algorithm needs a table of at least 256 MB. The line states the
/// size and an alternative. Returns an empty text for smaller tables and for networks.
std::string LargeTableNote(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options);

/// Name that users give so that ChooseAlgorithm selects the algorithm.
inline constexpr const char* kAutoAlgorithm = "auto";

/// Result of ChooseAlgorithm.
struct Choice {
  std::string algorithm;
  std::string reason;  ///< one line for users
};

/// Selects an algorithm as in Fig. 6 of the paper, by the number of squads (rescue ships) and by
/// whether the devices are intelligent and networked. The first row that applies is used:
///
///   one agent                                          a single-agent learner (lstm_dqn)
///   several squads, or networked intelligent devices   a multi-agent learner (vdn)
///   intelligent devices without a network              one learner for each agent
///                                                      (independent_dqn)
///
/// A device is intelligent if it is self-propelled, and networked if view.shared_sight is set.
Choice ChooseAlgorithm(const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
