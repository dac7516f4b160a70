// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/farm/forecast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/observation/view.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

using test::MakeFarm;

/// Ten-minute steps, cells of one kilometre, and a storm that moves north for four days.
Scenario Forecast() {
  Scenario scenario = test::CrowdedScenario(1, 0);
  scenario.cell_size_m = 1000.0;
  scenario.step_duration_s = 600.0;
  scenario.step_limit = 600;
  DisasterSpec storm;
  storm.radii = {20.0F, 50.0F};
  storm.risks = {-20.0F, -5.0F};
  storm.duration = 576;
  for (int day = 0; day <= 4; ++day) {
    storm.track.push_back({static_cast<float>(144 * day),
                           5.0F,
                           -100.0F + 60.0F * static_cast<float>(day),
                           3,
                           storm.radii,
                           storm.risks,
                           {}});
  }
  scenario.disasters = {storm};
  scenario.view.forecast_error_km = {69.0F, 121.0F, 175.0F};
  return scenario;
}

double Length(std::array<float, 2> vector) {
  return std::hypot(static_cast<double>(vector[0]), static_cast<double>(vector[1]));
}

TEST(ForecastError, GrowsAsGivenWithLeadTime) {
  const Scenario scenario = Forecast();
  EXPECT_EQ(MeanForecastError(scenario, 0.0F), 0.0F);
  EXPECT_FLOAT_EQ(MeanForecastError(scenario, 72.0F), 34.5F) << "12 hours";
  EXPECT_FLOAT_EQ(MeanForecastError(scenario, 144.0F), 69.0F);
  EXPECT_FLOAT_EQ(MeanForecastError(scenario, 288.0F), 121.0F);
  EXPECT_FLOAT_EQ(MeanForecastError(scenario, 432.0F), 175.0F);
  EXPECT_FLOAT_EQ(MeanForecastError(scenario, 576.0F), 229.0F) << "on as from 48 to 72 hours";
}

TEST(ForecastError, IsOneOnAverageToAnySide) {
  double length = 0.0;
  std::array<double, 2> mean{};
  std::array<int, 4> sides{};
  constexpr int kEpisodes = 40000;
  for (std::uint64_t episode = 0; episode < kEpisodes; ++episode) {
    const auto error = ForecastErrorVector(7, episode, 0);
    length += Length(error) / kEpisodes;
    for (std::size_t i = 0; i < 2; ++i) mean[i] += static_cast<double>(error[i]) / kEpisodes;
    ++sides[QuadrantOf(-error[0], -error[1])];
  }
  EXPECT_NEAR(length, 1.0, 0.01);
  EXPECT_NEAR(mean[0], 0.0, 0.015);
  EXPECT_NEAR(mean[1], 0.0, 0.015);
  for (const int side : sides) EXPECT_NEAR(side, kEpisodes / 4, 400);
  EXPECT_NE(ForecastErrorVector(7, 0, 0), ForecastErrorVector(7, 0, 1)) << "another disaster";
}

TEST(Forecasts, AreOffByTheErrorOfTheirLeadTime) {
  Farm farm = MakeFarm(Forecast());
  farm.Reset(3, 5);
  const double unit = Length(ForecastErrorVector(3, 5, 0));
  const auto at = [&](std::int32_t issued, std::int32_t step) {
    const auto there = ForecastAt(farm, 0, issued, step);
    const double true_y = -100.0 + 60.0 * std::min(step, 576) / 144.0;
    return std::hypot(static_cast<double>(there[0]) - 5.0, static_cast<double>(there[1]) - true_y);
  };
  EXPECT_NEAR(at(0, 0), 0.0, 1e-4);
  EXPECT_NEAR(at(0, 144), 69.0 * unit, 1e-2);
  EXPECT_NEAR(at(0, 432), 175.0 * unit, 1e-2);
  EXPECT_NEAR(at(0, 72), 34.5 * unit, 1e-2) << "straight between waypoints";
  EXPECT_LT(at(300, 432), at(100, 432)) << "a later forecast is better";
  EXPECT_NEAR(at(432, 432), 0.0, 1e-4);
  EXPECT_NEAR(at(0, 900), at(0, 576), 1e-4) << "it stays at the track's end";
}

TEST(Forecasts, AreTheSameAsATrack) {
  Farm farm = MakeFarm(Forecast());
  farm.Reset(3, 6);
  test::RandomSteps(farm, 100, 1);
  const std::vector<Waypoint> track = ForecastTrack(farm, 0, 100);
  EXPECT_EQ(track.front().step, 100.0F);
  Disaster ghost = farm.disasters()[0];
  ghost.waypoint = 0;
  for (std::int32_t step = 100; step < 560; step += 23) {
    FollowTrack(ghost, track, step);
    const auto there = ForecastAt(farm, 0, 100, step);
    EXPECT_NEAR(ghost.x, there[0], 1e-3) << step;
    EXPECT_NEAR(ghost.y, there[1], 1e-3) << step;
  }
  EXPECT_EQ(track.back().radii, farm.scenario().disasters[0].radii);
}

TEST(Forecasts, AreTheSameAsATrackThatIsYetToBegin) {
  Scenario scenario = Forecast();
  for (Waypoint& waypoint : scenario.disasters[0].track) waypoint.step += 150.0F;
  Farm farm = MakeFarm(scenario);
  farm.Reset(3, 6);
  test::RandomSteps(farm, 100, 1);
  const std::vector<Waypoint> track = ForecastTrack(farm, 0, 100);
  Disaster ghost = farm.disasters()[0];
  ghost.waypoint = 0;
  for (const std::int32_t step : {100, 101, 125, 149, 150, 151, 294, 400}) {
    FollowTrack(ghost, track, step);
    const auto there = ForecastAt(farm, 0, 100, step);
    EXPECT_NEAR(ghost.x, there[0], 1e-3) << step;
    EXPECT_NEAR(ghost.y, there[1], 1e-3) << step;
  }
  EXPECT_NE(ForecastAt(farm, 0, 100, 149)[0], 5.0F) << "it errs from the first step on";
}

// Returns a farm after 60 steps and checks that its true state equals that of a farm whose ships
// observe the current motion.
Farm PlayedBeside(const Scenario& plain, const Scenario& scenario) {
  Farm told = MakeFarm(scenario);
  Farm knows = MakeFarm(plain);
  told.Reset(3, 7);
  knows.Reset(3, 7);
  test::RandomSteps(told, 60, 2);
  test::RandomSteps(knows, 60, 2);
  EXPECT_EQ(told.disasters()[0].y, knows.disasters()[0].y) << "the truth is the same";
  EXPECT_EQ(told.record().episode_return, knows.record().episode_return);
  return told;
}

TEST(Forecasts, AreWhatShipsObserveWhileTheTruthFollowsTheTrack) {
  Scenario plain = Forecast();
  plain.view.forecast_error_km.clear();
  const Farm told = PlayedBeside(plain, Forecast());
  View view;
  Observe(told, 0, view);
  const KnownDisaster& known = view.disasters[0];
  const auto there = ForecastAt(told, 0, 60, 60 + kForecastSteps);
  EXPECT_NEAR(known.belief.x + kForecastSteps * known.belief.dx, there[0], 1e-3);
  EXPECT_NEAR(known.belief.y + kForecastSteps * known.belief.dy, there[1], 1e-3);
  EXPECT_NE(known.belief.dx, told.disasters()[0].dx);
  EXPECT_EQ(known.belief.x, told.disasters()[0].x) << "where it is now is known";
}

TEST(Forecasts, AgeWithTheBulletinTheyCameWith) {
  Scenario scenario = Forecast();
  scenario.view.mode = ViewMode::kPartial;
  scenario.view.sensor_radius = 1.0F;
  scenario.view.bulletin_period = 50;
  Farm farm = MakeFarm(scenario);
  farm.Reset(3, 8);
  test::RandomSteps(farm, 70, 2);
  View view;
  Observe(farm, 0, view);
  const KnownDisaster& known = view.disasters[0];
  ASSERT_FALSE(known.visible);
  ASSERT_EQ(known.age, 20);
  const auto there = ForecastAt(farm, 0, 50, 70 + kForecastSteps);
  const float lead = 20.0F + kForecastSteps;
  EXPECT_NEAR(known.belief.x + lead * known.belief.dx, there[0], 1e-3);
  EXPECT_NEAR(known.belief.y + lead * known.belief.dy, there[1], 1e-3);
}

std::string Refused(const std::string& errors, bool tracked = true) {
  Scenario scenario = Forecast();
  scenario.view.forecast_error_km.clear();
  if (!tracked) scenario.disasters[0].track.clear();
  std::string text = ToYaml(scenario);
  text.replace(text.find("view:\n"), 6, "view:\n  forecast_error_km: " + errors + "\n");
  try {
    ParseScenario(text, "x.yaml");
  } catch (const InputError& error) {
    return std::string(error.what()).substr(std::string(error.what()).find("view"));
  }
  return "was taken";
}

TEST(Forecasts, AreAskedForInWords) {
  EXPECT_EQ(Refused("[69, 121, 175]"), "was taken");
  EXPECT_EQ(Refused("[69, 121]"), "view.forecast_error_km: got 2 entries, expected [3, 3]");
  EXPECT_EQ(Refused("[69, 21, 175]"),
            "view.forecast_error_km: got an error that shrinks with time, expected ascending "
            "numbers");
  EXPECT_EQ(Refused("[69, 121, 175]", false),
            "view.forecast_error_km: is used only if a disaster has a track or "
            "view.disaster_slots is above 0");
}

TEST(Forecasts, AreWrittenBackAndPartOfTheHash) {
  const Scenario scenario = Forecast();
  EXPECT_EQ(ParseScenario(ToYaml(scenario), "x.yaml").view.forecast_error_km,
            scenario.view.forecast_error_km);
  Scenario other = scenario;
  other.view.forecast_error_km[0] = 70.0F;
  EXPECT_NE(HashScenario(other), HashScenario(scenario));
  other.view.forecast_error_km.clear();
  EXPECT_EQ(ToYaml(other).find("forecast"), std::string::npos);
}

/// The storm of Forecast() with two forecasts issued by an authority at steps 0 and 200, without
/// forecast_error_km.
Scenario ReportedFarm() {
  Scenario scenario = Forecast();
  scenario.view.forecast_error_km.clear();
  scenario.disasters[0].forecasts = {{0.0F, {{144.0F, 45.0F, -40.0F}, {288.0F, 95.0F, 0.0F}}},
                                     {200.0F, {{288.0F, 25.0F, 20.0F}, {432.0F, 35.0F, 60.0F}}}};
  return scenario;
}

TEST(IssuedForecasts, LeadFromWhereTheStormIsToThePointsSaid) {
  Farm farm = MakeFarm(ReportedFarm());
  farm.Reset(3, 5);
  const auto at = [&](std::int32_t issued, std::int32_t step) {
    return ForecastAt(farm, 0, issued, step);
  };
  using Place = std::array<float, 2>;
  EXPECT_EQ(at(0, 0), (Place{5.0F, -100.0F})) << "where it is is known";
  EXPECT_EQ(at(0, 144), (Place{45.0F, -40.0F}));
  EXPECT_EQ(at(0, 72), (Place{25.0F, -70.0F})) << "straight between";
  EXPECT_NEAR(at(0, 400)[0], 95.0 + 112.0 * 50.0 / 144.0, 1e-3) << "on as on its last leg";
  EXPECT_NEAR(at(0, 400)[1], 112.0 * 40.0 / 144.0, 1e-3);
  EXPECT_EQ(at(0, 576), (Place{195.0F, 80.0F}));
  EXPECT_EQ(at(0, 900), at(0, 576)) << "as far as the truth has a track";
  EXPECT_EQ(at(431, 432), (Place{35.0F, 60.0F}));
  EXPECT_NEAR(at(431, 441)[0], 35.0 + 9.0 * 10.0 / 144.0, 1e-3) << "not as on from the truth";
  EXPECT_EQ(at(72, 72), (Place{5.0F, -70.0F})) << "the truth again";
  EXPECT_EQ(at(72, 108), (Place{25.0F, -55.0F}));
  EXPECT_EQ(at(199, 288), (Place{95.0F, 0.0F})) << "the newer one is not out yet";
  EXPECT_EQ(at(200, 288), (Place{25.0F, 20.0F})) << "the newest counts";
}

TEST(IssuedForecasts, AreObservedFromTheFirstIssueUntilTheyExpire) {
  Scenario scenario = ReportedFarm();
  scenario.disasters[0].forecasts[0].step = 10.0F;
  Farm farm = MakeFarm(scenario);
  farm.Reset(3, 5);
  EXPECT_FALSE(HasForecast(farm, 0, 9));
  EXPECT_TRUE(HasForecast(farm, 0, 10));
  EXPECT_TRUE(HasForecast(farm, 0, 431));
  EXPECT_FALSE(HasForecast(farm, 0, 432));
}

TEST(IssuedForecasts, AreWhatShipsObserveWhileTheTruthFollowsTheTrack) {
  Scenario plain = ReportedFarm();
  plain.disasters[0].forecasts.clear();
  const Farm told = PlayedBeside(plain, ReportedFarm());
  View view;
  Observe(told, 0, view);
  const auto there = ForecastAt(told, 0, 60, 60 + kForecastSteps);
  EXPECT_NEAR(view.disasters[0].belief.x + kForecastSteps * view.disasters[0].belief.dx, there[0],
              1e-3);
  EXPECT_GT(view.disasters[0].belief.dx, 0.0F) << "said to go east, and it goes north";
  EXPECT_EQ(told.disasters()[0].x, 5.0F);
}

TEST(IssuedForecasts, AreTheSameAsATrackWithTheTruthsRings) {
  Scenario scenario = ReportedFarm();
  scenario.disasters[0].track[2].radii = {30.0F, 60.0F};
  Farm farm = MakeFarm(scenario);
  farm.Reset(3, 6);
  test::RandomSteps(farm, 100, 1);
  const std::vector<Waypoint> track = ForecastTrack(farm, 0, 100);
  Disaster ghost = farm.disasters()[0];
  Disaster truth = ghost;
  ghost.waypoint = 0;
  for (std::int32_t step = 100; step < 560; step += 23) {
    FollowTrack(ghost, track, step);
    FollowTrack(truth, scenario.disasters[0].track, step);
    const auto there = ForecastAt(farm, 0, 100, step);
    EXPECT_NEAR(ghost.x, there[0], 1e-3) << step;
    EXPECT_NEAR(ghost.y, there[1], 1e-3) << step;
    EXPECT_NEAR(ghost.radius[0], truth.radius[0], 1e-3) << step;
  }
}

TEST(IssuedForecasts, AreOfTheScenariosTrackNotOfOneSetInPlay) {
  Farm farm = MakeFarm(ReportedFarm());
  farm.Reset(3, 6);
  Farm loaded = MakeFarm(ReportedFarm());
  DisasterSpec other = farm.scenario().disasters[0];
  other.forecasts.clear();
  farm.SetDisaster(0, other);
  loaded.Load(farm.Save());
  EXPECT_TRUE(HasForecast(farm, 0, 0)) << "the same track stays the scenario's";
  EXPECT_TRUE(HasForecast(loaded, 0, 0));
  other.track[1].x += 1.0F;
  farm.SetDisaster(0, other);
  EXPECT_FALSE(HasForecast(farm, 0, 0));
  loaded.Load(farm.Save());
  EXPECT_FALSE(HasForecast(loaded, 0, 0));
}

TEST(IssuedForecasts, AreOnlyOfATrackOfTheScenario) {
  const auto refused = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return "was taken";
  };
  Scenario scenario = ReportedFarm();
  scenario.disasters[0].track.clear();
  EXPECT_EQ(refused([&] { ValidateScenario(scenario); }),
            "disasters[0].forecasts: is used only if 'track' is set");
}

// Returns the error of reading a file with these forecasts, or "was taken".
std::string RefusalOfReported(const std::string& forecasts, const std::string& errors = "") {
  const std::string text =
      "name: x\ngrid: {origin: {latitude: 30, longitude: 122}}\n"
      "time: {step_duration_s: 600, start: 2021-07-24T00:00:00Z}\n"
      "disasters:\n  - kind: typhoon\n    risks: [-10]\n    track:\n"
      "      - {step: 0, x: 1, y: 1, radii: [3], grade: 3}\n    forecasts: " +
      forecasts + "\n" + errors;
  try {
    ParseScenario(text, "x.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "was taken";
}

TEST(IssuedForecasts, AreRefusedWithALine) {
  EXPECT_EQ(RefusalOfReported("[{step: 0, points: [{step: 6, x: 1, y: 2}]}]"), "was taken");
  EXPECT_EQ(RefusalOfReported("[{step: 6, points: [{step: 6, x: 1, y: 2}]}]"),
            "x.yaml:9: disasters[0].forecasts[0].points[0].step: got 6, expected more than the "
            "step of its issue, 6");
  EXPECT_EQ(RefusalOfReported("[{step: 6, points: [{step: 9, x: 1, y: 2}]}, "
                              "{step: 6, points: [{step: 9, x: 1, y: 2}]}]"),
            "x.yaml:9: disasters[0].forecasts[1].step: got 6, expected more than the step of "
            "forecasts[0], 6");
  EXPECT_EQ(RefusalOfReported("[{step: 6}]"),
            "x.yaml:9: disasters[0].forecasts[0].points: got 0 entries, expected [1, 10000]");
  EXPECT_EQ(RefusalOfReported("[{step: 0, points: [{step: 6, x: 1, latitude: 2}]}]"),
            "x.yaml:9: disasters[0].forecasts[0].points[0].y: missing, expected a number in "
            "[-1e+06, 1e+06]");
  EXPECT_EQ(RefusalOfReported("[{step: 0, points: [{step: 6, x: 1, y: 2}]}]",
                              "view: {forecast_error_km: [1, 2, 3]}\n"),
            "x.yaml:10: view.forecast_error_km: is used only if no disaster has forecasts, but "
            "disasters[0] has");
}

TEST(IssuedForecasts, AreReadInUnitsOfTheGlobeAndWrittenInThoseOfTheGrid) {
  const Scenario scenario = ParseScenario(
      "name: x\ngrid: {cell_size_m: 1000, origin: {latitude: 30, longitude: 122}}\n"
      "time: {step_duration_s: 600, start: 2021-07-24T00:00:00Z}\n"
      "disasters:\n  - kind: typhoon\n    risks: [-10]\n    track:\n"
      "      - {step: 0, x: 1, y: 1, radii: [3], grade: 3}\n    forecasts:\n"
      "      - {time: 2021-07-23T23:00:00Z, points: [{time: 2021-07-24T06:00:00Z, latitude: 30.1,"
      " longitude: 122}]}\n",
      "x.yaml");
  const std::vector<IssuedForecast>& said = scenario.disasters[0].forecasts;
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].step, -6.0F);
  ASSERT_EQ(said[0].points.size(), 1U);
  EXPECT_EQ(said[0].points[0].step, 36.0F);
  EXPECT_NEAR(said[0].points[0].x, 0.0F, 1e-3);
  EXPECT_NEAR(said[0].points[0].y, 11.085F, 0.01F) << "a tenth of a degree";
  EXPECT_EQ(ToYaml(ParseScenario(ToYaml(scenario), "again")), ToYaml(scenario));
  Scenario without = scenario;
  without.disasters[0].forecasts.clear();
  EXPECT_NE(HashScenario(without), HashScenario(scenario));
  EXPECT_EQ(ToYaml(without).find("forecasts"), std::string::npos);
}

}  // namespace
}  // namespace aquafarm
