// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/ensemble.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "agents_fixture.h"
#include "rescue/rescue_samples.h"

namespace aquafarm::agents {
namespace {

TEST(ForecastErrors, GrowAsPublished) {
  const ForecastErrors errors;
  EXPECT_NEAR(SpreadAt(errors, 24.0).position_km * std::sqrt(std::acos(-1.0) / 2.0), 66.2, 1e-9);
  EXPECT_NEAR(SpreadAt(errors, 36.0).position_km * std::sqrt(std::acos(-1.0) / 2.0),
              (66.2 + 119.5) / 2.0, 1e-9);
  EXPECT_EQ(SpreadAt(errors, -5.0).position_km, SpreadAt(errors, 0.0).position_km);
  ForecastErrors none;
  none.scale = 0.0;
  EXPECT_EQ(SpreadAt(none, 72.0).position_km, 0.0);
}

TEST(ForecastErrors, TheSizeForgetsItsReport) {
  const ForecastErrors errors;
  EXPECT_NEAR(SizeSpreadAt(errors, 0.4, 0.0), 0.1, 1e-12);
  // Of two values with correlation r, one that is known leaves the spread sqrt(1 - r²).
  const double after_a_day = std::sqrt(0.16 * (1.0 - 0.865 * 0.865) + 0.01 * 0.865 * 0.865);
  EXPECT_NEAR(SizeSpreadAt(errors, 0.4, 24.0), after_a_day, 2e-3);
  EXPECT_NEAR(SizeSpreadAt(errors, 0.4, 2000.0), 0.4, 1e-6);
  EXPECT_EQ(SizeSpreadAt(errors, 0.4, std::numeric_limits<double>::infinity()), 0.4);
}

TEST(Ensemble, RadiiSpreadFromTheirLastReport) {
  CentralForecast forecast = test::PassingStorm();
  const Ensemble unknown(forecast, test::SmallEnsemble(4000), {});
  forecast.size_report_h = 0.0;
  for (double& lead : forecast.lead_h) lead *= 10.0;  // 0, 50, 100 h
  const Ensemble reported(forecast, test::SmallEnsemble(4000), {});
  const double full = unknown.spread().front().size_log;
  EXPECT_NEAR(unknown.spread().back().size_log, full, 0.05 * full);
  for (std::size_t i = 0; i < 3; ++i) {
    const double expected = SizeSpreadAt(ForecastErrors{}, 0.35, 50.0 * static_cast<double>(i));
    EXPECT_NEAR(reported.spread()[i].size_log, expected, 0.05 * expected) << i;
  }
}

TEST(Ensemble, RefusesArraysThatDoNotFitIntoMemory) {
  EnsembleOptions options = test::SmallEnsemble(60000);
  options.steps = 4000;
  const std::vector<Cell> sites(64, Cell{2, 3});
  EXPECT_CONTAINS(
      test::MessageOf<InputError>([&] { Ensemble(test::PassingStorm(), options, sites); }),
      "members times steps times devices: got 15360000000, expected [0, 400000000]");
}

// Radii without a wind: an unknown spread would make all radii NaN, which never arrive.
TEST(Ensemble, AStormOfUnknownWindStillArrives) {
  CentralForecast forecast = test::PassingStorm();
  for (StormPoint& point : forecast.path.points) {
    point.wind_mps = std::numeric_limits<double>::quiet_NaN();
  }
  const Ensemble ensemble(forecast, test::SmallEnsemble(100), {{6, 5}});
  for (const EnsembleSpread& at : ensemble.spread()) EXPECT_GT(at.size_log, 0.0);
  const std::int16_t* arrival = ensemble.Arrival(2, {6, 5});
  const auto reached = std::count_if(arrival, arrival + 100,
                                     [](std::int16_t at) { return at != Ensemble::kNoArrival; });
  EXPECT_GT(reached, 90) << "the storm passes through this cell";
}

// A typhoon that was once a weak storm: its radii spread as those of typhoons do.
TEST(Ensemble, RadiiSpreadAsThoseOfStormsOfTheirStrength) {
  CentralForecast forecast = test::PassingStorm();
  forecast.path.points[0].wind_mps = 15.0;  // below a gale
  forecast.path.points[1].wind_mps = 20.0;  // below 48 kt
  forecast.path.points[2].wind_mps = 40.0;
  const auto sigma = [](double wind_mps) {
    return EstimateRadius(34, wind_mps, 30.0, 2).log_sigma;
  };
  ASSERT_GT(sigma(20.0), 1.2 * sigma(40.0));
  const Ensemble unknown(forecast, test::SmallEnsemble(4000), {});
  EXPECT_NEAR(unknown.spread()[0].size_log, sigma(20.0), 0.03 * sigma(20.0));
  EXPECT_NEAR(unknown.spread()[1].size_log, sigma(20.0), 0.03 * sigma(20.0));
  EXPECT_NEAR(unknown.spread()[2].size_log, sigma(40.0), 0.03 * sigma(40.0));
}

// Without errors all members are the central forecast; a slow test of every cell and step.
TEST(Ensemble, WithoutErrorsCoversTheCellsOfTheCentralForecast) {
  const CentralForecast forecast = test::PassingStorm();
  EnsembleOptions options = test::SmallEnsemble(3);
  options.errors.scale = 0.0;
  const Ensemble ensemble(forecast, options, {{2, 3}});
  float exposure = 0.0F;
  for (std::int32_t step = 0; step < ensemble.steps(); ++step) {
    const double part = step / 60.0;  // the storm moves from the first point to the last
    const double x = -20.0 + 40.0 * part;
    for (std::int32_t cell = 0; cell < options.width * options.height; ++cell) {
      const double dx = x - cell % options.width;
      const double dy = 5.0 - cell / options.width;
      for (std::int32_t ring = 0; ring < 3; ++ring) {
        const double radius = forecast.path.points[0].radius[static_cast<std::size_t>(ring)];
        const double beyond = std::hypot(dx, dy) - radius;
        if (std::abs(beyond) < 1e-4) continue;  // on the edge
        const int covered = beyond < 0.0 ? 3 : 0;
        EXPECT_EQ(ensemble.Covered(ring, step)[cell], covered)
            << "ring " << ring << " step " << step << " cell " << cell;
        const Cell at{cell % options.width, cell / options.width};
        if (covered > 0) {
          EXPECT_LE(ensemble.Arrival(ring, at)[0], step);
        }
        if (covered == 0) {
          EXPECT_NE(ensemble.Arrival(ring, at)[0], step);
        }
      }
    }
    const double distance = std::hypot(x - 2.0, 2.0);
    exposure += distance <= 3.0 ? 20.0F : distance <= 6.0 ? 10.0F : distance <= 9.0 ? 5.0F : 0.0F;
    EXPECT_NEAR(ensemble.Exposure(0, step)[1], exposure, 1e-3F) << step;
  }
}

TEST(Ensemble, AMemberDoesNotDependOnTheirNumber) {
  const CentralForecast forecast = test::PassingStorm();
  const Ensemble few(forecast, test::SmallEnsemble(20), {});
  const Ensemble many(forecast, test::SmallEnsemble(200), {});
  for (std::int32_t member = 0; member < 20; ++member) {
    EXPECT_EQ(few.Arrival(2, {5, 5})[member], many.Arrival(2, {5, 5})[member]);
  }
}

TEST(Ensemble, HasTheSpreadOfTheStatistics) {
  const Ensemble ensemble(test::PassingStorm(), test::SmallEnsemble(4000), {});
  const EnsembleSpread& last = ensemble.spread().back();
  const double expected = SpreadAt(ForecastErrors{}, last.lead_h).position_km;
  EXPECT_NEAR(last.along_km, expected, 0.05 * expected);
  EXPECT_NEAR(last.across_km, expected, 0.05 * expected);
  // 70 % of a normal distribution in two directions lie within sqrt(-2 ln 0.3) deviations.
  EXPECT_NEAR(last.radius70_km, std::sqrt(-2.0 * std::log(0.3)) * expected, 0.05 * expected);
}

TEST(Ensemble, MeanRiskIsTheMeanOfTheMembers) {
  const CentralForecast forecast = test::PassingStorm();
  const EnsembleOptions options = test::SmallEnsemble(50);
  const Cell site{4, 5};
  const Ensemble ensemble(forecast, options, {site});
  RiskField mean = ensemble.MeanRisk(1, -1.0F);
  for (std::int32_t step = 1; step < ensemble.steps(); ++step) {
    double risk = 0.0;
    for (std::int32_t member = 0; member < 50; ++member) {
      risk -= static_cast<double>(ensemble.Exposure(0, step)[member] -
                                  ensemble.Exposure(0, step - 1)[member]) /
              50.0;
    }
    EXPECT_NEAR(mean.At(step).risk(site.y, site.x), risk, 1e-3) << step;
    const double calm = 1.0 - ensemble.Covered(2, step)[site.y * options.width + site.x] / 50.0;
    EXPECT_NEAR(mean.At(step).quiet(site.y, site.x), risk - calm, 1e-3) << step;
  }
}

}  // namespace
}  // namespace aquafarm::agents
