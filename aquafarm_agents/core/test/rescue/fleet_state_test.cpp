// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/fleet_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "rescue/rescue_samples.h"

namespace aquafarm::agents {
namespace {

using test::kScenarios;

// The state of two ships and all devices of the ranch off Zhoushan, with In-Fa as recorded.
class Fleet : public ::testing::Test {
 protected:
  Fleet() {
    request_.storm = kScenarios + "/archives/zhoushan_cma.txt";
    request_.storm_name = "2106";
    request_.at = ParseUtc("at", "2021-07-23T18:00:00Z");
    request_.members = 50;
    request_.speed_kn = 12.0;
    case_ = MakeRescueCase(
        std::make_shared<const Scenario>(LoadScenario(kScenarios + "/zhoushan_infa_2021.yaml")),
        request_);
    fleet_.devices.resize(case_.problem.devices.size());
    fleet_.ships = {{{10, 5}, {}}, {{4, 5}, {}}};
  }

  std::string Codes() const {
    std::string codes;
    for (const RescueWarning& one : case_.warnings) codes += one.code + " ";
    return codes;
  }
  // Returns the warning with a code; nullptr if there is none.
  const RescueWarning* Warning(const std::string& code) const {
    const auto found = std::find_if(case_.warnings.begin(), case_.warnings.end(),
                                    [&](const RescueWarning& one) { return one.code == code; });
    return found == case_.warnings.end() ? nullptr : &*found;
  }
  std::string Refusal() {
    try {
      UseFleet(request_, fleet_, case_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  RescueRequest request_;
  RescueCase case_;
  FleetState fleet_;
};

TEST_F(Fleet, ShipsStartWhereTheyAreAndDevicesAreAsDamaged) {
  fleet_.devices[1].health = 0.75;
  UseFleet(request_, fleet_, case_);
  ASSERT_EQ(case_.problem.ships.size(), 2U);
  EXPECT_EQ(case_.problem.ships[0].cell, (Cell{10, 5}));
  EXPECT_EQ(case_.problem.ships[1].cell, (Cell{4, 5}));
  EXPECT_EQ(case_.problem.ships[1].ready_s, 0.0);
  ASSERT_EQ(case_.problem.devices.size(), 4U);
  EXPECT_EQ(case_.problem.devices[0].damage_before, 0.0);
  EXPECT_EQ(case_.problem.devices[1].damage_before, 0.25);
  EXPECT_EQ(case_.problem.ports.size(), 3U);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  for (const ShipRoute& route : report.plan.routes) {
    EXPECT_EQ(route.path.front().cell, fleet_.ships[static_cast<std::size_t>(route.ship)].cell);
  }
}

TEST_F(Fleet, DevicesInPortAreLeftOutAndTheOthersKeepTheirNames) {
  fleet_.devices[0].is_deployed = false;
  fleet_.devices[2].self_propelled = true;
  UseFleet(request_, fleet_, case_);
  ASSERT_EQ(case_.problem.devices.size(), 2U);
  EXPECT_EQ(case_.problem.devices[0].name, "F1");
  EXPECT_EQ(case_.problem.devices[1].name, "F3");
  EXPECT_NE(Codes().find("devices_in_port devices_self_propelled"), std::string::npos) << Codes();
}

// Open water from (14, 4) to port C at (16, 4): two cells of 1 km at 12 knots, then a drop-off.
TEST_F(Fleet, AShipWithADeviceAboardIsOrderedToDeliverIt) {
  request_.depart_s = 7200.0;  // does not hold for a ship at sea with a device aboard
  fleet_.ships = {{{14, 4}, {2}}};
  fleet_.devices[2].is_deployed = false;
  fleet_.devices[2].health = 0.5;
  UseFleet(request_, fleet_, case_);
  ASSERT_EQ(case_.problem.devices.size(), 4U);
  EXPECT_EQ(case_.problem.devices[2].name, "F2");
  EXPECT_EQ(case_.problem.devices[2].cell, (Cell{14, 4}));
  EXPECT_EQ(case_.problem.devices[2].damage_before, 0.5);
  EXPECT_EQ(case_.warnings.back().code, "devices_aboard");
  EXPECT_EQ(case_.warnings.back().ship, 0);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  ASSERT_EQ(report.plan.routes.size(), 1U);
  const std::vector<RescueOrder>& orders = report.plan.routes[0].orders;
  ASSERT_GE(orders.size(), 2U);
  EXPECT_EQ(orders[0].kind, OrderKind::kLeave);
  EXPECT_EQ(orders[0].cell, (Cell{14, 4}));
  EXPECT_EQ(orders[0].time_s, 0.0);
  EXPECT_EQ(orders[1].kind, OrderKind::kDeliver);
  EXPECT_EQ(orders[1].port, 2);
  EXPECT_EQ(orders[1].devices, std::vector<std::int32_t>{2});
  EXPECT_NEAR(orders[1].time_s, 2000.0 / (12.0 * 0.514444) + case_.problem.handling_s, 1.0);
  EXPECT_EQ(report.plan.devices[2].home, orders[1].probability);
  EXPECT_GT(report.plan.devices[2].mean_loss_idle, 0.0);
  EXPECT_LT(report.plan.devices[2].mean_loss, report.plan.devices[2].mean_loss_idle);
}

// The known time is too short for one of the deadlines: its end is not the end of the danger.
TEST_F(Fleet, AnOpenDeadlineLeavesTheLastDepartureUnknown) {
  RescueProblem problem;
  problem.devices.resize(2);
  PlanReport report;
  report.deadlines = {{{0.95, 3600.0}, {0.5, 7200.0, true}}, {{0.95, 3600.0}, {0.5, 9000.0}}};
  EXPECT_EQ(LastDepartureOf(problem, report).none_after_s, std::nullopt);
  EXPECT_EQ(LastDepartureOf(problem, report).not_known_beyond_s, 9000.0);
  report.result = PlanResult::kStormStaysAway;
  EXPECT_EQ(LastDepartureOf(problem, report).not_known_beyond_s, std::nullopt);
}

// Ships with devices aboard come home, also after the last departure of those that fetch.
TEST_F(Fleet, DeadlinesOfDevicesAboardDoNotLetShipsLeaveLate) {
  RescueProblem problem;
  problem.devices.resize(3);
  problem.ships.resize(2);
  problem.ships[1].aboard = {1};
  PlanReport report;
  for (const double hour : {9.0, 15.0, 8.0}) {
    report.deadlines.push_back({{0.95, 3600.0}, {0.5, 3600.0 * hour}});
  }
  EXPECT_EQ(LastDepartureOf(problem, report).none_after_s, 9.0 * 3600.0);
  EXPECT_EQ(LastDepartureOf(problem, report).not_known_beyond_s, std::nullopt);
  report.result = PlanResult::kStormUnknown;
  EXPECT_EQ(LastDepartureOf(problem, report).none_after_s, std::nullopt);
}

// 2 km at 0.05 knots take 22 hours, and In-Fa comes before.
TEST_F(Fleet, WindsOnTheWayHomeAreAStopOfTheShip) {
  request_.speed_kn = 0.05;
  fleet_.ships = {{{14, 4}, {2}}, {{4, 5}, {}}};
  UseFleet(request_, fleet_, case_);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  ASSERT_EQ(report.plan.routes.size(), 1U);
  EXPECT_LT(report.plan.routes[0].orders.back().probability, 0.5);
  const RescueWarning* warning = Warning("winds_on_way_home");
  ASSERT_NE(warning, nullptr) << Codes();
  EXPECT_EQ(warning->severity, "stop");
  EXPECT_EQ(warning->ship, 0);
  EXPECT_NE(warning->text.find("ship 1 has F2 aboard, and winds stop it on its way home"),
            std::string::npos)
      << warning->text;
  EXPECT_EQ(Warning("devices_aboard"), nullptr) << "no note promises the delivery";
}

TEST_F(Fleet, AShipWithASafeWayHomeHasNoStop) {
  fleet_.ships = {{{14, 4}, {2}}};
  UseFleet(request_, fleet_, case_);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  MakeReport(case_, ensemble);
  EXPECT_EQ(Warning("winds_on_way_home"), nullptr);
  EXPECT_NE(Warning("devices_aboard"), nullptr);
}

// In a port that takes no devices, with no chance to reach another one.
TEST_F(Fleet, NoShipLeavesAPortIfWindsStopItInAllFutures) {
  request_.speed_kn = 0.01;
  fleet_.ships = {{{16, 4}, {2}}};
  UseFleet(request_, fleet_, case_);
  ASSERT_EQ(case_.problem.ports[2].cell, (Cell{16, 4}));
  case_.problem.ports[2].is_open = false;
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  EXPECT_TRUE(report.plan.routes.empty());
  const RescueWarning* warning = Warning("winds_on_way_home");
  ASSERT_NE(warning, nullptr) << Codes();
  EXPECT_EQ(warning->severity, "stop");
  EXPECT_EQ(warning->ship, 0);
  EXPECT_EQ(warning->advice, "Keep it in port.");
  EXPECT_EQ(Warning("devices_aboard"), nullptr) << "it has no orders";
}

// A storm without known winds stops no ship in any member, which does not mean that it is safe.
TEST_F(Fleet, ChancesAreUnknownIfTheWindsAre) {
  const std::string path = ::testing::TempDir() + "fleet_state_test_unknown_winds.json";
  std::ofstream(path) << R"([{"tfbh": "202106", "ename": "In-Fa", "points": [
      {"time": "2021-07-24T08:00:00", "lat": 30.0, "lng": 122.7, "strong": "",
       "move_dir": "北", "move_speed": 10, "forecast": [{"sets": "CMA", "points": [
         {"time": "2021-07-25T08:00:00", "lat": 30.2, "lng": 122.7, "strong": ""},
         {"time": "2021-07-26T08:00:00", "lat": 30.4, "lng": 122.7, "strong": ""}]}]}]}])";
  request_.storm.clear();
  request_.storm_name.clear();
  request_.bulletin = path;
  request_.at = ParseUtc("at", "2021-07-24T00:00:00Z");
  case_ = MakeRescueCase(case_.scenario, request_);
  fleet_.ships = {{{14, 4}, {2}}};
  UseFleet(request_, fleet_, case_);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  ASSERT_EQ(report.result, PlanResult::kStormUnknown) << report.text;
  ASSERT_EQ(report.plan.routes.size(), 1U);
  const std::string text = ToText(case_, report);
  EXPECT_NE(text.find("deliver at " + case_.problem.ports[2].name + "  [unknown]\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("F2: unknown\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("100 %"), std::string::npos) << text;
  EXPECT_EQ(text.find("no ship should leave after"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(ToJson(case_, ensemble, report, {}));
  for (const auto& order : json.at("plan").at("routes").at(0).at("orders")) {
    EXPECT_TRUE(order.at("probability").is_null()) << order;
  }
  for (const auto& device : json.at("devices")) {
    EXPECT_TRUE(device.at("odds").at("home").is_null()) << device;
    for (const auto& share : device.at("odds").at("home_before")) EXPECT_TRUE(share.is_null());
  }
  EXPECT_TRUE(json.at("what_if").at(0).at("all_home").is_null());
  EXPECT_TRUE(json.at("deadlines").at("no_departure_after").is_null());
}

TEST_F(Fleet, UnknownDevicesAboardAreRefused) {
  fleet_.ships = {{{14, 4}, {7}}};
  EXPECT_EQ(
      Refusal(),
      "state: ship 1: got device 7 aboard, expected ids of devices in [0, 4), each aboard one "
      "ship");
}

TEST_F(Fleet, WithoutADeviceLeftNothingIsPlanned) {
  for (DeviceNow& device : fleet_.devices) device.is_deployed = false;
  UseFleet(request_, fleet_, case_);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const PlanReport report = MakeReport(case_, ensemble);
  EXPECT_TRUE(report.plan.routes.empty());
  EXPECT_FALSE(ToJson(case_, ensemble, report, {}).empty());
}

TEST_F(Fleet, ADeviceWithoutHealthIsLeftBehindButNotSafe) {
  fleet_.devices[0].health = 0.0;
  UseFleet(request_, fleet_, case_);
  const Ensemble ensemble(case_.forecast, case_.ensemble, case_.Sites());
  const auto json = nlohmann::json::parse(ToJson(case_, ensemble, MakeReport(case_, ensemble), {}));
  const auto& left = json.at("plan").at("left_behind");
  ASSERT_EQ(left.size(), 1U) << left;
  EXPECT_EQ(left[0].at("device"), 0);
  EXPECT_EQ(left[0].at("reason"), "not_worth_it") << "winds may reach it";
  EXPECT_EQ(left[0].at("text"), "F0: it has no value left to save.");
}

TEST_F(Fleet, AStateOfAnotherRanchIsRefused) {
  fleet_.devices.pop_back();
  EXPECT_EQ(Refusal(), "state: got 3 devices, expected 4, as in zhoushan_infa_2021");
  fleet_.devices.resize(4);
  fleet_.ships = {{{11, 8}, {}}};
  EXPECT_EQ(Refusal(), "state: ship 1: got cell (11, 8), expected water of zhoushan_infa_2021");
  fleet_.ships = {{{-1, 99}, {}}};
  EXPECT_EQ(Refusal(), "state: ship 1: got cell (-1, 99), expected water of zhoushan_infa_2021");
  request_.devices = "devices.csv";
  EXPECT_NE(Refusal().find("devices: got a file, expected none"), std::string::npos);
}

}  // namespace
}  // namespace aquafarm::agents
