// SPDX-License-Identifier: BSD-3-Clause
// The size of a storm from its report to the members of an ensemble.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/storms/to_disaster.h"
#include "aquafarm/tracks/reader.h"
#include "aquafarm/tracks/wind_radii.h"
#include "base/constants.h"
#include "rescue/case_parts.h"
#include "rescue/rescue_samples.h"
#include "rescue/storm_member.h"

namespace aquafarm::agents {
namespace {

using test::kScenarios;
constexpr std::size_t kGale = 2;  // ring of 34 kt

// A storm north of the ranch off Zhoushan that moves north by half a degree an hour.
class Storm : public ::testing::Test {
 protected:
  Storm() {
    request_.storm = kScenarios + "/archives/zhoushan_cma.txt";
    request_.storm_name = "2106";
    request_.at = ParseUtc("at", "2021-07-23T18:00:00Z");
    case_ = MakeRescueCase(
        std::make_shared<const Scenario>(LoadScenario(kScenarios + "/zhoushan_infa_2021.yaml")),
        request_);
    case_.storm.known_until = *request_.at + 24 * kHour_s;
  }

  // Adds a fix. @param gale_km recorded radius of 34 kt; 0: none is recorded
  void Add(int hours, double wind_mps, double gale_km, bool forecast) {
    StormFix fix;
    fix.time = case_.start + hours * kHour_s;
    fix.position = {30.0 + 0.02 * hours, 122.7};
    fix.wind_mps = wind_mps;
    fix.averaging_min = 2;
    fix.grade = GradeOfWind(wind_mps);
    fix.forecast = forecast;
    if (gale_km > 0.0) AddRing({34, {gale_km, gale_km, gale_km, gale_km}, false}, fix.rings);
    track_.fixes.push_back(fix);
  }

  // Radii [km] of a ring at a time in 4,000 members. @param hours after the start
  std::vector<double> Gales(int hours, std::size_t ring = kGale) {
    UseStorm(track_, request_, case_);
    const auto& points = case_.forecast.path.points;
    const double step = hours * static_cast<double>(kHour_s) / case_.ensemble.step_s;
    const auto found = std::find_if(points.begin(), points.end(), [step](const StormPoint& point) {
      return std::abs(point.step - step) < 1e-9;
    });
    if (found == points.end()) throw std::out_of_range("no point at this hour");
    const auto point = static_cast<std::size_t>(found - points.begin());
    MemberSampler sampler(case_.forecast, case_.ensemble);
    std::vector<StormState> states;
    std::vector<double> radii;
    for (std::int32_t member = 0; member < 4000; ++member) {
      sampler.Draw(member, states);
      radii.push_back(static_cast<double>(states[point].radius[ring][0]) *
                      case_.scenario->cell_size_m / 1000.0);
    }
    std::sort(radii.begin(), radii.end());
    return radii;
  }
  static double Median(double wind_mps, double latitude) {
    return EstimateRadius(34, wind_mps, latitude, 2).median_km;
  }

  RescueRequest request_;
  RescueCase case_;
  StormTrack track_;
};

TEST_F(Storm, AReportedSizeHoldsWhereTheForecastIsBelowAGale) {
  Add(-6, 25.0, 3.0 * Median(25.0, 29.88), false);
  Add(0, 25.0, 3.0 * Median(25.0, 30.0), false);
  Add(12, 16.0, 0.0, true);  // below 17.2 m/s: no ring, but in many members it has gales
  const std::vector<double> radii = Gales(12);
  const auto first = std::upper_bound(radii.begin(), radii.end(), 0.0);
  const auto count = static_cast<double>(radii.end() - first);
  EXPECT_GT(count, 1000.0);
  EXPECT_LT(count, 3000.0);
  // 3 times the estimate, of which 93 % of the logarithm are left after 12 hours.
  const double size = std::pow(3.0, std::exp(-12.0 / 165.0));
  const double of_a_gale = first[(radii.end() - first) / 2];
  EXPECT_NEAR(of_a_gale / Median(18.5, 30.24), size, 0.25 * size);
}

TEST_F(Storm, AnErrorOfTheWindDoesNotChangeReportedRadii) {
  Add(-6, 17.5, 200.0, false);
  Add(0, 17.5, 200.0, false);  // just a gale: half of the errors of the wind are below it
  Add(12, 17.5, 0.0, true);
  const std::vector<double> radii = Gales(0);
  EXPECT_GT(radii.front(), 200.0 * std::exp(-4.5 * 0.1)) << "10 % are the error of a report";
  EXPECT_NEAR(radii[2000], 200.0, 2.0);
  EXPECT_NEAR(std::log(radii[3365] / radii[2000]), 0.1, 0.01);  // one standard deviation
  EXPECT_EQ(Gales(12).front(), 0.0) << "the forecast has no measured radii";
}

// The report has no 50 kt winds, but its wind may be too low by a little.
TEST_F(Storm, AWindThatIsReachedByTheErrorOfTheReportHasItsRing) {
  Add(-6, 24.5, 200.0, false);
  Add(0, 24.5, 200.0, false);
  Add(12, 24.5, 0.0, true);
  const std::vector<double> radii = Gales(0, 1);
  EXPECT_EQ(radii.front(), 0.0);
  EXPECT_GT(radii.back(), 20.0) << "50 kt are 25.7 m/s";
  EXPECT_LT(radii.back(), Gales(0).back());
  EXPECT_GT(Gales(0).front(), 200.0 * std::exp(-4.5 * 0.1)) << "the reported gales stay";
}

// The report has a radius of gales; that of 50 kt is estimated from the wind.
TEST_F(Storm, AnErrorOfTheWindChangesTheRingsThatAreNotReported) {
  Add(-6, 33.0, 200.0, false);
  Add(0, 33.0, 200.0, false);
  Add(12, 33.0, 0.0, true);
  UseStorm(track_, request_, case_);
  const auto reported = case_.forecast.path.points[1];
  EXPECT_EQ(reported.keeps_radii, (std::array<bool, kMaxStormRings>{false, false, true}));
  request_.errors.size_report_error = 0.0;  // the errors of the wind alone
  const std::vector<double> gales = Gales(0);
  EXPECT_NEAR(gales.front(), gales.back(), 1e-3);
  const std::vector<double> storm = Gales(0, 1);
  EXPECT_GT(storm.back(), 1.05 * storm.front());
}

// The winds fall below a gale after 9 of 12 hours. Linear radii are too small until then.
TEST_F(Storm, RadiiBetweenTwoPointsFollowFromTheWind) {
  Add(-6, 32.0, 0.0, false);
  Add(0, 32.0, 0.0, false);
  Add(12, 12.8, 0.0, true);
  request_.errors.scale = 0.0;
  EXPECT_NEAR(Gales(6).front(), Median(22.4, 30.12), 0.5);
  EXPECT_NEAR(Gales(9).front(), Median(17.6, 30.18), 0.5);
  EXPECT_GT(Gales(6).front(), 1.3 * Median(32.0, 30.0) / 2.0);
  EXPECT_EQ(Gales(12).front(), 0.0);
}

// A bulletin that weakens below a gale, as a plan and as a disaster of the farm: both have gales at
// a device until the same time.
TEST_F(Storm, TheFarmHasGalesAsLongAsThePlan) {
  auto scenario = std::make_shared<Scenario>(*case_.scenario);
  scenario->start_time = case_.start;
  const Cell device = case_.problem.devices[0].cell;
  for (const double gale_km : {0.0, 1.4 * Median(32.0, 30.0)}) {
    track_ = {};
    Add(-6, 32.0, gale_km, false);
    Add(0, 32.0, gale_km, false);
    Add(12, 12.8, 0.0, true);
    for (StormFix& fix : track_.fixes) fix.position.longitude = 124.25;  // 150 km off the ranch
    StormTrack bulletin = track_;
    bulletin.fixes.pop_back();
    bulletin.forecasts = {{"", case_.start, {track_.fixes.back()}}};
    UseStorm(WithForecast(bulletin, NoForecast::kPersist), request_, case_);
    EnsembleOptions exact = case_.ensemble;
    exact.members = 1;
    exact.errors.scale = 0.0;
    const Ensemble plan(case_.forecast, exact, {device});
    double plan_end_h = 0.0;
    for (std::int32_t step = 0; step < plan.steps(); ++step) {
      const auto cell = static_cast<std::size_t>(device.y * exact.width + device.x);
      if (plan.Covered(kGale, step)[cell] > 0) plan_end_h = step * exact.step_s / kHour_s;
    }
    Farm farm(scenario);
    farm.SetDisaster(0, ToDisaster(bulletin, *scenario, 0, 0));
    const std::vector<std::uint8_t> hold(farm.ships().size(),
                                         static_cast<std::uint8_t>(Action::kHold));
    double farm_end_h = 0.0;
    while (farm.step() * scenario->step_duration_s < 12.0 * kHour_s) {
      if (farm.RiskAt(device) < 0.0F) {
        farm_end_h = farm.step() * scenario->step_duration_s / kHour_s;
      }
      farm.Step(hold.data());
    }
    EXPECT_GT(plan_end_h, 8.0) << "linear radii end after six hours";
    EXPECT_LT(plan_end_h, 12.0);
    EXPECT_NEAR(farm_end_h, plan_end_h, (scenario->step_duration_s + exact.step_s) / kHour_s);
  }
}

TEST_F(Storm, StretchesWithoutAKnownWindHaveTheLargerRadiiAndAWarning) {
  Add(-6, 32.0, 0.0, false);
  Add(0, 32.0, 0.0, false);
  Add(12, 12.0, 0.0, true);
  track_.fixes.back().wind_mps.reset();
  track_.fixes.back().grade = StormGrade::kTropicalDepression;
  request_.errors.scale = 0.0;
  EXPECT_NEAR(Gales(9).front(), Median(32.0, 30.0), 1e-3);
  EXPECT_EQ(Gales(12).front(), 0.0);
  EXPECT_EQ(case_.storm.held, 1);
  EXPECT_EQ(case_.storm.rings.waypoints.size(), 3U) << "the page shows the bulletin's points";
}

TEST_F(Storm, AReportOfGalesAloneIsAReport) {
  Add(-6, 40.0, 500.0, false);
  Add(0, 40.0, 500.0, false);  // no radius of 50 and 64 kt
  Add(12, 40.0, 0.0, true);
  UseStorm(track_, request_, case_);
  EXPECT_EQ(case_.forecast.size_report_h,
            static_cast<double>(case_.start - *case_.storm.issued) / kHour_s);
  EXPECT_GT(case_.storm.rings.waypoints[2].radii_km[kGale], 1.2 * Median(40.0, 30.24));
}

// The forecast states the quadrants of gales, but not those of stronger winds.
TEST_F(Storm, ReportedQuadrantsOfAForecastAreKept) {
  Add(-6, 40.0, 150.0, false);
  Add(0, 40.0, 150.0, false);
  Add(12, 40.0, 0.0, true);
  AddRing({34, {400.0, 300.0, 100.0, 60.0}, false}, track_.fixes.back().rings);
  UseStorm(track_, request_, case_);
  const StormWaypoint& at = case_.storm.rings.waypoints[2];
  EXPECT_TRUE(at.estimated) << "the radii of 50 and 64 kt";
  EXPECT_EQ(at.quadrants_km[kGale], (std::array<double, 4>{400.0, 300.0, 100.0, 60.0}));
  EXPECT_EQ(at.radii_km[kGale], 400.0);
  EXPECT_GT(at.radii_km[1], 60.0);
  EXPECT_LE(at.quadrants_km[1][3], 60.0) << "no ring extends beyond one of a weaker wind";
}

TEST_F(Storm, AnEstimatedRingContainsAStrongerOneThatIsReported) {
  Add(-6, 40.0, 100.0, false);
  Add(0, 40.0, 100.0, false);
  Add(12, 40.0, 0.0, true);
  const double wide_km = 0.9 * Median(40.0, 30.24);  // more than the report's gales
  AddRing({50, {wide_km, 50.0, 50.0, 50.0}, false}, track_.fixes.back().rings);
  UseStorm(track_, request_, case_);
  const StormWaypoint& at = case_.storm.rings.waypoints[2];
  EXPECT_EQ(at.quadrants_km[1][0], wide_km);
  EXPECT_GE(at.quadrants_km[kGale][0], wide_km);
  EXPECT_LT(at.quadrants_km[kGale][1], wide_km) << "of the size of the report";
}

}  // namespace
}  // namespace aquafarm::agents
