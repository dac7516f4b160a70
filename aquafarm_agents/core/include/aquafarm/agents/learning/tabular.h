// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Q-learning (Watkins; Eq. 12) and SARSA (Rummery and Niranjan; Eq. 14) over a table of floats:
///
///   Q(s, a) ← Q(s, a) + α (r + γ V(s') − Q(s, a))        V(s') = 0 after termination
///   Q-learning: V(s') = max over a' of Q(s', a')          SARSA: V(s') = Q(s', a') of the a'
///   chosen
///
/// The two differ in V alone; both choose a' before the update. Each agent has a table of its own
/// that all farms share, entries updated in farm order. An episode cut off at the step limit is
/// bootstrapped like any other step.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Floats [agents, states, kActionCount] row-major.
struct QTable {
  std::int32_t agents{};
  std::uint32_t states{};
  std::vector<float> values;

  QTable() = default;
  /// @throws InputError when the farm has no tabular states or the table would be too large
  QTable(const EnvironmentSpec& spec, float initial_value);
  std::size_t Row(std::int32_t agent, std::uint32_t state) const {
    return (static_cast<std::size_t>(agent) * states + state) * kActionCount;
  }
  /// Largest table that is made [bytes].
  inline static constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30U;
};

/// V(s') of Eq. 12: what the best action is worth.
struct QLearningRule {
  static float NextValue(float best, float /*chosen*/) { return best; }
};
/// V(s') of Eq. 14: what the chosen action is worth.
struct SarsaRule {
  static float NextValue(float /*best*/, float chosen) { return chosen; }
};

/// Numbers of a tabular learner, with what was measured to do well on the shipped farms.
struct TabularOptions {
  Schedule learning_rate{ScheduleKind::kLinear, 0.5, 0.02, 1.0};
  double discount{0.97};
  ExplorationOptions exploration;
  double initial_value{0.0};  ///< of every entry; high values make it try everything once
  bool mask_illegal{false};   ///< never try, nor bootstrap on, actions that would be ILLEGAL

  /// Reads "key=value …". @param resolved gets all of them with their values in force
  /// @throws InputError
  static TabularOptions Parse(const std::string& text, std::string& resolved);
};

template <typename Rule>
class TabularLearner final : public Learner {
 public:
  TabularLearner(const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options);

  std::uint8_t encodings() const override { return kIndexBit; }
  std::string options() const override { return resolved_; }
  void Step(const Results& results, double progress, std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override;
  std::unique_ptr<Policy> GreedyPolicy() const override;
  void SavePolicy(Checkpoint& checkpoint) const override;
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

  const QTable& table() const { return table_; }

 private:
  std::string resolved_;
  TabularOptions options_;
  std::int32_t farms_;
  QTable table_;
  Explorer explorer_;
  std::vector<std::uint64_t> pending_;  // [N, S] offset into values of the (s, a) in progress
  float learning_rate_{};
  float loss_;
};

extern template class TabularLearner<QLearningRule>;
extern template class TabularLearner<SarsaRule>;

/// Plays the best action of a table; the lowest number among equals.
class GreedyTabularPolicy final : public Policy {
 public:
  GreedyTabularPolicy(QTable table, bool mask_illegal)
      : table_(std::move(table)), mask_illegal_(mask_illegal) {}
  std::uint8_t encodings() const override { return kIndexBit; }
  void Begin(std::uint64_t, std::int32_t) override {}
  void Act(const Results& results, std::vector<std::uint8_t>& actions) override;

 private:
  QTable table_;
  bool mask_illegal_;
};

/// @throws InputError when the policy does not fit farms of `spec`, with the reason
std::unique_ptr<Policy> MakeTabularPolicy(const Checkpoint& checkpoint,
                                          const EnvironmentSpec& spec);

}  // namespace aquafarm::agents
