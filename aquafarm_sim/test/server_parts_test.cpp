// SPDX-License-Identifier: BSD-3-Clause
// Tests of the parts of FarmServer.
#include <gtest/gtest.h>

#include <array>
#include <future>

#include "aquafarm_sim/server/claim_table.h"
#include "aquafarm_sim/server/command_barrier.h"
#include "aquafarm_sim/server/pace_clock.h"
#include "aquafarm_sim/server/request_log.h"
#include "tiny_farms.h"

namespace aquafarm_sim {
namespace {

using aquafarm::MutexLock;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Answers = RequestLog<RequestKey, int>;

// Longer than any test waits; a test that reaches it fails.
constexpr auto kLong = std::chrono::minutes(5);

TEST(RequestLog, FindsTheLastCompletedRequestOfTheSameClientOnly) {
  Answers log;
  log.Begin() = 42;
  EXPECT_EQ(nullptr, log.Find({7, "/a"})) << "not complete";
  log.Complete({7, "/a"});
  ASSERT_NE(nullptr, log.Find({7, "/a"}));
  EXPECT_EQ(42, *log.Find({7, "/a"}));
  EXPECT_EQ(nullptr, log.Find({7, "/b"}));
  EXPECT_EQ(nullptr, log.Find({8, "/a"}));
  log.Forget();
  EXPECT_EQ(nullptr, log.Find({7, "/a"}));
}

TEST(RequestLog, ARequestWithoutANumberIsNeverARepetition) {
  Answers log;
  log.Begin() = 1;
  log.Complete({0, "/a"});
  EXPECT_EQ(nullptr, log.Find({0, "/a"}));
}

TEST(ClaimTable, OnlyTheHolderMayCommandUntilItReleases) {
  ClaimTable claims(2, 300.0);
  EXPECT_FALSE(claims.IsHeldByAnother(0, "/b", false));
  claims.SetHolder(0, "/a");
  EXPECT_TRUE(claims.IsHeldByAnother(0, "/b", false));
  EXPECT_FALSE(claims.IsHeldByAnother(0, "/a", false));
  EXPECT_FALSE(claims.IsHeldByAnother(1, "/b", false)) << "the other ship is free";
  claims.SetHolder(0, "");
  EXPECT_FALSE(claims.IsHeldByAnother(0, "/b", false));
  EXPECT_EQ(0U, claims.expired());
}

TEST(ClaimTable, ASilentHolderLosesItsClaimUnlessItsCommandWaits) {
  ClaimTable claims(1, 0.0);
  claims.SetHolder(0, "/a");
  EXPECT_TRUE(claims.IsHeldByAnother(0, "/b", true));
  EXPECT_EQ("/a", claims.holder(0));
  EXPECT_FALSE(claims.IsHeldByAnother(0, "/b", false));
  EXPECT_EQ("", claims.holder(0));
  EXPECT_EQ(1U, claims.expired());
}

MessageContext Paced(double rate_hz) {
  MessageContext context;
  context.paced = true;
  context.rate_hz = rate_hz;
  return context;
}

TEST(PaceClock, EachStepMovesTheStampByOnePeriod) {
  PaceClock clock(Paced(4.0));
  clock.Advance();
  clock.Advance();
  EXPECT_EQ(500'000'000U, clock.context().stamp.toNSec());
  clock.SetPace(true, 2.0);
  clock.Advance();
  EXPECT_EQ(1'000'000'000U, clock.context().stamp.toNSec());
}

TEST(PaceClock, AScheduledPauseBeginsAfterItsSteps) {
  PaceClock clock(Paced(10.0));
  clock.SetPaused(true, 2);
  EXPECT_FALSE(clock.context().paused);
  clock.Advance();
  EXPECT_FALSE(clock.context().paused);
  clock.Advance();
  EXPECT_TRUE(clock.context().paused);
  clock.SetPaused(true, 1);
  clock.SetPaused(false);
  clock.Advance();
  EXPECT_FALSE(clock.context().paused) << "the scheduled pause is removed";
}

TEST(PaceClock, TicksAreAPeriodApartAndNoneIsDueAfterTheEnd) {
  aquafarm::Mutex mutex;
  MutexLock lock(mutex);
  PaceClock clock(Paced(50.0));
  bool ending = false;
  const auto began = steady_clock::now();
  for (int tick = 0; tick < 5; ++tick) ASSERT_TRUE(clock.WaitForTick(lock, ending));
  EXPECT_GE(steady_clock::now() - began, milliseconds(100));
  ending = true;
  EXPECT_FALSE(clock.WaitForTick(lock, ending));
}

// Clients that set the same rate again and again must not stop the farm.
TEST(PaceClock, SettingTheSamePaceDelaysNoTick) {
  aquafarm::Mutex mutex;
  PaceClock clock(Paced(5.0));
  bool ending = false;
  auto ticked = std::async(std::launch::async, [&] {
    MutexLock lock(mutex);
    return clock.WaitForTick(lock, ending);
  });
  const auto limit = steady_clock::now() + kLong;
  while (ticked.wait_for(milliseconds(20)) != std::future_status::ready &&
         steady_clock::now() < limit) {
    const MutexLock lock(mutex);
    clock.SetPace(true, 5.0);
    clock.SetPaused(false);
  }
  {
    const MutexLock lock(mutex);
    EXPECT_LT(steady_clock::now(), limit);
    ending = true;
    clock.Wake();
  }
  EXPECT_TRUE(ticked.get());
}

TEST(PaceClock, APausedClockWaitsUntilItIsResumed) {
  aquafarm::Mutex mutex;
  PaceClock clock(Paced(1000.0));
  bool ending = false;
  {
    const MutexLock lock(mutex);
    clock.SetPaused(true);
  }
  auto ticked = std::async(std::launch::async, [&] {
    MutexLock lock(mutex);
    return clock.WaitForTick(lock, ending);
  });
  EXPECT_EQ(std::future_status::timeout, ticked.wait_for(milliseconds(50)));
  {
    const MutexLock lock(mutex);
    clock.SetPaused(false);
  }
  EXPECT_TRUE(ticked.get());
}

struct TwoShips : testing::Test {
  TwoShips() : farm(Scenario()), barrier(2) {}
  static std::shared_ptr<const aquafarm::Scenario> Scenario() {
    aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
    scenario.ships.count = 2;
    return std::make_shared<const aquafarm::Scenario>(scenario);
  }
  aquafarm::Farm farm;
  CommandBarrier barrier;
  aquafarm::Mutex mutex;
  bool ending{};
};

TEST_F(TwoShips, TheBarrierIsCompleteWhenEveryPresentShipHasACommand) {
  EXPECT_EQ((std::vector<std::int32_t>{0, 1}), barrier.MissingShips(farm));
  barrier.Add({0, 3}, nullptr);
  EXPECT_FALSE(barrier.IsComplete(farm));
  barrier.SetAbsent(1, true);
  EXPECT_TRUE(barrier.IsComplete(farm));
  EXPECT_EQ(std::vector<std::int32_t>{1}, barrier.AbsentShips());
  std::array<std::uint8_t, 2> actions{};
  barrier.WriteActions(actions.data());
  EXPECT_EQ(3, actions[0]);
  EXPECT_EQ(static_cast<std::uint8_t>(aquafarm::Action::kHold), actions[1]);
}

TEST_F(TwoShips, AnAnswerReachesItsCallAndItsRepetition) {
  MutexLock lock(mutex);
  CommandBarrier::Call call;
  const ShipCommand command{0, 3, 0, 0, 99};
  barrier.Add(command, &call);
  EXPECT_EQ(nullptr, barrier.FindAnswer(command));
  aquafarm_msgs::CommandResult result;
  result.step = 7;
  barrier.Answer(0, result);
  EXPECT_EQ(CommandBarrier::WaitEnd::kAnswered,
            barrier.Wait(lock, call, steady_clock::now() + kLong, ending));
  EXPECT_EQ(7U, call.answer->step);
  ASSERT_NE(nullptr, barrier.FindAnswer(command));
  EXPECT_EQ(7U, barrier.FindAnswer(command)->step);
  EXPECT_FALSE(barrier.HasCommand(0));
  barrier.ForgetAnswers();
  EXPECT_EQ(nullptr, barrier.FindAnswer(command));
}

TEST_F(TwoShips, ANewerCommandEndsTheWaitOfTheEarlierOne) {
  MutexLock lock(mutex);
  CommandBarrier::Call earlier;
  CommandBarrier::Call newer;
  barrier.Add({0, 1}, &earlier);
  barrier.Add({0, 2}, &newer);
  EXPECT_EQ(CommandBarrier::WaitEnd::kSuperseded,
            barrier.Wait(lock, earlier, steady_clock::now() + kLong, ending));
  std::array<std::uint8_t, 2> actions{};
  barrier.WriteActions(actions.data());
  EXPECT_EQ(2, actions[0]);
}

TEST_F(TwoShips, AWaitEndsWhenDroppedAtItsDeadlineAndAtTheEnd) {
  MutexLock lock(mutex);
  CommandBarrier::Call call;
  barrier.Add({0, 1}, &call);
  EXPECT_EQ(CommandBarrier::WaitEnd::kTimedOut,
            barrier.Wait(lock, call, steady_clock::now() + milliseconds(10), ending));
  EXPECT_TRUE(barrier.HasCommand(0)) << "the caller decides whether it steps or withdraws";
  ending = true;
  EXPECT_EQ(CommandBarrier::WaitEnd::kTimedOut,
            barrier.Wait(lock, call, steady_clock::now() + kLong, ending));
  barrier.Drop("why");
  CommandBarrier::Call newer;
  barrier.Add({0, 2}, &newer);
  EXPECT_EQ(CommandBarrier::WaitEnd::kDropped,
            barrier.Wait(lock, call, steady_clock::now() + kLong, ending))
      << "also if the ship has a newer command";
  EXPECT_EQ("why", barrier.drop_reason());
  barrier.Withdraw(call);
  EXPECT_TRUE(barrier.HasCommand(0)) << "the newer command";
}

TEST_F(TwoShips, AWithdrawnCommandIsNotCarriedOut) {
  CommandBarrier::Call call;
  barrier.Add({0, 1}, &call);
  barrier.Withdraw(call);
  EXPECT_FALSE(barrier.HasCommand(0));
  EXPECT_EQ((std::vector<std::int32_t>{0, 1}), barrier.MissingShips(farm));
}

}  // namespace
}  // namespace aquafarm_sim
