// SPDX-License-Identifier: BSD-3-Clause
// The outcome of a plan: known winds, unknown winds, and trips that cost more than they save.
#include "aquafarm/agents/rescue/plan_report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/tracks/reader.h"
#include "base/constants.h"
#include "rescue/case_parts.h"
#include "rescue/rescue_samples.h"

namespace aquafarm::agents {
namespace {

using test::kScenarios;

// A storm south of the ranch off Zhoushan that moves over it within 30 hours.
class Report : public ::testing::Test {
 protected:
  Report() {
    RescueRequest& request = request_;
    request.storm = kScenarios + "/archives/zhoushan_cma.txt";
    request.storm_name = "2106";
    request.at = ParseUtc("at", "2021-07-23T18:00:00Z");
    request.speed_kn = 12.0;
    request.ships = 2;
    request.members = 100;
    case_ = MakeRescueCase(
        std::make_shared<const Scenario>(LoadScenario(kScenarios + "/zhoushan_infa_2021.yaml")),
        request);
    case_.warnings.clear();
    case_.storm.known_until = case_.start + 48 * kHour_s;
  }

  // Adds a fix. @param wind_mps 0: neither wind, grade nor radii are known
  void Add(int hours, double wind_mps) {
    StormFix fix;
    fix.time = case_.start + hours * kHour_s;
    fix.position = {27.5 + hours / 12.0, 122.7};
    fix.forecast = hours > 0;
    if (wind_mps > 0.0) {
      fix.wind_mps = wind_mps;
      fix.averaging_min = 2;
      fix.grade = GradeOfWind(wind_mps);
    }
    track_.fixes.push_back(fix);
  }

  PlanReport Make() {
    UseStorm(track_, request_, case_);
    const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
    return MakeReport(case_, ensemble);
  }

  std::string SeverityOf(const std::string& code) const {
    for (const RescueWarning& one : case_.warnings) {
      if (one.code == code) return one.severity;
    }
    return "none";
  }

  RescueRequest request_;
  RescueCase case_;
  StormTrack track_;
};

TEST_F(Report, KnownWindsMakeAPlan) {
  for (const int hours : {0, 24, 48}) Add(hours, 35.0);
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kPlan) << report.text;
  EXPECT_FALSE(report.plan.routes.empty());
}

// The forecast has winds that reach the ranch, but until then the members interpolate from none.
TEST_F(Report, WindsThatAreUnknownAtFirstAreNotCalm) {
  Add(0, 0.0);
  for (const int hours : {24, 48}) Add(hours, 35.0);
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kStormUnknown) << report.text;
  EXPECT_EQ(report.text,
            "It is unknown when the storm reaches the devices: its wind and radii are unknown from "
            "2021-07-23T18:00:00Z.");
  EXPECT_EQ(SeverityOf("storm_unknown"), "stop");
  EXPECT_TRUE(report.plan.routes.empty()) << "no trip can be judged";
  EXPECT_FALSE(LastDepartureOf(case_.problem, report).none_after_s);
  EXPECT_FALSE(LastDepartureOf(case_.problem, report).not_known_beyond_s);
  EXPECT_NE(ToText(case_, report).find(": unknown\n"), std::string::npos);
}

TEST_F(Report, WithUnknownWindsAShipStillDeliversWhatItHasAboard) {
  Add(0, 0.0);
  for (const int hours : {24, 48}) Add(hours, 35.0);
  case_.problem.ships[0].cell = case_.problem.devices[0].cell;
  case_.problem.ships[0].aboard = {0};
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kStormUnknown) << report.text;
  ASSERT_EQ(report.plan.routes.size(), 1U);
  EXPECT_EQ(report.plan.routes[0].ship, 0);
  for (const RescueOrder& order : report.plan.routes[0].orders) {
    EXPECT_NE(order.kind, OrderKind::kFetch);
  }
}

TEST_F(Report, WindsThatAreUnknownAfterThePlanDoNotMatter) {
  for (const int hours : {0, 24, 48, 96}) Add(hours, 35.0);
  Add(120, 0.0);
  case_.storm.known_until = case_.start + 120 * kHour_s;
  EXPECT_EQ(Make().result, PlanResult::kPlan);
}

TEST_F(Report, TripsThatCostTooMuchAreNotCalledTooLate) {
  for (const int hours : {0, 24, 48}) Add(hours, 35.0);
  case_.problem.energy = RescueEnergy{1.0, 0.0, 1.0, 0.0, 1e9};
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kNothingSaved);
  EXPECT_EQ(report.text, "No trip saves more than it costs: no ship leaves to fetch a device.");
  EXPECT_EQ(SeverityOf("not_worth_it"), "warning");
  EXPECT_EQ(SeverityOf("nothing_can_be_saved"), "none");
}

TEST_F(Report, DevicesWithoutValueAreNotCalledTooLate) {
  for (const int hours : {0, 24, 48}) Add(hours, 35.0);
  for (RescueDevice& device : case_.problem.devices) device.value = 0.0;
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kNothingSaved);
  EXPECT_EQ(report.text, "No device has value left: nothing can be saved.");
}

TEST_F(Report, ShipsThatAreTooLateAreCalledTooLateWithPricesToo) {
  for (const int hours : {0, 24, 48}) Add(hours, 35.0);
  case_.problem.energy = RescueEnergy{1.0, 0.0, 1.0, 0.0, 1e9};
  for (RescueShip& ship : case_.problem.ships) ship.ready_s = 47.9 * kHour_s;
  const PlanReport report = Make();
  EXPECT_EQ(report.result, PlanResult::kNothingSaved);
  EXPECT_EQ(SeverityOf("nothing_can_be_saved"), "stop");
  EXPECT_EQ(SeverityOf("not_worth_it"), "none");
}

}  // namespace
}  // namespace aquafarm::agents
