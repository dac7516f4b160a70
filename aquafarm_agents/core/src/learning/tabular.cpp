// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/tabular.h"

#include <cmath>
#include <utility>

#include "aquafarm/base/check.h"
#include "learning/common_options.h"

namespace aquafarm::agents {
namespace {

constexpr float kLossShare = 0.01F;  // weight of one step in the moving average of the loss

}  // namespace

std::uint64_t QTable::BytesOf(const EnvironmentSpec& spec) {
  return static_cast<std::uint64_t>(spec.agents) * spec.state_count * kActionCount * sizeof(float);
}

QTable::QTable(const EnvironmentSpec& spec, float initial_value)
    : agents(spec.agents), states(spec.state_count) {
  const std::uint64_t bytes = BytesOf(spec);
  if (states == 0 || bytes > kMaxBytes) {
    throw InputError("scenario " + spec.scenario_name +
                     ": too many states for a table (devices, cells or agents), expected a learner "
                     "with a network; use algorithm auto");
  }
  values.assign(bytes / sizeof(float), initial_value);
}

TabularOptions TabularOptions::Parse(const std::string& text, std::string& resolved) {
  OptionReader reader(text);
  TabularOptions options;
  ReadSchedule(reader, "learning_rate", 0.0, 1.0, options.learning_rate);
  ReadNumber(reader, "gamma", 0.0, 1.0, options.gamma);
  ReadExploration(reader, options.exploration);
  ReadNumber(reader, "initial_value", -1e6, 1e6, options.initial_value);
  ReadFlag(reader, "mask_illegal", options.mask_illegal);
  reader.Finish();
  resolved = reader.Resolved();
  return options;
}

TableLearner::TableLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                           const std::string& options)
    : options_(TabularOptions::Parse(options, resolved_)),
      farms_(spec.farms),
      table_(spec, static_cast<float>(options_.initial_value)),
      explorer_(options_.exploration, seed, SlotCount(spec)),
      pending_(SlotCount(spec)),
      loss_(std::nanf("")) {}

void TableLearner::SetProgress(double progress) {
  explorer_.SetProgress(progress);
  learning_rate_ = static_cast<float>(options_.learning_rate.At(progress));
}

void TableLearner::AddLoss(float loss) {
  loss_ = std::isnan(loss_) ? loss : loss_ + kLossShare * (loss - loss_);
}

LearnerStatus TableLearner::status() const {
  return {loss_, static_cast<float>(explorer_.level()), learning_rate_};
}

std::unique_ptr<Policy> TableLearner::GreedyPolicy() const {
  return std::make_unique<GreedyTabularPolicy>(table_, options_.mask_illegal);
}

void TableLearner::SavePolicy(Checkpoint& checkpoint) const {
  checkpoint.LendArray("table", table_.values);
  checkpoint.sections["mask_illegal"] = options_.mask_illegal ? "1" : "0";
}

void TableLearner::Save(Checkpoint& checkpoint) const {
  SavePolicy(checkpoint);
  explorer_.Save(checkpoint);
  checkpoint.SetArray("pending", pending_);
  checkpoint.SetArray("loss", std::vector<float>{loss_});
}

void TableLearner::Load(const Checkpoint& checkpoint) {
  std::vector<float> values;
  std::vector<float> loss;
  std::vector<std::uint64_t> pending;
  checkpoint.GetArray("table", table_.values.size(), values);
  checkpoint.GetArray("pending", pending_.size(), pending);
  checkpoint.GetArray("loss", 1, loss);
  for (const std::uint64_t offset : pending) {
    if (offset != kNoAction && offset >= values.size())
      throw InputError(
          "checkpoint: section 'pending': a number is out of range; use another checkpoint");
  }
  explorer_.Load(checkpoint);
  table_.values = std::move(values);
  pending_ = std::move(pending);
  loss_ = loss[0];
}

template <typename Rule>
void TabularLearner<Rule>::Step(const StepResults& results, double progress,
                                std::vector<std::uint8_t>& actions) {
  SetProgress(progress);
  actions.resize(pending_.size());
  const float rate = learning_rate_;
  const auto discount = static_cast<float>(options_.gamma);
  float* const values = table_.values.data();
  float error_sum = 0.0F;
  std::int32_t learnt = 0;
  std::size_t slot = 0;
  for (std::int32_t farm = 0; farm < farms_; ++farm) {
    const auto f = static_cast<std::size_t>(farm);
    const bool is_transition = results.is_first[f] == 0;
    for (std::int32_t agent = 0; agent < table_.agents; ++agent, ++slot) {
      const ActionMask allowed = ActionMaskOf(results.legal[slot]);
      const std::size_t row = table_.Row(agent, results.index[slot]);
      const Best best = BestOf(values + row, allowed);
      const std::uint8_t action = explorer_.Choose(values + row, allowed, best, slot);
      if (is_transition && pending_[slot] != kNoAction) {
        const bool goes_on = !results.IsDone(slot, f);
        const float next = goes_on ? Rule::NextValue(best.value, values[row + action]) : 0.0F;
        float& value = values[pending_[slot]];
        const float error = results.rewards[slot] + discount * next - value;
        value += rate * error;
        error_sum += error * error;
        ++learnt;
      }
      pending_[slot] = results.active[slot] != 0 ? row + action : kNoAction;
      actions[slot] = action;
    }
  }
  if (learnt > 0) AddLoss(error_sum / static_cast<float>(learnt));
}

template class TabularLearner<QLearningRule>;
template class TabularLearner<SarsaRule>;

void GreedyTabularPolicy::Act(const StepResults& results, std::vector<std::uint8_t>& actions) {
  actions.resize(results.index.size());
  values_.resize(actions.size());
  std::size_t slot = 0;
  while (slot < actions.size()) {
    for (std::int32_t agent = 0; agent < table_.agents; ++agent, ++slot) {
      const ActionMask allowed =
          mask_illegal_ ? static_cast<ActionMask>(results.legal[slot] & kAllActions) : kAllActions;
      const float* row = table_.values.data() + table_.Row(agent, results.index[slot]);
      const Best best = BestOf(row, allowed);
      actions[slot] = best.action;
      values_[slot] = best.value;
    }
  }
}

std::unique_ptr<Policy> MakeTabularPolicy(const Checkpoint& checkpoint,
                                          const EnvironmentSpec& spec) {
  const EnvironmentSpec& own = checkpoint.spec;
  CheckFit(checkpoint, spec, "width", own.width, spec.width);
  CheckFit(checkpoint, spec, "height", own.height, spec.height);
  CheckFit(checkpoint, spec, "agents", own.agents, spec.agents);
  CheckFit(checkpoint, spec, "tabular states", own.state_count, spec.state_count);
  QTable table(spec, 0.0F);
  checkpoint.GetArray("table", table.values.size(), table.values);
  return std::make_unique<GreedyTabularPolicy>(std::move(table),
                                               checkpoint.Section("mask_illegal") == "1");
}

}  // namespace aquafarm::agents
