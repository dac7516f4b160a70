// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents {

/// Hyperparameters of MADDPG. docs/several_agents.md explains the defaults.
struct MaddpgOptions {
  std::int32_t hidden_size{256};  ///< units of each hidden layer, and of the LSTM
  Schedule actor_rate{ScheduleKind::kLinear, 1e-3, 1e-5, 1.0};   ///< learning rate of the actors
  Schedule critic_rate{ScheduleKind::kLinear, 1e-3, 1e-5, 1.0};  ///< learning rate of the critic
  double gamma{0.97};
  ExplorationOptions exploration{
      ExplorationKind::kEpsilonGreedy, {ScheduleKind::kLinear, 1.0, 0.005, 0.1}, {}};
  std::int32_t batch_size{64};          ///< time steps per update, each with all agents of a farm
  double train_interval{4.0};           ///< farm steps between updates
  std::uint64_t learning_starts{5000};  ///< farm steps before the first update
  std::uint64_t buffer_size{200000};    ///< capacity in observations, each of one agent
  double priority_exponent{0.6};        ///< exponent α of prioritised replay; 0: uniform
  double importance_exponent{0.4};      ///< initial exponent β; rises to 1
  double tau{0.01};                     ///< weight of the online network in soft target updates
  std::int32_t n_step{1};               ///< steps of a return (Sutton 1988)
  double temperature{1.0};              ///< temperature of the Gumbel-softmax
  double logit_penalty{3e-4};           ///< weight of mean logits² in the loss of the actors
  double reward_scale{0.05};            ///< factor of the rewards; 1: unscaled
  double max_grad_norm{10.0};           ///< max norm of the gradient; 0: no limit
  bool best_response{true};    ///< true: targets use the agent's best response to the others'
                               ///< target actors; false: its own target actor (Lowe et al. 2017)
  bool mask_illegal{true};     ///< exclude illegal actions when acting and bootstrapping
  bool mask_blocked{true};     ///< also exclude moves onto a charted rock, an island or off the map
  bool shared{true};           ///< one network for all actors; false: one network per actor
  bool recurrent{false};       ///< actors with an LSTM
  std::int32_t window{4};      ///< time steps of a training sequence; 1 without `recurrent`
  std::string device{"auto"};  ///< auto, cpu or cuda
  std::int32_t threads{1};

  /// Parses "key=value …".
  /// @param resolved receives all options with their effective values
  /// @throws InputError if an option is unknown or out of range
  static MaddpgOptions Parse(const std::string& text, std::string& resolved);
};

}  // namespace aquafarm::agents
