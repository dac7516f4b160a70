// SPDX-License-Identifier: BSD-3-Clause
// Two ranks in two threads of this process.
#include "aquafarm/agents/ranks/process_group.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <thread>
#include <utility>

namespace aquafarm::agents {
namespace {

using std::chrono::milliseconds;

// Limits [s] of exchanges and of the work of rank 0, and a work that takes longer than exchanges.
constexpr double kAnswer = 2.0;
constexpr double kWork = 60.0;
constexpr milliseconds kSlow{4000};

/// What a rank ends with: its sum, or the message of the error that ended it.
struct Result {
  float sum{};
  std::string lost;
};

/// Rank r adds r + 1 to the sum after `before`.
Result PlayRank(int rank, int port, const GroupTimes& times,
                const std::function<void(ProcessGroup&)>& before) {
  RankVariables variables;
  variables.rank = rank;
  variables.world_size = 2;
  variables.launcher = "test";
  variables.master_port = port;
  Result result;
  try {
    const auto group = JoinProcessGroup(variables, times);
    before(*group);
    std::vector<float> values{static_cast<float>(rank + 1)};
    std::vector<double> none;
    group->Sum(values, none);
    result.sum = values[0];
  } catch (const RankLost& error) {
    result.lost = error.what();
  } catch (const std::runtime_error& error) {  // of the work
    result.lost = std::string("work: ") + error.what();
  }
  return result;
}

std::pair<Result, Result> PlayTwoRanks(const std::function<void(ProcessGroup&)>& before,
                                       double work_s = kWork) {
  static int next = 0;
  const int port = 21000 + (getpid() * 7 + next++) % 8000;
  GroupTimes times;
  times.answer_s = kAnswer;
  times.work_s = work_s;
  auto one = std::async(std::launch::async, PlayRank, 1, port, times, before);
  Result zero = PlayRank(0, port, times, before);
  return {std::move(zero), one.get()};
}

TEST(ProcessGroup, TheWorkOfRank0MayTakeLongerThanAnExchange) {
  int calls = 0;
  const auto [zero, one] = PlayTwoRanks([&](ProcessGroup& group) {
    for (int i = 0; i < 2; ++i) {
      group.RunOnRank0([&] {
        ++calls;
        std::this_thread::sleep_for(kSlow);
      });
    }
  });
  EXPECT_EQ(calls, 2);  // not on rank 1
  EXPECT_EQ(zero.lost + one.lost, "");
  EXPECT_EQ(zero.sum, 3.0F);
  EXPECT_EQ(one.sum, 3.0F);
}

// Rank 0 then writes several times to a closed connection; SIGPIPE must not end it.
TEST(ProcessGroup, WithoutItTheOtherRankGivesUpAndRank0ReportsIt) {
  const auto [zero, one] = PlayTwoRanks([&](ProcessGroup& group) {
    if (group.rank() == 0) std::this_thread::sleep_for(kSlow);
    group.Broadcast(std::string(10'000'000, 'x'));
  });
  const std::string lost = "ranks: rank 0 of 2 has ended or does not answer";
  EXPECT_EQ(one.lost.rfind(lost, 0), 0U) << one.lost;
  EXPECT_EQ(zero.lost.rfind(lost, 0), 0U) << zero.lost;  // the first report counts
}

TEST(ProcessGroup, AWorkThatFailsEndsTheWaitAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  const auto [zero, one] = PlayTwoRanks([&](ProcessGroup& group) {
    group.RunOnRank0([] { throw std::runtime_error("the disk is full"); });
  });
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(zero.lost, "work: the disk is full");
  EXPECT_EQ(one.lost.rfind("ranks: rank 0 of 2 has ended or does not answer", 0), 0U) << one.lost;
  EXPECT_NE(one.lost.find("it did not read or write the run folder within 60 s"), std::string::npos)
      << one.lost;
}

TEST(ProcessGroup, AWorkThatDoesNotEndIsGivenUpAfterItsLimit) {
  const auto [zero, one] = PlayTwoRanks(
      [&](ProcessGroup& group) { group.RunOnRank0([] { std::this_thread::sleep_for(kSlow); }); },
      1.0);
  EXPECT_EQ(one.lost.rfind("ranks: rank 0 of 2 has ended or does not answer", 0), 0U) << one.lost;
  EXPECT_NE(one.lost.find("it did not read or write the run folder within 1 s"), std::string::npos)
      << one.lost;
  EXPECT_NE(zero.lost, "");
}

}  // namespace
}  // namespace aquafarm::agents
