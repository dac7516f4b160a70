// SPDX-License-Identifier: BSD-3-Clause
// The message RescuePlan contains the numbers of the core's plan, which the core also writes to
// plan.json.
#include "aquafarm_agents/plan/plan_messages.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/cell_bits.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm_agents {
namespace {

namespace agents = aquafarm::agents;
using aquafarm_msgs::RescuePlan;

// In-Fa in 2021 as recorded, from the early morning of the 24th of July on.
class PlanMessages : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    agents::RescueRequest request;
    request.storm = AQUAFARM_SCENARIO_DIR "/archives/zhoushan_cma.txt";
    request.storm_name = "2106";
    request.at = aquafarm::ParseUtc("at", "2021-07-23T18:00:00Z");
    request.ships = 2;
    request.speed_kn = 12.0;
    request.members = 100;
    const auto scenario = std::make_shared<const aquafarm::Scenario>(
        aquafarm::LoadScenario(AQUAFARM_SCENARIO_DIR "/zhoushan_infa_2021.yaml"));
    case_ = new agents::RescueCase(agents::MakeRescueCase(scenario, request));
    ensemble_ = new agents::Ensemble(case_->forecast, case_->ensemble, case_->Sites());
    report_ = new agents::PlanReport(agents::MakeReport(*case_, *ensemble_));
    agents::PlanProvenance provenance;
    provenance.command = "aquafarm_plan test";
    provenance.computed_at = *request.at + 60;
    provenance.compute_s = 1.25;
    provenance.inputs = {{"storm", request.storm}};
    json_ = new std::string(agents::ToJson(*case_, *ensemble_, *report_, provenance));
    read_ = new aquafarm_agents::PlanMessages(ReadPlan(*json_, "plan.json"));
  }
  static void TearDownTestSuite() {
    delete read_;
    delete json_;
    delete report_;
    delete ensemble_;
    delete case_;
  }

  static const RescuePlan& plan() { return read_->plan; }
  static ros::Time At(double time_s) {
    return ros::Time(static_cast<std::uint32_t>(case_->start + std::llround(time_s)), 0);
  }
  static void ExpectCell(aquafarm::Cell cell, const aquafarm_msgs::Cell& message) {
    EXPECT_EQ(cell.x, message.x);
    EXPECT_EQ(cell.y, message.y);
  }
  template <typename Message>
  static void ExpectPlace(aquafarm::Cell cell, const Message& message) {
    ExpectCell(cell, message.cell);
    const aquafarm::GeoPoint place = case_->frame.ToGeo(cell.x, cell.y);
    EXPECT_NEAR(place.latitude, message.latitude_deg, 1e-6);
    EXPECT_NEAR(place.longitude, message.longitude_deg, 1e-6);
  }
  static void ExpectLoss(const std::vector<float>& losses, const aquafarm_msgs::RescueLoss& loss) {
    const agents::LossSummary summary = agents::Summarize(losses);
    EXPECT_NEAR(summary.mean, loss.mean, 0.01);
    EXPECT_NEAR(summary.standard_error, loss.standard_error, 0.01);
    EXPECT_NEAR(summary.q05, loss.q05, 0.01);
    EXPECT_NEAR(summary.q50, loss.q50, 0.01);
    EXPECT_NEAR(summary.q95, loss.q95, 0.01);
    EXPECT_NEAR(summary.cvar05, loss.cvar05, 0.01);
    ASSERT_EQ(loss.exceedance_loss.size(), loss.exceedance_probability.size());
    ASSERT_FALSE(loss.exceedance_loss.empty());
    for (std::size_t i = 0; i < loss.exceedance_loss.size(); ++i) {
      double above = 0.0;  // the losses are rounded to 0.01
      double near = 0.0;
      for (const float one : losses) {
        above += static_cast<double>(one) > loss.exceedance_loss[i] + 0.01 ? 0.01 : 0.0;
        near += std::abs(static_cast<double>(one) - loss.exceedance_loss[i]) <= 0.01 ? 0.01 : 0.0;
      }
      EXPECT_GE(loss.exceedance_probability[i], above - 1e-6);
      EXPECT_LE(loss.exceedance_probability[i], above + near + 1e-6);
    }
  }

  inline static agents::RescueCase* case_{};
  inline static agents::Ensemble* ensemble_{};
  inline static agents::PlanReport* report_{};
  inline static std::string* json_{};
  inline static aquafarm_agents::PlanMessages* read_{};
};

TEST_F(PlanMessages, TheSampleHasSomethingToConvert) {
  EXPECT_EQ(report_->result, agents::PlanResult::kPlan);
  EXPECT_GE(report_->plan.routes.size(), 1U);
  EXPECT_FALSE(case_->warnings.empty());
}

TEST_F(PlanMessages, ProvenanceAndWords) {
  EXPECT_EQ(plan().version, aquafarm::kVersion);
  EXPECT_EQ(plan().command, "aquafarm_plan test");
  EXPECT_EQ(plan().scenario_name, case_->scenario->name);
  EXPECT_EQ(plan().scenario_hash, case_->scenario->hash);
  EXPECT_EQ(plan().seed, 1U);
  EXPECT_EQ(plan().members, 100U);
  EXPECT_EQ(plan().computed_at, At(60.0));
  EXPECT_NEAR(plan().compute_s, 1.25, 1e-9);
  ASSERT_EQ(plan().inputs.size(), 1U);
  EXPECT_EQ(plan().inputs[0].role, "storm");
  EXPECT_EQ(plan().inputs[0].path, case_->storm.file);
  EXPECT_EQ(plan().inputs[0].hash.size(), 16U);
  EXPECT_EQ(plan().result, static_cast<int>(report_->result));
  EXPECT_EQ(plan().text, report_->text);
  ASSERT_EQ(plan().warnings.size(), case_->warnings.size());
  for (std::size_t i = 0; i < case_->warnings.size(); ++i) {
    EXPECT_EQ(plan().warnings[i].code, case_->warnings[i].code);
    EXPECT_EQ(plan().warnings[i].severity, case_->warnings[i].severity);
    EXPECT_EQ(plan().warnings[i].text, case_->warnings[i].text);
    EXPECT_EQ(plan().warnings[i].advice, case_->warnings[i].advice);
  }
  ASSERT_EQ(plan().assumptions.size(), case_->assumptions.size());
  for (std::size_t i = 0; i < case_->assumptions.size(); ++i) {
    EXPECT_EQ(plan().assumptions[i].what, case_->assumptions[i].what);
    EXPECT_EQ(plan().assumptions[i].value, case_->assumptions[i].value);
    EXPECT_EQ(plan().assumptions[i].basis, case_->assumptions[i].basis);
    EXPECT_EQ(plan().assumptions[i].source, case_->assumptions[i].source);
  }
}

TEST_F(PlanMessages, RanchAndFleet) {
  EXPECT_EQ(plan().start, At(0.0));
  EXPECT_EQ(plan().end, At((ensemble_->steps() - 1) * ensemble_->options().step_s));
  EXPECT_EQ(plan().step_s, ensemble_->options().step_s);
  EXPECT_EQ(plan().utc_offset_min, case_->utc_offset_min);
  EXPECT_EQ(plan().width, case_->scenario->width);
  EXPECT_EQ(plan().height, case_->scenario->height);
  EXPECT_EQ(plan().cell_size_m, case_->scenario->cell_size_m);
  EXPECT_NEAR(plan().origin_latitude_deg, case_->scenario->origin->latitude, 1e-6);
  EXPECT_NEAR(plan().origin_longitude_deg, case_->scenario->origin->longitude, 1e-6);
  const agents::RescueProblem& problem = case_->problem;
  ASSERT_EQ(plan().ports.size(), problem.ports.size());
  for (std::size_t i = 0; i < problem.ports.size(); ++i) {
    EXPECT_EQ(plan().ports[i].id, static_cast<int>(i));
    EXPECT_EQ(plan().ports[i].name, problem.ports[i].name);
    ExpectPlace(problem.ports[i].cell, plan().ports[i]);
  }
  ASSERT_EQ(plan().ships.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(plan().ships[i].id, static_cast<int>(i));
    EXPECT_EQ(plan().ships[i].name, problem.ships[i].name);
    ExpectPlace(problem.ships[i].cell, plan().ships[i]);
    ASSERT_GE(plan().ships[i].port, 0);
    ExpectCell(problem.ships[i].cell, plan().ports.at(plan().ships[i].port).cell);
    EXPECT_NEAR(plan().ships[i].speed_kn, 12.0, 1e-3);
    EXPECT_EQ(plan().ships[i].capacity, problem.ships[i].capacity);
    EXPECT_EQ(plan().ships[i].ready, At(problem.ships[i].ready_s));
  }
  const nav_msgs::OccupancyGrid& chart = read_->chart;
  ASSERT_EQ(chart.data.size(), static_cast<std::size_t>(plan().width * plan().height));
  for (std::int32_t y = 0; y < plan().height; ++y) {
    for (std::int32_t x = 0; x < plan().width; ++x) {
      const bool blocked = (case_->layout.bits({x, y}) & aquafarm::kBlockedBits) != 0;
      EXPECT_EQ(chart.data[static_cast<std::size_t>(y * plan().width + x)], blocked ? 100 : 0);
    }
  }
}

TEST_F(PlanMessages, StormWithItsPoints) {
  const agents::StormRecord& storm = case_->storm;
  EXPECT_EQ(plan().storm_name, storm.name);
  EXPECT_EQ(plan().agency, storm.agency);
  EXPECT_EQ(plan().storm_file, storm.file);
  EXPECT_EQ(plan().hindcast, true);
  EXPECT_EQ(plan().issued.sec, *storm.issued);
  EXPECT_EQ(plan().recorded_until.sec, storm.recorded_until);
  EXPECT_EQ(plan().forecast_until.sec, *storm.known_until);
  EXPECT_NEAR(plan().age_h, storm.age_h, 0.01);
  EXPECT_EQ(plan().closest_stamp.sec, storm.passage.nearest_time);
  EXPECT_NEAR(plan().closest_km, storm.passage.nearest_km, 0.1);
  EXPECT_GE(plan().closest_bearing_deg, 0.0F);
  const auto& points = storm.rings.waypoints;
  ASSERT_EQ(plan().storm.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& message = plan().storm[i];
    EXPECT_EQ(message.stamp.sec, points[i].time);
    EXPECT_EQ(message.source, points[i].forecast ? aquafarm_msgs::RescueStormPoint::ASSUMED
                                                 : aquafarm_msgs::RescueStormPoint::RECORDED);
    EXPECT_NEAR(message.latitude_deg, points[i].position.latitude, 1e-6);
    EXPECT_NEAR(message.longitude_deg, points[i].position.longitude, 1e-6);
    const auto cell = case_->frame.ToGrid(points[i].position);
    EXPECT_NEAR(message.x, cell[0], 0.01);
    EXPECT_NEAR(message.y, cell[1], 0.01);
    EXPECT_EQ(points[i].wind_mps.has_value(), std::isfinite(message.wind_mps));
    EXPECT_EQ(points[i].pressure_hpa.has_value(), std::isfinite(message.pressure_hpa));
    EXPECT_EQ(message.radii_estimated, points[i].estimated && !points[i].silent);
    ASSERT_EQ(message.radii_km.size(), plan().rings.size());
    for (std::size_t ring = 0; ring < message.radii_km.size(); ++ring) {
      EXPECT_EQ(points[i].silent, std::isnan(message.radii_km[ring]));
      if (points[i].silent) continue;
      EXPECT_NEAR(message.radii_km[ring], points[i].radii_km[ring], 0.06);
    }
  }
}

TEST_F(PlanMessages, RingsErrorsAndHazardOfTheEnsemble) {
  ASSERT_EQ(static_cast<std::int32_t>(plan().rings.size()), ensemble_->rings());
  for (std::size_t ring = 0; ring < plan().rings.size(); ++ring) {
    EXPECT_EQ(plan().rings[ring].wind_kt, case_->forecast.path.wind_kt[ring]);
    EXPECT_EQ(plan().rings[ring].id, std::to_string(case_->forecast.path.wind_kt[ring]) + "kt");
    EXPECT_LT(plan().rings[ring].risk, 0.0F);
  }
  std::size_t at = 0;
  for (const agents::EnsembleSpread& spread : ensemble_->spread()) {
    // The ensemble also has points between those of the forecast.
    if (at == plan().forecast_error.size()) break;
    const auto& message = plan().forecast_error[at];
    if (spread.lead_h < 0.0 || message.stamp != At(spread.time_s)) continue;
    ++at;
    EXPECT_NEAR(message.lead_h, spread.lead_h, 0.01);
    EXPECT_NEAR(message.x, spread.center[0], 0.01);
    EXPECT_NEAR(message.y, spread.center[1], 0.01);
    EXPECT_NEAR(message.along_km, spread.along_km, 0.06);
    EXPECT_NEAR(message.across_km, spread.across_km, 0.06);
    EXPECT_NEAR(message.radius70_km, spread.radius70_km, 0.06);
    EXPECT_NEAR(message.wind_mps, spread.wind_mps, 0.01);
    EXPECT_NEAR(message.size_log, spread.size_log, 0.001);
  }
  EXPECT_EQ(at, plan().forecast_error.size());
  EXPECT_GT(at, 1U);
  ASSERT_FALSE(plan().hazard.empty());
  for (const auto& hazard : plan().hazard) {
    const auto step = static_cast<std::int32_t>(
        std::lround((hazard.stamp - plan().start).toSec() / plan().step_s));
    for (std::int32_t ring = 0; ring < ensemble_->rings(); ++ring) {
      EXPECT_NEAR(hazard.probability.at(ring), ensemble_->Touching(ring, step) / 100.0, 1e-4);
    }
  }
}

TEST_F(PlanMessages, DevicesWithOddsAndDeadlines) {
  ASSERT_EQ(plan().devices.size(), case_->problem.devices.size());
  for (std::size_t d = 0; d < plan().devices.size(); ++d) {
    const auto& message = plan().devices[d];
    const agents::RescueDevice& device = case_->problem.devices[d];
    const agents::DeviceOutcome& outcome = report_->plan.devices[d];
    EXPECT_EQ(message.id, static_cast<int>(d));
    EXPECT_EQ(message.name, device.name);
    EXPECT_EQ(message.kind, device.kind);
    ExpectPlace(device.cell, message);
    EXPECT_NEAR(message.value, device.value, 0.01);
    EXPECT_NEAR(message.damage_before, device.damage_before, 1e-4);
    EXPECT_EQ(message.ship, outcome.ship);
    EXPECT_EQ(message.port, outcome.port);
    const bool fetched = outcome.ship != aquafarm::kNone;
    EXPECT_EQ(message.fetch, fetched ? At(outcome.fetch_s) : ros::Time());
    EXPECT_EQ(message.deliver, fetched ? At(outcome.deliver_s) : ros::Time());
    EXPECT_EQ(message.left_reason.empty(), fetched);
    EXPECT_EQ(message.left_text.empty(), fetched);
    EXPECT_NEAR(message.home, outcome.home, 1e-4);
    ASSERT_EQ(message.home_before.size(), outcome.home_before.size());
    ASSERT_EQ(message.arrival.size(), outcome.home_before.size());
    for (std::int32_t ring = 0; ring < ensemble_->rings(); ++ring) {
      EXPECT_NEAR(message.home_before[ring], outcome.home_before[ring], 1e-4);
      const std::int16_t* arrival = ensemble_->Arrival(ring, device.cell);
      const auto came = [&](ros::Time by) {
        return static_cast<double>(std::count_if(arrival, arrival + 100, [&](std::int16_t step) {
          return step != agents::Ensemble::kNoArrival &&
                 (by.isZero() || At(step * plan().step_s) <= by);
        }));
      };
      EXPECT_NEAR(message.arrival[ring].probability, came({}) / 100.0, 1e-4);
      const ros::Time median = message.arrival[ring].q50;
      EXPECT_GE(median.isZero() ? 50.0 : came(median), 50.0);
      EXPECT_LT(message.arrival[ring].q95.isZero() ? came({}) : 0.0, 96.0);
    }
    EXPECT_NEAR(message.expected_loss, std::max(0.0, outcome.mean_loss), 0.01);
    EXPECT_NEAR(message.expected_loss_idle, outcome.mean_loss_idle, 0.01);
    EXPECT_NEAR(message.expected_damage, outcome.mean_loss / device.value, 1e-3);
    ASSERT_EQ(message.deadlines.size(), report_->deadlines[d].size());
    for (std::size_t i = 0; i < message.deadlines.size(); ++i) {
      const agents::Deadline& deadline = report_->deadlines[d][i];
      EXPECT_NEAR(message.deadlines[i].probability, deadline.probability, 1e-6);
      EXPECT_EQ(message.deadlines[i].possible, deadline.leave_s.has_value());
      EXPECT_EQ(message.deadlines[i].leave, deadline.leave_s ? At(*deadline.leave_s) : ros::Time());
      EXPECT_EQ(message.deadlines[i].open, deadline.is_open);
      EXPECT_EQ(message.deadlines[i].ship, deadline.ship);
    }
  }
}

TEST_F(PlanMessages, RoutesWithOrders) {
  EXPECT_FALSE(plan().objective.empty());
  EXPECT_FALSE(plan().method.empty());
  EXPECT_NEAR(plan().expected_value, report_->plan.saved, 0.01);
  EXPECT_NEAR(plan().bound, std::max(report_->plan.bound, report_->plan.saved), 0.01);
  ASSERT_EQ(plan().routes.size(), report_->plan.routes.size());
  double first_s = 1e18;
  for (std::size_t r = 0; r < plan().routes.size(); ++r) {
    const auto& message = plan().routes[r];
    const agents::ShipRoute& route = report_->plan.routes[r];
    EXPECT_EQ(message.ship, route.ship);
    EXPECT_NEAR(message.km, route.km, 0.001);
    ASSERT_EQ(message.orders.size(), route.orders.size());
    first_s = std::min(first_s, route.orders.front().time_s);
    for (std::size_t i = 0; i < route.orders.size(); ++i) {
      const agents::RescueOrder& order = route.orders[i];
      EXPECT_EQ(message.orders[i].action, static_cast<int>(order.kind));
      EXPECT_EQ(message.orders[i].stamp, At(order.time_s));
      ExpectPlace(order.cell, message.orders[i]);
      EXPECT_EQ(message.orders[i].device, order.device);
      EXPECT_EQ(message.orders[i].devices, order.devices);
      EXPECT_EQ(message.orders[i].port, order.port);
      EXPECT_NEAR(message.orders[i].km, order.km, 0.001);
      EXPECT_NEAR(message.orders[i].probability, order.probability, 1e-4);
    }
    ASSERT_EQ(message.path.size(), route.path.size());
    ASSERT_EQ(message.path_stamps.size(), route.path.size());
    const nav_msgs::Path path = PathOfShip(plan(), route.ship);
    ASSERT_EQ(path.poses.size(), route.path.size());
    for (std::size_t i = 0; i < route.path.size(); ++i) {
      ExpectCell(route.path[i].cell, message.path[i]);
      EXPECT_NEAR((message.path_stamps[i] - plan().start).toSec(), route.path[i].time_s, 0.1);
      EXPECT_EQ(path.poses[i].header.stamp, message.path_stamps[i]);
      EXPECT_EQ(path.poses[i].pose.position.x, route.path[i].cell.x * plan().cell_size_m);
      EXPECT_EQ(path.poses[i].pose.position.y, route.path[i].cell.y * plan().cell_size_m);
    }
  }
  EXPECT_EQ(plan().first_departure, At(first_s));
  EXPECT_TRUE(PathOfShip(plan(), 99).poses.empty());
}

TEST_F(PlanMessages, LossesAndChanges) {
  EXPECT_EQ(plan().currency, "");
  double insured = 0.0;
  for (const agents::RescueDevice& device : case_->problem.devices) insured += device.value;
  EXPECT_NEAR(plan().insured, insured, 0.01);
  ExpectLoss(report_->plan.loss, plan().loss);
  ExpectLoss(report_->plan.loss_idle, plan().loss_idle);
  const agents::LastDeparture last = agents::LastDepartureOf(case_->problem, *report_);
  const auto time_of = [&](std::optional<double> at_s) { return at_s ? At(*at_s) : ros::Time(); };
  EXPECT_EQ(plan().no_departure_after, time_of(last.none_after_s));
  EXPECT_EQ(plan().not_known_beyond, time_of(last.not_known_beyond_s));
  EXPECT_FALSE(plan().no_departure_rule.empty());
  ASSERT_EQ(plan().what_if.size(), report_->what_if.size());
  for (std::size_t i = 0; i < plan().what_if.size(); ++i) {
    const auto& message = plan().what_if[i];
    const agents::WhatIf& row = report_->what_if[i];
    EXPECT_EQ(message.change, row.change);
    EXPECT_EQ(message.text, row.text);
    EXPECT_EQ(message.possible, row.is_possible);
    if (!row.is_possible) {
      EXPECT_TRUE(std::isnan(message.mean_loss) && std::isnan(message.difference_high));
      continue;
    }
    EXPECT_NEAR(message.mean_loss, row.loss.mean, 0.01);
    EXPECT_NEAR(message.q95, row.loss.q95, 0.01);
    EXPECT_NEAR(message.devices_home, row.devices_home, 0.01);
    EXPECT_NEAR(message.all_home, row.all_home, 1e-4);
    EXPECT_NEAR(message.difference, row.difference, 0.01);
    EXPECT_NEAR(message.difference_low, row.difference_low, 0.01);
    EXPECT_NEAR(message.difference_high, row.difference_high, 0.01);
  }
}

// Numbers that are not known: 0 would look harmless.
TEST_F(PlanMessages, WithUnknownWindsEveryNumberOfTheStormIsNaN) {
  agents::PlanReport report = *report_;
  report.result = agents::PlanResult::kStormUnknown;
  const RescuePlan unknown = ReadPlan(agents::ToJson(*case_, *ensemble_, report, {}), "x").plan;
  EXPECT_TRUE(plan().unknown.empty());
  EXPECT_EQ(unknown.unknown.find("The storm's winds are unknown from "), 0U) << unknown.unknown;
  std::vector<double> numbers{unknown.expected_value, unknown.bound};
  for (const auto& device : unknown.devices) {
    numbers.insert(numbers.end(), {device.home, device.expected_damage, device.expected_loss,
                                   device.expected_loss_idle});
    numbers.insert(numbers.end(), device.home_before.begin(), device.home_before.end());
    for (const auto& arrival : device.arrival) {
      numbers.push_back(arrival.probability);
      EXPECT_TRUE(arrival.q05.isZero() && arrival.q50.isZero() && arrival.q95.isZero());
    }
    for (const auto& deadline : device.deadlines) {
      EXPECT_FALSE(deadline.possible || deadline.open);
      EXPECT_TRUE(deadline.leave.isZero());
    }
  }
  for (const auto& hazard : unknown.hazard) {
    numbers.insert(numbers.end(), hazard.probability.begin(), hazard.probability.end());
  }
  for (const auto& loss : {unknown.loss, unknown.loss_idle}) {
    numbers.insert(numbers.end(),
                   {loss.mean, loss.standard_error, loss.q05, loss.q50, loss.q95, loss.cvar05});
    EXPECT_TRUE(loss.exceedance_loss.empty());
  }
  for (const auto& row : unknown.what_if) {
    numbers.insert(numbers.end(), {row.mean_loss, row.q95, static_cast<double>(row.all_home),
                                   row.difference, row.difference_low, row.difference_high});
  }
  for (const double number : numbers) EXPECT_TRUE(std::isnan(number)) << number;
  EXPECT_EQ(unknown.devices.size(), plan().devices.size());
}

TEST_F(PlanMessages, AnotherFileThanAPlanIsRefusedInOneLine) {
  const auto refusal = [](const std::string& json) {
    try {
      ReadPlan(json, "x.json");
    } catch (const aquafarm::InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  std::string other = *json_;
  other.replace(other.find("\"version\": 1"), 12, "\"version\": 2");
  std::string early = *json_;
  const std::string start = "\"recorded_until\": \"";
  early.replace(early.find(start) + start.size(), 4, "1949");
  const std::pair<std::string, std::string> cases[] = {
      {"{", "x.json: "},
      {"{}", "'version'"},
      {other, "version: got another version than 1"},
      {early, "a time before 1970"},
  };
  for (const auto& [json, words] : cases) {
    const std::string text = refusal(json);
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_NE(text.find("expected a plan file of version 1"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace aquafarm_agents
