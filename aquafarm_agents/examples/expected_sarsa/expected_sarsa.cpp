// SPDX-License-Identifier: BSD-3-Clause
// A learner of another package: Expected SARSA (van Seijen et al. 2009) with a table.
//   Q(s, a) ← Q(s, a) + α (r + γ [(1 − ε) max_a' Q(s', a') + ε mean_a' Q(s', a')] − Q(s, a))
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/register_learner.h"
#include "aquafarm/base/check.h"
using namespace aquafarm::agents;

// TableLearner implements checkpoints and the greedy policy, which its base class Learner does not.
struct ExpectedSarsa final : TableLearner {
  ExpectedSarsa(const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options)
      : TableLearner(spec, seed, options) {
    const ExplorationOptions& own = options_.exploration;
    if (own.kind != ExplorationKind::kEpsilonGreedy || own.is_curious())
      throw aquafarm::InputError("exploration: got '" + ToString(own) +
                                 "', expected epsilon_greedy with learner expected_sarsa");
  }
  void Step(const StepResults& now, double progress, std::vector<std::uint8_t>& actions) override {
    SetProgress(progress);
    actions.resize(pending_.size());
    const auto epsilon = static_cast<float>(explorer_.level());
    const auto gamma = static_cast<float>(options_.gamma);
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const std::size_t farm = i / static_cast<std::size_t>(table_.agents);
      const auto agent = static_cast<std::int32_t>(i % static_cast<std::size_t>(table_.agents));
      const auto allowed = ActionMaskOf(now.legal[i]);
      const std::size_t row = table_.Row(agent, now.index[i]);
      const float* const values = &table_.values[row];
      const Best best = BestOf(values, allowed);
      if (now.is_first[farm] == 0 && pending_[i] != kNoAction) {
        float sum = 0;
        for (unsigned a = 0; a < 10; ++a) sum += (allowed >> a & 1U) != 0 ? values[a] : 0;
        const float mean = sum / static_cast<float>(__builtin_popcount(allowed));
        const float next = now.IsDone(i, farm) ? 0 : (1 - epsilon) * best.value + epsilon * mean;
        float& value = table_.values[pending_[i]];  // of the last state and action
        value += learning_rate_ * (now.rewards[i] + gamma * next - value);
      }
      actions[i] = explorer_.Choose(values, allowed, best, i);
      pending_[i] = now.active[i] == 0 ? kNoAction : row + actions[i];
    }
  }
};

std::unique_ptr<Learner> Make(const EnvironmentSpec& spec, std::uint64_t seed,
                              const std::string& options) {
  return std::make_unique<ExpectedSarsa>(spec, seed, options);
}
std::uint8_t ObservationTypes(const std::string&) { return kIndexBit; }
const bool kRegistered = RegisterLearner({"expected_sarsa", "tabular Expected SARSA", true, 4000000,
                                          ObservationTypes, Make, MakeTabularPolicy});
