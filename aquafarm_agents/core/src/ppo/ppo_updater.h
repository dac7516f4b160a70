// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/ppo/ppo_options.h"
#include "aquafarm/base/rng.h"
#include "ppo/actor_critic.h"
#include "ppo/adam.h"
#include "ppo/ppo_loss.h"
#include "ppo/rollout.h"
#include "ppo/teacher.h"

namespace aquafarm::agents {

/// Improves an ActorCritic with full rollouts in epochs of shuffled minibatches. A minibatch is
/// processed in chunks that fit the processor's cache; their gradients are summed.
class PpoUpdater {
 public:
  PpoUpdater(const PpoOptions& options, ActorCritic& network);
  /// Adds a teacher, which the policy imitates with the weight PpoOptions::teacher.
  void SetTeacher(std::unique_ptr<const Teacher> teacher) { teacher_ = std::move(teacher); }

  /// Position of an update in the run; for schedules and messages.
  struct Context {
    double progress{};  ///< of the run, [0, 1]
    std::uint64_t farm_steps{};
  };
  /// Runs all epochs on a complete rollout. @param rng for the order of the samples
  /// @throws LearnerFailed if a loss or a gradient is not finite; the weights are then those of
  /// the last good minibatch
  void Update(const Rollout& rollout, const Context& context, RandomStream& rng);

  double learning_rate() const { return learning_rate_; }
  /// Moving average of the squared value error [reward²]; NaN before the first update.
  float value_error() const { return value_error_; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or have another size
  void Load(const Checkpoint& checkpoint);

 private:
  void Collect(const Rollout& rollout);
  void Shuffle(RandomStream& rng);
  void NormalizeAdvantages(const Rollout& rollout, std::size_t first, std::size_t count);
  PpoLoss LearnMinibatch(const Rollout& rollout, std::size_t first, std::size_t count);
  PpoLoss LearnChunk(const Rollout& rollout, std::size_t first, std::size_t count);
  void Gather(const Rollout& rollout, std::size_t first, std::size_t count);
  [[noreturn]] void Fail(const std::string& what, const Context& context) const;

  const PpoOptions options_;
  ActorCritic& network_;
  Adam adam_;
  double learning_rate_{};
  float value_error_;
  PpoCoefficients coefficients_;
  std::unique_ptr<const Teacher> teacher_;  // null without tokens
  float teacher_coef_{};

  // Scratch.
  std::vector<std::uint32_t> sequences_;  // first slots of the sequences with transitions
  std::size_t length_;                    // steps of a sequence
  float mean_{};                          // mean of the advantages of a minibatch
  float inverse_deviation_{1.0F};
  float weight_{};  // weight of a row in a minibatch
  std::vector<float> features_;
  std::vector<float> state_;
  std::vector<std::uint8_t> started_;
  std::vector<ActionMask> masks_;
  std::vector<std::uint8_t> actions_;
  std::vector<float> log_probs_;
  std::vector<float> values_;
  std::vector<float> advantages_;
  std::vector<float> targets_;
  std::vector<float> weights_;
  std::vector<float> slopes_;
  ActionDistribution distribution_;
};

}  // namespace aquafarm::agents
