// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/farm.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "aquafarm/base/check.h"
#include "oracle_farm.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::Act;
using test::CrowdedScenario;
using test::MakeFarm;
using test::RandomSteps;
using test::StepOne;
using test::StillDisaster;
using test::TinyScenario;

Farm TinyFarm() { return MakeFarm(TinyScenario()); }

// Moves from the port (2,0) north to the device at (2,2) and picks it up.
void FetchTheDevice(Farm& farm) {
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kPickup);
}

TEST(Step, AQuietMoveCostsTheStep) {
  Farm farm = TinyFarm();
  const Ship& ship = StepOne(farm, Action::kNorth);
  EXPECT_EQ(ship.cell, (Cell{2, 1}));
  EXPECT_EQ(ship.outcome, Outcome::kOk);
  EXPECT_EQ(ship.terms.step, -1.0F);
  EXPECT_EQ(ship.reward, -1.0F);
  EXPECT_EQ(farm.step(), 1);
}

TEST(Step, AMoveOffTheMapStaysAndCostsTheStep) {
  Farm farm = TinyFarm();
  const Ship& ship = StepOne(farm, Action::kSouth);
  EXPECT_EQ(ship.cell, (Cell{2, 0}));
  EXPECT_EQ(ship.outcome, Outcome::kEdge);
  EXPECT_EQ(ship.reward, -1.0F);
}

TEST(Step, ACrashOnAnIslandCostsTwentyAndNothingElse) {
  Farm farm = TinyFarm();
  const Ship& ship = StepOne(farm, Action::kWest);
  EXPECT_EQ(ship.cell, (Cell{2, 0}));
  EXPECT_EQ(ship.outcome, Outcome::kCrash);
  EXPECT_EQ(ship.terms.crash, -20.0F);
  EXPECT_EQ(ship.reward, -20.0F);
  EXPECT_EQ(farm.record().crashes, 1);
}

TEST(Step, ACrashOnARockCostsTheRocksOwnReward) {
  Farm farm = TinyFarm();
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kNorth);
  const Ship& ship = StepOne(farm, Action::kNorthEast);
  EXPECT_EQ(ship.outcome, Outcome::kCrash);
  EXPECT_EQ(ship.reward, -4.0F);
}

TEST(Step, ACrashHurtsWhatIsAboardByAHundredthOfTheRock) {
  Farm farm = TinyFarm();
  FetchTheDevice(farm);
  StepOne(farm, Action::kNorthEast);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.96F);
}

TEST(Step, ACrashOnAnIslandCostsAFifthOfHealthAndNeverMoreThanAll) {
  Farm farm = TinyFarm();
  FetchTheDevice(farm);
  StepOne(farm, Action::kSouth);  // (2,1), east of the island
  for (int crash = 0; crash < 7; ++crash) StepOne(farm, Action::kWest);
  EXPECT_EQ(farm.devices()[0].health, 0.0F);
}

TEST(Step, PickupOnADevicePaysTwenty) {
  Farm farm = TinyFarm();
  FetchTheDevice(farm);
  const Ship& ship = farm.ships()[0];
  EXPECT_EQ(ship.outcome, Outcome::kOk);
  EXPECT_EQ(ship.reward, 20.0F);
  EXPECT_EQ(ship.aboard, 1);
  EXPECT_EQ(farm.devices()[0].status, DeviceStatus::kAboard);
  EXPECT_EQ(farm.CellOf(0), ship.cell);
}

TEST(Step, PickupAwayFromADeviceCostsTen) {
  Farm farm = TinyFarm();
  const Ship& ship = StepOne(farm, Action::kPickup);
  EXPECT_EQ(ship.outcome, Outcome::kIllegalPickup);
  EXPECT_EQ(ship.reward, -10.0F);
  EXPECT_EQ(ship.terms.step, 0.0F);
}

TEST(Step, DropOffAtAPortPaysTwentyAndHealthTimesValue) {
  Farm farm = TinyFarm();
  FetchTheDevice(farm);
  StepOne(farm, Action::kSouth);
  StepOne(farm, Action::kSouth);
  const Ship& ship = StepOne(farm, Action::kDropOff);
  EXPECT_EQ(ship.reward, 20.0F + 80.0F);
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
  EXPECT_TRUE(farm.record().Success());
  EXPECT_EQ(farm.record().episode_return, -1.0F * 4 + 20 + 100);
}

TEST(Step, DropOffAtSeaOrWithNothingAboardCostsTen) {
  Farm farm = TinyFarm();
  EXPECT_EQ(StepOne(farm, Action::kDropOff).outcome, Outcome::kIllegalDropOff);
  FetchTheDevice(farm);
  EXPECT_EQ(StepOne(farm, Action::kDropOff).reward, -10.0F);
  EXPECT_EQ(farm.ships()[0].aboard, 1);
}

TEST(Step, AfterTheEndIsAProgrammersMistake) {
  Scenario scenario = TinyScenario();
  scenario.step_limit = 1;
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  EXPECT_EQ(farm.reason(), EndReason::kStepLimit);
  EXPECT_THROW(StepOne(farm, Action::kNorth), LogicError);
}

TEST(Step, AnActionThatIsNoneIsAProgrammersMistake) {
  Farm farm = TinyFarm();
  const std::uint8_t code = 250;
  EXPECT_THROW(farm.Step(&code), LogicError);
}

TEST(Step, HoldingStaysAndCostsTheStep) {
  Farm farm = TinyFarm();
  const Ship& ship = StepOne(farm, Action::kHold);
  EXPECT_EQ(ship.outcome, Outcome::kHeld);
  EXPECT_EQ(ship.cell, (Cell{2, 0}));
  EXPECT_EQ(ship.reward, -1.0F);
}

TEST(PlaceShip, PutsItOnFreeWaterAloneAndItContinuesFromThere) {
  auto scenario = TinyScenario();
  scenario.ships.count = 2;
  Farm farm = MakeFarm(scenario);
  farm.PlaceShip(1, {4, 4});
  farm.PlaceShip(0, {2, 2});
  for (const Cell cell : {Cell{-1, 0}, Cell{5, 0}, Cell{3, 3}, Cell{0, 0}, Cell{4, 4}}) {
    EXPECT_FALSE(farm.CanPlaceShip(0, cell)) << cell.x << ' ' << cell.y;
    EXPECT_THROW(farm.PlaceShip(0, cell), InputError) << cell.x << ' ' << cell.y;
    EXPECT_EQ(farm.ships()[0].cell, (Cell{2, 2}));
  }
  EXPECT_TRUE(farm.CanPlaceShip(0, {2, 2})) << "its own cell";
  EXPECT_TRUE(farm.CanPlaceShip(1, {4, 3}));
  const std::uint8_t actions[] = {Act(Action::kPickup), Act(Action::kWest)};
  farm.Step(actions);
  EXPECT_EQ(farm.ships()[0].outcome, Outcome::kOk);
  EXPECT_EQ(farm.ships()[0].aboard, 1);
  EXPECT_EQ(farm.ships()[1].cell, (Cell{3, 4}));
}

TEST(Capacity, AFullShipPicksUpNoMore) {
  Scenario scenario = TinyScenario();
  scenario.devices.sites.push_back({{2, 3}, DeviceKind::kMonitoring, 60.0F, false});
  Farm farm = MakeFarm(scenario);
  FetchTheDevice(farm);
  StepOne(farm, Action::kNorth);
  EXPECT_EQ(farm.LegalActions(0), kMoveMask);
  EXPECT_EQ(StepOne(farm, Action::kPickup).outcome, Outcome::kIllegalPickup);
}

TEST(Capacity, DropOffUnloadsEverything) {
  Scenario scenario = TinyScenario();
  scenario.ships.capacity = 2;
  scenario.devices.sites.push_back({{2, 3}, DeviceKind::kMonitoring, 60.0F, false});
  Farm farm = MakeFarm(scenario);
  FetchTheDevice(farm);
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kPickup);
  for (int i = 0; i < 3; ++i) StepOne(farm, Action::kSouth);
  EXPECT_EQ(StepOne(farm, Action::kDropOff).reward, 20.0F + 80.0F + 60.0F);
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
}

TEST(Disasters, PayTheRiskInsteadOfTheStep) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(2, 2, {1, 3}, {-15, -5})};
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(StepOne(farm, Action::kNorth).reward, -15.0F);
  EXPECT_EQ(StepOne(farm, Action::kSouth).reward, -5.0F);
  EXPECT_EQ(StepOne(farm, Action::kPickup).reward, -15.0F);  // -10 - 5
  EXPECT_EQ(farm.record().steps_in_disaster, 3);
}

TEST(Disasters, WearDownWhatIsDeployedOrAboard) {
  Scenario scenario = TinyScenario();
  scenario.damage.exposure_damage = 0.01F;
  scenario.disasters = {StillDisaster(2, 2, {0.5F}, {-20})};
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.8F);
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kPickup);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.4F);
  StepOne(farm, Action::kSouth);  // leaves the disaster
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.4F);
}

TEST(End, ComesWhenEveryDisasterIsOver) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(20, 20, {1}, {-5}), StillDisaster(20, 20, {1}, {-5})};
  scenario.disasters[0].duration = 2;
  scenario.disasters[1].duration = 3;
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kNorth);
  EXPECT_FALSE(farm.over());
  StepOne(farm, Action::kNorth);
  EXPECT_EQ(farm.reason(), EndReason::kDisasterEnded);
  EXPECT_FALSE(farm.record().Success());
}

TEST(End, RetrievalInTheLastStepIsASuccess) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(20, 20, {1}, {-5})};
  scenario.disasters[0].duration = 6;
  Farm farm = MakeFarm(scenario);
  FetchTheDevice(farm);
  StepOne(farm, Action::kSouth);
  StepOne(farm, Action::kSouth);
  StepOne(farm, Action::kDropOff);
  EXPECT_EQ(farm.step(), 6);
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
}

// Steps a farm and the oracle with the same random actions and compares their results.
void CompareWithOracle(const Scenario& scenario, std::uint64_t seed) {
  Farm farm = MakeFarm(scenario);
  for (std::uint64_t episode = 0; episode < 20; ++episode) {
    farm.Reset(seed, episode);
    test::OracleFarm oracle(farm);
    RandomStream rng({seed, episode, RngStream::kExploration, 0});
    while (!farm.over()) {
      std::vector<Action> actions;
      std::vector<std::uint8_t> codes;
      for (std::size_t i = 0; i < farm.ships().size(); ++i) {
        // Picks up and drops off whenever legal, so that devices are also delivered.
        const ActionMask legal = farm.LegalActions(static_cast<std::int32_t>(i));
        auto action = static_cast<Action>(rng.Below(kActionCount + 1));
        if ((legal & MaskOf(Action::kPickup)) != 0) action = Action::kPickup;
        if ((legal & MaskOf(Action::kDropOff)) != 0) action = Action::kDropOff;
        actions.push_back(action);
        codes.push_back(Act(action));
      }
      farm.Step(codes.data());
      oracle.Step(actions, farm);
      const std::string where = scenario.name + " seed " + std::to_string(seed) + " episode " +
                                std::to_string(episode) + " step " + std::to_string(farm.step());
      for (std::size_t i = 0; i < oracle.ships.size(); ++i) {
        const Ship& ship = farm.ships()[i];
        ASSERT_EQ(ship.outcome, oracle.ships[i].outcome) << where << " ship " << i;
        if (scenario.energy) {
          ASSERT_FLOAT_EQ(ship.reward, oracle.ships[i].reward) << where << " ship " << i;
        } else {
          ASSERT_EQ(ship.reward, oracle.ships[i].reward) << where << " ship " << i;
        }
        ASSERT_NEAR(ship.energy, oracle.ships[i].kwh, 1e-9) << where << " ship " << i;
        ASSERT_NEAR(ship.distance, oracle.ships[i].km, 1e-9) << where << " ship " << i;
        ASSERT_EQ(ship.cell, (Cell{oracle.ships[i].at.first, oracle.ships[i].at.second})) << where;
        ASSERT_EQ(static_cast<std::size_t>(ship.aboard), oracle.ships[i].hold.size()) << where;
      }
      for (std::size_t d = 0; d < oracle.devices.size(); ++d) {
        const Cell cell = farm.CellOf(static_cast<std::int32_t>(d));
        ASSERT_EQ(farm.devices()[d].health, oracle.devices[d].health) << where << " device " << d;
        ASSERT_EQ(std::make_pair(cell.x, cell.y), oracle.PlaceOf(d)) << where << " device " << d;
      }
      ASSERT_EQ(farm.reason(), oracle.reason) << where;
    }
  }
}

TEST(Oracle, AgreesOnTheEnergyOfShipsAndSelfPropelledDevices) {
  Scenario scenario = CrowdedScenario(3, 2);
  scenario.energy = EnergySpec{0.3, {1.5, 0.4, 0.6, 0.2}, {0.7, 0.0, 0.9, 0.05}};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) CompareWithOracle(scenario, seed);
}

TEST(Oracle, AgreesOnRandomFarmsWithOneShip) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) CompareWithOracle(CrowdedScenario(1, 0), seed);
}

TEST(Oracle, AgreesOnRandomFarmsWithSeveralShipsAndSelfPropelledDevices) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scenario scenario = CrowdedScenario(3, 2);
    if (seed % 2 == 0) scenario.rewards.sharing = RewardSharing::kTeam;
    CompareWithOracle(scenario, seed);
  }
}

TEST(Oracle, AgreesOnRandomFarmsWhereKindsMatter) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scenario scenario = CrowdedScenario(2, 1);
    RandomStream rng({seed, 0, RngStream::kLayout, 0});
    for (auto& row : scenario.damage.kinds) {
      for (float& factor : row) factor = rng.Uniform(0.0F, 3.0F);
    }
    CompareWithOracle(scenario, seed);
  }
}

TEST(Hash, IsThatOfTheEpisodeNotOfWhatWasPlayedBefore) {
  Farm farm = MakeFarm(CrowdedScenario(2));
  farm.Reset(7, 3);
  RandomSteps(farm, 50, 1);
  const std::uint64_t first = farm.Hash();
  farm.Reset(8, 0);
  RandomSteps(farm, 90, 2);
  EXPECT_NE(farm.Hash(), first);
  farm.Reset(7, 3);
  RandomSteps(farm, 50, 1);
  EXPECT_EQ(farm.Hash(), first);
}

TEST(Hash, ChangesWithEveryStep) {
  Farm farm = MakeFarm(CrowdedScenario(1));
  std::uint64_t last = farm.Hash();
  for (int i = 0; i < 100; ++i) {
    RandomSteps(farm, 1, static_cast<std::uint64_t>(i));
    EXPECT_NE(farm.Hash(), last);
    last = farm.Hash();
  }
}

}  // namespace
}  // namespace aquafarm
