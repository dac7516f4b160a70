// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/call_limit.h"

#include <gtest/gtest.h>

#include <thread>

namespace aquafarm_agents {
namespace {

TEST(EndUnlessDone, ReturnsOnceTheTaskIsDone) {
  bool is_done = false;
  EndUnlessDone([&is_done] { is_done = true; }, 50);
  EXPECT_TRUE(is_done);
}

TEST(EndUnlessDoneDeathTest, EndsAProcessThatHangsWithTheCodeOfLostFarms) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(EndUnlessDone([] { std::this_thread::sleep_for(std::chrono::minutes(5)); }, 2),
              testing::ExitedWithCode(4), "roscpp is in a deadlock.*continue it with resume:=true");
}

}  // namespace
}  // namespace aquafarm_agents
