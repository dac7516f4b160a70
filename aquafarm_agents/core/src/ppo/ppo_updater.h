// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/ppo/ppo_options.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/base/rng.h"
#include "ppo/actor_critic.h"
#include "ppo/adam.h"
#include "ppo/ppo_loss.h"
#include "ppo/rollout.h"

namespace aquafarm::agents {

/// Trains an ActorCritic on full rollouts, in epochs of shuffled minibatches.
///
/// Each shard divides its own rollout into nearly equal parts, one for each minibatch. Gradients,
/// losses and statistics of the advantages are added as a binary tree over the shards of all ranks,
/// so the sums have the same bits for every number of ranks. A shard processes its part of a
/// minibatch in chunks that fit the processor's cache, and sums their gradients.
class PpoUpdater {
 public:
  /// @param network must outlive the updater
  /// @param shards number of shards in this process, a power of two
  /// @param group the processes with the other shards; null if this process has all shards
  PpoUpdater(const PpoOptions& options, ActorCritic& network, std::size_t shards,
             ProcessGroup* group);

  /// Data of one shard of this process. Both pointers must be set.
  struct Input {
    const Rollout* rollout{};  ///< after Rollout::Finish
    RandomStream* rng{};       ///< draws the order of the samples
  };

  /// Progress of the run, for schedules and messages.
  struct Context {
    double progress{};           ///< fraction of the run that is done, [0, 1]
    std::uint64_t farm_steps{};  ///< farm steps of this process so far
  };
  /// Runs all epochs.
  /// @param inputs one for each shard of this process
  /// @throws LearnerFailed if a loss or a gradient is not finite. The weights are then those after
  ///   the last good minibatch.
  /// @throws RankLost if another rank does not answer
  void Update(const std::vector<Input>& inputs, const Context& context);

  double learning_rate() const { return learning_rate_; }
  /// Moving average of the squared value error [reward²]; NaN before the first update.
  float value_error() const { return value_error_; }
  /// Mean entropy of the policy in the minibatches of the last update [nats]; ln 10, the entropy of
  /// a uniform policy, before the first update.
  float entropy() const { return entropy_; }
  void set_entropy(float entropy) { entropy_ = entropy; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing, damaged or have another size
  void Load(const Checkpoint& checkpoint);

 private:
  struct Range {
    std::size_t first{};
    std::size_t count{};
  };
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // the saved numbers, by name
  void Collect(const Rollout& rollout, std::size_t shard);
  void Shuffle(std::size_t shard, RandomStream& rng);
  std::size_t CountSequences();
  Range Part(std::size_t shard, std::size_t batch) const;
  void SumAdvantages(const std::vector<Input>& inputs);
  void NormalizeAdvantages(std::size_t batch);
  PpoLoss LearnMinibatch(const std::vector<Input>& inputs, std::size_t batch);
  PpoLoss LearnChunk(const Rollout& rollout, const std::uint32_t* sequences, std::size_t count);
  void Gather(const Rollout& rollout, const std::uint32_t* sequences, std::size_t count);
  [[noreturn]] void Fail(const std::string& what, const Context& context) const;

  const PpoOptions options_;
  ActorCritic& network_;
  Adam adam_;
  double learning_rate_{};
  float value_error_;
  float entropy_;
  PpoCoefficients coefficients_;
  ProcessGroup* const group_;

  // Buffers and values that each update uses again. One entry per shard of this process:
  std::vector<std::vector<std::uint32_t>> sequences_;  // first sample of each sequence
  std::vector<std::vector<float>> gradients_;          // of a minibatch
  std::vector<std::vector<double>> losses_;            // of a minibatch: the members of PpoLoss
  std::vector<std::vector<double>> advantage_sums_;    // by minibatch: Σ A, Σ A², number of rows
  // Of the present update or minibatch:
  std::vector<float> nothing_;     // empty; ProcessGroup::Sum of doubles alone
  std::size_t batches_{};          // minibatches of an epoch
  std::size_t length_;             // steps of a sequence
  float mean_{};                   // mean of the advantages of a minibatch
  float inverse_deviation_{1.0F};  // 1 / their standard deviation
  float weight_{};                 // weight of each row of a minibatch
  // Rows of a chunk:
  std::vector<float> features_;
  std::vector<float> joint_;
  std::vector<float> state_;
  std::vector<std::uint8_t> is_first_;
  std::vector<ActionMask> masks_;
  std::vector<std::uint8_t> actions_;
  std::vector<float> log_probs_;
  std::vector<float> values_;
  std::vector<float> advantages_;
  std::vector<float> targets_;
  std::vector<float> weights_;
  std::vector<std::uint8_t> labels_;
  std::vector<float> slopes_;
  ActionDistribution distribution_;
};

}  // namespace aquafarm::agents
