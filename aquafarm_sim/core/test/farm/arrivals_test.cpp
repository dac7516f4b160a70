// SPDX-License-Identifier: BSD-3-Clause
// Disasters and forecasts that arrive during an episode.
#include <gtest/gtest.h>

#include <functional>

#include "aquafarm/base/check.h"
#include "aquafarm/farm/forecast.h"
#include "aquafarm/observation/view.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;
using test::StillDisaster;

/// A storm that moves north along x = 5, one cell per step. The sensors of the ships have a short
/// range.
Scenario NorthernStorm(ViewMode mode = ViewMode::kPartial) {
  Scenario scenario = test::CrowdedScenario(2, 0);
  DisasterSpec storm;
  storm.radii = {1.0F, 2.0F};
  storm.risks = {-20.0F, -5.0F};
  storm.duration = 150;
  storm.track = {{0.0F, 5.0F, -60.0F, 3, storm.radii, storm.risks},
                 {150.0F, 5.0F, 90.0F, 3, storm.radii, storm.risks}};
  scenario.disasters = {storm};
  scenario.view.mode = mode;
  scenario.view.sensor_radius = 1.0F;
  scenario.view.bulletin_period = 50;
  return scenario;
}

/// A forecast issued at step 10. It leads the storm east and lets it grow.
IssuedForecast Eastward() {
  IssuedForecast forecast{10.0F,
                          {{40.0F, 35.0F, -50.0F, 4, {3.0F, 6.0F}, {-20.0F, -5.0F}},
                           {70.0F, 65.0F, -50.0F, 4, {5.0F, 8.0F}, {-15.0F, -5.0F}}}};
  return forecast;
}

Farm At10(const Scenario& scenario = NorthernStorm()) {
  Farm farm = MakeFarm(scenario);
  farm.Reset(4, 2);
  test::RandomSteps(farm, 10, 3);
  return farm;
}

TEST(IssueForecast, ChangesWhatAgentsObserveAndNotTheTruth) {
  Farm informed = At10();
  Farm uninformed = At10();
  informed.IssueForecast(0, Eastward());
  EXPECT_NE(informed.Hash(), uninformed.Hash());
  View view;
  Observe(informed, 0, view);
  EXPECT_TRUE(view.disasters[0].known);
  EXPECT_EQ(view.disasters[0].age, 0) << "the bulletin is issued at once";
  EXPECT_FLOAT_EQ(view.disasters[0].belief.dx, 1.0F) << "30 cells east in 30 steps";
  EXPECT_EQ(view.disasters[0].belief.dy, 0.0F);
  for (int step = 0; step < 100; ++step) {
    test::RandomSteps(informed, 1, static_cast<std::uint64_t>(step));
    test::RandomSteps(uninformed, 1, static_cast<std::uint64_t>(step));
    ASSERT_EQ(informed.disasters()[0].x, uninformed.disasters()[0].x);
    ASSERT_EQ(informed.disasters()[0].y, uninformed.disasters()[0].y);
    ASSERT_EQ(informed.disasters()[0].radius, uninformed.disasters()[0].radius);
    ASSERT_EQ(informed.record().episode_return, uninformed.record().episode_return);
  }
}

TEST(IssueForecast, ReachesShipsThatDoNotSeeTheDisaster) {
  Farm farm = At10();
  View view;
  Observe(farm, 0, view);
  EXPECT_EQ(view.disasters[0].age, 10) << "of the bulletin of step 0";
  farm.IssueForecast(0, Eastward());
  test::RandomSteps(farm, 3, 1);
  Observe(farm, 0, view);
  EXPECT_EQ(view.disasters[0].age, 3);
  EXPECT_FLOAT_EQ(view.disasters[0].belief.dx, 1.0F);
}

TEST(IssueForecast, HasItsOwnRings) {
  Farm farm = At10();
  farm.IssueForecast(0, Eastward());
  const std::vector<Waypoint> track = ForecastTrack(farm, 0, 10);
  ASSERT_EQ(track.size(), 4U) << "now, two points, and the end of the storm";
  EXPECT_EQ(track[0].x, 5.0F);
  EXPECT_EQ(track[0].y, -50.0F);
  EXPECT_EQ(track[0].radii, (std::vector<float>{1.0F, 2.0F})) << "the present rings are known";
  EXPECT_EQ(track[1].radii, (std::vector<float>{3.0F, 6.0F}));
  EXPECT_EQ(track[2].radii, (std::vector<float>{5.0F, 8.0F}));
  EXPECT_EQ(track[2].risks[0], -15.0F);
  EXPECT_EQ(track[3].step, 150.0F);
  EXPECT_EQ(track[3].x, 145.0F) << "on as on its last leg";
  EXPECT_EQ(track[3].radii, (std::vector<float>{5.0F, 8.0F}));
  IssuedForecast without = Eastward();
  for (Waypoint& point : without.points) point.radii = point.risks = {};
  farm.IssueForecast(0, without);
  EXPECT_EQ(ForecastTrack(farm, 0, 10)[1].radii, (std::vector<float>{1.0F, 2.0F}));
}

TEST(IssueForecast, MayBeOfADisasterWithoutATrack) {
  Scenario scenario = NorthernStorm(ViewMode::kFull);
  scenario.disasters = {StillDisaster(4, 4, {2}, {-10})};
  Farm farm = At10(scenario);
  EXPECT_FALSE(HasForecast(farm, 0, 10));
  farm.IssueForecast(0, {5.0F, {{30.0F, 14.0F, 4.0F}}});
  EXPECT_TRUE(HasForecast(farm, 0, 10));
  EXPECT_EQ(ForecastAt(farm, 0, 10, 20), (std::array<float, 2>{9.0F, 4.0F}));
  EXPECT_EQ(ForecastAt(farm, 0, 10, 99), (std::array<float, 2>{14.0F, 4.0F}));
  EXPECT_EQ(ForecastTrack(farm, 0, 10).back().radii, (std::vector<float>{2.0F}));
  test::RandomSteps(farm, 20, 1);
  EXPECT_EQ(farm.disasters()[0].x, 4.0F);
  EXPECT_FALSE(HasForecast(farm, 0, 30)) << "it has expired";
}

TEST(IssueForecast, KeepsTheLastKnownMotionAndGrowthAfterItsLastPoint) {
  Scenario scenario = NorthernStorm(ViewMode::kFull);
  scenario.disasters = {StillDisaster(4, 4, {2}, {-10})};
  DisasterSpec& spec = scenario.disasters[0];
  spec.speed = 0.25F;
  spec.heading_deg = 90;
  spec.radius_growth = 0.125F;
  spec.border = Border::kLeave;
  spec.duration = 90;
  Farm farm = At10(scenario);
  const Disaster now = farm.disasters()[0];
  ASSERT_FLOAT_EQ(now.radius[0], 3.25F);
  // A forecast with one point: after it, the disaster continues with its present motion.
  farm.IssueForecast(0, {5.0F, {{30.0F, 14.0F, 4.0F}}});
  EXPECT_FLOAT_EQ(ForecastAt(farm, 0, 10, 50)[0], 14.0F + 20.0F * now.dx);
  EXPECT_FLOAT_EQ(ForecastAt(farm, 0, 10, 50)[1], 4.0F + 20.0F * now.dy);
  EXPECT_NE(ForecastAt(farm, 0, 10, 50), ForecastAt(farm, 0, 10, 30));
  // Its rings grow by the disaster's growth until the disaster ends at step 90.
  const std::vector<Waypoint> track = ForecastTrack(farm, 0, 10);
  EXPECT_FLOAT_EQ(track[1].radii[0], 3.25F + 20.0F * 0.125F);
  EXPECT_EQ(track.back().step, 90.0F);
  EXPECT_FLOAT_EQ(track.back().radii[0], 3.25F + 80.0F * 0.125F);
  Disaster ghost = now;
  ghost.waypoint = 0;
  FollowTrack(ghost, track, 70);
  EXPECT_NEAR(ghost.radius[0], 3.25F + 60.0F * 0.125F, 1e-4F);
  EXPECT_NEAR(ghost.x, 14.0F + 40.0F * now.dx, 1e-4F);
  // A forecast with two points: after the last one, their motion continues and their rings grow.
  farm.IssueForecast(0, {6.0F,
                         {{30.0F, 14.0F, 4.0F, 3, {4.0F}, {-10.0F}, {}},
                          {40.0F, 24.0F, 9.0F, 3, {5.0F}, {-10.0F}, {}}}});
  EXPECT_EQ(ForecastAt(farm, 0, 10, 60), (std::array<float, 2>{44.0F, 19.0F}));
  EXPECT_FLOAT_EQ(ForecastTrack(farm, 0, 10).back().radii[0], 5.0F + 50.0F * 0.125F);
}

TEST(IssueForecast, IsReplacedByTheNewest) {
  Scenario scenario = NorthernStorm();
  scenario.disasters[0].forecasts = {{0.0F, {{100.0F, 0.0F, 0.0F}}},
                                     {30.0F, {{100.0F, 1.0F, 0.0F}}}};
  Farm farm = At10(scenario);
  EXPECT_EQ(NewestForecast(farm, 0, 10)->points[0].x, 0.0F);
  farm.IssueForecast(0, Eastward());
  EXPECT_EQ(NewestForecast(farm, 0, 10)->points[0].x, 35.0F);
  EXPECT_EQ(NewestForecast(farm, 0, 30)->points[0].x, 1.0F) << "the scenario's next one";
  farm.Reset(4, 3);
  EXPECT_EQ(NewestForecast(farm, 0, 10)->points[0].x, 0.0F) << "another episode";
}

TEST(IssueForecast, IsSavedAndLoaded) {
  Farm farm = At10();
  farm.IssueForecast(0, Eastward());
  farm.SetDisaster(1, StillDisaster(1, 1, {1}, {-5}));
  Farm loaded = MakeFarm(NorthernStorm());
  loaded.Load(farm.Save());
  EXPECT_EQ(loaded.Hash(), farm.Hash());
  EXPECT_EQ(loaded.forecasts()[1], nullptr);
  for (int step = 0; step < 20; ++step) {
    test::RandomSteps(farm, 1, 5);
    test::RandomSteps(loaded, 1, 5);
    EXPECT_EQ(ForecastAt(loaded, 0, farm.step(), 60), ForecastAt(farm, 0, farm.step(), 60));
    EXPECT_EQ(loaded.Hash(), farm.Hash());
  }
  Farm plain = At10();
  EXPECT_EQ(plain.Save().find("forecasts"), std::string::npos) << "as in older versions";
  loaded.Load(plain.Save());
  EXPECT_EQ(loaded.forecasts()[0], nullptr);
}

TEST(SetDisaster, TakesTheTruthAndTheForecastApart) {
  Farm farm = At10();
  DisasterSpec storm = farm.scenario().disasters[0];
  storm.track[1].x = 20.0F;
  storm.forecasts = {Eastward()};
  farm.SetDisaster(1, storm);
  View view;
  Observe(farm, 0, view);
  ASSERT_TRUE(view.disasters[1].known) << "its bulletin is issued at once";
  EXPECT_FLOAT_EQ(view.disasters[1].belief.x + 10.0F * view.disasters[1].belief.dx,
                  ForecastAt(farm, 1, 10, 20)[0]);
  test::RandomSteps(farm, 10, 1);
  EXPECT_FLOAT_EQ(farm.disasters()[1].x, 7.0F);
  storm.forecasts.clear();
  farm.SetDisaster(1, storm);
  EXPECT_FALSE(HasForecast(farm, 1, farm.step())) << "another disaster, another forecast";
}

/// A storm as a bulletin of step 4 announces it: recorded until then, forecast after it.
DisasterSpec Announced() {
  DisasterSpec storm = NorthernStorm().disasters[0];
  storm.track = {{0.0F, 5.0F, -60.0F, 3, storm.radii, storm.risks},
                 {4.0F, 5.0F, -56.0F, 3, storm.radii, storm.risks},
                 {148.0F, 50.0F, 40.0F, 4, {2.0F, 4.0F}, storm.risks}};
  storm.forecasts = {{4.0F, {storm.track[2]}}};
  return storm;
}

TEST(FitArrival, KeepsTheTruthAsFarFromTheForecastAsPublishedErrorsAre) {
  Scenario scenario = NorthernStorm();
  scenario.cell_size_m = 1000.0;
  scenario.step_duration_s = 600.0;
  scenario.view.disaster_slots = 1;
  scenario.view.forecast_error_km = {69.0F, 121.0F, 175.0F};
  Farm farm = At10(scenario);
  DisasterSpec storm = Announced();
  FitArrival(farm, 1, storm);
  EXPECT_EQ(storm.forecasts[0].points[0].x, 50.0F) << "agents receive the bulletin";
  EXPECT_EQ(storm.track[1].x, 5.0F) << "what is recorded is true";
  const auto unit = ForecastErrorVector(4, 2, 1);
  EXPECT_NEAR(storm.track[2].x, 50.0F - 69.0F * unit[0], 1e-3) << "24 hours after the issue";
  EXPECT_NEAR(storm.track[2].y, 40.0F - 69.0F * unit[1], 1e-3);
  farm.SetDisaster(1, storm);
  EXPECT_EQ(ForecastAt(farm, 1, 10, 148), (std::array<float, 2>{50.0F, 40.0F}));
  scenario.view.forecast_error_km.clear();
  const Farm exact = At10(scenario);
  storm = Announced();
  FitArrival(exact, 1, storm);
  EXPECT_EQ(storm.track[2].x, 50.0F) << "without errors the storm follows the forecast";
}

TEST(FitArrival, IssuesAForecastOfTheFutureNow) {
  const Farm farm = At10();
  DisasterSpec storm = Announced();
  storm.forecasts[0].step = 90.0F;
  storm.track.insert(storm.track.begin() + 2, {90.0F, 9.0F, 9.0F, 3, storm.radii, storm.risks});
  FitArrival(farm, 1, storm);
  EXPECT_EQ(storm.forecasts[0].step, 10.0F);
  ASSERT_EQ(storm.forecasts[0].points.size(), 2U);
  EXPECT_EQ(storm.forecasts[0].points[0].step, 90.0F) << "recorded, and yet to come here";
}

TEST(FitForecast, KeepsRingsThatFitTheDisaster) {
  Farm farm = At10();
  EXPECT_EQ(FitForecast(farm, 0, Announced()).points[0].radii, (std::vector<float>{2.0F, 4.0F}));
  farm.SetDisaster(1, StillDisaster(1, 1, {1}, {-5}));
  const IssuedForecast bare = FitForecast(farm, 1, Announced());
  EXPECT_TRUE(bare.points[0].radii.empty());
  EXPECT_EQ(bare.points[0].x, 50.0F);
  EXPECT_NO_THROW(farm.IssueForecast(1, bare));
}

std::string Refused(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "was taken";
}

TEST(IssueForecast, IsRefusedInWords) {
  Farm farm = At10();
  farm.IssueForecast(0, Eastward());
  const std::uint64_t hash = farm.Hash();
  const auto refused = [&](const std::function<void(IssuedForecast&)>& change,
                           std::int32_t id = 0) {
    IssuedForecast forecast = Eastward();
    change(forecast);
    return Refused([&] { farm.IssueForecast(id, forecast); });
  };
  EXPECT_EQ(refused([](IssuedForecast&) {}, 1),
            "disaster: got 1, expected one of the 1 disasters of this episode; add it without "
            "forecast_only");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.step = 11.0F; }),
            "forecast.step: got 11, expected at most the present step, 10");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.step = 9.0F; }),
            "forecast.step: got 9, expected at least the step of the newest forecast, 10");
  EXPECT_EQ(refused([](IssuedForecast& f) {
              f.step = 2.0F;
              f.points = {{8.0F, 1.0F, 1.0F}};
            }),
            "forecast.points: got 8, expected a last point after the present step, 10");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.points.clear(); }),
            "forecasts[0].points: got 0 entries, expected [1, 10000]");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.points[1].step = 40.0F; }),
            "forecasts[0].points[1].step: got 40, expected more than the step of points[0], 40");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.points[1].radii.clear(); }),
            "forecasts[0].points[1].radii: missing, expected radii because points[0] has radii");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.points[0].radii = {3.0F}; }),
            "forecasts[0].points[0].radii: got 1 entries, expected as many as risks: 2");
  EXPECT_EQ(refused([](IssuedForecast& f) { f.points[0].x = 1e9F; }),
            "forecasts[0].points[0].x: got 1e+09, expected [-1e+06, 1e+06]");
  EXPECT_EQ(farm.Hash(), hash) << "nothing is half-applied";
}

std::string WithPoints(const std::string& points) {
  return "name: x\ndisasters:\n  - kind: typhoon\n    risks: [-20, -10]\n    track:\n"
         "      - {step: 0, x: 1, y: 1, radii: [3, 4], grade: 3}\n"
         "    forecasts: [{step: 0, points: [" +
         points + "]}]\n";
}

TEST(ScenarioForecasts, MayHaveRings) {
  const Scenario scenario =
      ParseScenario(WithPoints("{step: 6, x: 1, y: 2, grade: 4, radii: [5, 9]}, "
                               "{step: 9, x: 1, y: 3, grade: 2, radii: [0, 8], risks: [-15, -5]}"),
                    "x.yaml");
  const std::vector<Waypoint>& points = scenario.disasters[0].forecasts[0].points;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].risks, (std::vector<float>{-20.0F, -10.0F})) << "those of the disaster";
  EXPECT_EQ(points[1].radii, (std::vector<float>{0.0F, 8.0F}));
  const Scenario again = ParseScenario(ToYaml(scenario), "again");
  EXPECT_EQ(ToYaml(again), ToYaml(scenario));
  EXPECT_EQ(again.disasters[0].forecasts[0].points[1].risks, (std::vector<float>{-15.0F, -5.0F}));
  const auto refused = [](const std::string& points_text) {
    return Refused([&] { ParseScenario(WithPoints(points_text), "x.yaml"); });
  };
  EXPECT_EQ(refused("{step: 6, x: 1, y: 2}"), "was taken");
  EXPECT_EQ(refused("{step: 6, x: 1, y: 2, radii: [5, 9]}"),
            "x.yaml:7: disasters[0].forecasts[0].points[0].grade: missing, expected a whole number "
            "in [1, 4]");
  EXPECT_EQ(refused("{step: 6, x: 1, y: 2}, {step: 9, x: 1, y: 2, grade: 3, radii: [5, 9]}"),
            "x.yaml:7: disasters[0].forecasts[0].points[1].radii: got radii, expected none "
            "because points[0] has none");
}

}  // namespace
}  // namespace aquafarm
