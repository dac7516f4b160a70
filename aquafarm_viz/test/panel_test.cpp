// SPDX-License-Identifier: BSD-3-Clause
// The panel "Ranch" on Qt's offscreen platform: no display, no rviz, no ROS.
#include <gtest/gtest.h>

#include <QApplication>
#include <QFontInfo>
#include <QImage>
#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm_sim/plan_words.h"
#include "aquafarm_viz/base/palette.h"
#include "fit_screen.h"
#include "fixture.h"
#include "ranch_widget.h"

namespace aquafarm_viz {
namespace {

aquafarm_msgs::TrainingStatusConstPtr Training(std::uint64_t episode, float mean_return) {
  auto training = boost::make_shared<aquafarm_msgs::TrainingStatus>();
  training->phase = aquafarm_msgs::TrainingStatus::TRAINING;
  training->algorithm = "q_learning";
  training->episode = episode;
  training->episodes = 2000;
  training->mean_return = mean_return;
  training->success_rate = 0.62F;
  training->steps_per_second = 250000.0F;
  training->time_left_s = 42.0;
  return training;
}

RanchModel Filled() {
  RanchModel model;
  model.Take(boost::make_shared<aquafarm_msgs::FarmSpec>(test::MakeSpec()));
  auto state = test::MakeState();
  state.ships[0].aboard = {0};
  state.ships[0].capacity = 1;
  EXPECT_EQ(model.Take(boost::make_shared<aquafarm_msgs::FarmState>(state)), "");
  return model;
}

TEST(FitScreen, ShrinksAWindowThatIsLargerThanTheScreen) {
  const WindowFit now{{1600, 900}, 560};
  EXPECT_TRUE(FitToScreen(now, {0, 0}, {1920, 1080}) == now);
  const WindowFit small = FitToScreen(now, {2, 30}, {1280, 720});
  EXPECT_EQ(small.window, QSize(1278, 690));
  EXPECT_EQ(small.dock_width, 434) << "so that the farm keeps two thirds";
  EXPECT_EQ(FitToScreen({{1600, 900}, 300}, {0, 0}, {1280, 720}).dock_width, 300);
}

TEST(RanchModel, SaysWhatTheStateIs) {
  const RanchModel model = Filled();
  EXPECT_EQ(model.Headline(), "paper   episode 12   step 17 / 5,000   return -42.5   seed 7");
  EXPECT_EQ(model.RewardLine(), "reward -5.0:   disaster -5.0");
  ASSERT_EQ(model.Ships().size(), 1U);
  EXPECT_EQ(model.Ships()[0], (RanchModel::Row{"0", "(12, 8)", "NE", "F0", "-5.0", "0.0"}));
  ASSERT_EQ(model.Devices().size(), 4U);
  EXPECT_EQ(model.Devices()[1],
            (RanchModel::Row{"F1", "monitoring", "(6, 0)", "delivered", "70 %", "75"}));
  EXPECT_EQ(model.Devices()[0][3], "deployed");
  EXPECT_EQ(model.Devices()[3][3], "risk -5 now, -12 in 12 min");
  EXPECT_EQ(model.Disasters().at(0),
            (RanchModel::Row{"typhoon", "3.1 km ESE", "E at 10 km/h", "", "49 h"}));
  EXPECT_EQ(RanchModel().Headline(), "no ranch yet");
}

TEST(RanchModel, RefusesAStateThatCannotBeShown) {
  RanchModel model;
  auto state = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  state->disasters[0].risks.clear();
  EXPECT_NE(model.Take(state), "");
}

TEST(RanchModel, KeepsTheWholeCurveInBoundedRoom) {
  RanchModel model;
  for (std::uint64_t episode = 1; episode <= 20000; ++episode) {
    model.Take(Training(episode, static_cast<float>(episode)));
  }
  const auto& curve = model.curve();
  EXPECT_GE(curve.size(), RanchModel::kMaxPoints / 2);
  EXPECT_LT(curve.size(), RanchModel::kMaxPoints);
  EXPECT_EQ(curve.front().episode, 1.0);
  EXPECT_GT(curve.back().episode, 19900.0);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_LT(curve[i - 1].episode, curve[i].episode);
  }
  EXPECT_EQ(model.TrainingLine(),
            "q_learning, training   20,000 / 2,000 episodes   mean return 20000.0   success 62 %   "
            "250.0\u00a0k\u00a0steps/s   left\u00a00:42");
}

TEST(RanchModel, ANewTrainingBeginsANewCurve) {
  RanchModel model;
  model.Take(Training(100, 1.0F));
  model.Take(Training(101, 2.0F));
  model.Take(Training(101, 3.0F));  // the same episode
  EXPECT_EQ(model.curve().size(), 2U);
  model.Take(Training(1, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_TRUE(model.curve().empty());
}

TEST(RanchModel, ADisasterBeginsAtTheShipWithRisksByItsGrade) {
  const RanchModel model = Filled();
  const auto info = model.MakeDisaster(aquafarm_msgs::DisasterState::RED_TIDE, 4, 6.0);
  EXPECT_EQ(info.kind, aquafarm_msgs::DisasterState::RED_TIDE);
  EXPECT_EQ(info.x, 12.0F);
  EXPECT_EQ(info.y, 8.0F);
  ASSERT_EQ(info.radii.size(), 3U);
  EXPECT_FLOAT_EQ(info.radii[2], 6.0F);
  EXPECT_FLOAT_EQ(info.risks[0], -20.0F);
  EXPECT_FLOAT_EQ(info.risks[1], -12.5F);
  EXPECT_FLOAT_EQ(info.risks[2], -5.0F);
  EXPECT_FLOAT_EQ(model.MakeDisaster(0, 1, 6.0).risks[0], -5.0F);
  EXPECT_EQ(model.NextDisaster(), 1);
}

// Two ships and three devices; the plan starts on 2021-07-24 at 08:00 local time.
aquafarm_msgs::RescuePlanPtr Plan() {
  using aquafarm_msgs::RescueOrder;
  auto plan = boost::make_shared<aquafarm_msgs::RescuePlan>();
  plan->text = "1 of 2 ships leave.";
  plan->utc_offset_min = 480;
  plan->start = ros::Time(1627084800, 0);
  plan->no_departure_after = plan->start + ros::Duration(5.5 * 3600.0);
  plan->ports.resize(1);
  plan->ports[0].name = "port A";
  plan->ships.resize(2);
  plan->devices.resize(3);
  for (int i = 0; i < 3; ++i) {
    auto& device = plan->devices[static_cast<std::size_t>(i)];
    device.name = "D" + std::to_string(i + 1);
    device.ship = i == 1 ? 0 : -1;
    device.home = 0.874F;
    device.left_reason = i == 0 ? "too_late" : i == 2 ? "safe_in_place" : "";
    device.deadlines.resize(3);
    for (std::size_t k = 0; k < 3; ++k) {
      device.deadlines[k].probability = k == 0 ? 0.95F : k == 1 ? 0.8F : 0.5F;
      device.deadlines[k].possible = k > 0;
      device.deadlines[k].open = k == 2;
      device.deadlines[k].leave = plan->start + ros::Duration(3600.0);
    }
  }
  aquafarm_msgs::RescueRoute route;
  for (const std::uint8_t action : {RescueOrder::LEAVE, RescueOrder::FETCH, RescueOrder::DELIVER}) {
    RescueOrder order;
    order.action = action;
    order.stamp = plan->start + ros::Duration(8.0 * 3600.0 * action);
    order.port = action == RescueOrder::FETCH ? -1 : 0;
    order.device = action == RescueOrder::FETCH ? 1 : -1;
    if (action == RescueOrder::DELIVER) order.devices = {1};
    order.probability = 1.0F - 0.1F * static_cast<float>(action);
    route.orders.push_back(order);
  }
  plan->routes = {route};
  plan->ships[0].name = "ship 1";
  plan->ships[1].id = 1;
  plan->ships[1].name = "ship 2";
  return plan;
}

TEST(PlanText, TheNextOrderIsThatOfTheTime) {
  const auto plan = Plan();
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
  const auto plan = Plan();
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
  const auto plan = Plan();
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
  const auto plan = Plan();
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
  const auto plan = Plan();
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
  const auto plan = Plan();
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

TEST(RanchModel, APlanThatFollowsTheRanchHasItsTime) {
  RanchModel model = Filled();
  auto plan = Plan();
  model.Take(aquafarm_msgs::RescuePlanConstPtr(plan), ros::SteadyTime(1.0));
  EXPECT_EQ(model.PlanNow(), plan->start);
  auto state = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  state->world_time = plan->start + ros::Duration(600.0);
  EXPECT_EQ(model.Take(aquafarm_msgs::FarmStateConstPtr(state)), "");
  EXPECT_EQ(model.PlanNow(), plan->start);
  plan->follows_ranch = true;
  EXPECT_EQ(model.PlanNow(), state->world_time);
}

// Records the requests of the buttons as text.
struct Asked {
  std::vector<std::string> words;
  RanchButtons Buttons() {
    RanchButtons buttons;
    buttons.pause = [this](bool paused, std::uint32_t steps) {
      words.push_back("pause " + std::to_string(paused) + " " + std::to_string(steps));
    };
    buttons.reset = [this](std::uint64_t seed) {
      words.push_back("reset " + std::to_string(seed));
    };
    buttons.set_pace = [this](const std::string& pace, double rate_hz) {
      words.push_back("pace '" + pace + "' " + std::to_string(static_cast<int>(rate_hz)));
    };
    buttons.drive = [this](int ship, std::uint8_t action) {
      words.push_back("drive " + std::to_string(ship) + " " + std::to_string(action));
    };
    buttons.send_disaster = [this](int id, const aquafarm_msgs::DisasterInfo& info) {
      words.push_back("disaster " + std::to_string(id) + " " + std::to_string(info.radii.size()));
    };
    buttons.jump = [this](std::uint64_t step) { words.push_back("jump " + std::to_string(step)); };
    return buttons;
  }
};

TEST(RanchWidget, EachButtonAsksForWhatItSays) {
  const RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  widget.findChild<QSpinBox*>("seed")->setValue(31);
  widget.findChild<QSpinBox*>("step")->setValue(17);
  for (const char* name : {"pause", "resume", "step", "pace", "reset", "jump", "N", "SE", "hold",
                           "pickup", "drop-off", "send disaster"}) {
    auto* button = widget.findChild<QPushButton*>(name);
    ASSERT_NE(button, nullptr) << name;
    button->click();
  }
  EXPECT_EQ(asked.words,
            (std::vector<std::string>{"pause 1 0", "pause 0 0", "pause 1 1", "pace '' 4",
                                      "reset 31", "jump 17", "drive 0 0", "drive 0 7", "drive 0 10",
                                      "drive 0 8", "drive 0 9", "disaster 1 3"}));
}

TEST(RanchWidget, ShowsDeadlinesAndTheNextOrderOnceThereIsAPlan) {
  RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  auto* ships = widget.findChild<QTableWidget*>("plan_ships");
  auto* devices = widget.findChild<QTableWidget*>("plan_devices");
  auto* line = widget.findChild<QLabel*>("plan");
  ASSERT_TRUE(ships != nullptr && devices != nullptr && line != nullptr);
  EXPECT_TRUE(ships->isHidden() && devices->isHidden() && line->isHidden());
  const auto plan = Plan();
  plan->text = "<b>1</b> of 2 ships leave.";
  model.Take(aquafarm_msgs::RescuePlanConstPtr(plan), ros::SteadyTime::now());
  widget.Refresh();
  EXPECT_FALSE(ships->isHidden() || devices->isHidden() || line->isHidden());
  EXPECT_EQ(line->textFormat(), Qt::PlainText);
  EXPECT_EQ(line->text().toStdString(), PlanHeadline(*plan, 0.0));
  ASSERT_EQ(ships->rowCount(), 2);
  EXPECT_EQ(ships->item(0, 1)->text(), "leave port A");
  EXPECT_EQ(ships->item(1, 1)->text(), "stay");
  ASSERT_EQ(devices->rowCount(), 3);
  EXPECT_EQ(devices->item(1, 1)->text(), "87 %");
  EXPECT_EQ(devices->item(1, 3)->text(), "09:00");
}

TEST(RanchWidget, SaysWithinFiveSecondsThatThePlanIsNoLongerRenewed) {
  RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  const ros::SteadyTime now = ros::SteadyTime::now();
  const auto text = [&] {
    widget.RefreshPlanAge();
    return widget.findChild<QLabel*>("plan")->text().toStdString();
  };
  EXPECT_EQ(text(), "") << "without a plan nothing is missing";
  model.Take(aquafarm_msgs::RescuePlanConstPtr(Plan()), now - ros::WallDuration(7.5));
  EXPECT_NE(
      text().find("NOT RENEWED: plan_node has sent nothing for 7 s; start it again, unless it is "
                  "still planning (that may take more than 60 s)."),
      std::string::npos)
      << text();
  model.MarkPlanNodePresent(now);
  EXPECT_EQ(text().find("NOT RENEWED"), std::string::npos);
}

int Count(const QImage& image, QRgb color) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.pixel(x, y) == color ? 1 : 0;
  }
  return count;
}

TEST(RanchWidget, ShowsTablesAndTheCurve) {
  RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  widget.resize(500, 800);
  const QImage before = widget.grab().toImage();
  for (int episode = 1; episode < 60; ++episode) {
    model.Take(Training(static_cast<std::uint64_t>(episode),
                        static_cast<float>(100.0 * std::sin(episode / 10.0))));
  }
  widget.Refresh();
  widget.ShowMessage("<b>paused</b>");  // must not be parsed as markup
  const QImage after = widget.grab().toImage();
  const QRgb curve = qRgb(0xff, 0xd4, 0x3b);
  EXPECT_EQ(Count(before, curve), 0);
  EXPECT_GT(Count(after, curve), 100);
  std::map<std::string, int> cells;
  for (const auto* table : widget.findChildren<QTableWidget*>()) {
    for (int y = 0; y < table->rowCount(); ++y) {
      for (int x = 0; x < table->columnCount(); ++x) {
        ++cells[table->item(y, x)->text().toStdString()];
      }
    }
  }
  EXPECT_EQ(cells["(12, 8)"], 1);
  EXPECT_EQ(cells["deployed"], 1) << "two others are in danger";
  EXPECT_EQ(cells["delivered"], 1);
  bool told = false;
  for (const auto* line : widget.findChildren<QLabel*>()) {
    told = told || (line->text() == "<b>paused</b>" && line->textFormat() == Qt::PlainText);
  }
  EXPECT_TRUE(told);
}

TEST(CurveWidget, HasRoundTicksInsideTheRange) {
  EXPECT_EQ(RoundTicks({-233.0, 150.0}, 4), (std::vector<double>{-200.0, -100.0, 0.0, 100.0}));
  EXPECT_EQ(RoundTicks({0.3, 3.2}, 3), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_EQ(RoundTicks({1.0, 2000.0}, 5), (std::vector<double>{500.0, 1000.0, 1500.0, 2000.0}));
  EXPECT_EQ(RoundTicks({-3300.0, 60.0}, 3), (std::vector<double>{-3000.0, -2000.0, -1000.0, 0.0}));
  for (const double span : {1e-6, 0.7, 42.0, 1e9}) {
    for (const double low : {-0.97, -0.5, 0.03, 5.0}) {
      const auto ticks = RoundTicks({low * span, (low + 1.0) * span}, 3);
      EXPECT_LE(ticks.size(), 6U) << span;
      EXPECT_GE(ticks.size(), 3U) << span << " from " << low;
    }
  }
}

TEST(CurveWidget, IsLinearAboveZeroAndLogarithmicBelow) {
  const std::vector<CurvePoint> curve{{0.0, -5000.0, 0.0}, {9.0, 300.0, 1.0}};
  const CurveRange range = RangeOfReturns(curve);
  EXPECT_LT(range.low, -5000.0);
  EXPECT_GT(range.high, 300.0);
  const ReturnScale scale(range);
  EXPECT_TRUE(scale.is_bent());
  EXPECT_EQ(scale.Height(200.0), 200.0);
  EXPECT_GT(scale.Height(-5000.0), -2.0 * range.high) << "about as much space as above 0";
  EXPECT_LT(scale.Height(-5000.0), scale.Height(-4000.0));
  EXPECT_EQ(scale.Ticks(6),
            (std::vector<double>{0.0, 100.0, 200.0, 300.0, -300.0, -1000.0, -3000.0}));
  EXPECT_FALSE(ReturnScale({-5000.0, -300.0}).is_bent());
  EXPECT_EQ(ReturnScale({-5000.0, -300.0}).Height(-400.0), -400.0);
  for (const double sign : {1.0, -1.0}) {
    const CurveRange one = RangeOfReturns({{0.0, sign * 5.0, 0.0}, {9.0, sign * 300.0, 1.0}});
    EXPECT_FALSE(ReturnScale(one).is_bent()) << "returns of one sign";
    EXPECT_LT(one.low, one.high);
  }
  EXPECT_GT(RangeOfReturns({{0.0, 0.0, 0.0}, {9.0, 0.0, 0.0}}).high, 0.0) << "only zeros";
}

TEST(RanchWidget, ShowsTheSymbolOfEachDeviceNextToItsKind) {
  const RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  int symbols = 0;
  for (const auto* table : widget.findChildren<QTableWidget*>()) {
    for (int row = 0; row < table->rowCount(); ++row) {
      const QTableWidgetItem* item = table->item(row, 1);
      if (item->icon().isNull()) continue;
      const QImage icon = item->icon().pixmap(32, 32).toImage();
      const Rgb color = DeviceColor(model.shown().state->devices[std::size_t(row)].kind);
      EXPECT_EQ(icon.pixel(16, 16), qRgb(color.r, color.g, color.b)) << row;
      ++symbols;
    }
  }
  EXPECT_EQ(symbols, 4);
}

TEST(RanchWidget, TablesAreAsTallAsTheirRows) {
  const RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  widget.resize(640, 1200);
  widget.grab();
  int filled = 0;
  for (const auto* table : widget.findChildren<QTableWidget*>()) {
    if (table->rowCount() == 0 || !table->isVisibleTo(&widget)) continue;
    ++filled;
    const QRect last = table->visualItemRect(table->item(table->rowCount() - 1, 0));
    EXPECT_LE(table->viewport()->height() - last.bottom(), 10) << "no empty half below the rows";
    EXPECT_LE(last.bottom(), table->viewport()->height()) << "all rows are seen";
  }
  EXPECT_EQ(filled, 3) << "ships, devices and disasters";
}

TEST(RanchWidget, FitsAWindowOf1280x720WithTextOfElevenPixels) {
  RanchModel model = Filled();
  model.Take(Training(1, 1.0F));
  model.Take(Training(2, 2.0F));
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  widget.resize(640, 600);  // half of the window; rviz has a menu, tools, tabs and a status bar
  widget.Refresh();
  EXPECT_LE(widget.minimumSizeHint().height(), 600);
  EXPECT_LE(widget.minimumSizeHint().width(), 640) << "half of it is left for the ranch";
  int seen = 0;
  for (const auto* part : widget.findChildren<QWidget*>()) {
    ++seen;
    EXPECT_GE(QFontInfo(part->font()).pixelSize(), 11) << part->metaObject()->className();
  }
  EXPECT_GT(seen, 30);
}

}  // namespace
}  // namespace aquafarm_viz

int main(int argc, char** argv) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
