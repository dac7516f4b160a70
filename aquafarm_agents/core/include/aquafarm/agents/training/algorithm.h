// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

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
  /// Returns the ObservationTypeBits that it requires with these options. @throws InputError if an
  /// option is wrong
  std::uint8_t (*observation_types)(const std::string& options);
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
  /// Those of its ObservationTypeBits that only the learner reads, not the trained policy.
  std::uint8_t only_for_training{0};
};

}  // namespace aquafarm::agents
