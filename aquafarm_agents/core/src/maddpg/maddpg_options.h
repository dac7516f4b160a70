// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents {

/// Numbers and switches of MADDPG; docs/several_agents.md gives their sources.
struct MaddpgOptions {
  std::int32_t hidden{256};  ///< units of a hidden layer; of the LSTM when recurrent
  Schedule actor_rate{ScheduleKind::kLinear, 1e-3, 1e-5, 1.0};   ///< learning rate of Adam
  Schedule critic_rate{ScheduleKind::kLinear, 1e-3, 1e-5, 1.0};  ///< learning rate of Adam
  double discount{0.97};
  ExplorationOptions exploration{
      ExplorationKind::kEpsilonGreedy, {ScheduleKind::kLinear, 1.0, 0.005, 0.1}, {}};
  std::int32_t batch{64};        ///< moments of an update, all agents of a farm each
  double steps_per_update{4.0};  ///< farm steps between updates
  std::uint64_t start{5000};     ///< farm steps before the first update
  std::uint64_t replay{200000};  ///< transitions kept
  double priority{0.6};          ///< α of prioritised replay; 0: all moments alike
  double importance{0.4};        ///< β at the start
  double target_rate{0.01};      ///< share copied to the target networks at each update
  std::int32_t n_step{1};
  double temperature{1.0};     ///< of the Gumbel-softmax
  double logit_penalty{3e-4};  ///< keeps actors from becoming sure too early
  double reward_scale{0.05};
  double gradient_limit{10.0};  ///< largest norm of a gradient; 0: none
  bool best_response{true};     ///< targets: the best own answer to the others' target actors; else
                                ///< the own target actor's, as printed
  bool mask_illegal{true};      ///< never try, nor bootstrap on, actions that would be ILLEGAL
  bool mask_blocked{true};      ///< nor moves onto a charted rock, an island or off the map
  bool shared{true};       ///< one network for all actors, which tells them apart by their index
  bool recurrent{false};   ///< actors with a memory
  std::int32_t window{4};  ///< steps through which a recurrent actor learns
  std::string device{"auto"};  ///< auto, cpu or cuda
  std::int32_t threads{1};

  /// @throws InputError
  static MaddpgOptions Parse(const std::string& text, std::string& resolved);
};

}  // namespace aquafarm::agents
