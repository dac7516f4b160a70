// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Actors and critic of MADDPG on libtorch.

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "maddpg/maddpg_options.h"
#include "networks/networks.h"

namespace aquafarm::agents {

/// The actors of all agents of a farm: one network each, or one for all.
class ActorTeam final : public torch::nn::Module {
 public:
  ActorTeam(const EnvironmentSpec& spec, const MaddpgOptions& options);

  /// Numbers of (h, c) that an agent carries; 0 when the actors have no memory.
  std::int64_t carry_size() const { return carry_size_; }

  /// Logits at a window's last step, the memory moved on through it.
  /// @param observations [T, B, S, F]
  /// @param keeps [T, B, S] 0: the memory is emptied before that step
  /// @param carry [B, S, carry_size] before the window; becomes that after it. Undefined: no memory
  /// @returns [B, S, kActionCount]
  torch::Tensor Forward(const torch::Tensor& observations, const torch::Tensor& keeps,
                        torch::Tensor& carry);

 private:
  torch::Tensor ForwardOne(std::size_t network, const torch::Tensor& observations,
                           const torch::Tensor& keeps, torch::Tensor& carry);

  std::int64_t carry_size_;
  std::vector<std::shared_ptr<QNetwork>> plain_;
  std::vector<std::shared_ptr<RecurrentNetwork>> recurrent_;
};

/// Each agent's Q of each of its actions, from all observations and the others' actions: one
/// network that judges them all.
class JointCritic final : public torch::nn::Module {
 public:
  JointCritic(const EnvironmentSpec& spec, std::int64_t hidden);
  /// @param observations [B, S, F]
  /// @param actions [B, S, kActionCount] one-hot, or 0 for an agent that is done
  /// @returns [B, S, kActionCount]
  torch::Tensor Forward(const torch::Tensor& observations, const torch::Tensor& actions);

 private:
  torch::nn::Linear first_{nullptr};
  torch::nn::Linear second_{nullptr};
  torch::nn::Linear head_{nullptr};
};

}  // namespace aquafarm::agents
