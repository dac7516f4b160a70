// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "aquafarm/agents/base/schedule.h"
#include "aquafarm/agents/learning/exploration.h"

namespace aquafarm::agents {

/// How a trained policy chooses its actions.
enum class PolicyMode : std::uint8_t {
  kGreedy,   ///< the most probable action
  kSampled,  ///< an action drawn from the policy's probabilities
};
inline constexpr int kPolicyModeCount = 2;
std::string_view ToString(PolicyMode value);

/// Teacher that the policy imitates at the start of training.
enum class TeacherPolicy : std::uint8_t {
  kRule,     ///< a simple rule on entity tokens (src/ppo/route_rule.h)
  kPlanner,  ///< the algorithm `planner`, which sees the complete farm
};
inline constexpr int kTeacherPolicyCount = 2;
std::string_view ToString(TeacherPolicy value);

/// Name of multi-agent PPO with a centralized critic.
inline constexpr const char* kMappo = "mappo";

/// Options of PPO and MAPPO. Two presets give the defaults: *tuned* for a fixed layout, *large* for
/// layouts that change in each episode. docs/algorithms.md has the measurements.
struct PpoOptions {
  std::int32_t hidden_size{128};     ///< units of each hidden layer, and of the LSTM
  bool recurrent{false};             ///< an LSTM instead of the second hidden layer
  std::int32_t sequence_length{16};  ///< steps of back-propagation through time; recurrent only
  Schedule learning_rate{ScheduleKind::kLinear, 1e-3, 0.0, 1.0};  ///< of Adam
  double gamma{0.98};                                             ///< discount per step
  double gae_lambda{0.95};                            ///< λ of generalized advantage estimation
  std::int32_t rollout_size{16384};                   ///< agent steps collected between two updates
  std::int32_t batch_size{256};                       ///< minibatch size [agent steps]
  std::int32_t epochs{2};                             ///< passes over each rollout
  Schedule clip_range{ScheduleKind::kConstant, 0.2};  ///< ε of the clipped probability ratio
  double value_clip_range{0.0};     ///< max change of a value per update; 0: not limited
  double value_coef{0.5};           ///< weight of the value loss
  double max_grad_norm{0.5};        ///< max norm of the gradient; 0: not limited
  double reward_scale{0.05};        ///< factor on all rewards
  bool normalize_advantages{true};  ///< to mean 0 and deviation 1 in each minibatch
  bool mask_illegal{true};          ///< probability 0 for actions that would be ILLEGAL
  bool mask_blocked{
      true};  ///< probability 0 for moves onto a charted rock or an island, or off the map
  /// `level` is the coefficient of the entropy bonus; `icm` adds an intrinsic reward.
  ExplorationOptions exploration{
      ExplorationKind::kEntropy, {ScheduleKind::kLinear, 0.02, 0.0, 1.0}, {}};
  /// Weight of the cross-entropy with a teacher, which the policy imitates at first (kickstarting,
  /// src/ppo/ppo_loss.h). It is averaged over all agent steps, so a teacher that labels every
  /// n-th step needs n times the weight.
  Schedule teacher{ScheduleKind::kConstant, 0.0, 0.0, 1.0};
  TeacherPolicy teacher_policy{TeacherPolicy::kRule};
  std::int32_t teacher_interval{1};  ///< it labels every teacher_interval-th step of a rollout
  /// Data augmentation: the observations of each episode are transformed by one of the eight
  /// symmetries of the grid (rotations and reflections), drawn at its start; needs entity tokens.
  bool augment{false};
  PolicyMode policy{PolicyMode::kGreedy};  ///< how the trained policy acts
  /// The trained policy averages its network over the eight symmetries, which makes it equivariant
  /// to rotations and reflections of the ranch; needs entity tokens.
  bool symmetric{false};
  /// Subtracted from an action's logit for each earlier use of that action in the same situation
  /// (cell, load, remaining devices) of the episode; only in the trained greedy policy. 0: no
  /// effect.
  double repetition_penalty{0.0};
  /// If a situation occurs this many times, the trained greedy policy follows the route to the
  /// nearest target while this route has no more risk per step than the safest cell near the ship
  /// (src/ppo/loop_guard.h); needs entity tokens; 0: never.
  std::int32_t max_visits{0};
  std::int32_t threads{1};  ///< CPU threads of libtorch and of its BLAS
  /// Number of groups of farms, a power of two. Each group has its own part of every minibatch.
  /// Gradients are added in a fixed order, so results depend on the number of shards but not on
  /// the number of processes.
  std::int32_t shards{1};

  /// Centralized critic, which observes all agents of a farm; true for MAPPO.
  bool central{false};
  /// Weight w of the team reward: an agent learns from (1 − w) · its individual reward + w · the
  /// sum of all agents' rewards.
  Schedule team_share{ScheduleKind::kConstant, 0.0, 0.0, 1.0};

  const char* algorithm() const { return central ? kMappo : "ppo"; }
  /// Returns whether agents learn from the team's rewards at some time of the training.
  /// @param team_reward as in EnvironmentSpec
  bool IsTeam(bool team_reward) const { return team_reward || team_share.IsEverPositive(); }
  /// Returns whether the policy imitates a teacher at some time of the training.
  bool HasTeacher() const { return teacher.IsEverPositive(); }
  /// Returns the steps per agent in one rollout. @param slots farms × agents
  std::int32_t Horizon(std::size_t slots) const;

  /// Parses "key=value …". @param resolved receives the values of all options
  /// @param central the options are those of MAPPO
  /// @throws InputError if a key is unknown or a value is out of range
  static PpoOptions Parse(const std::string& text, std::string& resolved, bool central = false);
};

}  // namespace aquafarm::agents
