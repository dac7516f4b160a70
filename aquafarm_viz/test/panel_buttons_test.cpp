// SPDX-License-Identifier: BSD-3-Clause
// The panel "Ranch" as in rviz, connected to a running ranch. The test clicks its buttons.
#include <gtest/gtest.h>

#include <QApplication>
#include <QtTest/QTest>
#include <algorithm>
#include <chrono>
#include <functional>
#include <string>

#include "ranch_panel.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmState;

constexpr std::chrono::seconds kLimit{60};

class PanelButtons : public testing::Test {
 protected:
  void SetUp() override {
    states_ = node_.subscribe<FarmState>(
        "state", 1000, [this](const aquafarm_msgs::FarmStateConstPtr& state) { state_ = *state; });
    panel_.resize(600, 900);
    panel_.show();
    ASSERT_TRUE(ros::service::waitForService("pause", ros::Duration(-1)));
    SetPace("paced", 8.0);
    Press("resume");
    ASSERT_TRUE(Until([this] {
      return !state_.ships.empty() && !state_.paused && state_.pace == FarmState::PACED &&
             Says("episode ");
    }));
  }

  // Processes window events and callbacks until a condition is true.
  static bool Until(const std::function<bool()>& is_so, std::chrono::milliseconds limit = kLimit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!is_so()) {
      if (std::chrono::steady_clock::now() > end || !ros::ok()) return false;
      QApplication::processEvents();
      ros::spinOnce();
      ros::WallDuration(0.002).sleep();
    }
    return true;
  }

  static void Wait(std::chrono::milliseconds time) {
    Until([] { return false; }, time);
  }

  void Press(const char* name) {
    auto* button = panel_.findChild<QPushButton*>(name);
    ASSERT_NE(button, nullptr) << name;
    QTest::mouseClick(button, Qt::LeftButton);
  }

  // Selects an item in the combo box that contains it.
  void Choose(const char* item) {
    for (auto* box : panel_.findChildren<QComboBox*>()) {
      if (const int index = box->findText(item); index >= 0) return box->setCurrentIndex(index);
    }
    FAIL() << "no box with " << item;
  }

  void SetPace(const char* pace, double rate_hz) {
    Choose(pace);
    panel_.findChild<QDoubleSpinBox*>("rate")->setValue(rate_hz);
    Press("pace");
  }

  bool Says(const std::string& words) const {
    const auto lines = panel_.findChildren<QLabel*>();
    return std::any_of(lines.begin(), lines.end(), [&words](const QLabel* line) {
      return line->text().toStdString().find(words) != std::string::npos;
    });
  }

  ros::NodeHandle node_;
  RanchPanel panel_;
  FarmState state_;
  ros::Subscriber states_;
};

TEST_F(PanelButtons, PauseStopsTheFarmStepTakesOneAndResumeContinues) {
  Press("pause");
  ASSERT_TRUE(Until([this] { return Says("   paused") && state_.paused; }));
  const std::uint64_t step = state_.step;
  Wait(std::chrono::milliseconds(600));  // the duration of five steps
  EXPECT_EQ(state_.step, step);
  Press("step");
  EXPECT_TRUE(Until([&] { return state_.step == step + 1 && Says("one step, then paused"); }));
  Wait(std::chrono::milliseconds(600));
  EXPECT_EQ(state_.step, step + 1);
  EXPECT_TRUE(state_.paused);
  Press("resume");
  EXPECT_TRUE(Until([&] { return state_.step > step + 3 && !state_.paused && Says("resumed"); }));
}

TEST_F(PanelButtons, ResetBeginsTheEpisodesOfTheSeedNextToIt) {
  for (const std::uint64_t seed : {31U, 47U}) {
    panel_.findChild<QSpinBox*>("seed")->setValue(static_cast<int>(seed));
    Press("reset");
    const std::string seen = "seed " + std::to_string(seed);
    EXPECT_TRUE(Until([&] {
      return state_.seed == seed && state_.episode == 0 && Says(seen + ", episode 0") &&
             Says("   " + seen);
    })) << state_.seed;
    EXPECT_LT(state_.step, 100U);
  }
}

TEST_F(PanelButtons, ThePaceIsThatOfTheBoxes) {
  SetPace("paced", 50.0);
  ASSERT_TRUE(Until([this] { return state_.rate_hz == 50.0 && Says("paced, 50.0 steps/s"); }));
  const std::uint64_t step = state_.step;
  EXPECT_TRUE(
      Until([&] { return state_.step >= step + 150; }, std::chrono::seconds(15)));  // not at 8 Hz
  SetPace("lockstep", 8.0);
  EXPECT_TRUE(Until(
      [this] { return state_.pace == FarmState::LOCKSTEP && Says("lockstep, 8.0 steps/s"); }));
}

TEST_F(PanelButtons, AShipIsDrivenByHand) {
  SetPace("lockstep", 8.0);
  ASSERT_TRUE(Until([this] { return state_.pace == FarmState::LOCKSTEP && Says("lockstep, "); }));
  const struct {
    const char* button;
    std::uint8_t action;
  } kKeys[]{{"N", 0}, {"S", 1}, {"W", 2}, {"E", 3}, {"hold", 10}, {"pickup", 8}, {"drop-off", 9}};
  for (const auto& key : kKeys) {
    const std::uint64_t step = state_.step;
    Press(key.button);
    EXPECT_TRUE(Until([&] { return state_.step == step + 1; })) << key.button;
    EXPECT_EQ(state_.ships[0].action, key.action) << key.button;
    EXPECT_TRUE(Until([&] { return Says("step " + std::to_string(step + 1)); })) << key.button;
  }
}

TEST_F(PanelButtons, ADisasterIsSentToShip0) {
  Press("pause");
  ASSERT_TRUE(Until([this] { return state_.paused && Says("   paused"); }));
  const std::size_t before = state_.disasters.size();
  Choose("red tide");
  Choose("red");
  Press("send disaster");
  ASSERT_TRUE(Until([&] { return state_.disasters.size() == before + 1; }));
  const DisasterState& sent = state_.disasters.back();
  EXPECT_EQ(sent.kind, DisasterState::RED_TIDE);
  EXPECT_EQ(sent.grade, 4);
  ASSERT_EQ(sent.radii.size(), 3U);
  EXPECT_FLOAT_EQ(sent.radii.back(), 4.0F);
  EXPECT_FLOAT_EQ(sent.x, static_cast<float>(state_.ships[0].x));
  EXPECT_FLOAT_EQ(sent.y, static_cast<float>(state_.ships[0].y));
  EXPECT_TRUE(Until([&] { return Says("red tide sent as disaster " + std::to_string(before)); }));
}

}  // namespace
}  // namespace aquafarm_viz

int main(int argc, char** argv) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "panel_buttons_test");
  QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
