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

/// Evaluates an ActorCritic for all agents of all farms and chooses their actions. Each agent of
/// each farm has one slot: N farms with S agents have N · S slots.
class Actor {
 public:
  Actor(const EnvironmentSpec& spec, const PpoOptions& options, std::size_t state_size);

  /// Makes Observe average the outputs of the network over all rotations and reflections of the
  /// observed tokens. A rotated or reflected ranch then has the same values, and its probabilities
  /// are rotated or reflected accordingly. Only for networks without a recurrent state.
  void AverageSymmetries(const TokenLayout& layout) { symmetries_ = AllSymmetries(layout); }
  /// Clears the recurrent states and sets the number of farms N.
  void Begin(std::size_t farms);
  /// Computes masks, probabilities and values for the observations of `results`, and advances the
  /// recurrent states. The mask of an inactive agent contains only action 0.
  void Observe(ActorCritic& network, const StepResults& results);

  /// Draws actions from the probabilities. Slot i draws from stream i.
  void Sample(AgentRng& rng, std::vector<std::uint8_t>& actions) const;
  /// Takes the most probable action of each agent. Ties go to the lowest action number.
  void TakeBest(std::vector<std::uint8_t>& actions) const;

  std::size_t slots() const { return masks_.size(); }
  const std::vector<ActionMask>& masks() const { return masks_; }  ///< [N, S]
  const std::vector<float>& values() const { return values_; }     ///< [N, S]
  const ActionDistribution& distribution() const { return distribution_; }
  /// Recurrent states after the last Observe, [N, S, state_size].
  const std::vector<float>& state() const { return state_; }
  std::vector<float>& state() { return state_; }
  /// Recurrent states before the last Observe. Where an episode starts, they are those of the
  /// previous episode: only the network clears its copy (SequenceRows::is_first).
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
  std::vector<float> joint_;  // [N, S, joint_agents, F]; empty without a central critic
  std::vector<TokenSymmetry> symmetries_;  // Observe averages over these; empty: no averaging
  std::vector<float> turned_;              // [N, S, F]
  std::vector<float> mean_outputs_;        // [N, S, kActorCriticOutputs]
  std::vector<std::uint8_t> is_first_;
  std::vector<float> state_;
  std::vector<float> state_before_;
  ActionDistribution distribution_;
};

}  // namespace aquafarm::agents
