// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "ppo/gae.h"
#include "ppo/ppo_loss.h"

namespace aquafarm::agents {

/// T steps of E slots (farms × agents). The sample of step t and slot e has the index t · E + e. It
/// contains an observation, the chosen action, and the reward and end that followed.
class Rollout {
 public:
  struct Shape {
    std::size_t steps{};       ///< T
    std::size_t slots{};       ///< E
    std::size_t agents{};      ///< agents of one farm
    std::size_t features{};    ///< features of one agent
    std::size_t state_size{};  ///< size of an agent's recurrent state
    /// The recurrent states are stored at steps 0, n, 2n, … with n = sequence_length.
    std::size_t sequence_length{1};
    /// Agents learn from the team reward. An inactive agent then has transitions until the episode
    /// of its farm ends, because it still receives the team reward.
    bool is_team{};
    bool has_labels{};  ///< whether the actions of a teacher are recorded
  };
  /// Parameters of the reward r' from which an agent learns:
  /// r' = scale · ((1 − team_share) · its reward + team_share · the sum of its farm's rewards)
  struct Rewards {
    float scale{1.0F};
    float team_share{};
  };
  explicit Rollout(const Shape& shape);

  const Shape& shape() const { return shape_; }
  std::size_t samples() const { return shape_.steps * shape_.slots; }
  std::size_t recorded_steps() const { return steps_; }
  bool IsFull() const { return steps_ == shape_.steps && !is_open_; }

  /// Records the rewards and ends that followed the actions of the last Add. Does nothing if there
  /// was no Add since the last Complete.
  void Complete(const StepResults& results, const Rewards& rewards);
  /// Records a step of all slots: observations and chosen actions. The rollout must not be full.
  /// @param masks, actions, log_probs, values [E]
  /// @param state [E, state_size] recurrent states before the actions
  void Add(const StepResults& results, const std::vector<ActionMask>& masks,
           const std::vector<std::uint8_t>& actions, const std::vector<float>& log_probs,
           const std::vector<float>& values, const std::vector<float>& state);
  /// Records the actions of a teacher at the step of the last Add.
  /// @param labels [E] actions or kNoLabel
  void SetLabels(const std::vector<std::uint8_t>& labels);
  /// Computes advantages and value targets of a full rollout.
  /// @param last_values [E] values of the observations after the last step
  void Finish(const std::vector<float>& last_values, float gamma, float lambda);
  void Clear() { steps_ = 0; }

  bool IsValid(std::size_t sample) const { return ends_[sample] != StepEnd::kNoTransition; }
  const float* features(std::size_t sample) const {
    return features_.data() + sample * shape_.features;
  }
  /// Recurrent state before a sample, [state_size].
  /// @param sample at a step that is a multiple of sequence_length
  const float* state(std::size_t sample) const;
  bool is_first(std::size_t sample) const { return is_first_[sample] != 0; }
  ActionMask mask(std::size_t sample) const { return masks_[sample]; }
  std::uint8_t action(std::size_t sample) const { return actions_[sample]; }
  float log_prob(std::size_t sample) const { return log_probs_[sample]; }
  float value(std::size_t sample) const { return values_[sample]; }
  float advantage(std::size_t sample) const { return advantages_[sample]; }
  /// Action of a teacher, or kNoLabel.
  std::uint8_t label(std::size_t sample) const {
    return labels_.empty() ? kNoLabel : labels_[sample];
  }
  float target(std::size_t sample) const { return advantages_[sample] + values_[sample]; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or have another size, or if the number of steps, an
  ///   action or a label is out of range
  void Load(const Checkpoint& checkpoint);

 private:
  template <typename Self, typename Visit>
  static void VisitNumbers(Self& self, const Visit& visit);  // the saved numbers, by name

  Shape shape_;
  std::size_t steps_{};  // number of recorded steps
  bool is_open_{};       // the results of the last step are not recorded yet
  std::vector<float> features_;
  std::vector<float> states_;  // [T / sequence_length, E, state_size]
  std::vector<ActionMask> masks_;
  std::vector<std::uint8_t> actions_;
  std::vector<std::uint8_t> is_first_;
  std::vector<float> log_probs_;
  std::vector<float> values_;  // [T + 1, E]
  std::vector<float> rewards_;
  std::vector<StepEnd> ends_;
  std::vector<std::uint8_t> labels_;  // empty without a teacher
  std::vector<float> advantages_;
};

}  // namespace aquafarm::agents
