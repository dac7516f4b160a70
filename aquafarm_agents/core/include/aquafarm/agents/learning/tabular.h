// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Q-learning (Watkins 1989; Eq. 12) and SARSA (Rummery and Niranjan 1994; Eq. 14) with a table of
/// floats. The equations are those of the paper (docs/model.md):
///
///   Q(s, a) ← Q(s, a) + α (r + γ V(s') − Q(s, a))        V(s') = 0 after termination
///   Q-learning: V(s') = max_a' Q(s', a')         SARSA: V(s') = Q(s', a') of the chosen a'
///
/// The algorithms differ only in V. Both choose a' before the update. Each agent has one table,
/// which is updated with the transitions of all farms, in the order of the farms. The last step of
/// a truncated episode bootstraps like any other step.

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Tables of action values Q(s, a), one for each agent of a farm.
struct QTable {
  std::int32_t agents{};
  std::uint32_t states{};
  std::vector<float> values;  ///< [agents, states, kActionCount], row-major

  QTable() = default;
  /// @throws InputError if the farm has no tabular states or the tables would exceed kMaxBytes
  QTable(const EnvironmentSpec& spec, float initial_value);
  /// Returns the index in `values` of the first action of a state.
  std::size_t Row(std::int32_t agent, std::uint32_t state) const {
    return (static_cast<std::size_t>(agent) * states + state) * kActionCount;
  }
  /// Returns the size of the tables of all agents of a farm [bytes]; 0 if the farm has no tabular
  /// states.
  static std::uint64_t BytesOf(const EnvironmentSpec& spec);
  /// Max size of the tables of all agents of a farm [bytes].
  inline static constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30U;
};

/// V(s') of Eq. 12: the value of the greedy action.
struct QLearningRule {
  static float NextValue(float best, float /*chosen*/) { return best; }
};
/// V(s') of Eq. 14: the value of the chosen action.
struct SarsaRule {
  static float NextValue(float /*best*/, float chosen) { return chosen; }
};

/// Hyperparameters of a tabular learner. The defaults are tuned on the shipped scenarios.
struct TabularOptions {
  Schedule learning_rate{ScheduleKind::kLinear, 0.5, 0.02, 1.0};
  double gamma{0.97};
  ExplorationOptions exploration;
  double initial_value{0.0};  ///< initial action value; high values promote exploration
  bool mask_illegal{false};   ///< exclude illegal actions when acting and bootstrapping

  /// Parses "key=value …".
  /// @param resolved receives all options with their effective values
  /// @throws InputError if an option is unknown or out of range
  static TabularOptions Parse(const std::string& text, std::string& resolved);
};

/// Base class of learners with a table. A derived class implements Step.
class TableLearner : public Learner {
 public:
  /// @throws InputError if the farm has no tabular states, if its tables would exceed kMaxBytes, or
  ///   if an option is invalid
  TableLearner(const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options);

  std::uint8_t observation_types() const override { return kIndexBit; }
  std::string options() const override { return resolved_; }
  LearnerStatus status() const override;
  std::unique_ptr<Policy> GreedyPolicy() const override;
  void SavePolicy(Checkpoint& checkpoint) const override;
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

  const QTable& table() const { return table_; }

 protected:
  /// Sets ε or the temperature, and the learning rate.
  /// @param progress fraction of the run that is done, [0, 1]
  void SetProgress(double progress);
  /// Returns the actions that an agent may choose: the legal ones with mask_illegal, else all.
  ActionMask ActionMaskOf(ActionMask legal) const {
    return options_.mask_illegal ? static_cast<ActionMask>(legal & kAllActions) : kAllActions;
  }
  /// Updates the reported loss, a moving average. @param loss mean squared TD error of one step
  void AddLoss(float loss);

  /// Value in pending_ of an agent that has no last action, because it was not active.
  inline static constexpr auto kNoAction = std::numeric_limits<std::uint64_t>::max();

  std::string resolved_;
  TabularOptions options_;
  std::int32_t farms_;
  QTable table_;
  Explorer explorer_;
  std::vector<std::uint64_t> pending_;  ///< [N, S] index in table_.values of the last (s, a)
  float learning_rate_{};
  float loss_;
};

/// @tparam Rule QLearningRule or SarsaRule
template <typename Rule>
class TabularLearner final : public TableLearner {
 public:
  using TableLearner::TableLearner;
  void Step(const StepResults& results, double progress,
            std::vector<std::uint8_t>& actions) override;
};

extern template class TabularLearner<QLearningRule>;
extern template class TabularLearner<SarsaRule>;

/// Policy that takes the greedy action of a table. Ties go to the lowest action number.
class GreedyTabularPolicy final : public Policy {
 public:
  GreedyTabularPolicy(QTable table, bool mask_illegal)
      : table_(std::move(table)), mask_illegal_(mask_illegal) {}
  std::uint8_t observation_types() const override { return kIndexBit; }
  void Begin(std::uint64_t, std::int32_t) override {}
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override;

 private:
  QTable table_;
  bool mask_illegal_;
};

/// Makes a greedy policy from the table of a checkpoint.
/// @throws InputError with the reason if the policy does not fit farms of `spec`
std::unique_ptr<Policy> MakeTabularPolicy(const Checkpoint& checkpoint,
                                          const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
