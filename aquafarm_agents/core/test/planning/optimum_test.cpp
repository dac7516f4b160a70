// SPDX-License-Identifier: BSD-3-Clause
// The share of the optimum that a policy reaches, and the refusals of bounds.
#include "aquafarm/agents/planning/optimum.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "agents_fixture.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

// Farms whose best plan earns `value` of the device, less a cost per step.
Farm FarmWorth(float value, std::uint64_t episode) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.devices.sites.front().value = value;
  scenario.rewards.step = -30.0F;
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.Reset(1, episode);
  return farm;
}

TEST(CompareWithOptimum, RefusesAnOptimumThatIsNotPositive) {
  const auto poor = [](std::uint64_t, std::uint64_t episode) { return FarmWorth(10.0F, episode); };
  const std::string message = test::MessageOf<InputError>(
      [&] { CompareWithOptimum({EpisodeSummary{}}, poor, 1000000, 1, nullptr); });
  EXPECT_CONTAINS(message, "optimum: the best plans have the mean return -");
}

TEST(CompareWithOptimum, CountsOnlyLargeEpisodesAsTooLarge) {
  const auto message_for = [](const std::function<void(Scenario&)>& change) {
    const auto make = [&change](std::uint64_t seed, std::uint64_t episode) {
      Scenario scenario = aquafarm::test::TinyScenario();
      change(scenario);
      Farm farm(std::make_shared<const Scenario>(scenario));
      farm.Reset(seed, episode);
      return farm;
    };
    OptimumShare share;
    const std::string message = test::MessageOf<InputError>(
        [&] { share = CompareWithOptimum({EpisodeSummary{}}, make, 1, 1, nullptr); });
    EXPECT_EQ(share.too_large, message.empty() ? 1U : 0U);
    return message;
  };
  EXPECT_EQ(message_for([](Scenario&) {}), "") << "more than one state";
  EXPECT_CONTAINS(message_for([](Scenario& scenario) { scenario.ships.count = 2; }),
                  "optimum: got 2 agents, expected one");
}

TEST(CompareWithOptimum, RefusesRewardsThatHaveNoBestPlan) {
  const auto make = [](std::uint64_t seed, std::uint64_t episode) {
    Scenario scenario = aquafarm::test::TinyScenario();
    scenario.rewards.step = 1.0F;
    Farm farm(std::make_shared<const Scenario>(scenario));
    farm.Reset(seed, episode);
    return farm;
  };
  EXPECT_CONTAINS(test::MessageOf<InputError>(
                      [&] { CompareWithOptimum({EpisodeSummary{}}, make, 1000000, 1, nullptr); }),
                  "planner: rewards.step: got more than 0");
}

TEST(TeamBound, RefusesADropOffThatCostsIfShipsCarrySeveralDevices) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.rewards.drop_off = -2.0F;
  scenario.ships.capacity = 2;
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.Reset(1, 0);
  EXPECT_CONTAINS(test::MessageOf<InputError>([&] { TeamBound(farm); }),
                  "bound: rewards.drop_off: got less than 0 with ships.capacity 2");
}

TEST(CompareWithOptimum, SkipsResamplesWithoutAPositiveOptimum) {
  std::vector<EpisodeSummary> episodes(2);
  episodes[1].episode = 1;
  for (EpisodeSummary& episode : episodes) episode.episode_return = -1.0F;
  const auto mixed = [](std::uint64_t, std::uint64_t episode) {
    return FarmWorth(episode == 0 ? 10000.0F : 10.0F, episode);
  };
  const OptimumShare share = CompareWithOptimum(episodes, mixed, 1000000, 1, nullptr);
  EXPECT_LE(share.low, share.share);
  EXPECT_GT(share.high, share.share);
  EXPECT_LT(share.high, 0.0);  // a loss on ranches that are worth something
}

}  // namespace
}  // namespace aquafarm::agents
