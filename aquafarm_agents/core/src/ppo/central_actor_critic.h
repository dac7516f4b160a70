// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ppo/actor_critic.h"

namespace aquafarm::agents {

/// The ActorCritic of agents that learn together (MAPPO, Yu et al. 2022, arXiv:2103.01955). An
/// agent's logits depend on its own observation. Its value depends on the observations of all
/// agents of its farm. There are two networks without common layers, both FeedForward or both
/// LstmActorCritic:
///
///   policy   computes the logits from SequenceRows::features; its value is not used
///   critic   computes the value from SequenceRows::joint; its logits are not used
///
/// The weights of the policy come first. A saved policy contains only these. The recurrent state of
/// an agent is the state of the policy, then the state of the critic.
class CentralActorCritic final : public ActorCritic {
 public:
  /// @param agents number of agents of one farm
  /// @param critic its weights must begin at index policy->weights().size()
  CentralActorCritic(std::size_t agents, std::unique_ptr<ActorCritic> policy,
                     std::unique_ptr<ActorCritic> critic);

  std::size_t state_size() const override { return policy_.network->state_size() * 2; }
  std::size_t chunk_rows() const override { return policy_.network->chunk_rows(); }
  std::size_t joint_agents() const override { return agents_; }
  std::size_t policy_size() const override { return policy_size_; }
  const float* Forward(const SequenceRows& rows, float* state_after) override;
  void Backward(const SequenceRows& rows, const float* slopes) override;

 private:
  /// One of the two networks, with its part of the states and slopes.
  struct Part {
    std::unique_ptr<ActorCritic> network;
    std::vector<float> state;        // [sequences, state_size] before the first step
    std::vector<float> state_after;  // [sequences, state_size]
    std::vector<float> slopes;       // [rows, kActorCriticOutputs]
  };
  SequenceRows RowsOf(const Part& part, const SequenceRows& rows) const;
  const float* ForwardPart(Part& part, const SequenceRows& rows, bool needs_state);
  void BackwardPart(Part& part, const SequenceRows& rows);
  void SplitStates(const SequenceRows& rows);
  void JoinStates(std::size_t sequences, float* state_after) const;

  const std::size_t agents_;
  Part policy_;
  Part critic_;
  const std::size_t policy_size_;
  std::vector<float> outputs_;  // [rows, kActorCriticOutputs]
};

/// Copies the observations of all agents of one farm: first that of `agent`, then the others in id
/// order.
/// @param farm [agents, features] observations in id order
/// @param joint [agents, features] receives the copy
void JoinObservations(const float* farm, std::size_t agents, std::size_t features,
                      std::size_t agent, float* joint);

}  // namespace aquafarm::agents
