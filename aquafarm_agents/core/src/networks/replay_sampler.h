// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Which moments of a replay a learner learns from: any alike, or by how wrong it was there (Schaul
/// et al. 2016): P(i) ∝ |δ_i|^α, set right by weights (N P(i))^-β.

#include <cstdint>
#include <memory>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"
#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {

/// A moment of one agent, or of a whole farm, in a replay.
struct Moment {
  std::size_t age{};
  std::size_t entry{};
};

template <typename Scalar>
class MomentSampler {
 public:
  /// @param replay must outlive the sampler
  /// @param steps that a moment must have after it
  /// @param group 1, or the agents of a farm, to draw moments of whole farms: their entry is that
  /// of the farm's first agent, who may be done
  MomentSampler(const Replay<Scalar>& replay, const DeepOptions& options, std::size_t steps,
                std::size_t group = 1);

  /// The replay got a moment more.
  void Remember();
  /// Whether there is a moment to draw; Draw must not be called otherwise.
  bool IsReady() const;
  /// Draws the i-th moment of a batch.
  Moment Draw(RandomStream& chance, std::size_t i);
  /// Weights of the batch just drawn, [batch], the largest 1. @param progress of the run: β rises
  /// to 1 with it
  const std::vector<float>& Weigh(double progress);
  /// The error that was found at the row of a drawn moment; of no use when all are drawn alike.
  void SetError(std::size_t row, float error);

  void Save(Checkpoint& checkpoint) const;
  /// The replay must have been loaded before. @throws InputError
  void Load(const Checkpoint& checkpoint);

 private:
  void Mark(std::size_t row, bool begins);
  bool Begins(std::size_t age, std::size_t entry) const {
    return group_ == 1 ? replay_.Begins(age, entry, steps_)
                       : replay_.BeginsForAny(age, entry, steps_);
  }

  const Replay<Scalar>& replay_;
  const double priority_;    // α; 0: all alike
  const double importance_;  // β at the start
  const std::size_t steps_;
  const std::size_t group_;
  std::vector<std::uint8_t> beginnings_;  // by row: 1 where a transition begins
  std::size_t beginning_count_{};
  std::unique_ptr<SumTree> priorities_;  // by row; null: all alike
  float largest_priority_{1.0F};
  std::vector<float> weights_;  // P(i) until they are weighed
};

extern template class MomentSampler<float>;
extern template class MomentSampler<std::uint8_t>;

}  // namespace aquafarm::agents
