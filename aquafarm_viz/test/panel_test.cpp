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

#include "aquafarm_viz/base/palette.h"
#include "fit_screen.h"
#include "fixture.h"
#include "plan_fixture.h"
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

TEST(RanchModel, SaysThatATrainingWaitsForAPausedRanch) {
  RanchModel model = Filled();
  auto state = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  state->paused = true;
  ASSERT_EQ(model.Take(aquafarm_msgs::FarmStateConstPtr(state)), "");
  auto training = boost::make_shared<aquafarm_msgs::TrainingStatus>(*Training(120, 81.2F));
  training->phase = aquafarm_msgs::TrainingStatus::WAITING;
  model.Take(aquafarm_msgs::TrainingStatusConstPtr(training));
  EXPECT_EQ(model.TrainingLine(),
            "q_learning, waiting (ranch paused)   120 / 2,000 episodes   mean return 81.2   "
            "success 62 %")
      << "neither a speed nor a time left";
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

TEST(RanchModel, APlanThatFollowsTheRanchHasItsTime) {
  RanchModel model = Filled();
  auto plan = test::MakePlan();
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
  const auto plan = test::MakePlan();
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
  model.Take(aquafarm_msgs::RescuePlanConstPtr(test::MakePlan()), now - ros::WallDuration(7.5));
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

TEST(RanchWidget, ShowsTheRegionIfADisasterIsOutsideAndNoCurveNeedsTheSpace) {
  RanchModel model = Filled();
  Asked asked;
  RanchWidget widget(model, asked.Buttons());
  auto* region = widget.findChild<QWidget*>("region");
  ASSERT_NE(region, nullptr);
  EXPECT_TRUE(region->isHidden()) << "all disasters are inside the farm";
  auto state = boost::make_shared<aquafarm_msgs::FarmState>(test::MakeState());
  state->disasters = {test::MakeDisaster(0, 300.0F, 12.0F)};
  ASSERT_EQ(model.Take(aquafarm_msgs::FarmStateConstPtr(state)), "");
  widget.resize(500, 800);
  widget.Refresh();
  EXPECT_FALSE(region->isHidden());
  const Rgb grade = GradeColor(state->disasters[0].grade);
  EXPECT_GT(Count(region->grab().toImage(), qRgb(grade.r, grade.g, grade.b)), 20) << "the centre";
  RanchModel planned = model;
  planned.Take(aquafarm_msgs::RescuePlanConstPtr(test::MakePlan()), ros::SteadyTime::now());
  RanchWidget other(planned, asked.Buttons());
  EXPECT_TRUE(other.findChild<QWidget*>("region")->isHidden()) << "the plan needs the space";
  for (int episode = 1; episode < 9; ++episode) {
    model.Take(Training(static_cast<std::uint64_t>(episode), 1.0F));
  }
  widget.Refresh();
  EXPECT_TRUE(region->isHidden());
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
