// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "ppo/actor_critic.h"
#include "ppo/linear.h"
#include "ppo/weight_drawer.h"

namespace aquafarm::agents {

/// The recurrent ActorCritic. The LSTM has forget gates (Gers et al. 2000):
///
///   x = ReLU(Linear(features))
///   i, f, o = sigmoid and g = tanh of the four parts of x · W_in + h · W_rec + b
///   c' = f c + i g,   h' = o tanh(c')
///   outputs = Linear([h', x])
///
/// The state of an agent is h, then c. Gradients flow back through the steps of a sequence, but not
/// across the start of an episode.
class LstmActorCritic final : public ActorCritic {
 public:
  LstmActorCritic(std::size_t features, std::size_t hidden, const WeightOrigin& origin);

  std::size_t state_size() const override { return 2 * hidden_; }
  std::size_t chunk_rows() const override { return 512; }
  const float* Forward(const SequenceRows& rows, float* state_after) override;
  void Backward(const SequenceRows& rows, const float* slopes) override;

 private:
  void Reserve(const SequenceRows& rows);
  void LoadState(const SequenceRows& rows);
  void StepForward(const SequenceRows& rows, std::size_t step);
  void StepBackward(const SequenceRows& rows, std::size_t step);

  const std::size_t hidden_;
  const Linear first_;
  const Linear gates_;      // W_in and b
  const Linear recurrent_;  // W_rec; without a bias
  const Linear head_;       // from [h', x] to the outputs

  std::vector<float> recurrent_transposed_;  // weights of `recurrent_`, [4 hidden, hidden]

  // [steps, sequences, …]
  std::vector<float> seen_;           // [hidden] x
  std::vector<float> gate_values_;    // [4 hidden] i, f, g, o
  std::vector<float> hidden_before_;  // [hidden] h before the step; 0 where an episode starts
  std::vector<float> cell_before_;    // [hidden] c before the step; 0 where an episode starts
  std::vector<float> cell_tanh_;      // [hidden] tanh(c')
  std::vector<float> joined_;         // [2 hidden] h', x
  std::vector<float> outputs_;
  std::vector<float> joined_slopes_;
  std::vector<float> gate_slopes_;
  std::vector<float> seen_slopes_;
  // [sequences, hidden]
  std::vector<float> hidden_now_;
  std::vector<float> cell_now_;
  std::vector<float> hidden_slopes_;
  std::vector<float> cell_slopes_;
};

}  // namespace aquafarm::agents
