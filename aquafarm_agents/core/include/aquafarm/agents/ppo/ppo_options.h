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

/// Teacher that the policy may imitate during training.
enum class TeacherPolicy : std::uint8_t {
  kRule,     ///< a simple rule on entity tokens (src/ppo/route_rule.h)
  kPlanner,  ///< the algorithm `planner`, which reads the complete state of the farm
};
inline constexpr int kTeacherPolicyCount = 2;
std::string_view ToString(TeacherPolicy value);

/// Name of multi-agent PPO with a centralized critic.
inline constexpr const char* kMappo = "mappo";

/// Options of PPO and MAPPO. Two presets give the defaults: *tuned* for a fixed layout, *large* for
/// layouts that change in each episode. docs/algorithms.md explains the options.
struct PpoOptions {
  std::int32_t hidden_size{128};     ///< units of each hidden layer and of the LSTM
  bool recurrent{false};             ///< an LSTM instead of the second hidden layer
  std::int32_t sequence_length{16};  ///< steps of back-propagation through time, if recurrent
  Schedule learning_rate{ScheduleKind::kLinear, 1e-3, 0.0, 1.0};  ///< learning rate of Adam
  double gamma{0.98};                                             ///< discount per step
  double gae_lambda{0.95};           ///< λ of generalized advantage estimation
  std::int32_t rollout_size{16384};  ///< approximate agent steps between two updates; see Horizon
  std::int32_t batch_size{256};      ///< approximate size of a minibatch [agent steps]
  std::int32_t epochs{2};            ///< passes over each rollout
  Schedule clip_range{ScheduleKind::kConstant, 0.2};  ///< ε of the clipped probability ratio
  double value_clip_range{0.0};     ///< range of V around V_old in the value loss; 0: not clipped
  double value_coef{0.5};           ///< weight of the value loss
  double max_grad_norm{0.5};        ///< max norm of the gradient; 0: not limited
  double reward_scale{0.05};        ///< factor of all rewards that the learner receives
  bool normalize_advantages{true};  ///< scale to mean 0 and deviation 1 in each minibatch
  bool mask_illegal{true};          ///< probability 0 for illegal pickups and drop-offs
  /// Probability 0 for moves onto a rock or an island or off the map, unless all moves lead there.
  bool mask_blocked{true};
  /// `level` is the coefficient of the entropy bonus. `curiosity` (icm in the option) is the weight
  /// of the intrinsic reward.
  ExplorationOptions exploration{
      ExplorationKind::kEntropy, {ScheduleKind::kLinear, 0.02, 0.0, 1.0}, {}};
  /// Weight that the cross-entropy with a teacher's actions has in the loss (kickstarting,
  /// src/ppo/ppo_loss.h); 0: no teacher. The label of a step is the action that the teacher would
  /// take. The cross-entropy is averaged over all agent steps, with and without a label. A teacher
  /// that labels every n-th step therefore needs n times the weight.
  Schedule teacher{ScheduleKind::kConstant, 0.0, 0.0, 1.0};
  TeacherPolicy teacher_policy{TeacherPolicy::kRule};  ///< which teacher the policy imitates
  std::int32_t teacher_interval{1};  ///< n: the teacher labels steps 0, n, 2n, … of each rollout
  /// Data augmentation: at the start of each episode, the learner draws one of the eight symmetries
  /// of the grid for each agent. In training, it transforms the observations and actions of the
  /// agent with this symmetry. Needs entity tokens.
  bool augment{false};
  PolicyMode policy{PolicyMode::kGreedy};  ///< how the trained policy acts
  /// The trained policy averages the outputs of its network over the eight symmetries. This makes
  /// it equivariant to rotations and reflections of the ranch. Needs entity tokens.
  bool symmetric{false};
  /// Penalty on the logit of an action in the trained greedy policy. It is subtracted once for each
  /// earlier use of the action in the same situation (cell, load, remaining devices). Only the last
  /// 1024 steps of the episode are counted.
  double repetition_penalty{0.0};
  /// The trained greedy policy counts how often each situation occurs. From the max_visits-th
  /// occurrence of a situation until the load or the remaining devices change, the policy follows
  /// the route of src/ppo/route_rule.h in each step in which this route is safe
  /// (src/ppo/loop_guard.h). Needs entity tokens. 0: never.
  std::int32_t max_visits{0};
  std::int32_t threads{1};  ///< CPU threads of libtorch and BLAS
  /// Number of groups of farms, a power of two up to 4096. Each group contributes its own part to
  /// every minibatch. Gradients are added in a fixed order, so results depend on the number of
  /// shards but not on the number of processes.
  std::int32_t shards{1};

  /// Not an option: true for MAPPO, whose critic observes all agents of a farm; false for PPO.
  bool central{false};
  /// Weight w of the team reward: an agent learns from (1 − w) · its individual reward + w · the
  /// sum of all agents' rewards. No effect if agents receive the team reward anyway.
  Schedule team_share{ScheduleKind::kConstant, 0.0, 0.0, 1.0};

  const char* algorithm() const { return central ? kMappo : "ppo"; }
  /// Returns whether agents learn from the team reward at any time of the training.
  /// @param team_reward EnvironmentSpec::team_reward
  bool IsTeam(bool team_reward) const { return team_reward || team_share.IsEverPositive(); }
  /// Returns whether the policy imitates a teacher at any time of the training.
  bool HasTeacher() const { return teacher.IsEverPositive(); }
  /// Returns the steps per agent in one rollout: rollout_size / slots, but at least 8, and rounded
  /// up to a multiple of sequence_length if recurrent.
  /// @param slots farms × agents, of all ranks
  std::int32_t Horizon(std::size_t slots) const;

  /// Parses "key=value …".
  /// @param resolved receives all options with their values
  /// @param central true for the options of MAPPO
  /// @throws InputError if a key is unknown, if a value is out of range, or if the number of shards
  ///   is not a power of two
  static PpoOptions Parse(const std::string& text, std::string& resolved, bool central = false);
};

}  // namespace aquafarm::agents
