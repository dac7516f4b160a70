// SPDX-License-Identifier: BSD-3-Clause
// Compares advantages with their definition as a sum, and checks the record of each kind of end.
#include "ppo/gae.h"

#include <gtest/gtest.h>

#include "agents_fixture.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/grid/action.h"
#include "ppo/rollout.h"

namespace aquafarm::agents::test {
namespace {

struct Steps {
  std::vector<float> rewards;
  std::vector<float> values;
  std::vector<StepEnd> ends;
};

// Returns the sum over future errors, in double precision, for one sample of one column (E = 1).
double DefinedAdvantage(const Steps& steps, std::size_t t, double gamma, double lambda) {
  if (steps.ends[t] == StepEnd::kNoTransition) return 0.0;
  double sum = 0.0;
  double weight = 1.0;
  for (; t < steps.ends.size(); ++t) {
    if (steps.ends[t] == StepEnd::kNoTransition) break;
    const double next =
        steps.ends[t] == StepEnd::kTerminated ? 0.0 : static_cast<double>(steps.values[t + 1]);
    sum += weight * (static_cast<double>(steps.rewards[t]) + gamma * next -
                     static_cast<double>(steps.values[t]));
    if (steps.ends[t] != StepEnd::kContinues) break;
    weight *= gamma * lambda;
  }
  return sum;
}

TEST(Gae, EqualsItsDefinitionForRandomEpisodes) {
  RandomStream rng({7, 0, RngStream::kLearner, 0});
  Steps steps;
  for (int t = 0; t < 200; ++t) {
    steps.rewards.push_back(rng.Uniform(-5.0F, 5.0F));
    steps.values.push_back(rng.Uniform(-5.0F, 5.0F));
    const std::uint32_t draw = rng.Below(10);
    steps.ends.push_back(draw < 7 ? StepEnd::kContinues : static_cast<StepEnd>(draw - 6));
  }
  steps.values.push_back(2.0F);
  std::vector<float> advantages;
  EstimateAdvantages(steps.rewards, steps.values, steps.ends, 1, 0.9F, 0.8F, advantages);
  ASSERT_EQ(advantages.size(), steps.ends.size());
  for (std::size_t t = 0; t < advantages.size(); ++t) {
    EXPECT_NEAR(advantages[t],
                DefinedAdvantage(steps, t, static_cast<double>(0.9F), static_cast<double>(0.8F)),
                1e-4)
        << t;
  }
}

TEST(Gae, BootstrapsAtTruncationAndNotAtTermination) {
  const std::vector<float> rewards{1.0F, 1.0F};
  const std::vector<float> values{10.0F, 20.0F, 30.0F, 40.0F};  // two slots, one step
  std::vector<float> advantages;
  EstimateAdvantages(rewards, values, {StepEnd::kTruncated, StepEnd::kTerminated}, 2, 0.5F, 1.0F,
                     advantages);
  EXPECT_FLOAT_EQ(advantages[0], 1.0F + 0.5F * 30.0F - 10.0F);
  EXPECT_FLOAT_EQ(advantages[1], 1.0F - 20.0F);
}

TEST(Gae, DoesNotMixSlots) {
  // Slot 0 gets no reward; slot 1 gets 8 in the second step.
  const std::vector<float> rewards{0, 0, 0, 8};
  const std::vector<float> values(6, 0.0F);
  const std::vector<StepEnd> ends(4, StepEnd::kContinues);
  std::vector<float> advantages;
  EstimateAdvantages(rewards, values, ends, 2, 0.5F, 0.5F, advantages);
  EXPECT_EQ(advantages, (std::vector<float>{0, 2, 0, 8}));
}

// Returns the results of one step of a farm with two agents.
StepResults Outcome(EndReason reason, bool is_first, std::vector<std::uint8_t> active) {
  StepResults results;
  results.rewards = {2.0F, 4.0F};
  results.active = std::move(active);
  results.end_reasons = {static_cast<std::uint8_t>(reason)};
  results.is_first = {static_cast<std::uint8_t>(is_first)};
  results.features = {1.0F, 2.0F};
  return results;
}

// Records one decision after `before` and its results `after`.
Rollout Recorded(const StepResults& before, const StepResults& after, bool is_team = false,
                 float team_share = 0.0F) {
  Rollout rollout({1, 2, 2, 1, 0, 1, is_team});
  rollout.Complete(before, {});  // without effect: there is no decision yet
  rollout.Add(before, {1, 1}, {0, 0}, {0, 0}, {10, 20}, {});
  EXPECT_FALSE(rollout.IsFull());
  rollout.Complete(after, {0.5F, team_share});
  EXPECT_TRUE(rollout.IsFull());
  rollout.Finish({100, 200}, 1.0F, 1.0F);
  return rollout;
}

TEST(Rollout, LearnsFromStepsOfActiveAgentsOnly) {
  const StepResults going = Outcome(EndReason::kNone, false, {1, 1});
  Rollout rollout = Recorded(going, going);
  EXPECT_FLOAT_EQ(rollout.advantage(0), 1.0F + 100.0F - 10.0F) << "reward 2, scaled by 0.5";
  EXPECT_FLOAT_EQ(rollout.target(1), 2.0F + 200.0F);
  // Agent 1 finishes in this step; its next value is not used.
  rollout = Recorded(going, Outcome(EndReason::kNone, false, {1, 0}));
  EXPECT_FLOAT_EQ(rollout.advantage(1), 2.0F - 20.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(0), 1.0F + 100.0F - 10.0F);
  // Agent 1 finished before.
  rollout = Recorded(Outcome(EndReason::kNone, false, {1, 0}), going);
  EXPECT_TRUE(rollout.IsValid(0));
  EXPECT_FALSE(rollout.IsValid(1));
  rollout = Recorded(going, Outcome(EndReason::kAllRetrieved, false, {1, 1}));
  EXPECT_FLOAT_EQ(rollout.advantage(0), 1.0F - 10.0F) << "terminated";
  rollout = Recorded(going, Outcome(EndReason::kStepLimit, false, {1, 1}));
  EXPECT_FLOAT_EQ(rollout.advantage(0), 1.0F + 100.0F - 10.0F) << "truncated";
  // The episode has ended: the environment ignores the action and starts the next episode.
  rollout = Recorded(Outcome(EndReason::kAllRetrieved, false, {1, 1}),
                     Outcome(EndReason::kNone, true, {1, 1}));
  EXPECT_FALSE(rollout.IsValid(0));
  // The farm was lost during the episode and replaced by another one.
  rollout = Recorded(going, Outcome(EndReason::kNone, true, {1, 1}));
  EXPECT_FALSE(rollout.IsValid(0));
}

TEST(Rollout, RefusesActionsThatDoNotExist) {
  const StepResults going = Outcome(EndReason::kNone, false, {1, 1});
  Checkpoint checkpoint;
  Recorded(going, going).Save(checkpoint);
  Rollout loaded({1, 2, 2, 1, 0, 1, false});
  loaded.Load(checkpoint);
  checkpoint.SetArray("rollout.actions", std::vector<std::uint8_t>{0, kActionCount});
  EXPECT_CONTAINS(MessageOf<InputError>([&] { loaded.Load(checkpoint); }),
                  "rollout.actions: got 10, expected at most 9");
}

TEST(Rollout, KeepsTheLabelsOfTheStepsThatHaveThem) {
  const StepResults going = Outcome(EndReason::kNone, false, {1, 1});
  const auto record = [&going](Rollout& rollout) {
    rollout.Complete(going, {});
    rollout.Add(going, {3, 3}, {0, 0}, {0, 0}, {10, 20}, {});
  };
  const Rollout::Shape shape{2, 2, 2, 1, 0, 1, false, /*has_labels=*/true};
  Rollout rollout(shape);
  record(rollout);
  rollout.SetLabels({1, kNoLabel});
  Checkpoint checkpoint;
  rollout.Save(checkpoint);
  Rollout loaded(shape);
  loaded.Load(checkpoint);
  for (Rollout* const one : {&rollout, &loaded}) {
    record(*one);
    EXPECT_EQ(one->label(0), 1);
    for (const std::size_t sample : {1, 2, 3}) EXPECT_EQ(one->label(sample), kNoLabel) << sample;
    one->Complete(going, {});
    one->Clear();
    record(*one);
    EXPECT_EQ(one->label(0), kNoLabel) << "of the rollout before";
  }
  EXPECT_EQ(Rollout({1, 2, 2, 1, 0, 1, false}).label(0), kNoLabel) << "without a teacher";
}

// Rewards 2 and 4, scaled by 0.5.
TEST(Rollout, AddsTheTeamsShareOfTheRewards) {
  const StepResults going = Outcome(EndReason::kNone, false, {1, 1});
  Rollout rollout = Recorded(going, going, /*is_team=*/true, 1.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(0), 3.0F + 100.0F - 10.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(1), 3.0F + 200.0F - 20.0F);
  rollout = Recorded(going, going, /*is_team=*/true, 0.25F);
  EXPECT_FLOAT_EQ(rollout.advantage(0), 0.5F * (0.75F * 2.0F + 0.25F * 6.0F) + 100.0F - 10.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(1), 0.5F * (0.75F * 4.0F + 0.25F * 6.0F) + 200.0F - 20.0F);
}

TEST(Rollout, AnAgentThatIsDoneEarnsTheTeamsRewardsUntilTheEpisodeEnds) {
  const StepResults going = Outcome(EndReason::kNone, false, {1, 1});
  const StepResults done = Outcome(EndReason::kNone, false, {1, 0});
  Rollout rollout = Recorded(going, done, /*is_team=*/true, 1.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(1), 3.0F + 200.0F - 20.0F) << "done in this step";
  rollout = Recorded(done, done, /*is_team=*/true, 1.0F);
  EXPECT_TRUE(rollout.IsValid(1)) << "done before";
  EXPECT_FLOAT_EQ(rollout.advantage(1), 3.0F + 200.0F - 20.0F);
  rollout =
      Recorded(done, Outcome(EndReason::kAllRetrieved, false, {1, 0}), /*is_team=*/true, 1.0F);
  EXPECT_FLOAT_EQ(rollout.advantage(1), 3.0F - 20.0F) << "the episode terminated";
}

}  // namespace
}  // namespace aquafarm::agents::test
