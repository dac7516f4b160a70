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

/// T steps of E slots (farms × agents), time-major: index t · E + e. Each contains an observation,
/// the chosen action, and the reward and end that followed.
class Rollout {
 public:
  struct Shape {
    std::size_t steps{};
    std::size_t slots{};   ///< E
    std::size_t agents{};  ///< agents of one farm
    std::size_t features{};
    std::size_t state_size{};
    std::size_t sequence_length{
        1};  ///< the recurrent state is stored at every sequence_length-th step
    /// An agent that is done earns until its farm's episode ends, because its return is the team's.
    bool is_team{};
    bool has_labels{};  ///< of a teacher
  };
  /// What an agent learns from: scale · ((1 − share) · its reward + share · the sum of its farm's).
  struct Rewards {
    float scale{1.0F};
    float team_share{};
  };
  explicit Rollout(const Shape& shape);

  const Shape& shape() const { return shape_; }
  std::size_t samples() const { return shape_.steps * shape_.slots; }
  std::size_t recorded_steps() const { return steps_; }
  bool IsFull() const { return steps_ == shape_.steps && !is_open_; }

  /// Records the results of the last decisions; does nothing if there are none.
  void Complete(const StepResults& results, const Rewards& rewards);
  /// Records decisions [E]. @param state [E, state_size] before them
  void Add(const StepResults& results, const std::vector<ActionMask>& masks,
           const std::vector<std::uint8_t>& actions, const std::vector<float>& log_probs,
           const std::vector<float>& values, const std::vector<float>& state);
  /// Records the actions of a teacher for the last decisions. @param labels [E], or kNoLabel
  void SetLabels(const std::vector<std::uint8_t>& labels);
  /// Computes advantages and value targets of a full rollout.
  /// @param last_values [E] of the observations after the last step
  void Finish(const std::vector<float>& last_values, float gamma, float lambda);
  void Clear() { steps_ = 0; }

  bool IsValid(std::size_t sample) const { return ends_[sample] != StepEnd::kNoTransition; }
  const float* features(std::size_t sample) const {
    return features_.data() + sample * shape_.features;
  }
  /// @param sample at a step that is a multiple of sequence_length
  const float* state(std::size_t sample) const;
  bool is_first(std::size_t sample) const { return is_first_[sample] != 0; }
  ActionMask mask(std::size_t sample) const { return masks_[sample]; }
  std::uint8_t action(std::size_t sample) const { return actions_[sample]; }
  float log_prob(std::size_t sample) const { return log_probs_[sample]; }
  float value(std::size_t sample) const { return values_[sample]; }
  float advantage(std::size_t sample) const { return advantages_[sample]; }
  /// The action of a teacher, or kNoLabel.
  std::uint8_t label(std::size_t sample) const {
    return labels_.empty() ? kNoLabel : labels_[sample];
  }
  float target(std::size_t sample) const { return advantages_[sample] + values_[sample]; }

  void Save(Checkpoint& checkpoint) const;
  /// @throws InputError if sections are missing or have another size
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
