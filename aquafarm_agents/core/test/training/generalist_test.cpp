// SPDX-License-Identifier: BSD-3-Clause
// The shipped policy, and trainings that begin with its weights.
#include <gtest/gtest.h>

#include <filesystem>

#include "aquafarm/agents/environment/family_environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/planning/optimum.h"
#include "aquafarm/agents/training/run.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents::test {
namespace {

std::shared_ptr<const Scenario> Shipped(const std::string& name, bool tokens) {
  Scenario scenario = LoadScenario(std::string(AQUAFARM_SCENARIO_DIR "/") + name + ".yaml");
  scenario.view.tokens = tokens;
  return std::make_shared<const Scenario>(std::move(scenario));
}

TEST(Generalist, PlaysRanchesThatItHasNeverMet) {
  const SavedPolicy saved = FindPolicy(kGeneralist);
  for (const std::string name : {"paper", "procedural", "zhoushan_storms"}) {
    const auto scenario = Shipped(name, true);
    LocalEnvironment environment(scenario, {16, kFeaturesBit, false, 1});
    const auto policy = MakePolicy(saved, environment.spec());
    const Evaluation evaluation = Evaluate(environment, *policy, 1000, 48);
    EXPECT_GE(evaluation.success_rate, 0.95) << name;
    const OptimumShare share = CompareWithOptimum(
        evaluation.episodes,
        [&scenario](std::uint64_t seed, std::uint64_t episode) {
          Farm farm(scenario);
          farm.Reset(seed, episode);
          return farm;
        },
        1000000, 1, nullptr);
    EXPECT_EQ(share.planned, 48U) << name;
    EXPECT_GT(share.share, 0.85) << name;
    EXPECT_LE(share.share, 1.0 + 1e-6) << name;
    EXPECT_LE(share.low, share.share);
    EXPECT_GE(share.high, share.share);
  }
}

TEST(Generalist, StatesAndTokensGiveTheSameActions) {
  const SavedPolicy saved = FindPolicy(kGeneralist);
  EXPECT_NE(saved.observation_types & kStatesBit, 0);
  LocalEnvironment with(Shipped("procedural", true), {3, kFeaturesBit, false, 1});
  LocalEnvironment without(Shipped("procedural", false), {3, kStatesBit, false, 1});
  const auto by_tokens = MakePolicy(saved, with.spec());
  const auto by_states = MakePolicy(saved, without.spec());
  EXPECT_EQ(by_states->observation_types(), kStatesBit);
  by_tokens->Begin(1, 3);
  by_states->Begin(1, 3);
  const StepResults* seen = &with.Reset(6);
  const StepResults* states = &without.Reset(6);
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> other;
  for (int step = 0; step < 150; ++step) {
    by_tokens->Act(*seen, actions);
    by_states->Act(*states, other);
    ASSERT_EQ(actions, other) << step;
    EXPECT_EQ(by_tokens->values(), by_states->values());
    seen = &with.Step(actions);
    states = &without.Step(other);
  }
}

TEST(Generalist, RefusesSeveralShips) {
  LocalEnvironment environment(Shipped("two_squads", false), {1, kStatesBit, false, 1});
  try {
    MakePolicy(FindPolicy(kGeneralist), environment.spec());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("agents: the policy has 1, the farm has 2; give policy:=planner"),
              std::string::npos)
        << error.what();
  }
}

TEST(Generalist, RefusesARanchWhoseTokensNeedTooMuchMemory) {
  Scenario large = LoadScenario(AQUAFARM_SCENARIO_DIR "/procedural.yaml");
  large.width = large.height = 1000;
  large.devices.count = 20;
  large.view.routes = false;
  LocalEnvironment environment(Shipped("procedural", false), {1, kStatesBit, false, 1});
  EnvironmentSpec spec = environment.spec();
  spec.scenario_yaml = ToYaml(large);
  try {
    MakePolicy(FindPolicy(kGeneralist), spec);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("view.tokens: needs "), std::string::npos)
        << error.what();
  }
}

RunReport FineTune(const std::string& options, bool tokens, const std::string& algorithm = "ppo",
                   const std::string& scenario = "paper") {
  RunOptions run;
  run.algorithm = algorithm;
  run.options = options;
  run.init = kGeneralist;
  run.steps = 200;
  run.evaluation_episodes = 20;
  run.random_episodes = 0;
  run.run_dir = (std::filesystem::path(::testing::TempDir()) / "generalist").string();
  std::filesystem::remove_all(run.run_dir);
  const RunReport report = Train(
      run,
      [&](std::uint8_t observation_types) {
        return MakeLocalFarms(Shipped(scenario, tokens), {8, observation_types, false, 1});
      },
      {}, nullptr);
  std::filesystem::remove_all(run.run_dir);
  return report;
}

// 200 steps are too few to learn anything: the first policy is the generalist's.
TEST(Generalist, ATrainingBeginsWithItsWeights) {
  const RunReport report = FineTune("", true);
  ASSERT_EQ(report.code, ExitCode::kOk) << report.summary;
  EXPECT_GE(report.status.evaluation.success_rate, 0.9);
}

TEST(Generalist, ATrainingOfTwoShipsBeginsWithItsWeights) {
  const RunReport report = FineTune("", true, "ppo", "two_squads");
  ASSERT_EQ(report.code, ExitCode::kOk) << report.summary;
  EXPECT_GE(report.status.evaluation.success_rate, 0.9);
}

TEST(Generalist, AResumedTrainingDoesNotNeedItsInitialPolicy) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "resumed";
  std::filesystem::remove_all(folder);
  const auto train = [&](const std::string& name, const std::string& init, std::uint64_t steps,
                         bool resume) {
    RunOptions run;
    run.algorithm = "ppo";
    run.init = init;
    run.steps = steps;
    run.resume = resume;
    run.evaluation_episodes = run.random_episodes = 0;
    run.run_dir = (folder / name).string();
    return Train(
        run,
        [](std::uint8_t observation_types) {
          return MakeLocalFarms(Shipped("paper", true), {8, observation_types, false, 1});
        },
        {}, nullptr);
  };
  ASSERT_EQ(train("first", kGeneralist, 200, false).code, ExitCode::kOk);
  ASSERT_EQ(train("second", (folder / "first").string(), 200, false).code, ExitCode::kOk);
  std::filesystem::remove_all(folder / "first");
  const RunReport report = train("second", "", 400, true);
  EXPECT_EQ(report.code, ExitCode::kOk) << report.summary;
  EXPECT_GE(report.status.progress.steps, 400U);
  std::filesystem::remove_all(folder);
}

TEST(Generalist, ATrainingThatDoesNotFitIsRefusedInOneLine) {
  const auto expect = [](const RunReport& report, const std::string& words) {
    EXPECT_EQ(report.code, ExitCode::kBadInput);
    EXPECT_NE(report.summary.find(words), std::string::npos) << report.summary;
  };
  expect(FineTune("", false), "the scenario needs view: {tokens: true}");
  expect(FineTune("hidden_size=64", true), "network: got a policy with");
  expect(FineTune("", true, "dqn"), "expected a policy of ppo");
}

}  // namespace
}  // namespace aquafarm::agents::test
