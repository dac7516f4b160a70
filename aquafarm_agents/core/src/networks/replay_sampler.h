// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Sampling of replayed transitions: uniform, or prioritised by the TD error δ (Schaul et al. 2016)
/// with P(i) ∝ (|δ_i| + 1e-4)^α and importance weights (N P(i))^-β.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// Position of a transition in a replay.
struct TransitionIndex {
  std::size_t age{};   ///< number of time steps after the oldest stored one
  std::size_t slot{};  ///< slot of the agent, or of the first agent of a farm
};

/// Draws the transitions of minibatches.
template <typename Scalar>
class ReplaySampler {
 public:
  /// @param replay must outlive the sampler
  /// @param steps number of later time steps that must be stored for a drawn time step
  /// @param group 1 to draw transitions of single agents; the number of agents per farm to draw
  ///        transitions of whole farms in which at least one agent is not done
  ReplaySampler(const Replay<Scalar>& replay, const DeepOptions& options, std::size_t steps,
                std::size_t group = 1);

  /// Updates the sampler after a time step was added to the replay.
  void Add();
  /// Returns whether a transition can be drawn.
  bool IsReady() const;
  /// Draws transition i of a batch. IsReady() must be true. @param i [0, batch_size)
  TransitionIndex Draw(RandomStream& rng, std::size_t i);
  /// Returns the importance weights of the drawn batch, [batch_size], scaled to a max of 1. Must be
  /// called once after the draws of a batch.
  /// @param progress of the run, [0, 1]; β rises linearly with it, from importance_exponent to 1
  const std::vector<float>& ImportanceWeights(double progress);
  /// Sets the priority of a drawn transition. No effect with uniform sampling.
  /// @param row Replay::Row of the transition
  /// @param error absolute TD error
  void UpdatePriority(std::size_t row, float error);

  void Save(Checkpoint& checkpoint) const;
  /// Restores the priorities. The replay must be loaded before.
  /// @throws InputError if sections are missing or do not fit
  void Load(const Checkpoint& checkpoint);

 private:
  void Mark(std::size_t row, bool begins);
  bool Begins(std::size_t age, std::size_t slot) const {
    return group_ == 1 ? replay_.Begins(age, slot, steps_)
                       : replay_.BeginsForAny(age, slot, steps_);
  }

  const Replay<Scalar>& replay_;
  const double priority_;    // α; 0: uniform
  const double importance_;  // initial β
  const std::size_t steps_;
  const std::size_t group_;
  std::vector<std::uint8_t> beginnings_;  // by row: 1 where a transition begins
  std::size_t beginning_count_{};
  std::unique_ptr<SumTree> priorities_;  // by row; null if uniform
  float largest_priority_{1.0F};
  std::vector<float> weights_;  // [batch_size] P(i) of the draws, until ImportanceWeights is called
};

extern template class ReplaySampler<float>;
extern template class ReplaySampler<std::uint8_t>;

}  // namespace aquafarm::agents
