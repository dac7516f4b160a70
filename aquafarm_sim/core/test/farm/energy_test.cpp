// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/energy.h"

#include <gtest/gtest.h>

#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StepOne;
using test::StillDisaster;
using test::TinyScenario;

// The tiny farm with cells of 500 m and a risk of -10 at (3, 1).
Scenario EnergyScenario() {
  Scenario scenario = TinyScenario();
  scenario.cell_size_m = 500.0;
  scenario.disasters = {StillDisaster(3.0F, 1.0F, {0.5F}, {-10.0F})};
  EnergySpec energy;
  energy.weight = 0.25;
  energy.ships = {2.0, 0.5, 0.4, 0.1};
  energy.self_propelled = {3.0, 0.0, 0.2, 0.05};
  scenario.energy = energy;
  return scenario;
}

// Computed by hand: 2 kWh/km, half more for the device aboard, 0.4 · 10 / 20 more in the risk, and
// 0.1 kWh in each step. A move has 500 m or 707.10678 m.
TEST(Energy, OfATrajectoryIsAsComputedByHand) {
  struct {
    Action action;
    double km;
    double kwh;
    double reward;  // without energy
  } const steps[] = {
      {Action::kNorth, 0.5, 1.1, -1.0},
      {Action::kNorth, 0.5, 1.1, -1.0},
      {Action::kPickup, 0.0, 0.1, 20.0},
      {Action::kSouthEast, 0.70710678, 2.64558441, -10.0},
      {Action::kSouthWest, 0.70710678, 2.22132034, -1.0},
      {Action::kDropOff, 0.0, 0.1, 100.0},
  };
  Farm farm = MakeFarm(EnergyScenario());
  for (const auto& step : steps) {
    SCOPED_TRACE(farm.step());
    const Ship& ship = StepOne(farm, step.action);
    EXPECT_NEAR(ship.distance, step.km, 1e-6);
    EXPECT_NEAR(ship.energy, step.kwh, 1e-6);
    EXPECT_NEAR(static_cast<double>(ship.terms.energy), -0.25 * step.kwh, 1e-6);
    EXPECT_NEAR(static_cast<double>(ship.reward), step.reward - 0.25 * step.kwh, 1e-5);
  }
  EXPECT_EQ(farm.reason(), EndReason::kAllRetrieved);
  EXPECT_NEAR(farm.ships()[0].episode_energy, 7.26690476, 1e-6);
  EXPECT_NEAR(farm.ships()[0].episode_distance, 2.41421356, 1e-6);
  EXPECT_NEAR(farm.record().energy, 7.26690476, 1e-6);
  EXPECT_NEAR(farm.record().distance, 2.41421356, 1e-6);
  EXPECT_NEAR(static_cast<double>(farm.record().episode_return), 107.0 - 1.81672619, 1e-4);
}

TEST(Energy, AShipThatStaysCoversNoDistance) {
  for (const Action action : {Action::kSouth, Action::kWest, Action::kPickup, Action::kHold}) {
    Farm farm = MakeFarm(EnergyScenario());
    const Ship& ship = StepOne(farm, action);  // edge, crash, illegal, held
    EXPECT_EQ(ship.distance, 0.0);
    EXPECT_EQ(ship.energy, 0.1);
  }
}

TEST(Energy, ASelfPropelledDeviceHasItsOwnFigures) {
  Scenario scenario = EnergyScenario();
  scenario.ships.count = 0;
  scenario.devices.sites[0].self_propelled = true;
  scenario.devices.sites[0].cell = {4, 2};
  Farm farm = MakeFarm(scenario);
  EXPECT_NEAR(StepOne(farm, Action::kSouthWest).energy, 0.05 + 3.0 * 0.70710678 * (1.0 + 0.2 * 0.5),
              1e-6);
  EXPECT_NEAR(StepOne(farm, Action::kSouthWest).energy, 0.05 + 3.0 * 0.70710678, 1e-6);
  EXPECT_EQ(StepOne(farm, Action::kDropOff).energy, 0.05);
  EXPECT_TRUE(farm.over());
}

TEST(Energy, IsZeroWithoutFiguresAndTheDistanceCounts) {
  Scenario scenario = EnergyScenario();
  scenario.energy.reset();
  Farm farm = MakeFarm(scenario);
  const Ship& ship = StepOne(farm, Action::kNorth);
  EXPECT_EQ(ship.energy, 0.0);
  EXPECT_EQ(ship.terms.energy, 0.0F);
  EXPECT_EQ(ship.reward, -1.0F);
  EXPECT_EQ(farm.record().distance, 0.5);
}

TEST(Energy, OfASavedEpisodeContinues) {
  Farm farm = MakeFarm(EnergyScenario());
  StepOne(farm, Action::kNorth);
  Farm loaded = MakeFarm(EnergyScenario());
  loaded.Load(farm.Save());
  StepOne(farm, Action::kNorthEast);
  StepOne(loaded, Action::kNorthEast);
  EXPECT_EQ(loaded.ships()[0].terms.energy, farm.ships()[0].terms.energy);
  EXPECT_EQ(loaded.ships()[0].episode_energy, farm.ships()[0].episode_energy);
  EXPECT_EQ(loaded.record().distance, farm.record().distance);
  EXPECT_EQ(loaded.Hash(), farm.Hash());
}

TEST(Energy, IsNotWrittenWhereItIsAbsent) {
  Scenario scenario = EnergyScenario();
  EXPECT_NE(ToYaml(scenario).find("energy:"), std::string::npos);
  EXPECT_EQ(ToYaml(ParseScenario(ToYaml(scenario), "again")), ToYaml(scenario));
  scenario.energy.reset();
  EXPECT_EQ(ToYaml(scenario).find("energy"), std::string::npos);
}

TEST(Energy, OfAScenarioInCodeIsCheckedLikeAFile) {
  Scenario scenario = EnergyScenario();
  scenario.energy->ships.per_km = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ValidateScenario(scenario), InputError);
  scenario.energy->ships.per_km = 1.0;
  scenario.energy->self_propelled.idle_per_step = -1.0;
  EXPECT_THROW(ValidateScenario(scenario), InputError);
}

}  // namespace
}  // namespace aquafarm
