// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/accounts.h"

#include <gtest/gtest.h>

#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StepOne;

Scenario InsuredTiny(double at_sea_loss = 1.0) {
  Scenario scenario = test::TinyScenario();
  scenario.money = MoneySpec{"CNY", {0.0, 1000.01, 0.0, 0.0}, 90.0, 0.0, at_sea_loss};
  scenario.step_duration_s = 600.0;
  scenario.step_limit = 10;
  return scenario;
}

Ledger MonitoringOf(const Farm& farm) {
  return farm.SettleAccounts().value().by_kind[static_cast<std::size_t>(DeviceKind::kMonitoring)];
}

void Expect(const Ledger& ledger, Cents insured, Cents saved, Cents damaged, Cents lost) {
  EXPECT_EQ(ledger.insured, insured);
  EXPECT_EQ(ledger.saved, saved);
  EXPECT_EQ(ledger.damaged, damaged);
  EXPECT_EQ(ledger.lost, lost);
}

TEST(Accounts, ADeliveredDeviceIsSaved) {
  Farm farm = MakeFarm(InsuredTiny());
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup, Action::kSouth,
                              Action::kSouth, Action::kDropOff}) {
    EXPECT_FALSE(farm.SettleAccounts());
    StepOne(farm, action);
  }
  Expect(MonitoringOf(farm), 100001, 100001, 0, 0);
  Expect(farm.SettleAccounts()->Total(), 100001, 100001, 0, 0);
  // Five steps of ten minutes at sea or moving; the drop-off is in the port.
  EXPECT_EQ(farm.record().ship_steps, 5);
  EXPECT_EQ(farm.SettleAccounts()->OperatingCost(), 7500);
}

TEST(Accounts, ACrashDamagesAShareOfTheValue) {
  Farm farm = MakeFarm(InsuredTiny());
  // The rock at (3, 3) takes 0.04 of the health.
  for (const Action action : {Action::kNorth, Action::kNorth, Action::kPickup, Action::kNorthEast,
                              Action::kSouth, Action::kSouth, Action::kDropOff}) {
    StepOne(farm, action);
  }
  ASSERT_TRUE(farm.record().Success());
  Expect(MonitoringOf(farm), 100001, 96001, 4000, 0);  // 4000.04 cents
}

TEST(Accounts, ADeviceThatIsNotInAPortIsLost) {
  for (const bool aboard : {false, true}) {
    Farm farm = MakeFarm(InsuredTiny());
    StepOne(farm, Action::kNorth);
    StepOne(farm, Action::kNorth);
    if (aboard) StepOne(farm, Action::kPickup);
    while (!farm.over()) StepOne(farm, Action::kHold);
    Expect(MonitoringOf(farm), 100001, 0, 0, 100001);
    EXPECT_EQ(farm.record().ship_steps, 10);
  }
}

TEST(Accounts, AtSeaLossIsTheShareOfTheRemainingValue) {
  Scenario scenario = InsuredTiny(0.25);
  scenario.money->device_values[static_cast<std::size_t>(DeviceKind::kMonitoring)] = 1000.0;
  scenario.damage.exposure_damage = 0.01F;
  scenario.disasters = {test::StillDisaster(2.0F, 2.0F, {1.0F}, {-5.0F})};
  Farm farm = MakeFarm(scenario);
  while (!farm.over()) StepOne(farm, Action::kHold);
  // Ten steps at a risk of 5 take half of the health. A quarter of the remaining value is lost.
  Expect(MonitoringOf(farm), 100000, 37500, 50000, 12500);
  EXPECT_EQ(farm.record().ship_steps, 0) << "the ship stayed in the port";
  EXPECT_EQ(farm.SettleAccounts()->OperatingCost(), 0);
}

TEST(Accounts, DamageIsAShareOfTheInitialHealth) {
  const MoneySpec money{"CNY", {}, 0.0, 0.0, 0.0};
  Expect(Settle(money, 1000, 0.4F, 0.8F, true), 1000, 500, 500, 0);
  Expect(Settle(money, 1000, 0.0F, 0.8F, false), 1000, 0, 1000, 0);
  Expect(Settle(money, 1000, 0.8F, 0.8F, false), 1000, 1000, 0, 0);
}

TEST(Accounts, EnergyHasItsPrice) {
  Scenario scenario = InsuredTiny();
  scenario.money->kwh = 1.5;
  scenario.energy.emplace();
  scenario.energy->ships.per_km = 3.0;  // cells of a kilometre
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  while (!farm.over()) StepOne(farm, Action::kHold);
  EXPECT_EQ(farm.SettleAccounts()->energy_cost, 450);
  EXPECT_EQ(farm.SettleAccounts()->OperatingCost(), 450 + 10 * 1500);
}

TEST(Accounts, ASiteMayHaveItsOwnValue) {
  Scenario scenario = InsuredTiny();
  scenario.devices.sites[0].insured_value = 7.5;
  scenario.devices.sites.push_back({{4, 4}, DeviceKind::kMonitoring, 60.0F, false});
  Farm farm = MakeFarm(scenario);
  while (!farm.over()) StepOne(farm, Action::kHold);
  EXPECT_EQ(MonitoringOf(farm).insured, 750 + 100001);
}

TEST(Accounts, WithoutMoneyThereAreNone) {
  Farm farm = MakeFarm(test::CrowdedScenario(2));
  test::RandomSteps(farm, 1000, 1);
  ASSERT_TRUE(farm.over());
  EXPECT_FALSE(farm.SettleAccounts());
  EXPECT_EQ(farm.record().ship_steps, 0);
}

TEST(Accounts, MoneyChangesNoEpisode) {
  const Scenario plain = test::CrowdedScenario(2);
  Scenario insured = plain;
  insured.money = MoneySpec{"CNY", {1.0, 2.0, 3.0, 4.0}, 5.0, 6.0, 0.5};
  Farm a = MakeFarm(plain);
  Farm b = MakeFarm(insured);
  while (!a.over()) {
    EXPECT_EQ(a.Hash(), b.Hash());
    test::RandomSteps(a, 1, 1);
    test::RandomSteps(b, 1, 1);
  }
  EXPECT_EQ(a.Hash(), b.Hash());
}

// A scenario with random rules and prices. Amounts have two decimals.
Scenario RandomInsured(RandomStream& rng) {
  Scenario scenario = test::CrowdedScenario(1 + static_cast<std::int32_t>(rng.Below(3)),
                                            static_cast<std::int32_t>(rng.Below(3)));
  scenario.devices.health = 0.1F + 0.9F * rng.Uniform(0.0F, 1.0F);
  scenario.damage.exposure_damage = rng.Uniform(0.0F, 0.01F);
  scenario.step_limit = 1 + static_cast<std::int32_t>(rng.Below(150));
  scenario.step_duration_s = 0.001 * (1 + rng.Below(10000000));
  MoneySpec money;
  for (double& value : money.device_values) value = rng.Below(2000000000) / 100.0;
  money.ship_hour = rng.Below(1000000) / 100.0;
  money.kwh = rng.Below(1000) / 100.0;
  money.at_sea_loss = rng.Below(5) / 4.0;
  scenario.energy.emplace();
  scenario.energy->ships.per_km = rng.Uniform(0.0F, 10.0F);
  scenario.energy->ships.idle_per_step = rng.Uniform(0.0F, 1.0F);
  scenario.money = money;
  return scenario;
}

// Slow oracle: books every device again from the farm's state, by kind and in integers.
void ExpectBalanced(const Farm& farm, std::int64_t ship_steps) {
  const Scenario& scenario = farm.scenario();
  const Accounts accounts = farm.SettleAccounts().value();
  Cents insured = 0;
  for (std::size_t kind = 0; kind < accounts.by_kind.size(); ++kind) {
    Ledger expected;
    for (const Device& device : farm.devices()) {
      if (static_cast<std::size_t>(device.kind) != kind) continue;
      const Cents value = std::llround(scenario.money->device_values[kind] * 100.0);
      const double health_lost =
          1.0 - static_cast<double>(device.health) / static_cast<double>(scenario.devices.health);
      const Cents damaged = std::llround(static_cast<double>(value) * health_lost);
      const bool in_port = device.status == DeviceStatus::kDelivered;
      const Cents lost =
          in_port
              ? 0
              : std::llround(static_cast<double>(value - damaged) * scenario.money->at_sea_loss);
      expected += {value, value - damaged - lost, damaged, lost};
    }
    const Ledger& ledger = accounts.by_kind[kind];
    EXPECT_TRUE(ledger == expected) << "kind " << kind;
    EXPECT_EQ(ledger.insured, ledger.saved + ledger.damaged + ledger.lost);
    EXPECT_EQ(ledger.Loss(), ledger.insured - ledger.saved);
    EXPECT_GE(std::min({ledger.saved, ledger.damaged, ledger.lost}), 0);
    insured += ledger.insured;
  }
  const Ledger total = accounts.Total();
  EXPECT_EQ(total.insured, insured);
  EXPECT_EQ(total.insured, total.saved + total.damaged + total.lost);
  EXPECT_EQ(farm.record().ship_steps, ship_steps);
  const double hours = static_cast<double>(ship_steps) * scenario.step_duration_s / 3600.0;
  EXPECT_EQ(accounts.ship_cost, std::llround(hours * scenario.money->ship_hour * 100.0));
  EXPECT_EQ(accounts.energy_cost, std::llround(farm.record().energy * scenario.money->kwh * 100.0));
  EXPECT_EQ(accounts.OperatingCost(), accounts.ship_cost + accounts.energy_cost);
}

TEST(Accounts, BalanceToTheCentInRandomEpisodes) {
  RandomStream rng({77, 0, RngStream::kExploration, 9});
  int with_loss = 0;
  int with_savings = 0;
  for (int round = 0; round < 60; ++round) {
    Farm farm = MakeFarm(RandomInsured(rng));
    for (std::uint64_t episode = 0; episode < 20; ++episode) {
      farm.Reset(static_cast<std::uint64_t>(round), episode);
      std::int64_t ship_steps = 0;
      while (!farm.over()) {
        std::vector<Cell> before;
        for (const Ship& ship : farm.ships()) before.push_back(ship.cell);
        test::RandomSteps(farm, 1, rng.Below(1000000000));
        for (std::size_t i = 0; i < before.size(); ++i) {
          const Ship& ship = farm.ships()[i];
          const bool in_port = (farm.layout().bits(ship.cell) & kPortBit) != 0;
          if (ship.own_device == kNone && (!in_port || !(before[i] == ship.cell))) ++ship_steps;
        }
      }
      ExpectBalanced(farm, ship_steps);
      with_loss += farm.SettleAccounts()->Total().Loss() > 0 ? 1 : 0;
      with_savings += farm.SettleAccounts()->Total().saved > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(with_loss, 600);
  EXPECT_GT(with_savings, 600);
}

TEST(Accounts, ALoadedEpisodeHasTheSameAccounts) {
  Scenario scenario = test::CrowdedScenario(2);
  scenario.money = MoneySpec{"CNY", {10.01, 20.02, 30.03, 40.04}, 5.0, 6.0, 1.0};
  Farm farm = MakeFarm(scenario);
  Farm copy = MakeFarm(scenario);
  test::RandomSteps(farm, 40, 3);
  copy.Load(farm.Save());
  EXPECT_EQ(copy.record().ship_steps, farm.record().ship_steps);
  EXPECT_GT(farm.record().ship_steps, 0);
  test::RandomSteps(farm, 1000, 4);
  copy.Load(farm.Save());
  ASSERT_TRUE(copy.over());
  EXPECT_TRUE(copy.SettleAccounts()->by_kind == farm.SettleAccounts()->by_kind);
  EXPECT_EQ(copy.SettleAccounts()->ship_cost, farm.SettleAccounts()->ship_cost);
  EXPECT_GT(copy.SettleAccounts()->Total().insured, 0);
}

}  // namespace
}  // namespace aquafarm
