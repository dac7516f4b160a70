// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/evaluation.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/learning/random_policy.h"

namespace aquafarm::agents::test {
namespace {

/// Moves north to the device and returns it south: solves the tiny farm in six steps.
class Scripted final : public Policy {
 public:
  std::uint8_t observation_types() const override { return 0; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    step_.assign(static_cast<std::size_t>(farms), 0);
  }
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    constexpr std::array<std::uint8_t, 6> kPlan{0, 0, 8, 1, 1, 9};
    actions.assign(step_.size(), 0);
    for (std::size_t i = 0; i < step_.size(); ++i) {
      if (results.is_first[i] != 0) step_[i] = 0;
      actions[i] = kPlan[step_[i]++ % kPlan.size()];
    }
  }

 private:
  std::vector<std::size_t> step_;
};

TEST(Evaluate, PlaysSeedsThatNoTrainingHas) {
  EXPECT_NE(EvaluationSeed(5), 5U);
  EXPECT_EQ(EvaluationSeed(5) & kEvaluationSeedBit, kEvaluationSeedBit);
  LocalEnvironment environment(TinyFarm(), {2, 0, false, 1});
  Scripted policy;
  const Evaluation evaluation = Evaluate(environment, policy, 5, 3);
  for (const EpisodeSummary& result : evaluation.episodes) {
    EXPECT_EQ(result.seed, EvaluationSeed(5));
  }
}

TEST(Evaluate, MeasuresWhatHappened) {
  LocalEnvironment environment(TinyFarm(), {3, 0, false, 1});
  Scripted policy;
  const Evaluation evaluation = Evaluate(environment, policy, 1, 10);
  EXPECT_TRUE(evaluation.complete);
  ASSERT_EQ(evaluation.episodes.size(), 10U);
  EXPECT_EQ(evaluation.success_rate, 1.0);
  EXPECT_EQ(evaluation.mean_steps, 6.0);
  // Four steps at −1, pickup 20, drop-off 20 and the device's value 80.
  EXPECT_NEAR(evaluation.mean_return, 116.0, 1e-4);
  EXPECT_NEAR(evaluation.return_per_step, 116.0 / 6.0, 1e-4);
  EXPECT_EQ(evaluation.mean_delivered_health, 1.0);
}

TEST(Evaluate, CountsTheOutcomesOfEachDevice) {
  LocalEnvironment environment(TinyFarm(), {3, 0, false, 1});
  Scripted policy;
  DeviceOutcomes outcomes;
  const AccountsOf look = [&](std::int32_t farm) -> std::optional<Accounts> {
    outcomes.Add(environment.batch().farm(farm).devices());
    return std::nullopt;
  };
  Evaluate(environment, policy, 1, 10, nullptr, {}, std::nullopt, look);
  ASSERT_EQ(outcomes.by_id.size(), 1U);
  EXPECT_TRUE(outcomes.are_same);
  EXPECT_EQ(outcomes.by_id[0].devices, 10);
  EXPECT_EQ(outcomes.by_id[0].delivered, 10);
  EXPECT_EQ(outcomes.by_id[0].delivered_health, 10.0);
  EXPECT_EQ(outcomes.by_id[0].Left(), 0);
}

TEST(DeviceOutcomes, DistinguishAboardAndLeft) {
  DeviceOutcomes outcomes;
  std::vector<Device> devices(2);
  devices[0].status = DeviceStatus::kAboard;
  outcomes.Add(devices);
  devices[0].status = DeviceStatus::kDelivered;
  devices[0].health = 0.25F;
  outcomes.Add(devices);
  EXPECT_EQ(outcomes.by_id[0].aboard, 1);
  EXPECT_EQ(outcomes.by_id[0].delivered, 1);
  EXPECT_EQ(outcomes.by_id[0].delivered_health, 0.25);
  EXPECT_EQ(outcomes.by_id[1].Left(), 2);
  EXPECT_TRUE(outcomes.are_same);
}

TEST(DeviceOutcomes, OfEpisodesWithOtherDevicesAreByKind) {
  std::vector<Device> devices(2);
  devices[0].kind = devices[1].kind = DeviceKind::kMonitoring;
  DeviceOutcomes of_other_kinds;
  of_other_kinds.Add(devices);
  devices[1].kind = DeviceKind::kBreedingRelease;
  devices[1].status = DeviceStatus::kDelivered;
  of_other_kinds.Add(devices);
  EXPECT_FALSE(of_other_kinds.are_same);
  const auto& tally = of_other_kinds.by_kind[static_cast<std::size_t>(DeviceKind::kMonitoring)];
  EXPECT_EQ(tally.devices, 3);
  EXPECT_EQ(tally.Left(), 3);
  DeviceOutcomes of_other_numbers;
  of_other_numbers.Add(devices);
  devices.pop_back();
  of_other_numbers.Add(devices);
  EXPECT_FALSE(of_other_numbers.are_same);
}

TEST(Evaluate, CountsEpisodesThatStartDifferently) {
  Scripted policy;
  LocalEnvironment same(TinyFarm(), {3, 0, false, 1});
  const Evaluation repeated = Evaluate(same, policy, 1, 10);
  EXPECT_EQ(repeated.distinct, 1U) << "one layout, one port, no disaster";
  EXPECT_CONTAINS(Describe(repeated), "(10 episodes, 1 distinct)");
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.disasters.emplace_back();  // starts anywhere
  LocalEnvironment environment(Share(scenario), {3, 0, false, 1});
  EXPECT_EQ(Evaluate(environment, policy, 1, 10).distinct, 10U);
}

TEST(Evaluate, DescribesTheIntervalOfTheMeanReturnFromDistinctStarts) {
  Evaluation evaluation;
  for (const float value : {90.0F, 110.0F, 90.0F, 110.0F}) {
    evaluation.episodes.emplace_back().episode_return = value;
  }
  evaluation.mean_return = 100.0;
  evaluation.distinct = 4;  // deviation 11.547, standard error 5.774
  EXPECT_CONTAINS(Describe(evaluation), "return 100.0 [95 %: 88.7, 111.3] per episode");
  evaluation.distinct = 2;  // the other two are repetitions
  EXPECT_CONTAINS(Describe(evaluation), "return 100.0 [95 %: 84.0, 116.0] per episode");
  evaluation.distinct = 1;
  EXPECT_CONTAINS(Describe(evaluation), "return 100.0 per episode");
  evaluation.success_rate = 0.9997;
  EXPECT_CONTAINS(Describe(evaluation), "success 99.9 %");
  evaluation.success_rate = 1.0;
  EXPECT_CONTAINS(Describe(evaluation), "success 100.0 %");
}

TEST(Evaluate, DoesNotDependOnTheNumberOfFarms) {
  const auto farm = Share(aquafarm::test::CrowdedScenario(2));
  std::vector<float> returns[2];
  for (const std::int32_t farms : {1, 7}) {
    LocalEnvironment environment(farm, {farms, 0, false, 1});
    class North final : public Policy {
     public:
      std::uint8_t observation_types() const override { return 0; }
      void Begin(std::uint64_t, std::int32_t) override {}
      void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
        actions.assign(results.rewards.size(), 5);
      }
    } policy;
    for (const EpisodeSummary& result : Evaluate(environment, policy, 1, 9).episodes) {
      returns[farms == 1 ? 0 : 1].push_back(result.episode_return);
    }
  }
  EXPECT_EQ(returns[0], returns[1]);
}

TEST(Evaluate, StopsWhenAsked) {
  LocalEnvironment environment(TinyFarm(), {1, 0, false, 1});
  RandomPolicy policy(environment.spec());
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(Evaluate(environment, policy, 1, 10, &stop).complete);
}

TEST(Evaluate, DrawsActionsFromASeedOfTheirOwnIfGiven) {
  const auto mean = [](std::optional<std::uint64_t> policy_seed) {
    LocalEnvironment environment(TinyFarm(), {2, 0, false, 1});
    RandomPolicy policy(environment.spec());
    return Evaluate(environment, policy, 1, 10, nullptr, {}, policy_seed).mean_return;
  };
  EXPECT_EQ(mean(7), mean(7));
  EXPECT_NE(mean(7), mean(8));
  EXPECT_EQ(mean(std::nullopt), mean(EvaluationSeed(1)));
}

using EvaluationFiles = FolderTest;

TEST_F(EvaluationFiles, HaveDevicesByIdOrByKind) {
  const auto written = [this](bool are_same) {
    Evaluation evaluation;
    evaluation.episodes.resize(1);
    evaluation.devices.are_same = are_same;
    evaluation.devices.Add(std::vector<Device>(2));
    WriteEvaluation(folder_ + "/e", evaluation, {});
    return nlohmann::json::parse(ReadFile(folder_ + "/e.json"));
  };
  const auto by_id = written(true);
  ASSERT_EQ(by_id.at("devices").size(), 2U);
  EXPECT_EQ(by_id.at("devices").at(1).at("id"), 1);
  EXPECT_EQ(by_id.at("devices").at(1).at("episodes"), 1);
  EXPECT_FALSE(by_id.contains("devices_by_kind"));
  const auto by_kind = written(false);
  ASSERT_EQ(by_kind.at("devices_by_kind").size(), 1U);
  EXPECT_EQ(by_kind.at("devices_by_kind").at(0).at("devices"), 2);
  EXPECT_EQ(by_kind.at("devices_by_kind").at(0).at("left"), 2);
  EXPECT_FALSE(by_kind.contains("devices"));
}

TEST_F(EvaluationFiles, HoldWhatIsNeededToDoItAgain) {
  LocalEnvironment environment(TinyFarm(), {2, 0, false, 1});
  Scripted policy;
  const Evaluation evaluation = Evaluate(environment, policy, 4, 5);
  WriteEvaluation(folder_ + "/e", evaluation, {"p.ckpt", "scripted", 9, "tiny", 77, "0.1.0", 2});
  const auto json = nlohmann::json::parse(ReadFile(folder_ + "/e.json"));
  EXPECT_EQ(json.at("seed"), 4);
  EXPECT_EQ(json.at("episodes"), 5);
  EXPECT_EQ(json.at("distinct_episodes"), 1);
  EXPECT_EQ(json.at("scenario_hash"), 77);
  EXPECT_EQ(json.at("success_rate"), 1.0);
  EXPECT_EQ(json.at("energy_kwh_per_episode"), 0.0);
  EXPECT_NEAR(json.at("distance_km_per_episode").get<double>(), evaluation.episodes[0].distance,
              1e-9);
  EXPECT_GT(evaluation.episodes[0].distance, 1.0);
  std::ifstream csv(folder_ + "/e.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_CONTAINS(line, "farm,seed,episode,steps,return");
  EXPECT_CONTAINS(line, ",success,energy_kwh,distance_km");
  int rows = 0;
  while (std::getline(csv, line)) {
    EXPECT_CONTAINS(line, ",all_retrieved,1");
    ++rows;
  }
  EXPECT_EQ(rows, 5);
}

}  // namespace
}  // namespace aquafarm::agents::test
