// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/rollout_values.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "evaluation/clairvoyant.h"

namespace aquafarm::agents::test {
namespace {

RolloutValues OfPlanner(const std::shared_ptr<const Scenario>& scenario,
                        std::int32_t episodes = 1) {
  return PlayValues(scenario, kStatesBit, Plan, 3, 0, episodes);
}

// The device at (2, 2) has value 80, the port is at (2, 0).
TEST(RolloutValues, AreWhatTheEpisodePaysFromEachCell) {
  const RolloutValues values = OfPlanner(TinyFarm());
  ASSERT_EQ(values.value.size(), 25U);
  const auto at = [&](int x, int y) { return values.value[static_cast<std::size_t>(5 * y + x)]; };
  EXPECT_EQ(at(2, 2), 20.0 - 2.0 + 20.0 + 80.0) << "pick up, two steps, drop off";
  EXPECT_EQ(at(2, 0), 118.0 - 2.0);
  EXPECT_EQ(at(4, 4), 118.0 - 3.0) << "around the rock at (3, 3)";
  EXPECT_TRUE(std::isnan(at(0, 0))) << "an island";
  EXPECT_TRUE(std::isnan(at(3, 3))) << "a rock";
}

// Eq. 10 on a farm without chance: the sum of γ^t r_t from each cell.
TEST(RolloutValues, AreDiscountedByStep) {
  const RolloutValues values = PlayValues(TinyFarm(), kStatesBit, Plan, 3, 0, 1, nullptr, 0.5);
  const auto at = [&](int x, int y) { return values.value[static_cast<std::size_t>(5 * y + x)]; };
  // Pick up for 20, two steps of -1, drop off for 100.
  const double laden = 20.0 - 0.5 - 0.25 + 0.125 * 100.0;
  EXPECT_NEAR(at(2, 2), laden, 1e-9);
  EXPECT_NEAR(at(2, 1), -1.0 + 0.5 * laden, 1e-9);
  EXPECT_NEAR(at(2, 0), -1.0 - 0.5 + 0.25 * laden, 1e-9);
  EXPECT_EQ(PlayValues(TinyFarm(), kStatesBit, Plan, 3, 0, 1, nullptr, 0.0).value[12], 20.0)
      << "the immediate reward alone (Eq. 3)";
  Scenario team = aquafarm::test::TinyScenario();
  team.step_limit = 60;
  team.rewards.sharing = RewardSharing::kTeam;
  EXPECT_EQ(PlayValues(Share(team), kStatesBit, Plan, 3, 0, 1, nullptr, 0.5).value[12],
            values.value[12]);
}

TEST(RolloutValues, AreTheMeanOfEpisodes) {
  EXPECT_EQ(OfPlanner(TinyFarm(), 3).value[12], OfPlanner(TinyFarm()).value[12]);
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.layout = LayoutMode::kPerEpisode;
  EXPECT_EQ(MessageOf<InputError>([&] { OfPlanner(Share(scenario), 2); }),
            "values: got layout.mode per_episode, expected fixed to average over 2 "
            "episodes");
}

using ValuesFile = FolderTest;

TEST_F(ValuesFile, HasTheSeaPortsAndDevicesNextToThem) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 60;
  SeaLayer warmth{"warmth", "degC", std::vector<float>(25, 21.5F)};
  warmth.values[24] = std::nanf("");
  scenario.seas = SeaSpec{{warmth}, {}, {}};
  const auto shared = Share(scenario);
  const std::string path = folder_ + "/values.json";
  WriteValues(path, OfPlanner(shared), "clairvoyant", *shared);
  const auto text = nlohmann::json::parse(ReadFile(path));
  EXPECT_EQ(text.at("scenario_hash").get<std::uint64_t>(), shared->hash);
  EXPECT_EQ(text.at("values").size(), 5U);
  EXPECT_TRUE(text.at("values")[0][0].is_null());
  EXPECT_EQ(text.at("values")[2][2], 118.0);
  EXPECT_EQ(text.at("ports"), nlohmann::json::parse("[[2, 0]]"));
  EXPECT_EQ(text.at("devices"), nlohmann::json::parse("[[2, 2]]"));
  EXPECT_EQ(text.at("seas")[0].at("units"), "degC");
  EXPECT_EQ(text.at("seas")[0].at("values")[0][0], 21.5);
  EXPECT_TRUE(text.at("seas")[0].at("values")[4][4].is_null());
}

}  // namespace
}  // namespace aquafarm::agents::test
