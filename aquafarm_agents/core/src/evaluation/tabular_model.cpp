// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/tabular_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "aquafarm/agents/base/options.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm::agents {
namespace {

constexpr std::int32_t kNoLimit = 10'000'000;  // steps; the largest step limit of a scenario
constexpr int kMaxSweeps = 100'000;
constexpr double kConverged = 1e-12;

// Returns the scenario without disasters and with the longest step limit, so that no episode ends
// before the last device is delivered. @throws InputError unless the scenario has one ship, no
// other agent and a fixed layout
std::shared_ptr<const Scenario> WithoutEnds(Scenario scenario) {
  if (scenario.AgentCount() != 1 || scenario.ships.count != 1) {
    throw InputError("matrices: got " + std::to_string(scenario.AgentCount()) +
                     " agents, expected one ship; choose a scenario with ships.count 1");
  }
  if (scenario.layout != LayoutMode::kFixed) {
    throw InputError(
        "matrices: got layout.mode per_episode, expected fixed: each episode would have "
        "other states");
  }
  scenario.disasters.clear();
  scenario.step_limit = kNoLimit;
  return std::make_shared<const Scenario>(std::move(scenario));
}

std::string WhyNotFinite(const Scenario& scenario) {
  if (!scenario.disasters.empty()) {
    return "got a scenario with disasters, whose positions are not in the tabular state";
  }
  if (scenario.damage.crash_probability > 0.0F) {
    return "got damage.crash_probability above 0, but health is not in the tabular state";
  }
  if (scenario.seas && scenario.damage.exposure_damage > 0.0F) {
    return "got damage.exposure_damage above 0, but health is not in the tabular state";
  }
  return "";
}

std::string ToMatrixMarket(std::size_t rows, std::size_t columns,
                           const std::vector<MatrixEntry>& entries) {
  std::string text = "%%MatrixMarket matrix coordinate real general\n" + std::to_string(rows) +
                     " " + std::to_string(columns) + " " + std::to_string(entries.size()) + "\n";
  for (const MatrixEntry& entry : entries) {
    text += std::to_string(entry.row + 1) + " " + std::to_string(entry.column + 1) + " " +
            FormatNumber(entry.value) + "\n";
  }
  return text;
}

std::vector<MatrixEntry> Sparse(const PolicyMatrix& policy) {
  std::vector<MatrixEntry> entries;
  for (std::size_t row = 0; row < policy.size(); ++row) {
    for (std::size_t action = 0; action < kActionCount; ++action) {
      if (policy[row][action] > 0.0) entries.push_back({row, action, policy[row][action]});
    }
  }
  return entries;
}

}  // namespace

TabularModel::TabularModel(const Scenario& scenario) : not_finite_(WhyNotFinite(scenario)) {
  const std::shared_ptr<const Scenario> endless = WithoutEnds(scenario);
  const Encoder encoder(*endless);
  if (encoder.state_count() == 0) {
    throw InputError("matrices: got too many tabular states for an index, expected at most " +
                     std::to_string(Encoder::kMaxStates) +
                     "; choose a scenario with fewer devices or cells");
  }
  Farm farm(endless);
  farm.Reset(1, 0);
  std::unordered_map<std::uint32_t, std::size_t> rows{{encoder.Index(farm, 0), 0}};
  states_.push_back(encoder.Index(farm, 0));
  const auto copy_of = [&endless](const Farm& original) {
    auto copy = std::make_unique<Farm>(endless, original.shared_layout());
    copy->CopyStateFrom(original);
    return copy;
  };
  std::vector<std::unique_ptr<const Farm>> found_farms;
  found_farms.push_back(copy_of(farm));
  constexpr std::size_t kEnd = static_cast<std::size_t>(-1);
  for (std::size_t row = 0; row < states_.size(); ++row) {  // breadth first
    const std::unique_ptr<const Farm> from = std::move(found_farms[row]);
    next_.emplace_back();
    reward_.emplace_back();
    for (std::uint8_t action = 0; action < kActionCount; ++action) {
      farm.CopyStateFrom(*from);
      if (action == 0) legal_.push_back(farm.LegalActions(0));
      farm.Step(&action);
      reward_[row][action] = farm.ships()[0].reward;
      const std::uint32_t state = encoder.Index(farm, 0);
      const auto [found, is_new] = rows.try_emplace(state, states_.size());
      next_[row][action] = farm.over() ? kEnd : found->second;
      if (farm.over() && is_new) rows.erase(found);
      if (farm.over() || !is_new) continue;
      states_.push_back(state);
      found_farms.push_back(copy_of(farm));
    }
  }
  for (auto& row : next_) std::replace(row.begin(), row.end(), kEnd, end());
}

std::size_t TabularModel::RowOf(std::uint32_t state) const {
  const auto found = std::find(states_.begin(), states_.end(), state);
  if (found == states_.end()) {
    throw InputError("matrices: got tabular state " + std::to_string(state) +
                     ", which no episode reaches");
  }
  return static_cast<std::size_t>(found - states_.begin());
}

std::vector<MatrixEntry> TabularModel::Transitions(const PolicyMatrix& policy) const {
  std::vector<MatrixEntry> entries;
  for (std::size_t row = 0; row < states_.size(); ++row) {
    const std::size_t first = entries.size();
    for (std::size_t action = 0; action < kActionCount; ++action) {
      const double probability = policy.at(row)[action];
      if (probability <= 0.0) continue;
      const std::size_t to = next_[row][action];
      const auto same =
          std::find_if(entries.begin() + static_cast<std::ptrdiff_t>(first), entries.end(),
                       [to](const MatrixEntry& entry) { return entry.column == to; });
      if (same != entries.end()) {
        same->value += probability;
      } else {
        entries.push_back({row, to, probability});
      }
    }
  }
  entries.push_back({end(), end(), 1.0});
  return entries;
}

std::vector<double> TabularModel::OptimalValues(double discount) const {
  if (!not_finite_.empty()) {
    throw InputError("value iteration: " + not_finite_ +
                     "; use the clairvoyant bound (policy clairvoyant) instead");
  }
  std::vector<double> values(rows());
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0.0;
    for (std::size_t row = 0; row < states_.size(); ++row) {
      double best = -std::numeric_limits<double>::infinity();
      for (std::size_t action = 0; action < kActionCount; ++action) {
        best = std::max(best, static_cast<double>(reward_[row][action]) +
                                  discount * values[next_[row][action]]);
      }
      change = std::max(change, std::abs(best - values[row]));
      values[row] = best;
    }
    if (change < kConverged) return values;
  }
  throw InputError("value iteration: no convergence in " + std::to_string(kMaxSweeps) +
                   " sweeps with discount " + FormatNumber(discount) +
                   ", expected a smaller discount or rewards.step below 0");
}

PolicyMatrix MakePolicyMatrix(const TabularModel& model, const std::vector<float>& table,
                              ExplorationKind kind, double level, bool mask_illegal) {
  PolicyMatrix policy(model.states().size());
  for (std::size_t row = 0; row < policy.size(); ++row) {
    const std::size_t first = model.states()[row] * std::size_t{kActionCount};
    AQUAFARM_CHECK_LE(first + kActionCount, table.size());
    const float* const values = table.data() + first;
    const ActionMask allowed =
        mask_illegal ? static_cast<ActionMask>(model.legal(row) & kAllActions) : kAllActions;
    if (kind == ExplorationKind::kBoltzmann) {
      policy[row] = BoltzmannProbabilities(values, allowed, level);
      continue;
    }
    int count = 0;
    for (std::size_t action = 0; action < kActionCount; ++action) {
      count += static_cast<int>((allowed >> action) & 1U);
    }
    for (std::size_t action = 0; action < kActionCount; ++action) {
      if (((allowed >> action) & 1U) != 0) policy[row][action] = level / count;
    }
    policy[row][BestOf(values, allowed).action] += 1.0 - level;
  }
  return policy;
}

void WriteMatrices(const std::string& prefix, const Scenario& scenario,
                   const Checkpoint& checkpoint, const std::string& policy, double discount) {
  if (!checkpoint.Has("table")) {
    throw InputError("matrices: got a policy of '" + checkpoint.algorithm +
                     "', expected one with a table, of q_learning or sarsa");
  }
  const ExplorationOptions how = ParseExploration(policy);
  if (how.level.kind != ScheduleKind::kConstant) {
    throw InputError("matrices: got policy '" + policy +
                     "', expected a fixed level, such as epsilon_greedy:0 or boltzmann:1");
  }
  const TabularModel model(scenario);
  std::vector<float> table;
  checkpoint.GetArray("table", checkpoint.spec.state_count * std::size_t{kActionCount}, table);
  if (checkpoint.spec.state_count != Encoder(scenario).state_count()) {
    throw InputError("matrices: got a table of scenario " + checkpoint.spec.scenario_name +
                     ", expected one of " + scenario.name);
  }
  const PolicyMatrix matrix = MakePolicyMatrix(model, table, how.kind, how.level.start,
                                               checkpoint.Section("mask_illegal") == "1");
  std::vector<double> optimal;
  if (WhyNotFinite(scenario).empty()) optimal = model.OptimalValues(discount);
  std::string states = "row,state,optimal_value\n";
  for (std::size_t row = 0; row < model.states().size(); ++row) {
    states += std::to_string(row + 1) + "," + std::to_string(model.states()[row]) + "," +
              (optimal.empty() ? "" : FormatNumber(optimal[row])) + "\n";
  }
  WriteFileAtomically(prefix + "_policy.mtx",
                      ToMatrixMarket(matrix.size(), kActionCount, Sparse(matrix)));
  WriteFileAtomically(prefix + "_transitions.mtx",
                      ToMatrixMarket(model.rows(), model.rows(), model.Transitions(matrix)));
  WriteFileAtomically(prefix + "_states.csv", states);
}

}  // namespace aquafarm::agents
