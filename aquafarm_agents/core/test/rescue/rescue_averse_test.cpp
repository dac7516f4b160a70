// SPDX-License-Identifier: BSD-3-Clause
// Plans against the worst storms, and plans with energy and costs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "aquafarm/agents/rescue/rescue_plan.h"
#include "rescue/rescue_samples.h"

namespace aquafarm::agents {
namespace {

// The device of the first order to fetch; kNone if there is none.
std::int32_t FirstOf(const RescuePlan& plan) {
  for (const ShipRoute& route : plan.routes) {
    for (const RescueOrder& order : route.orders) {
      if (order.kind == OrderKind::kFetch) return order.device;
    }
  }
  return kNone;
}

// Time for one trip before the winds. The storm comes from the west through F1 and turns south
// through F2 and the port. F1 is worth more, but its winds come first: in some storms they are
// there during the trip, and F1 is damaged until it is in port. F2 is always home before the winds.
TEST(RiskAverse, ASureDeviceIsBetterThanAMoreValuableOneInDanger) {
  CentralForecast forecast = test::PassingStorm();
  forecast.path.points[1].x = 5.0;
  forecast.path.points[2].x = 5.0;
  forecast.path.points[2].y = -15.0;
  forecast.path.points[2].east = 0.0;
  forecast.path.points[2].north = -1.0;
  for (StormPoint& point : forecast.path.points) point.radius = {1.0, 2.0, 3.0};
  EnsembleOptions options = test::SmallEnsemble(1000);
  options.errors.scale = 0.3;
  options.errors.wind_mps.assign(4, 0.0);
  options.errors.size_factor = 0.0;
  RescueProblem problem = test::SmallRescue();
  problem.devices = {{"F1", "monitoring", {6, 5}, 100.0, 0.0},
                     {"F2", "monitoring", {6, 0}, 70.0, 0.0}};
  problem.ports = {{"port A", {8, 0}, true}};
  const double pace_s = 1.5 * 600.0;  // per cell
  problem.ships = {{"ship 1", {8, 0}, 5000.0 / pace_s / 0.514444, 1, 9.0 * 600.0}};
  problem.exposure_damage = 0.02;
  const Ensemble ensemble(forecast, options, test::SitesOf(problem));

  const RescuePlan mean = PlanRescue(problem, ensemble);
  ASSERT_EQ(FirstOf(mean), 0);
  problem.risk_averse = 0.05;
  const RescuePlan averse = PlanRescue(problem, ensemble);
  ASSERT_EQ(FirstOf(averse), 1);
  EXPECT_EQ(averse.devices[1].home, 1.0);
  EXPECT_NEAR(MeanOfWorst(averse.loss, 0.05), 100.0, 1e-3) << "F1 is lost, and no more than F1";
  EXPECT_GT(MeanOfWorst(mean.loss, 0.05), 120.0) << "F2 is lost, and F1 in large part";
  EXPECT_GT(Summarize(averse.loss).mean, Summarize(mean.loss).mean + 10.0);
  EXPECT_LT(averse.averse_gap, 1.0) << "no other plan is better by more";
  problem.risk_averse = 1.0;  // the mean of all members
  EXPECT_EQ(FirstOf(PlanRescue(problem, ensemble)), 0);
}

// All orders of five devices, by brute force.
TEST(RiskAverse, NoOtherOrderHasAMeanOfTheWorstThatIsLowerByMoreThanTheGap) {
  RescueProblem problem = test::SmallRescue();
  problem.devices.push_back({"F4", "monitoring", {1, 6}, 90.0, 0.0});
  problem.devices.push_back({"F5", "monitoring", {5, 4}, 60.0, 0.0});
  problem.ports.pop_back();
  problem.ships.pop_back();
  problem.exposure_damage = 0.01;
  const Ensemble ensemble(test::PassingStorm(), test::SmallEnsemble(300), test::SitesOf(problem));
  for (const double share : {0.05, 0.2, 0.5}) {
    problem.risk_averse = share;
    const RescuePlan averse = PlanRescue(problem, ensemble);
    double least = 1e9;
    std::vector<std::int32_t> order(5);
    std::iota(order.begin(), order.end(), 0);
    do {
      RescuePlan plan;
      plan.routes.resize(1);
      for (const std::int32_t device : order) {
        RescueOrder fetch;
        fetch.kind = OrderKind::kFetch;
        fetch.device = device;
        RescueOrder deliver;
        deliver.kind = OrderKind::kDeliver;
        deliver.port = 0;
        plan.routes[0].orders.push_back(fetch);
        plan.routes[0].orders.push_back(deliver);
      }
      least = std::min(least, MeanOfWorst(PlayRescue(problem, ensemble, plan).loss, share));
    } while (std::next_permutation(order.begin(), order.end()));
    const double found = MeanOfWorst(averse.loss, share);
    EXPECT_GE(found, least - 1e-3) << share;
    EXPECT_LE(found, least + averse.averse_gap + 1e-3) << share;
    EXPECT_LE(found, least + 0.01 * least) << share;
  }
}

// The trip of a ship to one device and home, as a route for PlayRescue.
ShipRoute TripTo(std::int32_t ship, std::int32_t device, std::int32_t port) {
  ShipRoute route;
  route.ship = ship;
  RescueOrder fetch;
  fetch.kind = OrderKind::kFetch;
  fetch.device = device;
  RescueOrder deliver;
  deliver.kind = OrderKind::kDeliver;
  deliver.port = port;
  route.orders = {fetch, deliver};
  return route;
}

// In the worst storms no ship saves the devices that are in danger first. Ships that are idle still
// fetch them for the other storms: this costs nothing.
TEST(RiskAverse, AnIdleShipFetchesWhatItCanSaveInStormsThatAreNotTheWorst) {
  RescueProblem problem = test::SmallRescue();
  problem.devices.push_back({"F4", "monitoring", {1, 6}, 90.0, 0.0});
  problem.devices.push_back({"F5", "monitoring", {5, 4}, 60.0, 0.0});
  problem.devices.push_back({"F6", "monitoring", {8, 7}, 30.0, 0.0});
  problem.ships.push_back({"ship 3", {11, 0}, 30.0, 2, 600.0});
  problem.ships.push_back({"ship 4", {11, 9}, 20.0, 1, 0.0});
  problem.exposure_damage = 0.05;  // what the winds reach is lost
  const Ensemble ensemble(test::PassingStorm(), test::SmallEnsemble(400), test::SitesOf(problem));
  int fetched = 0;
  for (const int hours : {3, 4}) {
    for (RescueShip& ship : problem.ships) ship.ready_s = 3600.0 * hours;
    for (const double share : {0.05, 0.2}) {
      problem.risk_averse = share;
      const RescuePlan plan = PlanRescue(problem, ensemble);
      fetched += static_cast<int>(plan.routes.size());
      for (std::int32_t ship = 0; ship < 4; ++ship) {
        const auto is_own = [ship](const ShipRoute& route) { return route.ship == ship; };
        if (std::any_of(plan.routes.begin(), plan.routes.end(), is_own)) continue;
        for (std::int32_t device = 0; device < 6; ++device) {
          if (plan.devices[static_cast<std::size_t>(device)].ship != kNone) continue;
          RescuePlan more = plan;
          more.routes.push_back(TripTo(ship, device, ship % 2));
          const double saved = PlayRescue(problem, ensemble, more).saved;
          EXPECT_LE(saved, plan.saved + 1e-3) << "ship " << ship << ", device " << device
                                              << ", ready after " << hours << " h, worst " << share;
        }
      }
    }
  }
  EXPECT_GT(fetched, 4);
}

class Energy : public ::testing::Test {
 protected:
  Energy() {
    problem_.devices = {problem_.devices[2]};  // F3 at (9, 4), worth 40
    problem_.ports.pop_back();                 // port A at (11, 0)
    problem_.ships.pop_back();
    problem_.energy = RescueEnergy{2.0, 0.5, 3.0, 0.0, 0.0};
  }
  RescuePlan Plan() const {
    const Ensemble ensemble(test::PassingStorm(), test::SmallEnsemble(200),
                            test::SitesOf(problem_));
    return PlanRescue(problem_, ensemble);
  }
  RescueProblem problem_{test::SmallRescue()};
};

TEST_F(Energy, OfATripByHand) {
  const RescuePlan plan = Plan();
  ASSERT_EQ(plan.routes.size(), 1U);
  const double km = 5.0 * (4.0 + 2.0 * (std::sqrt(2.0) - 1.0));  // two diagonals, two straight on
  const double hours = km * 1000.0 / (60.0 * 1852.0) + 600.0 / 3600.0;
  const std::vector<RescueOrder>& orders = plan.routes[0].orders;
  ASSERT_EQ(orders.size(), 3U);
  EXPECT_EQ(orders[0].kwh, 0.0);
  EXPECT_NEAR(orders[1].kwh, 2.0 * km + 3.0 * hours, 1e-3);
  EXPECT_NEAR(orders[2].kwh, 3.0 * km + 3.0 * hours, 1e-3) << "half as much again in tow";
  EXPECT_NEAR(plan.routes[0].kwh, 5.0 * km + 6.0 * hours, 1e-3);
  EXPECT_NEAR(plan.routes[0].hours, 2.0 * hours, 1e-4);
  EXPECT_EQ(plan.cost, 0.0);
}

TEST_F(Energy, ATripThatCostsMoreThanItSavesIsLeftOut) {
  const RescuePlan free = Plan();
  ASSERT_GT(free.saved, 1.0);
  problem_.energy->per_kwh = 0.9 * free.saved / free.routes[0].kwh;
  const RescuePlan cheap = Plan();
  ASSERT_EQ(cheap.routes.size(), 1U);
  EXPECT_NEAR(cheap.cost, 0.9 * cheap.saved, 1e-3);
  problem_.energy->per_hour = 0.2 * free.saved / free.routes[0].hours;
  EXPECT_TRUE(Plan().routes.empty());
}

TEST_F(Energy, WithoutAModelThereIsNone) {
  problem_.energy.reset();
  EXPECT_EQ(Plan().routes.at(0).kwh, 0.0);
}

}  // namespace
}  // namespace aquafarm::agents
