// SPDX-License-Identifier: BSD-3-Clause
// Several ships, and devices that drive themselves.
#include <gtest/gtest.h>

#include "aquafarm/farm/farm.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::Act;
using test::MakeFarm;
using test::TinyScenario;

// Returns a farm with two ships at the port (2,0).
Farm TwoShips(std::int32_t capacity = 1) {
  Scenario scenario = TinyScenario();
  scenario.ships = {2, capacity};
  return MakeFarm(scenario);
}

void Both(Farm& farm, Action first, Action second) {
  const std::uint8_t codes[] = {Act(first), Act(second)};
  farm.Step(codes);
}

TEST(RightOfWay, ShipsShareAPort) {
  Farm farm = TwoShips();
  EXPECT_EQ(farm.ships()[0].cell, farm.ships()[1].cell);
  Both(farm, Action::kNorth, Action::kHold);
  Both(farm, Action::kSouth, Action::kHold);
  EXPECT_EQ(farm.ships()[0].cell, farm.ships()[1].cell);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kOk);
}

TEST(RightOfWay, HeadOnTheLowerIdTakesTheCellBetween) {
  Farm farm = TwoShips();
  for (int i = 0; i < 3; ++i) Both(farm, Action::kNorth, Action::kHold);
  Both(farm, Action::kHold, Action::kNorth);
  Both(farm, Action::kSouth, Action::kNorth);  // from (2,3) and (2,1)
  EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 2}));
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kOk);
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 1}));
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[1].reward, -5.0F);
  // Both continue, but neither can pass.
  Both(farm, Action::kSouth, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 2}));
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 1}));
  EXPECT_EQ(farm.record().collisions, 3);
}

TEST(RightOfWay, OfTwoForOneCellTheLowerIdGoesFirst) {
  Farm farm = TwoShips();
  Both(farm, Action::kNorth, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 1}));
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[1].reward, -5.0F);
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 0}));
}

TEST(RightOfWay, AChainFollowsWhenTheLowerIdLeads) {
  Farm farm = TwoShips();
  Both(farm, Action::kNorth, Action::kHold);
  Both(farm, Action::kNorth, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 2}));
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 1}));
  // On the way back the lower id moves to the cell that the higher one has not left yet.
  Both(farm, Action::kSouth, Action::kSouth);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 0}));
}

TEST(RightOfWay, AChainOfThreeGoesAsFarAsItsLowerIdsLead) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 3;
  const std::uint8_t north[] = {Act(Action::kNorth), Act(Action::kNorth), Act(Action::kNorth)};
  for (const auto& [order, moved] :
       {std::pair{std::array{0, 1, 2}, std::array{true, true, true}},
        std::pair{std::array{2, 1, 0}, std::array{true, false, false}},
        std::pair{std::array{1, 0, 2}, std::array{true, false, false}},
        std::pair{std::array{1, 2, 0}, std::array{true, true, false}}}) {
    Farm farm = MakeFarm(scenario);
    for (std::size_t i = 0; i < 3; ++i) farm.PlaceShip(order[i], {4, 2 - static_cast<int>(i)});
    farm.Step(north);
    for (std::size_t i = 0; i < 3; ++i) {
      const Ship& ship = farm.ships()[static_cast<std::size_t>(order[i])];
      EXPECT_EQ(ship.cell, (Cell{4, 2 - static_cast<int>(i) + (moved[i] ? 1 : 0)})) << order[i];
      EXPECT_EQ(ship.outcome, moved[i] ? Outcome::kOk : Outcome::kCollision) << order[i];
    }
  }
}

TEST(RightOfWay, ASwapIsBlockedForBoth) {
  Farm farm = TwoShips();
  Both(farm, Action::kNorth, Action::kHold);
  Both(farm, Action::kNorth, Action::kNorth);
  Both(farm, Action::kSouth, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 2}));
  EXPECT_EQ(farm.ships()[1].cell, (Cell{2, 1}));
  EXPECT_EQ(farm.record().collisions, 2);
}

TEST(RightOfWay, TheShipInADevicesCellHasItAlone) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  scenario.devices.sites[0].cell = {2, 1};
  scenario.ports.cells = {{2, 0}, {3, 0}};
  Farm farm = MakeFarm(scenario);
  for (int i = 0; i < 3 && farm.ships()[0].cell != Cell{2, 1}; ++i) {
    Both(farm, farm.ships()[0].cell.x == 3 ? Action::kNorthWest : Action::kNorth, Action::kHold);
  }
  const Action there =
      farm.ships()[1].cell.x == 3 ? Action::kNorthWest : Action::kNorth;  // to the same cell
  const Cell before = farm.ships()[1].cell;
  Both(farm, Action::kHold, there);
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kCollision);
  EXPECT_EQ(farm.ships()[1].cell, before);
  Both(farm, Action::kPickup, Action::kPickup);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kOk);
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kIllegalPickup);
  Both(farm, Action::kNorth, there);
  ASSERT_EQ(farm.ships()[1].cell, (Cell{2, 1}));
  Both(farm, Action::kHold, Action::kPickup);  // the device is gone
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kIllegalPickup);
  EXPECT_EQ(farm.ships()[1].aboard, 0);
  EXPECT_EQ(farm.ships()[0].aboard, 1);
}

TEST(RightOfWay, BothMayDropOffAtOnePort) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  scenario.devices.sites = {{{2, 1}, DeviceKind::kMonitoring, 50.0F, false},
                            {{2, 2}, DeviceKind::kMonitoring, 60.0F, false}};
  Farm farm = MakeFarm(scenario);
  Both(farm, Action::kNorth, Action::kHold);
  Both(farm, Action::kNorth, Action::kNorth);
  Both(farm, Action::kPickup, Action::kPickup);
  Both(farm, Action::kHold, Action::kSouth);
  Both(farm, Action::kSouth, Action::kHold);
  Both(farm, Action::kSouth, Action::kHold);
  Both(farm, Action::kDropOff, Action::kDropOff);
  EXPECT_EQ(farm.ships()[0].reward, 80.0F);
  EXPECT_EQ(farm.ships()[1].reward, 70.0F);
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
}

TEST(RightOfWay, ATeamSharesTheSum) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 2;
  scenario.rewards.sharing = RewardSharing::kTeam;
  Farm farm = MakeFarm(scenario);
  Both(farm, Action::kNorth, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].reward, -6.0F);
  EXPECT_EQ(farm.ships()[1].reward, -6.0F);
  EXPECT_EQ(farm.record().episode_return, -6.0F);
}

TEST(SelfPropelled, DevicesAreShipsThatDeliverThemselvesAndLeave) {
  Scenario scenario = TinyScenario();
  scenario.devices.sites.push_back({{3, 1}, DeviceKind::kBreedingRelease, 90.0F, true});
  Farm farm = MakeFarm(scenario);
  ASSERT_EQ(farm.ships().size(), 2U);
  EXPECT_EQ(farm.ships()[1].cell, (Cell{3, 1}));
  EXPECT_EQ(farm.ships()[1].own_device, 1);
  Both(farm, Action::kNorth, Action::kSouthWest);
  EXPECT_EQ(farm.CellOf(1), (Cell{2, 0}));
  EXPECT_EQ(farm.LegalActions(1), kMoveMask | MaskOf(Action::kDropOff));
  Both(farm, Action::kNorth, Action::kDropOff);
  EXPECT_EQ(farm.ships()[1].reward, 110.0F);
  EXPECT_FALSE(farm.ships()[1].active);
  EXPECT_FALSE(farm.over());
  Both(farm, Action::kPickup, Action::kNorth);
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kOutOfPlay);
  EXPECT_EQ(farm.ships()[1].reward, 0.0F);
}

TEST(SelfPropelled, DevicesCannotBePickedUp) {
  Scenario scenario = TinyScenario();
  scenario.ships.count = 1;
  scenario.devices.sites = {{{2, 0}, DeviceKind::kMonitoring, 90.0F, true}};
  scenario.ports.cells = {{2, 0}};
  scenario.devices.sites[0].cell = {2, 1};
  Farm farm = MakeFarm(scenario);
  Both(farm, Action::kHold, Action::kPickup);
  EXPECT_EQ(farm.ships()[1].outcome, Outcome::kIllegalPickup);
  Both(farm, Action::kHold, Action::kSouth);
  Both(farm, Action::kPickup, Action::kHold);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kIllegalPickup);
}

}  // namespace
}  // namespace aquafarm
