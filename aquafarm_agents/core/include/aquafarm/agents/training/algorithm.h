// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "aquafarm/agents/learning/sharded_learner.h"
#include "aquafarm/agents/ranks/process_group.h"

namespace aquafarm::agents {

/// Number of farms that aquafarm_train steps together by default.
inline constexpr std::int32_t kDefaultFarms = 16;

/// A learner or policy that users select by its name.
struct Algorithm {
  const char* name;
  const char* summary;          ///< one line for users
  bool learns;                  ///< false: the name also selects a policy, which needs no training
  std::uint64_t default_steps;  ///< default limit of a training [farm steps]; see DefaultSteps
  /// Returns the ObservationTypeBits that the algorithm requires with these options.
  /// @throws InputError if an option is wrong
  std::uint8_t (*observation_types)(const std::string& options);
  /// Creates the learner. The pointer is null if the algorithm cannot be trained.
  std::unique_ptr<Learner> (*make)(const EnvironmentSpec& spec, std::uint64_t seed,
                                   const std::string& options);
  /// Creates the policy for farms of `spec` from a checkpoint. For algorithms that do not learn,
  /// the checkpoint contains only the algorithm and its options.
  /// @throws InputError if the policy does not fit the farms
  std::unique_ptr<Policy> (*make_policy)(const Checkpoint& checkpoint, const EnvironmentSpec& spec);
  std::int32_t default_farms{kDefaultFarms};  ///< default number of farms of aquafarm_train
  /// Creates the learner of one rank of a process group. The pointer is null if several ranks
  /// cannot train the algorithm.
  std::unique_ptr<ShardedLearner> (*make_rank)(const EnvironmentSpec& spec, std::uint64_t seed,
                                               const std::string& options,
                                               ProcessGroup& group){nullptr};
  /// ObservationTypeBits that only the learner may read. The trained policy does not read them.
  std::uint8_t only_for_training{0};
};

}  // namespace aquafarm::agents
