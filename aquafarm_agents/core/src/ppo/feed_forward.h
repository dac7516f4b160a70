// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "ppo/actor_critic.h"
#include "ppo/linear.h"
#include "ppo/weight_drawer.h"

namespace aquafarm::agents {

/// The feed-forward ActorCritic: two hidden layers with ReLU.
class FeedForward final : public ActorCritic {
 public:
  FeedForward(std::size_t features, std::size_t hidden, const WeightOrigin& origin);

  std::size_t state_size() const override { return 0; }
  std::size_t chunk_rows() const override { return 256; }
  const float* Forward(const SequenceRows& rows, float* state_after) override;
  void Backward(const SequenceRows& rows, const float* slopes) override;

 private:
  void Reserve(std::size_t rows);

  const Linear first_;
  const Linear second_;
  const Linear head_;
  // [rows, …] activations of the last Forward, and slopes of the last Backward
  std::vector<float> first_out_;
  std::vector<float> second_out_;
  std::vector<float> outputs_;
  std::vector<float> first_slopes_;
  std::vector<float> second_slopes_;
};

}  // namespace aquafarm::agents
