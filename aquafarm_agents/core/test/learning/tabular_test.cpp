// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/tabular.h"

#include <cmath>
#include <cstring>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/training/trainer.h"
#include "chain.h"

namespace aquafarm::agents::test {
namespace {

constexpr const char* kByHand = "learning_rate=0.5 gamma=0.9 exploration=epsilon_greedy:0";

TEST(QLearning, UpdatesByEquation12) {
  Chain chain;
  TabularLearner<QLearningRule> learner(chain.spec, 1, kByHand);
  EXPECT_EQ(chain.Notify(learner, 0, 0.0F), 0);
  EXPECT_EQ(chain.Notify(learner, 1, 2.0F), 0);
  EXPECT_FLOAT_EQ(learner.table().values[0], 1.0F);  // 0 + 0.5 (2 + 0.9 · 0 − 0)
  chain.Notify(learner, 0, 3.0F);
  EXPECT_FLOAT_EQ(learner.table().values[10], 1.95F);  // 0.5 (3 + 0.9 · 1)
}

template <typename L>
float ValueAfterEnd(EndReason reason) {
  Chain chain;
  L learner(chain.spec, 1, std::string(kByHand) + " initial_value=10");
  chain.Notify(learner, 0, 0.0F);
  chain.Notify(learner, 2, 4.0F, reason);
  return learner.table().values[0];
}

TEST(Tabular, TerminationStopsBootstrappingAndTruncationDoesNot) {
  using Q = TabularLearner<QLearningRule>;
  using S = TabularLearner<SarsaRule>;
  EXPECT_FLOAT_EQ(ValueAfterEnd<Q>(EndReason::kAllRetrieved), 7.0F);  // 10 + 0.5 (4 − 10)
  EXPECT_FLOAT_EQ(ValueAfterEnd<Q>(EndReason::kDisasterEnded), 7.0F);
  EXPECT_FLOAT_EQ(ValueAfterEnd<Q>(EndReason::kStepLimit), 11.5F);  // 10 + 0.5 (4 + 9 − 10)
  EXPECT_FLOAT_EQ(ValueAfterEnd<S>(EndReason::kAllRetrieved), 7.0F);
  EXPECT_FLOAT_EQ(ValueAfterEnd<S>(EndReason::kStepLimit), 11.5F);
}

TEST(Tabular, TheStartOfAnEpisodeIsNotATransition) {
  Chain chain;
  TabularLearner<QLearningRule> learner(chain.spec, 1, kByHand);
  chain.Notify(learner, 0, 0.0F);
  chain.Notify(learner, 1, 5.0F, EndReason::kAllRetrieved);
  const std::vector<float> before = learner.table().values;
  chain.results.is_first[0] = 1;
  chain.Notify(learner, 2, 0.0F);
  EXPECT_EQ(learner.table().values, before);
}

/// Literal implementation of Eqs. 12 and 14, one entry at a time.
struct Oracle {
  std::vector<float> q;
  float alpha;
  float gamma;
  bool sarsa;

  void Learn(std::size_t row, std::uint8_t action, float reward, bool terminated,
             std::size_t next_row, std::uint8_t next_action) {
    float next = 0.0F;
    if (!terminated) {
      next = q[next_row + next_action];
      for (std::size_t a = 0; a < kActionCount && !sarsa; ++a)
        next = std::max(next, q[next_row + a]);
    }
    q[row + action] += alpha * (reward + gamma * next - q[row + action]);
  }
};

template <typename L>
void ExpectLikeOracle(bool sarsa) {
  LocalEnvironment environment(Share(aquafarm::test::CrowdedScenario(2)), {3, kIndexBit, false, 1});
  const EnvironmentSpec& spec = environment.spec();
  L learner(spec, 9, "learning_rate=0.25 gamma=0.75 exploration=epsilon_greedy:0.5");
  Oracle oracle{std::vector<float>(learner.table().values.size()), 0.25F, 0.75F, sarsa};
  std::vector<std::uint8_t> actions;
  StepResults results = environment.Reset(3);
  learner.Step(results, 0.0, actions);
  for (int step = 0; step < 2000; ++step) {
    const std::vector<std::uint8_t> taken = actions;
    const StepResults before = results;
    results = environment.Step(actions);
    learner.Step(results, 0.0, actions);
    std::size_t k = 0;
    for (std::size_t farm = 0; farm < 3; ++farm) {
      const bool terminated = IsTerminated(static_cast<EndReason>(results.end_reasons[farm]));
      for (std::int32_t agent = 0; agent < spec.agents; ++agent, ++k) {
        if (results.is_first[farm] != 0 || before.active[k] == 0) continue;
        oracle.Learn(learner.table().Row(agent, before.index[k]), taken[k], results.rewards[k],
                     terminated || results.active[k] == 0,
                     learner.table().Row(agent, results.index[k]), actions[k]);
      }
    }
    ASSERT_EQ(learner.table().values == oracle.q, true) << "step " << step;
  }
}

TEST(QLearning, IsTheSlowOracleBitForBit) {
  ExpectLikeOracle<TabularLearner<QLearningRule>>(false);
}
TEST(Sarsa, IsTheSlowOracleBitForBit) { ExpectLikeOracle<TabularLearner<SarsaRule>>(true); }

template <typename L>
void ExpectLearnsTinyFarm(const std::string& options) {
  const auto farm = TinyFarm();
  LocalEnvironment environment(farm, {4, kIndexBit, false, 1});
  L learner(environment.spec(), 2, options);
  EXPECT_EQ(Evaluate(environment, *learner.GreedyPolicy(), 1, 20).success_rate, 0.0);
  TrainerOptions training;
  training.steps = 60000;
  training.seed = 2;
  EXPECT_EQ(Trainer(environment, learner, training).Run(), TrainingEnd::kDone);
  const Evaluation after = Evaluate(environment, *learner.GreedyPolicy(), 1, 20);
  EXPECT_EQ(after.success_rate, 1.0);
  EXPECT_EQ(after.mean_steps, 6.0);  // two north, pickup, two south, drop-off
}

TEST(QLearning, GoesFromFailingToSolvingATinyFarm) {
  ExpectLearnsTinyFarm<TabularLearner<QLearningRule>>("");
}
TEST(Sarsa, GoesFromFailingToSolvingATinyFarm) {
  ExpectLearnsTinyFarm<TabularLearner<SarsaRule>>("");
}
TEST(QLearning, LearnsWithBoltzmannExploration) {
  ExpectLearnsTinyFarm<TabularLearner<QLearningRule>>("exploration=boltzmann");
}
TEST(Sarsa, LearnsWithLegalActionsOnly) {
  ExpectLearnsTinyFarm<TabularLearner<SarsaRule>>("mask_illegal=true");
}

TEST(QLearning, SolvesPaper) {
  LocalEnvironment environment(Paper(), {64, kIndexBit, false, 1});
  TabularLearner<QLearningRule> learner(environment.spec(), 1, "");
  TrainerOptions training;
  training.steps = 2000000;
  EXPECT_EQ(Trainer(environment, learner, training).Run(), TrainingEnd::kDone);
  const Evaluation after = Evaluate(environment, *learner.GreedyPolicy(), 1, 1000);
  EXPECT_EQ(after.success_rate, 1.0);
  EXPECT_GT(after.return_per_step, 3.0);
}

TEST(Tabular, IllegalActionsAreNeverTriedWhenMasked) {
  LocalEnvironment environment(TinyFarm(), {4, kIndexBit, false, 1});
  TabularLearner<QLearningRule> learner(environment.spec(), 1,
                                        "mask_illegal=true exploration=epsilon_greedy:1");
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  for (int i = 0; i < 2000; ++i) {
    learner.Step(*results, 0.0, actions);
    results = &environment.Step(actions);
    for (const std::uint8_t outcome : results->outcomes) {
      EXPECT_NE(outcome, static_cast<std::uint8_t>(Outcome::kIllegalPickup));
      EXPECT_NE(outcome, static_cast<std::uint8_t>(Outcome::kIllegalDropOff));
    }
  }
}

/// The same farms, but a truncated episode is reported as a terminated one.
class TruncationTerminates final : public Environment {
 public:
  explicit TruncationTerminates(Environment& farms) : farms_(farms) {}
  const EnvironmentSpec& spec() const override { return farms_.spec(); }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first_episode) override {
    return Change(farms_.Reset(seed, first_episode));
  }
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override {
    return Change(farms_.Step(actions));
  }
  std::string Save() override { return farms_.Save(); }
  const StepResults& Load(const std::string& bytes) override { return Change(farms_.Load(bytes)); }
  int truncated() const { return truncated_; }

 private:
  const StepResults& Change(const StepResults& results) {
    results_ = results;
    for (std::uint8_t& reason : results_.end_reasons) {
      if (!IsTruncated(static_cast<EndReason>(reason))) continue;
      reason = static_cast<std::uint8_t>(EndReason::kDisasterEnded);
      ++truncated_;
    }
    return results_;
  }
  Environment& farms_;
  StepResults results_;
  int truncated_{};
};

std::shared_ptr<const Scenario> Shipped(const std::string& name) {
  return std::make_shared<const Scenario>(
      LoadScenario(std::string(AQUAFARM_SCENARIO_DIR) + "/" + name + ".yaml"));
}

constexpr int kFarms = 8;

/// The table of a learner that always draws its action, so that it learns the values of RANDOM.
template <typename Rule>
std::vector<float> TableOfRandom(Environment& environment, std::uint64_t steps) {
  TabularLearner<Rule> learner(environment.spec(), 1,
                               "exploration=epsilon_greedy:1 learning_rate=linear:0.5:0.02:1");
  TrainerOptions trainer;
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, learner, trainer).Run(), TrainingEnd::kDone);
  return learner.table().values;
}

// The mean of a table's values over `known`, the entries that all tables have learnt.
double MeanValue(const std::vector<float>& values, const std::vector<std::size_t>& known) {
  double sum = 0.0;
  for (const std::size_t entry : known) sum += static_cast<double>(values[entry]);
  return sum / static_cast<double>(known.size());
}

// `paper` is the same farm, where no episode is truncated. A learner that bootstraps at truncation
// finds the values of `paper`; one that takes truncation for an end expects a future that costs
// less.
TEST(Truncated, BootstrappingFindsTheValuesOfEpisodesThatAreNotCutOff) {
  constexpr std::uint64_t kSteps = 3000000;
  constexpr std::size_t kNothingAboard = std::size_t{25} * 25 * kActionCount;
  LocalEnvironment whole(Shipped("paper"), {kFarms, kIndexBit, false, 1});
  LocalEnvironment cut(Shipped("truncated"), {kFarms, kIndexBit, false, 1});
  LocalEnvironment ended(Shipped("truncated"), {kFarms, kIndexBit, false, 1});
  TruncationTerminates terminates(ended);
  const auto reference = TableOfRandom<SarsaRule>(whole, kSteps);
  const auto bootstrapped = TableOfRandom<SarsaRule>(cut, kSteps);
  const auto stopped = TableOfRandom<SarsaRule>(terminates, kSteps);
  EXPECT_GT(terminates.truncated(), 10000);
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < kNothingAboard; ++i) {
    if (reference[i] != 0.0F && bootstrapped[i] != 0.0F && stopped[i] != 0.0F) known.push_back(i);
  }
  ASSERT_GT(known.size(), 1000U);
  const double expected = MeanValue(reference, known);
  EXPECT_NEAR(MeanValue(bootstrapped, known), expected, 0.1 * std::abs(expected));
  EXPECT_GT(MeanValue(stopped, known), expected + 0.15 * std::abs(expected));
}

TEST(Truncated, IsLearntByATable) {
  LocalEnvironment environment(Shipped("truncated"), {kFarms, kIndexBit, false, 1});
  TabularLearner<QLearningRule> learner(environment.spec(), 1, "");
  TrainerOptions trainer;
  trainer.steps = 2000000;
  EXPECT_EQ(Trainer(environment, learner, trainer).Run(), TrainingEnd::kDone);
  EXPECT_GE(Evaluate(environment, *learner.GreedyPolicy(), 1, 200).success_rate, 0.98);
}

}  // namespace
}  // namespace aquafarm::agents::test
