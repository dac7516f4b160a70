// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/observation/disaster_slots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::CrowdedScenario;
using test::MakeFarm;
using test::StillDisaster;
using test::TinyScenario;

using Named = std::map<std::string, float>;

Named Name(const Encoder& encoder, const float* values) {
  Named named;
  for (const std::string& name : encoder.feature_names()) named[name] = *values++;
  EXPECT_EQ(named.size(), static_cast<std::size_t>(encoder.feature_count())) << "a name twice";
  return named;
}

Named NamedFeatures(const Farm& farm, std::int32_t ship = 0) {
  const Encoder encoder(farm.scenario());
  View view;
  Observe(farm, ship, view);
  std::vector<float> values(static_cast<std::size_t>(encoder.feature_count()), -777.0F);
  encoder.Features(view, values.data());
  EXPECT_EQ(std::count(values.begin(), values.end(), -777.0F), 0) << "left one unwritten";
  return Name(encoder, values.data());
}

/// The tiny farm with a weak disaster far away, and slots for two more.
Scenario WithSlots() {
  Scenario scenario = TinyScenario();
  scenario.disasters = {StillDisaster(12, 0, {2}, {-5})};
  scenario.disasters[0].kind = DisasterKind::kRedTide;
  scenario.view.disaster_slots = 2;
  return scenario;
}

TEST(DisasterSlots, ShowADisasterThatArrivesInPlayMostDangerousFirst) {
  Farm farm = MakeFarm(WithSlots());
  test::RandomSteps(farm, 3, 1);
  Named seen = NamedFeatures(farm);
  EXPECT_EQ(seen.at("slot0.known"), 1.0F);
  EXPECT_EQ(seen.at("slot0.red_tide"), 1.0F);
  EXPECT_EQ(seen.at("slot1.known"), 0.0F);
  EXPECT_EQ(seen.count("slot3.known"), 0U) << "one of the scenario and two slots";
  EXPECT_EQ(seen.count("disaster0.known"), 0U);
  DisasterSpec spill = StillDisaster(4, 4, {1, 3}, {-20, -8});
  spill.kind = DisasterKind::kOilSpill;
  spill.grade = 2;
  farm.SetDisaster(1, spill);
  seen = NamedFeatures(farm);
  const Cell ship = farm.ships()[0].cell;
  EXPECT_EQ(seen.at("slot0.oil_spill"), 1.0F);
  EXPECT_EQ(seen.at("slot0.red_tide"), 0.0F);
  EXPECT_EQ(seen.at("slot0.grade"), 0.5F);
  EXPECT_EQ(seen.at("slot0.risk"), 1.0F);
  EXPECT_FLOAT_EQ(seen.at("slot0.east"), (4.0F - static_cast<float>(ship.x)) / 5.0F);
  EXPECT_FLOAT_EQ(seen.at("slot0.north"), (4.0F - static_cast<float>(ship.y)) / 5.0F);
  EXPECT_FLOAT_EQ(seen.at("slot0.reach"), 3.0F / 5.0F);
  EXPECT_EQ(seen.at("slot1.red_tide"), 1.0F);
  EXPECT_EQ(seen.at("slot2.known"), 0.0F);
}

TEST(DisasterSlots, KeepTheMostDangerousOfTooMany) {
  Scenario scenario = WithSlots();
  scenario.disasters.clear();
  scenario.view.disaster_slots = 1;
  Farm farm = MakeFarm(scenario);
  for (int i = 0; i < 5; ++i) {
    farm.SetDisaster(i, StillDisaster(40.0F - static_cast<float>(i), 0, {2}, {-10}));
  }
  farm.SetDisaster(5, StillDisaster(60, 0, {2}, {-10}));
  EXPECT_FLOAT_EQ(NamedFeatures(farm).at("slot0.east"),
                  (36.0F - static_cast<float>(farm.ships()[0].cell.x)) / 5.0F);
}

// Slow oracle: the danger as RankByDanger defines it, in plain loops.
double SlowDanger(const Farm& farm, const View& view, std::size_t id) {
  const Disaster& disaster = farm.disasters()[id];
  double worst = 0.0;
  double reach = 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(disaster.rings); ++k) {
    reach = std::max(reach, static_cast<double>(disaster.radius[k]));
    if (disaster.radius[k] > 0.0F) {
      worst = std::max(worst, -static_cast<double>(disaster.risk[k]));
    }
  }
  std::vector<std::array<float, 2>> positions = view.disasters[id].forecast;
  positions.push_back({disaster.x, disaster.y});
  double gap = 1e9;
  for (const auto& position : positions) {
    const double distance = std::hypot(static_cast<double>(position[0]) - view.self.x,
                                       static_cast<double>(position[1]) - view.self.y);
    gap = std::min(gap, std::max(0.0, distance - reach));
  }
  return worst / (1.0 + gap / std::max(farm.scenario().width, farm.scenario().height));
}

TEST(DisasterSlots, AreInTheOrderOfTheDefinition) {
  Scenario scenario = CrowdedScenario(2);
  scenario.view.disaster_slots = 6;
  scenario.view.forecast_leads_h = {0.5F, 1.0F};
  Farm farm = MakeFarm(scenario);
  RandomStream rng({4, 0, RngStream::kExploration, 2});
  for (std::uint64_t episode = 0; episode < 40; ++episode) {
    farm.Reset(9, episode);
    for (int id = 2; id < 7; ++id) {
      farm.SetDisaster(id, StillDisaster(rng.Uniform(-9.0F, 20.0F), rng.Uniform(-9.0F, 20.0F),
                                         {rng.Uniform(0.1F, 3.0F)}, {rng.Uniform(-20.0F, -5.0F)}));
    }
    test::RandomSteps(farm, 20, episode);
    View view;
    Observe(farm, 1, view);
    ASSERT_EQ(view.by_danger.size(), 7U);
    for (std::size_t i = 1; i < view.by_danger.size(); ++i) {
      const auto before = static_cast<std::size_t>(view.by_danger[i - 1]);
      const auto after = static_cast<std::size_t>(view.by_danger[i]);
      EXPECT_GE(SlowDanger(farm, view, before), SlowDanger(farm, view, after) - 1e-4);
    }
  }
}

TEST(DisasterSlots, HoldForecastPositionsAtTheLeadTimes) {
  Scenario scenario = WithSlots();
  scenario.step_duration_s = 600.0;
  scenario.view.forecast_leads_h = {1.0F, 6.0F};
  DisasterSpec& storm = scenario.disasters[0];
  storm.track = {{0.0F, 0.0F, 30.0F, 3, storm.radii, storm.risks, {}},
                 {200.0F, 0.0F, -70.0F, 3, storm.radii, storm.risks, {}}};
  Farm straight = MakeFarm(scenario);
  test::RandomSteps(straight, 10, 1);
  const auto north = [](const Farm& farm, float y) {
    return (y - static_cast<float>(farm.ships()[0].cell.y)) / 5.0F;
  };
  EXPECT_NEAR(NamedFeatures(straight).at("slot0.north_1h"), north(straight, 25.0F - 3.0F), 1e-4);
  EXPECT_NEAR(NamedFeatures(straight).at("slot0.north_6h"), north(straight, 25.0F - 18.0F), 1e-4);
  storm.forecasts = {{0.0F, {{100.0F, 90.0F, 25.0F}}}};
  Farm told = MakeFarm(scenario);
  test::RandomSteps(told, 10, 1);
  const auto there = ForecastAt(told, 0, 10, 46);
  EXPECT_NEAR(there[0], 36.0F, 1e-4);
  EXPECT_NEAR(NamedFeatures(told).at("slot0.north_6h"), north(told, there[1]), 1e-4);
  EXPECT_NEAR(NamedFeatures(told).at("slot0.east_6h"),
              (there[0] - static_cast<float>(told.ships()[0].cell.x)) / 5.0F, 1e-4);
}

TEST(DisasterSlots, ReachLearnersThroughTheBatch) {
  Scenario scenario = WithSlots();
  ValidateScenario(scenario);
  FarmBatch batch(std::make_shared<const Scenario>(scenario), 2);
  std::vector<float> features(2 * static_cast<std::size_t>(batch.encoder().feature_count()));
  BatchOutput output;
  output.features = features.data();
  batch.Reset(1, 0, output);
  batch.farm(1).SetDisaster(1, StillDisaster(2, 2, {3}, {-20}));
  const std::vector<std::uint8_t> hold(2, test::Act(Action::kHold));
  batch.Step(hold.data(), output);
  const Named first = Name(batch.encoder(), features.data());
  const Named second = Name(batch.encoder(), features.data() + batch.encoder().feature_count());
  EXPECT_EQ(first.at("slot0.risk"), 0.25F);
  EXPECT_EQ(second.at("slot0.risk"), 1.0F);
  EXPECT_EQ(second.at("slot1.risk"), 0.25F);
}

TEST(DisasterSlots, AreAbsentUnlessAskedFor) {
  Scenario scenario = WithSlots();
  EXPECT_EQ(ParseScenario(ToYaml(scenario), "x").view.disaster_slots, 2);
  const std::uint64_t with = HashScenario(scenario);
  scenario.view.disaster_slots = 0;
  EXPECT_NE(HashScenario(scenario), with);
  EXPECT_EQ(ToYaml(scenario).find("slots"), std::string::npos);
  EXPECT_EQ(ToYaml(scenario).find("leads"), std::string::npos);
  const Farm farm = MakeFarm(scenario);
  View view;
  Observe(farm, 0, view);
  EXPECT_TRUE(view.by_danger.empty());
  EXPECT_EQ(NamedFeatures(farm).count("disaster0.known"), 1U);
}

std::string Refused(const std::string& keys) {
  try {
    ParseScenario("name: x\ndisasters:\n  - {kind: typhoon}\nview: {" + keys + "}\n", "x.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "was taken";
}

TEST(DisasterSlots, AreRefusedInWords) {
  EXPECT_EQ(Refused("disaster_slots: 2, forecast_leads_h: [6, 24]"), "was taken");
  EXPECT_EQ(Refused("forecast_leads_h: [6]"),
            "x.yaml:4: view.forecast_leads_h: is used only if 'disaster_slots' is above 0");
  EXPECT_EQ(Refused("disaster_slots: 64"),
            "x.yaml:4: view.disaster_slots: got 64, expected at most 63 next to the 1 disasters of "
            "the scenario");
  EXPECT_EQ(Refused("disaster_slots: 1, forecast_leads_h: [6, 6]"),
            "x.yaml:4: view.forecast_leads_h[1]: got 6, expected more than the previous lead, 6");
  EXPECT_EQ(Refused("disaster_slots: -1"),
            "x.yaml:4: view.disaster_slots: got -1, expected [0, 64]");
}

}  // namespace
}  // namespace aquafarm
