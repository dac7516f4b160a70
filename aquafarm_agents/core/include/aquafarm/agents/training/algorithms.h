// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/sharded_learner.h"
#include "aquafarm/agents/ranks/process_group.h"

namespace aquafarm::agents {

/// Default number of farms that aquafarm_train steps together.
inline constexpr std::int32_t kDefaultFarms = 16;

/// A learner or policy that is selected by its name.
struct Algorithm {
  const char* name;
  const char* summary;          ///< one line for people
  bool learns;                  ///< false: the name refers to a policy that needs no training
  std::uint64_t default_steps;  ///< steps of a training without a limit; see DefaultSteps
  /// Returns the EncodingBits that it requires with these options. @throws InputError if an option
  /// is wrong
  std::uint8_t (*encodings)(const std::string& options);
  /// Creates the learner; nullptr if there is nothing to train.
  std::unique_ptr<Learner> (*make)(const EnvironmentSpec& spec, std::uint64_t seed,
                                   const std::string& options);
  /// Creates the trained policy for farms of `spec`. @throws InputError if it does not fit
  std::unique_ptr<Policy> (*make_policy)(const Checkpoint& checkpoint, const EnvironmentSpec& spec);
  std::int32_t default_farms{kDefaultFarms};  ///< farms that aquafarm_train steps together
  /// Creates the learner of one rank of a process group; nullptr if it learns in one process only.
  std::unique_ptr<ShardedLearner> (*make_rank)(const EnvironmentSpec& spec, std::uint64_t seed,
                                               const std::string& options,
                                               ProcessGroup& group){nullptr};
};

/// All algorithms, in the order in which they are listed to users.
const std::vector<Algorithm>& Algorithms();

/// @throws InputError "algorithm: got 'dqm', expected one of: random, q_learning, sarsa"
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
