// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "agents_fixture.h"
#include "environment_contract.h"

namespace aquafarm::agents::test {
namespace {

EnvironmentOptions Everything(std::int32_t farms, std::int32_t threads = 1) {
  return {farms, kIndexBit | kFeaturesBit | kPlanesBit, true, threads};
}

TEST(LocalEnvironment, KeepsTheContractOnATinyFarm) {
  LocalEnvironment environment(TinyFarm(), Everything(3));
  RunEnvironmentContract(environment);
}

TEST(LocalEnvironment, KeepsTheContractWithShipsDisastersAndChangingLayouts) {
  LocalEnvironment environment(Share(aquafarm::test::CrowdedScenario(2)), Everything(4));
  RunEnvironmentContract(environment, 600, false);
}

TEST(LocalEnvironment, KeepsTheContractOnPaper) {
  LocalEnvironment environment(Paper(), {2, kIndexBit, true, 1});
  RunEnvironmentContract(environment, 2500);
}

TEST(LocalEnvironment, ThreadsChangeNothing) {
  LocalEnvironment one(Share(aquafarm::test::CrowdedScenario(2)), Everything(5, 1));
  LocalEnvironment two(Share(aquafarm::test::CrowdedScenario(2)), Everything(5, 2));
  RandomActions random(3);
  ExpectSame(one.Reset(1), two.Reset(1));
  for (int i = 0; i < 300; ++i) {
    const auto actions = random.Next(SlotCount(one.spec()));
    ExpectSame(one.Step(actions), two.Step(actions));
  }
}

TEST(LocalEnvironment, GivesOnlyWhatWasAskedFor) {
  LocalEnvironment environment(TinyFarm(), {2, kFeaturesBit, false, 1});
  const StepResults& results = environment.Reset(1);
  EXPECT_TRUE(results.index.empty());
  EXPECT_TRUE(results.planes.empty());
  EXPECT_TRUE(results.hashes.empty());
  EXPECT_EQ(results.features.size(),
            2U * static_cast<std::size_t>(environment.spec().feature_count));
}

// The oracle is the same farm with individual rewards.
TEST(LocalEnvironment, SplitsTheTeamRewardByAgent) {
  Scenario team = aquafarm::test::CrowdedScenario(2);
  team.rewards.sharing = RewardSharing::kTeam;
  LocalEnvironment shared(Share(team), {3, kIndexBit, false, 1});
  LocalEnvironment own(Share(team), {3, kIndexBit | kOwnRewardsBit, false, 1});
  LocalEnvironment each(Share(aquafarm::test::CrowdedScenario(2)), {3, kIndexBit, false, 1});
  EXPECT_TRUE(shared.spec().team_reward);
  EXPECT_FALSE(own.spec().team_reward);
  EXPECT_EQ(own.spec().scenario_hash, shared.spec().scenario_hash);
  RandomActions random(3);
  shared.Reset(1);
  own.Reset(1);
  each.Reset(1);
  bool differ = false;
  for (int i = 0; i < 300; ++i) {
    const auto actions = random.Next(SlotCount(own.spec()));
    const StepResults& results = own.Step(actions);
    ASSERT_EQ(results.rewards, each.Step(actions).rewards);
    differ = differ || results.rewards != shared.Step(actions).rewards;
  }
  EXPECT_TRUE(differ);
  const std::vector<float> rewards = own.Load(own.Save()).rewards;
  EXPECT_EQ(rewards, each.Load(each.Save()).rewards);
}

TEST(LocalEnvironment, RefusesATableOfTooManyStates) {
  Scenario scenario;
  scenario.devices.count = 30;
  EXPECT_CONTAINS(MessageOf<InputError>([&] {
                    LocalEnvironment environment(Share(scenario), {1, kIndexBit, false, 1});
                  }),
                  "too many states for a table");
}

}  // namespace
}  // namespace aquafarm::agents::test
