// SPDX-License-Identifier: BSD-3-Clause
// A learner of another package: Expected SARSA (van Seijen et al. 2009) with a table.
//   Q(s, a) ← Q(s, a) + α (r + γ [(1 − ε) max_a' Q(s', a') + ε mean_a' Q(s', a')] − Q(s, a))
#include <numeric>

#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/register_learner.h"
using namespace aquafarm::agents;

// TableLearner adds checkpoints and the greedy policy. A learner without a table derives from
// Learner and implements these, too.
struct ExpectedSarsa final : TableLearner {
  using TableLearner::TableLearner;
  void Step(const StepResults& now, double progress, std::vector<std::uint8_t>& actions) override {
    SetProgress(progress);
    actions.resize(pending_.size());
    const auto epsilon = static_cast<float>(explorer_.level());
    const auto gamma = static_cast<float>(options_.gamma);
    const auto agents = static_cast<std::size_t>(table_.agents);
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const std::size_t farm = i / agents;
      const std::size_t row = table_.Row(static_cast<std::int32_t>(i % agents), now.index[i]);
      const float* const values = &table_.values[row];
      const Best best = BestOf(values, kAllActions);
      if (now.started[farm] == 0 && pending_[i] != kNoAction) {
        const float mean = std::accumulate(values, values + aquafarm::kActionCount, 0.0F) / 10;
        const float next = (1 - epsilon) * best.value + epsilon * mean;
        float& value = table_.values[pending_[i]];  // of the last state and action
        value +=
            learning_rate_ * (now.rewards[i] + (now.IsDone(i, farm) ? 0 : gamma * next) - value);
      }
      actions[i] = explorer_.Choose(values, kAllActions, best, i);
      pending_[i] = now.in_play[i] == 0 ? kNoAction : row + actions[i];
    }
  }
};

const bool kRegistered =
    RegisterLearner({"expected_sarsa", "tabular Expected SARSA", true, 4000000,
                     [](const std::string&) -> std::uint8_t { return kIndexBit; },
                     [](const EnvironmentSpec& spec, std::uint64_t seed,
                        const std::string& options) -> std::unique_ptr<Learner> {
                       return std::make_unique<ExpectedSarsa>(spec, seed, options);
                     },
                     MakeTabularPolicy});
