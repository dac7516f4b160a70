// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Farms that aquafarm_train steps together for most learners.
inline constexpr std::int32_t kDefaultFarms = 16;

/// A learner that can be asked for by name.
struct Algorithm {
  const char* name;
  const char* summary;          ///< one line for people
  bool learns;                  ///< false: its name alone stands for a policy
  std::uint64_t default_steps;  ///< of training without a limit; see DefaultSteps
  /// EncodingBits that it reads with these options. @throws InputError when an option is wrong
  std::uint8_t (*encodings)(const std::string& options);
  /// Null: there is nothing to train.
  std::unique_ptr<Learner> (*make)(const EnvironmentSpec& spec, std::uint64_t seed,
                                   const std::string& options);
  /// Makes what it learnt play on farms of `spec`. @throws InputError when it does not fit
  std::unique_ptr<Policy> (*make_policy)(const Checkpoint& checkpoint, const EnvironmentSpec& spec);
  std::int32_t default_farms{kDefaultFarms};  ///< stepped together by aquafarm_train
};

/// All of them, in the order in which they are listed.
const std::vector<Algorithm>& Algorithms();

/// @throws InputError "algorithm: got 'dqm', expected one of: random, q_learning, sarsa"
const Algorithm& FindAlgorithm(const std::string& name);

/// Steps of a training without a limit: the algorithm's own number, or eight for each state of a
/// table where that is more. (Measured for Q-learning, docs/data.md; SARSA is given the same.)
std::uint64_t DefaultSteps(const Algorithm& algorithm, const EnvironmentSpec& spec,
                           const std::string& options);

/// The name that leaves the choice to ChooseAlgorithm.
inline constexpr const char* kAutoAlgorithm = "auto";

struct Choice {
  std::string algorithm;
  std::string reason;  ///< one line for people
};

/// Chooses by device intelligence, network and number of squads, as Fig. 6 of the paper does:
///
///   non-intelligent devices, one squad        a single-agent learner
///   several squads, or networked devices      a multi-agent learner
///   intelligent devices without a network     a single-agent learner for each
///
/// A device is intelligent if it is self-propelled, and networked if view.shared_sight is set.
Choice ChooseAlgorithm(const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
