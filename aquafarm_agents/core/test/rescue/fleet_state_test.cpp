// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/fleet_state.h"

#include <gtest/gtest.h>

#include "aquafarm/agents/rescue/plan_report.h"
#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents {
namespace {

const std::string kScenarios = AQUAFARM_SCENARIO_DIR;

// Three squads' worth of state on the ranch off Zhoushan, with In-Fa as recorded.
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
  EXPECT_EQ(case_.problem.devices[0].name, "D2");
  EXPECT_EQ(case_.problem.devices[1].name, "D4");
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
  EXPECT_EQ(case_.problem.devices[2].name, "D3");
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
