// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Networks that give the logits of a policy and the value of a state from one shared trunk, with
/// their gradients written out. They use BLAS and no automatic differentiation.
///
///   feed-forward  features - Linear - ReLU - Linear - ReLU - Linear
///   recurrent     features - Linear - ReLU - LSTM - (h and its input) - Linear
///
/// The last layer has kActorCriticOutputs outputs: kActionCount logits, then the value.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aquafarm::agents {

/// A batch of sequences, time-major: row t · sequences + s. A feed-forward network takes steps = 1.
struct SequenceRows {
  std::size_t steps{1};
  std::size_t sequences{};
  const float* features{};         ///< [steps, sequences, F]
  const float* state{};            ///< [sequences, state_size] before the first step
  const std::uint8_t* is_first{};  ///< [steps, sequences] 1: the state is cleared before this step
  const float* joint{};            ///< [steps, sequences, joint_agents, F] by JoinObservations
  std::size_t rows() const { return steps * sequences; }
};

class ActorCritic {
 public:
  virtual ~ActorCritic() = default;

  /// Size of an agent's recurrent state; 0 if feed-forward.
  virtual std::size_t state_size() const = 0;
  /// Max number of rows for which Forward is efficient.
  virtual std::size_t chunk_rows() const = 0;

  /// Number of agents whose observations the value depends on; 0 if only on the agent's own.
  virtual std::size_t joint_agents() const { return 0; }
  /// Number of the first weights that a saved policy consists of.
  virtual std::size_t policy_size() const { return weights_.size(); }

  /// Computes the outputs and stores the activations that Backward needs.
  /// @param state_after [sequences, state_size] after the last step; nullptr if not needed
  /// @returns [rows, kActorCriticOutputs], valid until the next call
  virtual const float* Forward(const SequenceRows& rows, float* state_after) = 0;

  /// Adds the gradient of the last Forward to gradient().
  /// @param slopes [rows, kActorCriticOutputs]: d loss / d outputs
  virtual void Backward(const SequenceRows& rows, const float* slopes) = 0;

  std::vector<float>& weights() { return weights_; }
  const std::vector<float>& weights() const { return weights_; }
  /// Sum of the gradients since the last clear, in the order of the weights.
  std::vector<float>& gradient() { return gradient_; }

 protected:
  std::vector<float> weights_;
  std::vector<float> gradient_;
};

}  // namespace aquafarm::agents
