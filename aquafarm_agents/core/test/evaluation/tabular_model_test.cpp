// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/tabular_model.h"

#include <cmath>
#include <functional>
#include <map>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/evaluation/rollout_values.h"
#include "aquafarm/agents/planning/planner_policy.h"
#include "aquafarm/observation/encoder.h"

namespace aquafarm::agents::test {
namespace {

// The tiny farm without damage and disasters: rewards depend on state and action alone.
Scenario Quiet() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 1000;
  scenario.damage.crash_probability = 0.0F;
  return scenario;
}

std::vector<float> Table(const Scenario& scenario) {
  RandomStream rng({5, 0, RngStream::kLearner, 0});
  std::vector<float> table(std::size_t{Encoder(scenario).state_count()} * kActionCount);
  for (float& value : table) value = rng.Uniform(-3.0F, 3.0F);
  return table;
}

TEST(TabularModel, HasEachStateThatAFarmCanBeIn) {
  const Scenario scenario = Quiet();
  const TabularModel model(scenario);
  // 20 free cells (25 less an island of 4 and a rock), the device deployed or aboard.
  EXPECT_EQ(model.states().size(), 40U);
  EXPECT_EQ(model.rows(), 41U);
}

TEST(PolicyMatrix, RowsSumToOneWithTheProbabilitiesOfTheirPolicies) {
  const Scenario scenario = Quiet();
  const TabularModel model(scenario);
  const std::vector<float> table = Table(scenario);
  for (const bool masked : {false, true}) {
    for (const auto& [kind, level] : {std::pair{ExplorationKind::kEpsilonGreedy, 0.0},
                                      std::pair{ExplorationKind::kEpsilonGreedy, 0.3},
                                      std::pair{ExplorationKind::kBoltzmann, 0.7}}) {
      const PolicyMatrix policy = MakePolicyMatrix(model, table, kind, level, masked);
      for (std::size_t row = 0; row < policy.size(); ++row) {
        const float* const values = table.data() + model.states()[row] * kActionCount;
        double sum = 0.0;
        double largest = 0.0;
        for (std::size_t a = 0; a < kActionCount; ++a) {
          sum += policy[row][a];
          largest = std::max(largest, policy[row][a]);
          const bool legal = ((model.legal(row) >> a) & 1U) != 0;
          EXPECT_TRUE(legal || !masked || policy[row][a] == 0.0);
        }
        EXPECT_NEAR(sum, 1.0, 1e-12);
        if (masked) continue;
        if (kind == ExplorationKind::kBoltzmann) {  // Eq. 8 between two actions
          EXPECT_NEAR(std::log(policy[row][3] / policy[row][7]),
                      static_cast<double>(values[3] - values[7]) / level, 1e-5);
        } else {
          EXPECT_NEAR(largest, 1.0 - level + level / kActionCount, 1e-12);
        }
      }
    }
  }
}

TEST(TransitionMatrix, RowsSumToOne) {
  const Scenario scenario = Quiet();
  const TabularModel model(scenario);
  const PolicyMatrix policy =
      MakePolicyMatrix(model, Table(scenario), ExplorationKind::kBoltzmann, 1.0, false);
  std::vector<double> sums(model.rows());
  for (const MatrixEntry& entry : model.Transitions(policy)) {
    sums[entry.row] += entry.value;
    EXPECT_GT(entry.value, 0.0);
  }
  for (const double sum : sums) EXPECT_NEAR(sum, 1.0, 1e-12);
}

// The farm itself, with a disaster that changes no state, against the n-th power of the matrix.
TEST(TransitionMatrix, PowersAgreeWithSimulatedFrequencies) {
  Scenario scenario = Quiet();
  scenario.disasters = {aquafarm::test::StillDisaster(4.0F, 4.0F, {1.0F}, {-5.0F})};
  const TabularModel model(scenario);
  const PolicyMatrix policy =
      MakePolicyMatrix(model, Table(scenario), ExplorationKind::kBoltzmann, 4.0, false);
  constexpr int kSteps = 7;
  constexpr int kEpisodes = 20000;
  const auto shared = Share(scenario);
  const Encoder encoder(*shared);
  Farm farm(shared);
  farm.Reset(1, 0);
  const std::size_t start = model.RowOf(encoder.Index(farm, 0));
  std::vector<double> expected(model.rows());
  expected[start] = 1.0;
  const std::vector<MatrixEntry> transitions = model.Transitions(policy);
  for (int step = 0; step < kSteps; ++step) {
    std::vector<double> next(model.rows());
    for (const MatrixEntry& entry : transitions) {
      next[entry.column] += expected[entry.row] * entry.value;
    }
    expected = next;
  }
  RandomStream rng({6, 0, RngStream::kExploration, 0});
  std::vector<int> counts(model.rows());
  const std::string begin = farm.Save();
  for (int episode = 0; episode < kEpisodes; ++episode) {
    farm.Load(begin);
    for (int step = 0; step < kSteps && !farm.over(); ++step) {
      double left = static_cast<double>(rng.Unit());
      std::uint8_t action = 0;
      const auto& row = policy[model.RowOf(encoder.Index(farm, 0))];
      while (action + 1 < kActionCount && (left -= row[action]) >= 0.0) ++action;
      farm.Step(&action);
    }
    ++counts[farm.over() ? model.end() : model.RowOf(encoder.Index(farm, 0))];
  }
  for (std::size_t row = 0; row < model.rows(); ++row) {
    const double p = expected[row];
    const double deviation = std::sqrt(p * (1.0 - p) / kEpisodes);
    EXPECT_NEAR(counts[row] / static_cast<double>(kEpisodes), p, 5.0 * deviation + 1e-9)
        << "row " << row;
  }
  EXPECT_GT(expected[model.end()], 0.0);
}

TEST(OptimalValues, AreThoseOfTheBestPlanFromEachCell) {
  const Scenario scenario = Quiet();
  const auto shared = Share(scenario);
  const TabularModel model(scenario);
  const std::vector<double> optimal = model.OptimalValues(1.0);
  const RolloutValues planned = PlayValues(
      shared, kStatesBit,
      [](const EnvironmentSpec& spec) {
        return std::make_unique<PlannerPolicy>(spec, Foresight::kOracle);
      },
      3, 0, 1);
  const Encoder encoder(*shared);
  Farm farm(shared);
  int compared = 0;
  for (std::int32_t i = 0; i < 25; ++i) {
    if (std::isnan(planned.value[static_cast<std::size_t>(i)])) continue;
    farm.Reset(1, 0);
    farm.PlaceShip(0, {i % 5, i / 5});
    EXPECT_NEAR(optimal[model.RowOf(encoder.Index(farm, 0))],
                planned.value[static_cast<std::size_t>(i)], 1e-4)
        << "cell " << i;
    ++compared;
  }
  EXPECT_EQ(compared, 20);
}

// Brute force: the best of all action sequences that are so long that later rewards hardly count.
TEST(OptimalValues, AreThoseOfBruteForceWithADiscount) {
  const Scenario scenario = Quiet();
  const TabularModel model(scenario);
  constexpr double kDiscount = 0.5;
  std::vector<double> best(model.rows());
  const auto shared = Share(scenario);
  const Encoder encoder(*shared);
  std::map<std::pair<std::string, int>, double> seen;
  const std::function<double(Farm&, int)> search = [&](Farm& farm, int depth) {
    if (farm.over() || depth == 0) return 0.0;
    const std::pair<std::string, int> key{std::to_string(encoder.Index(farm, 0)), depth};
    const auto found = seen.find(key);
    if (found != seen.end()) return found->second;
    const std::string from = farm.Save();
    double most = -1e9;
    for (std::uint8_t action = 0; action < kActionCount; ++action) {
      farm.Load(from);
      farm.Step(&action);
      const auto reward = static_cast<double>(farm.ships()[0].reward);
      most = std::max(most, reward + kDiscount * search(farm, depth - 1));
    }
    return seen[key] = most;
  };
  Farm farm(shared);
  farm.Reset(1, 0);
  const std::size_t start = model.RowOf(encoder.Index(farm, 0));
  EXPECT_NEAR(model.OptimalValues(kDiscount)[start], search(farm, 24), 1e-4);
}

TEST(OptimalValues, AreRefusedWhereTheTabularStateDoesNotDecide) {
  Scenario stormy = Quiet();
  stormy.disasters = {aquafarm::test::StillDisaster(4.0F, 4.0F, {1.0F}, {-5.0F})};
  EXPECT_EQ(MessageOf<InputError>([&] { TabularModel(stormy).OptimalValues(0.9); }),
            "value iteration: got a scenario with disasters, whose positions are not in the "
            "tabular state; use the clairvoyant bound (policy clairvoyant) instead");
  Scenario two = Quiet();
  two.ships.count = 2;
  EXPECT_EQ(MessageOf<InputError>([&] { TabularModel{two}; }),
            "matrices: got 2 agents, expected one ship; choose a scenario with ships.count 1");
}

using MatrixFiles = FolderTest;

TEST_F(MatrixFiles, AreMatrixMarketFiles) {
  const Scenario scenario = Quiet();
  Checkpoint checkpoint;
  checkpoint.algorithm = "q_learning";
  checkpoint.spec.state_count = Encoder(scenario).state_count();
  checkpoint.SetArray("table", Table(scenario));
  checkpoint.sections["mask_illegal"] = "0";
  WriteMatrices(folder_ + "/m", scenario, checkpoint, "epsilon_greedy:0", 0.9);
  const std::string policy = ReadFile(folder_ + "/m_policy.mtx");
  EXPECT_EQ(policy.substr(0, policy.find("\n1 ")),
            "%%MatrixMarket matrix coordinate real general\n40 10 40");
  const std::string transitions = ReadFile(folder_ + "/m_transitions.mtx");
  EXPECT_CONTAINS(transitions, "general\n41 41 41\n");
  EXPECT_CONTAINS(transitions, "\n41 41 1\n");
  EXPECT_CONTAINS(ReadFile(folder_ + "/m_states.csv"), "row,state,optimal_value\n1,");
  EXPECT_EQ(MessageOf<InputError>([&] {
              WriteMatrices(folder_ + "/m", scenario, checkpoint, "boltzmann:linear:5:1:1", 0.9);
            }),
            "matrices: got policy 'boltzmann:linear:5:1:1', expected a fixed level, such as "
            "epsilon_greedy:0 or boltzmann:1");
}

}  // namespace
}  // namespace aquafarm::agents::test
