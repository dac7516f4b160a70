// SPDX-License-Identifier: BSD-3-Clause
// Damage by kinds (damage.kinds) and risks by grade (grade_factors).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/storms/to_disaster.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StepOne;
using test::StillDisaster;
using test::TinyScenario;

float& FactorOf(Scenario& scenario, DeviceKind device, DisasterKind disaster) {
  return scenario.damage
      .kinds[static_cast<std::size_t>(device)][static_cast<std::size_t>(disaster)];
}

// A cage and a buoy, both in a red tide of risk -8 and in waves of risk -10.
Scenario TideAndWaves() {
  Scenario scenario = TinyScenario();
  scenario.devices.sites = {{{2, 2}, DeviceKind::kTemporaryBreeding, 80.0F, false},
                            {{2, 3}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.damage.exposure_damage = 0.01F;
  scenario.disasters = {StillDisaster(2.0F, 2.0F, {9.0F}, {-8.0F}),
                        StillDisaster(2.0F, 2.0F, {9.0F}, {-10.0F})};
  scenario.disasters[0].kind = DisasterKind::kRedTide;
  scenario.disasters[1].kind = DisasterKind::kWave;
  return scenario;
}

TEST(DamageByKind, WithoutFactorsTheWorstRiskCounts) {
  Farm farm = MakeFarm(TideAndWaves());
  StepOne(farm, Action::kHold);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.9F);
  EXPECT_FLOAT_EQ(farm.devices()[1].health, 0.9F);
}

TEST(DamageByKind, IsTheWorstProductOfRiskAndFactor) {
  Scenario scenario = TideAndWaves();
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kRedTide) = 2.0F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kRedTide) = 0.0F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kWave) = 0.5F;
  Farm farm = MakeFarm(scenario);
  const Ship& ship = StepOne(farm, Action::kHold);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 1.0F - 0.01F * 16.0F);  // 2 · 8 of the red tide
  EXPECT_FLOAT_EQ(farm.devices()[1].health, 1.0F - 0.01F * 5.0F);   // half of 10 of the waves
  EXPECT_EQ(farm.DamagingRiskAt({2, 2}, DeviceKind::kTemporaryBreeding), -16.0F);
  EXPECT_EQ(farm.RiskAt({2, 2}), -10.0F) << "the risk itself has no factor";
  EXPECT_EQ(ship.terms.disaster, -10.0F) << "nor has the reward of ships";
}

TEST(DamageByKind, AlsoAppliesAboardAndNotToTheRiskOfTheSea) {
  Scenario scenario = TideAndWaves();
  scenario.disasters.resize(1);
  scenario.seas = SeaSpec{{}, std::vector<float>(25, -5.0F), {}};
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kRedTide) = 3.0F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kRedTide) = 0.0F;
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  StepOne(farm, Action::kNorth);
  ASSERT_EQ(StepOne(farm, Action::kPickup).aboard, 1);
  StepOne(farm, Action::kSouth);
  EXPECT_NEAR(farm.devices()[0].health, 1.0F - 4 * 0.24F, 1e-6F);
  EXPECT_NEAR(farm.devices()[1].health, 1.0F - 4 * 0.05F, 1e-6F) << "by the sea alone";
}

TEST(DamageByKind, HealthIsNotBelowZero) {
  Scenario scenario = TideAndWaves();
  scenario.damage.exposure_damage = 0.5F;
  FactorOf(scenario, DeviceKind::kTemporaryBreeding, DisasterKind::kRedTide) = 100.0F;
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kHold);
  EXPECT_EQ(farm.devices()[0].health, 0.0F);
}

TEST(DamageByKind, OfOneIsAbsentFromTextAndHash) {
  const std::string text = "name: x\n";
  const Scenario plain = ParseScenario(text, "plain");
  const Scenario ones =
      ParseScenario(text + "damage: {kinds: {monitoring: {wave: 1, red_tide: 1}}}\n", "ones");
  EXPECT_EQ(ones.hash, plain.hash);
  EXPECT_EQ(ToYaml(ones), ToYaml(plain));
}

TEST(DamageByKind, SurvivesTheTextOfAScenario) {
  Scenario scenario = TideAndWaves();
  FactorOf(scenario, DeviceKind::kDeepWaterBreeding, DisasterKind::kChemicalSpill) = 0.25F;
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kWave) = 0.0F;
  const Scenario back = ParseScenario(ToYaml(scenario), "again");
  EXPECT_EQ(back.damage.kinds, scenario.damage.kinds);
  EXPECT_NE(ToYaml(scenario).find("    monitoring:\n      wave: 0\n"
                                  "    deep_water_breeding:\n      chemical_spill: 0.25\n"),
            std::string::npos)
      << ToYaml(scenario);
  EXPECT_NE(HashScenario(scenario), HashScenario(TideAndWaves()));
}

TEST(DamageByKind, AFarmLoadsWhatItSaved) {
  Scenario scenario = TideAndWaves();
  FactorOf(scenario, DeviceKind::kMonitoring, DisasterKind::kWave) = 3.0F;
  Farm farm = MakeFarm(scenario);
  StepOne(farm, Action::kNorth);
  Farm other = MakeFarm(scenario);
  other.Load(farm.Save());
  StepOne(farm, Action::kNorth);
  StepOne(other, Action::kNorth);
  EXPECT_EQ(other.Hash(), farm.Hash());
}

// A disaster of grade `grade` with risks -12, -8 and -6.
DisasterSpec Graded(std::int32_t grade) {
  DisasterSpec disaster = StillDisaster(2.0F, 2.0F, {1.0F, 2.0F, 3.0F}, {-12.0F, -8.0F, -6.0F});
  disaster.grade = grade;
  disaster.grade_factors = {0.5F, 0.75F, 1.0F, 2.0F};
  return disaster;
}

TEST(GradeFactors, ScaleTheRisksOfAMovingDisasterWithinTheRangeOfRisks) {
  const auto risks = [](std::int32_t grade) {
    const Disaster disaster = SpawnDisaster(Graded(grade), 0, 1, 0, 5, 5);
    return std::vector<float>(disaster.risk.begin(), disaster.risk.begin() + 3);
  };
  EXPECT_EQ(risks(1), (std::vector<float>{-6.0F, -5.0F, -5.0F})) << "not milder than -5";
  EXPECT_EQ(risks(2), (std::vector<float>{-9.0F, -6.0F, -5.0F}));
  EXPECT_EQ(risks(3), (std::vector<float>{-12.0F, -8.0F, -6.0F}));
  EXPECT_EQ(risks(4), (std::vector<float>{-20.0F, -16.0F, -12.0F})) << "not worse than -20";
}

TEST(GradeFactors, WithoutThemTheGradeChangesNoRisk) {
  for (const std::int32_t grade : {1, 4}) {
    DisasterSpec disaster = Graded(grade);
    disaster.grade_factors.clear();
    EXPECT_EQ(SpawnDisaster(disaster, 0, 1, 0, 5, 5).risk[0], -12.0F);
    EXPECT_TRUE(RisksByGrade(disaster).empty());
  }
}

// The grade rises from 1 to 4 along the track.
TEST(GradeFactors, ApplyToWaypointsWithoutRisksOfTheirOwn) {
  const Scenario scenario = ParseScenario(R"(
name: x
disasters:
  - kind: typhoon
    risks: [-12, -6]
    grade_factors: [0.5, 0.75, 1, 2]
    track:
      - {step: 0, x: 0, y: 0, radii: [1, 2], grade: 1}
      - {step: 5, x: 9, y: 0, radii: [1, 2], grade: 4}
      - {step: 9, x: 9, y: 9, radii: [1, 2], grade: 4, risks: [-19, -9]}
)",
                                          "graded");
  const DisasterSpec& disaster = scenario.disasters.at(0);
  EXPECT_EQ(disaster.risks, (std::vector<float>{-12.0F, -6.0F})) << "before the factors";
  EXPECT_EQ(disaster.track[0].risks, (std::vector<float>{-6.0F, -5.0F}));
  EXPECT_EQ(disaster.track[1].risks, (std::vector<float>{-20.0F, -12.0F}));
  EXPECT_EQ(disaster.track[2].risks, (std::vector<float>{-19.0F, -9.0F})) << "rings say otherwise";
  const Scenario back = ParseScenario(ToYaml(scenario), "again");
  EXPECT_EQ(back.hash, scenario.hash);
  EXPECT_EQ(back.disasters[0].grade_factors, disaster.grade_factors);
  Farm farm = MakeFarm(scenario);
  EXPECT_EQ(farm.disasters()[0].risk[0], -6.0F);
}

TEST(GradeFactors, AreAbsentFromTheTextOfAScenarioWithoutThem) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {Graded(4)};
  EXPECT_NE(ToYaml(scenario).find("grade_factors: [0.5, 0.75, 1, 2]"), std::string::npos);
  const Scenario back = ParseScenario(ToYaml(scenario), "again");
  EXPECT_EQ(back.disasters[0].grade_factors, scenario.disasters[0].grade_factors);
  scenario.disasters[0].grade_factors.clear();
  EXPECT_EQ(ToYaml(scenario).find("grade_factors"), std::string::npos);
}

TEST(GradeFactors, ARefusedDisasterLeavesTheFarmAsItIs) {
  Scenario scenario = TinyScenario();
  scenario.disasters = {Graded(3)};
  Farm farm = MakeFarm(scenario);
  const std::uint64_t before = farm.Hash();
  DisasterSpec wrong = Graded(3);
  wrong.grade_factors = {1.0F, -1.0F, 1.0F, 1.0F};
  try {
    farm.SetDisaster(0, wrong);
    FAIL() << "a negative factor was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "grade_factors[1]: got -1, expected (0, 10]");
  }
  EXPECT_EQ(farm.Hash(), before);
  farm.SetDisaster(0, Graded(4));
  EXPECT_EQ(farm.disasters()[0].risk[1], -16.0F);
}

}  // namespace
}  // namespace aquafarm
