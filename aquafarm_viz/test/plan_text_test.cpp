// SPDX-License-Identifier: BSD-3-Clause
// The texts about a rescue plan in the panel.
#include "aquafarm_viz/scene/plan_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "aquafarm_sim/plan_words.h"
#include "plan_fixture.h"

namespace aquafarm_viz {
namespace {

TEST(PlanText, TheNextOrderIsThatOfTheTime) {
  const auto plan = test::MakePlan();
  using Rows = std::vector<PlanRow>;
  const auto at = [&](double hours) {
    return PlanShips(*plan, plan->start + ros::Duration(3600.0 * hours));
  };
  EXPECT_EQ(at(0.0),
            (Rows{{"ship 1", "leave port A", "08:00", "> 99 %"}, {"ship 2", "stay", "", ""}}));
  EXPECT_EQ(at(0.1)[0], (PlanRow{"ship 1", "fetch D2", "16:00", "90 %"}));
  EXPECT_EQ(at(9.0)[0], (PlanRow{"ship 1", "deliver D2 at port A", "25 Jul 00:00", "80 %"}));
  EXPECT_EQ(at(17.0)[0], (PlanRow{"ship 1", "all done", "", ""}));
  EXPECT_EQ(at(0.0)[0].size(), PlanShipColumns().size());
}

TEST(PlanText, DevicesHaveTheirOddsAndDeadlines) {
  const auto plan = test::MakePlan();
  const auto rows = PlanDevices(*plan);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], (PlanRow{"D1", "left behind", "none", "09:00", "not known beyond 09:00"}));
  EXPECT_EQ(rows[1], (PlanRow{"D2", "87 %", "none", "09:00", "not known beyond 09:00"}));
  EXPECT_EQ(rows[2][1], "stays");
  EXPECT_EQ(rows[0].size(), PlanDeviceColumns().size());
  plan->result = aquafarm_msgs::RescuePlan::STORM_UNKNOWN;
  EXPECT_EQ(PlanDevices(*plan)[1], (PlanRow{"D2", "unknown", "unknown", "unknown", "unknown"}));
}

// A ship with a device aboard has orders even if the winds are unknown, but no chances.
TEST(PlanText, ChancesAreUnknownIfTheWindsAre) {
  const auto plan = test::MakePlan();
  plan->result = aquafarm_msgs::RescuePlan::STORM_UNKNOWN;
  plan->ships[0].aboard = {1};
  plan->routes[0].orders.erase(plan->routes[0].orders.begin() + 1);
  for (const float chance : {1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    for (auto& order : plan->routes[0].orders) order.probability = chance;
    plan->devices[1].home = chance;
    for (const double hours : {0.0, 9.0}) {
      const PlanRow row = PlanShips(*plan, plan->start + ros::Duration(3600.0 * hours))[0];
      EXPECT_EQ(row[3], "unknown") << row[1];
    }
    EXPECT_EQ(PlanDevices(*plan)[1][1], "unknown");
  }
  EXPECT_EQ(PlanHeadline(*plan, 0.0), "plan: 1 of 2 ships leave.") << "no deadline is known";
}

TEST(PlanText, TheHeadlineNamesWhatIsOutdated) {
  const auto plan = test::MakePlan();
  EXPECT_EQ(PlanHeadline(*plan, 0.0),
            "plan: 1 of 2 ships leave. No ship should leave after 13:30.");
  plan->fault = "b.json: bad; this plan uses a.json";
  plan->warnings.resize(1);
  plan->warnings[0].severity = "stop";
  plan->warnings[0].text = "The bulletin is 14 hours old.";
  EXPECT_EQ(PlanHeadline(*plan, 0.0),
            "plan: 1 of 2 ships leave. No ship should leave after 13:30. The bulletin is 14 hours "
            "old. OUTDATED: b.json: bad; this plan uses a.json");
}

TEST(PlanText, DeparturesMayFollowTheEndOfTheKnownTime) {
  const auto plan = test::MakePlan();
  plan->not_known_beyond = plan->no_departure_after;
  plan->no_departure_after = ros::Time();
  EXPECT_EQ(PlanHeadline(*plan, 0.0),
            "plan: 1 of 2 ships leave. Ships may leave at least until 13:30. What follows is not "
            "known: plan again at the next bulletin.");
  plan->result = aquafarm_msgs::RescuePlan::STORM_UNKNOWN;
  EXPECT_EQ(PlanHeadline(*plan, 0.0), "plan: 1 of 2 ships leave.");
}

TEST(PlanWords, SharesAreNeverCertainAndOtherDaysAreNamed) {
  EXPECT_EQ(aquafarm_sim::PercentText(1.0), "> 99 %");
  EXPECT_EQ(aquafarm_sim::PercentText(0.87), "87 %");
  EXPECT_EQ(aquafarm_sim::PercentText(0.0), "< 1 %");
  EXPECT_EQ(aquafarm_sim::PercentText(std::numeric_limits<double>::quiet_NaN()), "unknown");
  aquafarm_msgs::RescuePlan plan;
  plan.utc_offset_min = 480;
  plan.start = ros::Time(1627084800, 0);  // 2021-07-24 00:00 UTC, 08:00 local time
  EXPECT_EQ(aquafarm_sim::LocalText(plan, plan.start), "08:00");
  EXPECT_EQ(aquafarm_sim::LocalText(plan, plan.start + ros::Duration(18.0 * 3600.0)),
            "25 Jul 02:00");
}

TEST(PlanWords, AShipAtSeaIsNeverOrderedToStay) {
  const auto plan = test::MakePlan();
  aquafarm_msgs::RescueShip ship = plan->ships[1];
  plan->ports[0].cell.x = 3;
  EXPECT_EQ(aquafarm_sim::WithoutRouteText(*plan, ship), "return to port");
  ship.cell.x = 3;
  EXPECT_EQ(aquafarm_sim::WithoutRouteText(*plan, ship), "stay");
  ship.aboard = {1};
  EXPECT_EQ(aquafarm_sim::WithoutRouteText(*plan, ship), "stay, no safe way to a port");
  ship.cell.x = 4;
  EXPECT_EQ(aquafarm_sim::WithoutRouteText(*plan, ship), "no safe way to a port");
}

}  // namespace
}  // namespace aquafarm_viz
