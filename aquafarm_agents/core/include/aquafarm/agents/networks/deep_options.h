// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents {

/// Architecture of a network and the observation type that it reads.
enum class NetworkKind : std::uint8_t {
  kMlp,  ///< reads the feature vector; two hidden layers
  kCnn,  ///< reads the planes; two convolutions and a hidden layer
};
inline constexpr int kNetworkKindCount = 2;
std::string_view ToString(NetworkKind value);

/// Loss function of the TD error.
enum class LossKind : std::uint8_t { kHuber, kMse };
inline constexpr int kLossKindCount = 2;
std::string_view ToString(LossKind value);

/// Hyperparameters of DQN, VDN and LSTM-DQN. The preset sets the defaults. *tuned* has values tuned
/// on the shipped scenarios. *paper* has the values of the paper: Eq. 15, Algorithm 2, and γ of
/// §2.3. It disables the extensions and max_grad_norm, and keeps the tuned values of all other
/// options. For τ of LSTM-DQN, of which the paper contains only the range, *paper* has the value of
/// Haarnoja et al. 2018. The members are initialized with the tuned defaults of DQN.
struct DeepOptions {
  NetworkKind network{NetworkKind::kMlp};
  /// Units of a hidden layer, and of the LSTM of LSTM-DQN. With skip_connection, the last hidden
  /// layer of LSTM-DQN has twice as many.
  std::int32_t hidden_size{256};
  Schedule learning_rate{ScheduleKind::kLinear, 5e-4, 1e-5, 1.0};  ///< learning rate of Adam
  double gamma{0.97};
  ExplorationOptions exploration{
      ExplorationKind::kEpsilonGreedy, {ScheduleKind::kLinear, 1.0, 0.005, 0.1}, {}};
  std::int32_t batch_size{64};  ///< transitions (LSTM-DQN: sequences) per update
  Schedule train_interval{ScheduleKind::kConstant, 2.0};  ///< farm steps between updates
  std::uint64_t learning_starts{5000};                    ///< farm steps before the first update
  std::uint64_t buffer_size{100000};                      ///< capacity in transitions
  std::uint64_t target_update_interval{250};  ///< updates between hard copies to the target network
  double tau{0.0};  ///< weight of the online network in soft target updates; 0: hard copies
  LossKind loss{LossKind::kHuber};
  double max_grad_norm{10.0};  ///< max norm of the gradient; 0: no limit

  // Extensions of the algorithm in §3.4.3 of the paper (docs/model.md), with their sources.
  bool double_dqn{true};            ///< van Hasselt et al. 2016
  bool dueling{false};              ///< Wang et al. 2016
  std::int32_t n_step{1};           ///< Sutton 1988; 1 disables it
  double priority_exponent{0.6};    ///< exponent α of Schaul et al. 2016; 0: uniform
  double importance_exponent{0.4};  ///< initial exponent β of Schaul et al. 2016; rises to 1
  double reward_scale{0.05};        ///< factor of the rewards; 1: unscaled
  /// Rate of a moving average of the weights (Polyak and Juditsky 1992). The agents act with the
  /// average. For the first 1 / rate updates it is the arithmetic mean. 0 disables it.
  double ema_rate{0.0};
  /// α of advantage learning (Baird 1999; Bellemare et al. 2016): subtracts
  /// α · (max_a Q − Q(s, a)) from the target, so that approximation errors change the greedy action
  /// less often. 0 disables it.
  double action_gap{0.0};
  /// Penalty [reward] that is subtracted from the value of an action when acting in training, once
  /// for each earlier use of the action in the same situation of the episode; see
  /// RepetitionPenalty. 0 disables it.
  double repetition_penalty{0.0};
  bool mask_illegal{true};   ///< exclude illegal actions when acting and bootstrapping
  bool mask_blocked{false};  ///< also exclude moves onto a rock or an island, or off the map

  // Options of recurrent networks only (R2D2: Kapturowski et al. 2019).
  /// Time steps of a sequence that are trained on, without the burn-in; 1 with paper_tuple.
  std::int32_t sequence_length{4};
  std::int32_t burn_in{2};  ///< warm-up steps before a sequence, not trained on; 0 with paper_tuple
  bool skip_connection{true};  ///< skip connection around the LSTM; the paper has none
  /// The option replayed=paper_tuple: replays single transitions, and evaluates each of the two
  /// observations with the recurrent state stored for it, as in Algorithm 2.
  bool paper_tuple{};

  /// True for VDN, which trains the sum of all agents' values instead of each value. Set by the
  /// algorithm, not by an option.
  bool joint{};

  std::string device{"auto"};  ///< auto, cpu or cuda
  std::int32_t threads{1};     ///< CPU threads of libtorch and BLAS

  /// Parses "key=value …".
  /// @param recurrent true for LSTM-DQN
  /// @param resolved receives all options with their effective values
  /// @throws InputError if an option is unknown, out of range or does not fit another option
  static DeepOptions Parse(const std::string& text, bool recurrent, std::string& resolved);
};

}  // namespace aquafarm::agents
