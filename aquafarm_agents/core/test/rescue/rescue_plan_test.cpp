// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/rescue/rescue_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "aquafarm/agents/rescue/what_if.h"
#include "aquafarm/base/check.h"
#include "rescue/rescue_samples.h"

namespace aquafarm::agents {
namespace {

class Rescue : public ::testing::Test {
 protected:
  Rescue() : ensemble_(test::PassingStorm(), test::SmallEnsemble(400), test::SitesOf(problem_)) {}
  RescueProblem problem_{test::SmallRescue()};
  Ensemble ensemble_;
};

// Follows a ship of a plan in one member, cell by cell, and returns whether it still works at the
// end of an order.
bool Works(const RescueProblem& problem, const Ensemble& ensemble, const ShipRoute& route,
           double until_s, std::size_t member) {
  std::vector<TimedCell> path = route.path;
  for (std::size_t i = 0; i < path.size() && path[i].time_s < until_s; ++i) {
    const double left_s = i + 1 < path.size() ? std::min(path[i + 1].time_s, until_s) : until_s;
    const std::int16_t arrival = ensemble.Arrival(problem.abort_ring, path[i].cell)[member];
    if (arrival != Ensemble::kNoArrival && arrival * ensemble.options().step_s <= left_s)
      return false;
  }
  return true;
}

// Computes odds and losses in another way: for each member by itself, from the path alone.
TEST_F(Rescue, OddsAndLossesAreThoseOfFollowingThePathInEachMember) {
  problem_.devices[0].damage_factor = 0.5;
  problem_.devices[1].damage_factor = 1.5;
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  ASSERT_FALSE(plan.routes.empty());
  std::vector<double> loss(400);
  for (std::size_t d = 0; d < problem_.devices.size(); ++d) {
    const DeviceOutcome& outcome = plan.devices[d];
    const RescueDevice& device = problem_.devices[d];
    int home = 0;
    for (std::size_t member = 0; member < 400; ++member) {
      std::int32_t step = ensemble_.steps() - 1;
      for (const ShipRoute& route : plan.routes) {
        if (route.ship != outcome.ship) continue;
        if (!Works(problem_, ensemble_, route, outcome.deliver_s, member)) continue;
        ++home;
        step = static_cast<std::int32_t>(std::floor(outcome.deliver_s / 600.0));
      }
      const auto exposure = static_cast<double>(ensemble_.Exposure(d, step)[member]);
      loss[member] += device.value *
                      std::min(1.0 - device.damage_before, 0.004 * device.damage_factor * exposure);
    }
    EXPECT_NEAR(outcome.home, home / 400.0, 1e-9) << device.name;
  }
  for (std::size_t member = 0; member < 400; ++member) {
    EXPECT_NEAR(static_cast<double>(plan.loss[member]), loss[member], 1e-3) << member;
  }
}

// Every assignment and order of three devices to two ships with the nearest ports, by brute force.
TEST_F(Rescue, NoOtherOrderSavesMore) {
  problem_.ports.pop_back();  // one port: no choice of ports
  problem_.ships[1].cell = problem_.ports[0].cell;
  const RescuePlan best = PlanRescue(problem_, ensemble_);
  EXPECT_TRUE(best.is_exhaustive);
  EXPECT_GE(best.bound, best.saved - 1e-6);
  const auto length = [](Cell a, Cell b) {
    const int dx = std::abs(a.x - b.x);
    const int dy = std::abs(a.y - b.y);
    return std::max(dx, dy) + (std::sqrt(2.0) - 1.0) * std::min(dx, dy);
  };
  double most = 0.0;
  std::vector<int> order{0, 1, 2};
  do {
    for (int first = 0; first <= 3; ++first) {  // the first ship takes so many of them
      double saved = 0.0;
      for (int ship = 0; ship < 2; ++ship) {
        const RescueShip& own = problem_.ships[static_cast<std::size_t>(ship)];
        const double pace = 5000.0 / (own.speed_kn * 0.514444);
        double time_s = own.ready_s;
        for (int i = ship == 0 ? 0 : first; i < (ship == 0 ? first : 3); ++i) {
          const auto d = static_cast<std::size_t>(order[static_cast<std::size_t>(i)]);
          const Cell site = problem_.devices[d].cell;
          time_s += 2.0 * (length(own.cell, site) * pace + 600.0);
          // Upper limit: the ship works if the winds are not at the site before it leaves.
          const auto step = static_cast<std::int32_t>(std::floor(time_s / 600.0));
          if (step >= ensemble_.steps()) continue;
          const std::int16_t* arrival = ensemble_.Arrival(2, site);
          for (std::size_t member = 0; member < 400; ++member) {
            if (arrival[member] * 600.0 <= time_s - length(own.cell, site) * pace - 600.0) continue;
            const double left = 1.0 - problem_.devices[d].damage_before;
            const auto loss = [&](std::int32_t at) {
              return problem_.devices[d].value *
                     std::min(left, 0.004 * static_cast<double>(ensemble_.Exposure(d, at)[member]));
            };
            saved += (loss(ensemble_.steps() - 1) - loss(step)) / 400.0;
          }
        }
      }
      most = std::max(most, saved);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_GT(best.saved, 0.9 * most);
  EXPECT_LE(best.saved, most + 1e-3);
}

TEST_F(Rescue, ADeadlineIsTheLastDepartureWithItsChance) {
  const std::vector<double> shares{0.95, 0.8, 0.5};
  const auto deadlines = Deadlines(problem_, ensemble_, shares);
  int found = 0;
  for (std::size_t d = 0; d < problem_.devices.size(); ++d) {
    for (const Deadline& deadline : deadlines[d]) {
      if (!deadline.leave_s || deadline.is_open) continue;
      RescueProblem alone = problem_;
      alone.ships = {problem_.ships[static_cast<std::size_t>(deadline.ship)]};
      for (std::size_t other = 0; other < problem_.devices.size(); ++other) {
        if (other != d) alone.devices[other].value = 0.0;  // only this one is worth a trip
      }
      const auto chance = [&](double leave_s) {
        alone.ships[0].ready_s = leave_s;
        return PlanRescue(alone, ensemble_).devices[d].home;
      };
      EXPECT_GE(chance(*deadline.leave_s), deadline.probability) << d;
      EXPECT_LT(chance(*deadline.leave_s + 600.0), deadline.probability) << d;
      ++found;
    }
  }
  EXPECT_GT(found, 3);
}

// A ship at sea with a device aboard: its way home is judged like every other way.
TEST_F(Rescue, ADeviceAboardIsDeliveredWithTheOddsOfItsWayHome) {
  problem_.ships[0].cell = problem_.devices[0].cell;
  problem_.ships[0].speed_kn = 7.0;  // too slow to be home before the winds in all members
  problem_.ships[0].aboard = {0};
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  const DeviceOutcome& outcome = plan.devices[0];
  ASSERT_EQ(outcome.ship, 0);
  EXPECT_EQ(outcome.fetch_s, 0.0);
  const ShipRoute& route = plan.routes.front();
  ASSERT_EQ(route.ship, 0);
  int home = 0;
  for (std::size_t member = 0; member < 400; ++member) {
    home += Works(problem_, ensemble_, route, outcome.deliver_s, member) ? 1 : 0;
  }
  EXPECT_NEAR(outcome.home, home / 400.0, 1e-9);
  EXPECT_GT(home, 20);
  EXPECT_LT(home, 380);
  for (const ShipRoute& other : plan.routes) {
    for (const RescueOrder& order : other.orders) EXPECT_NE(order.device, 0);
  }
  const auto deadlines = Deadlines(problem_, ensemble_, {0.01});
  EXPECT_EQ(deadlines[0][0].ship, 0) << "no other ship can bring it home";
}

TEST_F(Rescue, AShipWithADeviceAboardIsNeverWithoutAnOrder) {
  problem_.ships[0].aboard = {0};
  problem_.devices[0].cell = problem_.ships[0].cell = {0, 5};
  problem_.ships[0].speed_kn = 1.0;  // the winds overtake it in every member
  const RescuePlan late = PlanRescue(problem_, ensemble_);
  ASSERT_EQ(late.devices[0].ship, 0);
  EXPECT_EQ(late.devices[0].home, 0.0);
  EXPECT_EQ(late.routes[0].orders.back().kind, OrderKind::kDeliver);
  CentralForecast calm = test::PassingStorm();
  for (StormPoint& point : calm.path.points) point.y = 900.0;
  EnsembleOptions options = test::SmallEnsemble(50);
  const RescuePlan sure = PlanRescue(problem_, Ensemble(calm, options, test::SitesOf(problem_)));
  ASSERT_EQ(sure.routes.size(), 1U);
  EXPECT_EQ(sure.routes[0].orders.back().devices, std::vector<std::int32_t>{0});
  for (const WhatIf& row : CompareChanges(problem_, ensemble_, late)) {
    EXPECT_TRUE(row.change != "ships-1" || row.text.find("ship 2") != std::string::npos)
        << row.text;
  }
}

// The ships at sea are ready at once; an added ship is ready at `depart_s`.
TEST_F(Rescue, AnAddedShipLeavesWithTheShipsInPort) {
  problem_.ships.resize(1);
  problem_.ships[0].cell = problem_.devices[0].cell;
  problem_.ships[0].aboard = {0};
  const auto gain = [this](double depart_s) {
    problem_.depart_s = depart_s;
    const RescuePlan plan = PlanRescue(problem_, ensemble_);
    for (const WhatIf& row : CompareChanges(problem_, ensemble_, plan)) {
      if (row.change == "ships+1") return -row.difference;
    }
    return -1.0;
  };
  EXPECT_GT(gain(0.0), 0.5);
  EXPECT_EQ(gain(59 * 600.0), 0.0) << "the winds are there before";
  problem_.ships.push_back(test::SmallRescue().ships[1]);
  problem_.ships[1].ready_s = 59 * 600.0;
  EXPECT_EQ(gain(0.0), 0.0) << "as the ship in port";
}

TEST_F(Rescue, ShipsStayInPortWhenTheWindsAreThere) {
  for (RescueShip& ship : problem_.ships) ship.ready_s = 59 * 600.0;
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  EXPECT_TRUE(plan.routes.empty());
  EXPECT_EQ(plan.loss, plan.loss_idle);
  EXPECT_EQ(plan.saved, 0.0);
}

TEST_F(Rescue, RiskAversionNeverWorsensTheWorstCases) {
  const RescuePlan mean = PlanRescue(problem_, ensemble_);
  problem_.risk_averse = 0.05;
  const RescuePlan averse = PlanRescue(problem_, ensemble_);
  EXPECT_LE(MeanOfWorst(averse.loss, 0.05), MeanOfWorst(mean.loss, 0.05));
}

TEST_F(Rescue, ChangesBeginWithThePlanAndAreSortedByLoss) {
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  const std::vector<WhatIf> rows = CompareChanges(problem_, ensemble_, plan);
  EXPECT_EQ(rows[0].change, "none");
  EXPECT_EQ(rows[0].difference, 0.0);
  for (std::size_t i = 2; i < rows.size(); ++i) {
    EXPECT_GE(rows[i].loss.mean, rows[i - 1].loss.mean);
  }
  for (const WhatIf& row : rows) {
    if (row.change == "ships+1" || row.change == "capacity+1") {
      EXPECT_LE(row.difference, 1e-3);
    }
    if (row.change == "ships-1" || row.change.substr(0, 6) == "depart") {
      EXPECT_GE(row.difference, -1e-3);
    }
  }
}

TEST_F(Rescue, APlanPlayedInItsOwnMembersLosesTheSame) {
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  const RescuePlan played = PlayRescue(problem_, ensemble_, plan);
  EXPECT_EQ(played.loss, plan.loss);
  EXPECT_EQ(played.home_count, plan.home_count);
  EXPECT_NEAR(played.saved, plan.saved, 1e-9);
}

TEST_F(Rescue, SimpleRulesFetchByValueOrDistance) {
  problem_.ships.pop_back();  // one ship in port A at (11, 0)
  const auto order = [&](FetchRule rule) {
    std::string names;
    const RescuePlan plan = FetchInOrder(problem_, ensemble_, rule);
    for (const RescueOrder& one : plan.routes.at(0).orders) {
      if (one.kind != OrderKind::kFetch) continue;
      names += problem_.devices[static_cast<std::size_t>(one.device)].name + " ";
    }
    EXPECT_LE(plan.saved, PlanRescue(problem_, ensemble_).saved + 1e-6);
    return names;
  };
  EXPECT_EQ(order(FetchRule::kValue), "F1 F2 F3 ");
  // F3 at (9, 4) is nearest and goes to port A, four steps away; port B is five. From port A both
  // are eight steps away, but F1 at (3, 2) needs fewer diagonals than F2 at (6, 8).
  EXPECT_EQ(order(FetchRule::kNearest), "F3 F1 F2 ");
}

TEST_F(Rescue, NoLossIsBelowZero) {
  const RescuePlan plan = PlanRescue(problem_, ensemble_);
  for (const float loss : plan.loss) EXPECT_GE(loss, 0.0F);
  for (const DeviceOutcome& device : plan.devices) EXPECT_GE(device.mean_loss, 0.0);
}

TEST_F(Rescue, APlaceOnLandIsRefusedByName) {
  problem_.water(2, 3) = 0;
  try {
    PlanRescue(problem_, ensemble_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "F1: got cell (3, 2), expected water on the map");
  }
}

TEST(Loss, SummaryOfAHundredLosses) {
  std::vector<float> losses;
  for (int i = 100; i >= 1; --i) losses.push_back(static_cast<float>(i));
  const LossSummary summary = Summarize(losses);
  EXPECT_NEAR(summary.mean, 50.5, 1e-9);
  EXPECT_NEAR(summary.cvar05, 98.0, 1e-9);  // of 96 … 100
  EXPECT_NEAR(MeanOfWorst({4.0F, 1.0F, 3.0F}, 0.5), (4.0 + 0.5 * 3.0) / 1.5, 1e-9);
}

}  // namespace
}  // namespace aquafarm::agents
