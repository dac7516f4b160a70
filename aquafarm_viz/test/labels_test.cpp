// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/labels.h"

#include <aquafarm_msgs/Outcome.h>
#include <gtest/gtest.h>

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::Outcome;

std::string Line(std::uint8_t code, float reward) {
  aquafarm_msgs::CommandResult result;
  result.ok = true;
  result.code = code;
  result.reward = reward;
  result.step = 5;
  return DescribeResult(result);
}

TEST(DescribeResult, IsExecutedOnlyIfTheCommandWasExecutedAsGiven) {
  EXPECT_EQ(Line(Outcome::OK, 20.0F), "executed, +20.0, step 5");
  EXPECT_EQ(Line(Outcome::ILLEGAL_PICKUP, -10.0F), "illegal pickup, -10.0, step 5");
  EXPECT_EQ(Line(Outcome::ILLEGAL_DROP_OFF, -10.0F), "illegal drop-off, -10.0, step 5");
  EXPECT_EQ(Line(Outcome::CRASH, -20.0F), "crash, -20.0, step 5");
  EXPECT_EQ(Line(Outcome::EDGE, -1.0F), "edge, -1.0, step 5");
  EXPECT_EQ(Line(Outcome::HELD, -1.0F), "held, -1.0, step 5");
}

TEST(DescribeResult, OfAPacedCommandIsNotYetKnown) {
  EXPECT_EQ(Line(Outcome::ACCEPTED, 0.0F), "accepted for step 5");
}

TEST(EndText, CountsTheDevicesInPortUnlessAllAreRetrieved) {
  aquafarm_msgs::FarmState state;
  state.devices.resize(3);
  state.devices[1].status = aquafarm_msgs::DeviceState::DELIVERED;
  state.reason = aquafarm_msgs::FarmState::DISASTER_ENDED;
  EXPECT_EQ(EndText(state), "The disaster has ended: 1 of 3 devices in port");
  state.reason = 200;
  EXPECT_EQ(EndText(state), "Episode over: 1 of 3 devices in port");
  state.reason = aquafarm_msgs::FarmState::ALL_RETRIEVED;
  EXPECT_EQ(EndText(state), "All devices retrieved");
}

}  // namespace
}  // namespace aquafarm_viz
