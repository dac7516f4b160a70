// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/route.h"

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/learning/tabular.h"
#include "evaluation/clairvoyant.h"

namespace aquafarm::agents::test {
namespace {

// The device is two cells north of the port: pickup and delivery take six steps.
TEST(Route, IsTheEpisodeAndTheBestMoveOfEveryFreeCell) {
  const Route route = TraceRoute(TinyFarm(), kStatesBit, Plan, 3, 0);
  ASSERT_EQ(route.steps.size(), 7U);
  EXPECT_EQ(route.steps.front().cell, (Cell{2, 0}));
  EXPECT_EQ(route.steps[2].cell, (Cell{2, 2}));
  EXPECT_EQ(route.steps[3].aboard, 1);
  EXPECT_EQ(route.steps.back().cell, (Cell{2, 0}));
  EXPECT_EQ(route.steps.back().delivered, 1);
  EXPECT_TRUE(route.result.Success());
  // 25 cells minus four island cells and a rock.
  ASSERT_EQ(route.at_start.size(), 20U);
  ASSERT_EQ(route.after_pickup.size(), 20U);
  const auto of = [](const std::vector<GreedyAction>& moves, Cell cell) {
    for (const GreedyAction& move : moves) {
      if (move.cell == cell) return static_cast<Action>(move.action);
    }
    return Action::kHold;
  };
  EXPECT_EQ(of(route.at_start, {2, 2}), Action::kPickup);
  EXPECT_EQ(of(route.at_start, {2, 1}), Action::kNorth);
  EXPECT_EQ(of(route.at_start, {1, 3}), Action::kSouthEast);
  EXPECT_EQ(of(route.after_pickup, {2, 0}), Action::kDropOff);
  EXPECT_EQ(of(route.after_pickup, {3, 1}), Action::kSouthWest);
}

TEST(GreedyActions, OfATableCarryItsValues) {
  LocalEnvironment environment(TinyFarm(), {1, kIndexBit, false, 1});
  QTable table(environment.spec(), -1.0F);
  for (std::uint32_t state = 0; state < table.states; ++state) {
    table.values[table.Row(0, state) + 3] = static_cast<float>(state);  // east
  }
  GreedyTabularPolicy policy(table, false);
  const std::uint32_t here = environment.Reset(3, 0).index[0];
  const Farm& farm = environment.batch().farm(0);
  const std::vector<GreedyAction> moves = GreedyActions(farm, kIndexBit, policy);
  ASSERT_EQ(moves.size(), 20U);
  std::set<float> values;
  for (const GreedyAction& move : moves) {
    EXPECT_EQ(static_cast<Action>(move.action), Action::kEast);
    if (move.cell == farm.ships()[0].cell) {
      EXPECT_EQ(move.value, static_cast<float>(here));
    }
    values.insert(move.value);
  }
  EXPECT_EQ(values.size(), 20U);  // each cell is a distinct state
}

TEST(GreedyActions, OfAPlannerHaveNoValuesAndMayBeStopped) {
  LocalEnvironment environment(TinyFarm(), {1, kStatesBit, false, 1});
  const auto policy = Plan(environment.spec());
  environment.Reset(3, 0);
  const Farm& farm = environment.batch().farm(0);
  EXPECT_TRUE(std::isnan(GreedyActions(farm, kStatesBit, *policy).front().value));
  const std::atomic<bool> stop{true};
  EXPECT_TRUE(GreedyActions(farm, kStatesBit, *policy, &stop).empty());
}

using RouteFile = FolderTest;

TEST_F(RouteFile, SaysWhatFarmAndEpisodeItWas) {
  const auto scenario = TinyFarm();
  const LocalEnvironment environment(scenario, {1, 0, false, 1});
  WriteRoute(folder_ + "/route.json", TraceRoute(scenario, kStatesBit, Plan, 3, 0),
             environment.spec());
  const auto text = nlohmann::json::parse(ReadFile(folder_ + "/route.json"));
  EXPECT_EQ(text.at("scenario_hash").get<std::uint64_t>(), environment.spec().scenario_hash);
  EXPECT_EQ(text.at("reason"), "all_retrieved");
  EXPECT_EQ(text.at("chart").at("ports"), nlohmann::json::parse("[[2, 0]]"));
  EXPECT_EQ(text.at("steps").size(), 7U);
  EXPECT_EQ(text.at("actions"), nlohmann::json::parse("[0, 0, 8, 1, 1, 9]"));
  EXPECT_EQ(text.at("steps")[2].at("action"), "pickup");
  EXPECT_EQ(text.at("best_moves_after_pickup").size(), 20U);
}

}  // namespace
}  // namespace aquafarm::agents::test
