// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Networks that compute the logits of a policy and the value of a state. Their gradients are
/// written by hand, without automatic differentiation (matrix products: networks/gemm.h).
///
///   FeedForward         features - Linear - ReLU - Linear - ReLU - Linear
///   LstmActorCritic     features - Linear - ReLU - LSTM - (its output and its input) - Linear
///   TokenActorCritic    an encoder for each kind of entity token, then as FeedForward
///   CentralActorCritic  two separate networks: one for the logits, one for the value
///
/// Each has kActorCriticOutputs outputs: kActionCount logits, then the value.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aquafarm::agents {

/// A batch of sequences, time-major: step t of sequence s is row t · sequences + s. For networks
/// without a recurrent state, steps is 1.
struct SequenceRows {
  std::size_t steps{1};
  std::size_t sequences{};
  const float* features{};         ///< [steps, sequences, F]
  const float* state{};            ///< [sequences, state_size] states before the first step
  const std::uint8_t* is_first{};  ///< [steps, sequences] 1: the state is cleared before this step
  /// [steps, sequences, joint_agents, F] as written by JoinObservations; unused if joint_agents is
  /// 0
  const float* joint{};
  std::size_t rows() const { return steps * sequences; }
};

class ActorCritic {
 public:
  virtual ~ActorCritic() = default;

  /// Size of an agent's recurrent state; 0 if feed-forward.
  virtual std::size_t state_size() const = 0;
  /// Largest number of rows for which Forward is efficient.
  virtual std::size_t chunk_rows() const = 0;

  /// Number of agents whose observations determine the value; 0 if only the agent's own observation
  /// determines it.
  virtual std::size_t joint_agents() const { return 0; }
  /// Number of weights in a saved policy, which contains the first policy_size() weights.
  virtual std::size_t policy_size() const { return weights_.size(); }

  /// Computes the outputs and stores the activations that Backward needs.
  /// @param state_after [sequences, state_size] after the last step; nullptr if not needed
  /// @returns [rows, kActorCriticOutputs], valid until the next call
  virtual const float* Forward(const SequenceRows& rows, float* state_after) = 0;

  /// Adds the gradient of the last Forward to gradient().
  /// @param rows those of the last Forward
  /// @param slopes [rows, kActorCriticOutputs]: d loss / d outputs
  virtual void Backward(const SequenceRows& rows, const float* slopes) = 0;

  std::vector<float>& weights() { return weights_; }
  const std::vector<float>& weights() const { return weights_; }
  /// Sum of the gradients in the order of the weights. The caller clears it.
  std::vector<float>& gradient() { return gradient_; }

 protected:
  std::vector<float> weights_;
  std::vector<float> gradient_;
};

}  // namespace aquafarm::agents
