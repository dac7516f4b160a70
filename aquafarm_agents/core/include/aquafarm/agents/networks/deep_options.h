// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents {

/// Which observation a network reads, and how.
enum class NetworkKind : std::uint8_t {
  kMlp,  ///< the feature vector, two hidden layers
  kCnn,  ///< the planes, two convolutions and a hidden layer
};
inline constexpr int kNetworkKindCount = 2;
std::string_view ToString(NetworkKind value);

/// How the error of a prediction counts.
enum class LossKind : std::uint8_t { kHuber, kMse };
inline constexpr int kLossKindCount = 2;
std::string_view ToString(LossKind value);

/// Numbers and switches of DQN and LSTM-DQN. Two presets give the defaults: *tuned*, what was
/// measured to do well on the shipped farms, and *paper*, §3.4.3 as printed with every switch off.
struct DeepOptions {
  NetworkKind network{NetworkKind::kMlp};
  std::int32_t hidden{256};  ///< units of a hidden layer; of the LSTM when recurrent
  Schedule learning_rate{ScheduleKind::kLinear, 5e-4, 1e-5, 1.0};  ///< of Adam
  double discount{0.97};
  ExplorationOptions exploration{
      ExplorationKind::kEpsilonGreedy, {ScheduleKind::kLinear, 1.0, 0.005, 0.1}, {}};
  std::int32_t batch{64};  ///< transitions, or sequences, of an update
  Schedule steps_per_update{ScheduleKind::kConstant, 2.0};  ///< farm steps between updates
  std::uint64_t start{5000};                                ///< farm steps before the first update
  std::uint64_t replay{100000};                             ///< transitions kept
  std::uint64_t target_period{250};  ///< updates between copies to the target network (hard)
  double target_rate{0.0};           ///< share copied at each update (soft) instead; 0: hard
  LossKind loss{LossKind::kHuber};
  double gradient_limit{10.0};  ///< largest norm of a gradient; 0: none

  // Switches beyond §3.4.3, with their sources.
  bool double_q{true};        ///< van Hasselt et al. 2016
  bool dueling{false};        ///< Wang et al. 2016
  std::int32_t n_step{1};     ///< Sutton 1988; 1: off
  double priority{0.6};       ///< exponent α of Schaul et al. 2016; 0: uniform
  double importance{0.4};     ///< exponent β of the same, at the start; 1 at the end
  double reward_scale{0.05};  ///< 1: off
  /// Share of the newest weights in a moving average, which then acts instead of them (Polyak and
  /// Juditsky 1992; the plain mean until there are 1 / share of them); 0: off
  double average_rate{0.0};
  /// α of advantage learning (Baird 1999; Bellemare et al. 2016): of what an action is worth less
  /// than the best this share is taken off its target, so that errors of the network less often
  /// make it the best; 0: off
  double action_gap{0.0};
  /// Points that an action counts less, while exploring, for each time that it was taken in the
  /// same situation (cell, load, devices still out) of this episode; 0: off
  double repetition_penalty{0.0};
  bool mask_illegal{true};   ///< never try, nor bootstrap on, actions that would be ILLEGAL
  bool mask_blocked{false};  ///< nor moves onto a charted rock, an island or off the map

  // Recurrent alone (R2D2: Kapturowski et al. 2019).
  std::int32_t sequence{4};  ///< steps learnt from; replayed=paper_tuple: 1, with burn_in 0
  std::int32_t burn_in{2};   ///< steps before them that only warm up the state

  /// Learn the sum of all agents' values instead of each on its own (VDN); set by the algorithm.
  bool joint{};

  std::string device{"auto"};  ///< auto, cpu or cuda
  std::int32_t threads{1};     ///< of the network library on the CPU

  /// Reads "key=value …". @param resolved gets all of them with their values in force
  /// @throws InputError
  static DeepOptions Parse(const std::string& text, bool recurrent, std::string& resolved);
};

}  // namespace aquafarm::agents
