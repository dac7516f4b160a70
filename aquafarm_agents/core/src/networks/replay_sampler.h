// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Sampling of replayed transitions: uniform, or prioritised by the TD error (Schaul et al. 2016)
/// with P(i) ∝ |δ_i|^α and importance weights (N P(i))^-β.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// Index of a time step of one agent, or of a whole farm, in a replay.
struct TransitionIndex {
  std::size_t age{};
  std::size_t slot{};
};

template <typename Scalar>
class ReplaySampler {
 public:
  /// @param replay must outlive the sampler
  /// @param steps number of later time steps that a drawn time step must have
  /// @param group 1, or the number of agents of a farm to draw whole farms. The slot is then that
  ///        of the farm's first agent, which may be done
  ReplaySampler(const Replay<Scalar>& replay, const DeepOptions& options, std::size_t steps,
                std::size_t group = 1);

  /// Updates the sampler after a time step was added to the replay.
  void Add();
  /// True if a transition can be drawn. Precondition of Draw.
  bool IsReady() const;
  /// Draws the i-th transition of a batch.
  TransitionIndex Draw(RandomStream& rng, std::size_t i);
  /// Importance weights of the last batch, [batch], scaled to a max of 1.
  /// @param progress of the run, [0, 1]; β rises to 1 with it
  const std::vector<float>& ImportanceWeights(double progress);
  /// Sets the TD error at the row of a drawn transition. No effect with uniform sampling.
  void UpdatePriority(std::size_t row, float error);

  void Save(Checkpoint& checkpoint) const;
  /// Requires a loaded replay. @throws InputError
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
  std::vector<float> weights_;  // P(i) until Weigh is called
};

extern template class ReplaySampler<float>;
extern template class ReplaySampler<std::uint8_t>;

}  // namespace aquafarm::agents
