// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Actors and critic of MADDPG, as modules of libtorch.

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "maddpg/maddpg_options.h"
#include "networks/networks.h"

namespace aquafarm::agents {

/// The actors of all agents of a farm: one network per agent, or one shared network.
class ActorTeam final : public torch::nn::Module {
 public:
  ActorTeam(const EnvironmentSpec& spec, const MaddpgOptions& options);

  /// Returns the number of values of an agent's recurrent state (h, c); 0 if the actors are not
  /// recurrent.
  std::int64_t recurrent_size() const { return recurrent_size_; }

  /// Returns the logits at the last step of a window of T steps, for B farms with S agents each.
  /// @param observations [T, B, S, F]
  /// @param keeps [T, B, S] 0 resets the recurrent state before that step, 1 keeps it
  /// @param recurrent_state [B, S, recurrent_size] before the window; receives the state after the
  ///   window. It is an undefined tensor if the actors are not recurrent
  /// @returns [B, S, kActionCount]
  torch::Tensor Forward(const torch::Tensor& observations, const torch::Tensor& keeps,
                        torch::Tensor& recurrent_state);

 private:
  torch::Tensor ForwardOne(std::size_t network, const torch::Tensor& observations,
                           const torch::Tensor& keeps, torch::Tensor& recurrent_state);

  std::int64_t recurrent_size_;
  std::vector<std::shared_ptr<QNetwork>> plain_;
  std::vector<std::shared_ptr<RecurrentNetwork>> recurrent_;
};

/// Computes Q for each action of each agent, from the observations of all agents and the actions of
/// the other agents. The same network evaluates every agent.
class JointCritic final : public torch::nn::Module {
 public:
  JointCritic(const EnvironmentSpec& spec, std::int64_t hidden);
  /// @param observations [B, S, F]
  /// @param actions [B, S, kActionCount] one-hot, or zeros for an agent that is done
  /// @returns Q [B, S, kActionCount]
  torch::Tensor Forward(const torch::Tensor& observations, const torch::Tensor& actions);

 private:
  torch::nn::Linear first_{nullptr};
  torch::nn::Linear second_{nullptr};
  torch::nn::Linear head_{nullptr};
};

}  // namespace aquafarm::agents
