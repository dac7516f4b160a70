// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/agent_rng.h"
#include "aquafarm/agents/ppo/ppo_options.h"
#include "ppo/actor_critic.h"
#include "ppo/ppo_loss.h"
#include "ppo/token_symmetry.h"

namespace aquafarm::agents {

/// Evaluates an ActorCritic for all agents of all farms and chooses their actions.
class Actor {
 public:
  Actor(const EnvironmentSpec& spec, const PpoOptions& options, std::size_t state_size);

  /// Averages the outputs of the network over all rotations and reflections of the observed
  /// tokens from now on: a turned ranch then has the turned probabilities and the same value.
  void AverageSymmetries(const TokenLayout& layout) { symmetries_ = AllSymmetries(layout); }
  /// Clears the recurrent states. @param farms N
  void Begin(std::size_t farms);
  /// Computes masks (only action 0 for an agent that is done), probabilities and values for the
  /// observations of `results` and advances the recurrent states of their agents.
  void Observe(ActorCritic& network, const StepResults& results);

  /// Draws actions from the probabilities; agent i draws from stream i.
  void Sample(AgentRng& rng, std::vector<std::uint8_t>& actions) const;
  /// Takes the most probable actions; the action with the lowest index among equals.
  void TakeBest(std::vector<std::uint8_t>& actions) const;

  std::size_t slots() const { return masks_.size(); }
  const std::vector<ActionMask>& masks() const { return masks_; }  ///< [N, S]
  const std::vector<float>& values() const { return values_; }     ///< [N, S]
  const ActionDistribution& distribution() const { return distribution_; }
  const std::vector<float>& state() const { return state_; }  ///< [N, S, state_size]
  std::vector<float>& state() { return state_; }
  /// The states before the last Observe, cleared where an episode started.
  const std::vector<float>& state_before() const { return state_before_; }

 private:
  void Join(std::size_t joint_agents, const std::vector<float>& features);
  const float* MeanOutputs(ActorCritic& network, SequenceRows rows);

  const PpoOptions options_;
  const std::size_t agents_;
  const std::size_t features_;
  const std::size_t state_size_;
  std::vector<ActionMask> masks_;
  std::vector<float> values_;
  std::vector<float> joint_;               // [N, S, joint_agents, F]
  std::vector<TokenSymmetry> symmetries_;  // to average over; empty: only the plain tokens
  std::vector<float> turned_;              // [N, S, F]
  std::vector<float> mean_outputs_;        // [N, S, kActorCriticOutputs]
  std::vector<std::uint8_t> is_first_;
  std::vector<float> state_;
  std::vector<float> state_before_;
  ActionDistribution distribution_;
};

}  // namespace aquafarm::agents
