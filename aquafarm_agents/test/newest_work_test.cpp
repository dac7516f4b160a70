// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/newest_work.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

namespace aquafarm_agents {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// Records the requests that were worked on; the first one takes until `go`.
struct Record {
  std::vector<int> requests;
  std::vector<Clock::time_point> starts;
  std::atomic<bool> go{false};
  std::atomic<int> begun{0};

  std::function<void(const int&)> Work() {
    return [this](const int& request) {
      requests.push_back(request);
      starts.push_back(Clock::now());
      ++begun;
      while (!go) std::this_thread::sleep_for(milliseconds(1));
    };
  }
};

void WaitFor(const std::function<bool()>& condition) {
  const Clock::time_point end = Clock::now() + std::chrono::seconds(20);
  while (!condition() && Clock::now() < end) std::this_thread::sleep_for(milliseconds(1));
  ASSERT_TRUE(condition());
}

TEST(NewestWork, TheNewestRequestReplacesThoseThatWait) {
  Record record;
  NewestWork<int> work(record.Work(), milliseconds(0));
  work.Ask(1);
  WaitFor([&] { return record.begun == 1; });
  const Clock::time_point before = Clock::now();
  for (int request = 2; request <= 1000; ++request) work.Ask(request);
  EXPECT_LT(Clock::now() - before, std::chrono::seconds(5)) << "Ask waits for work";
  EXPECT_TRUE(work.busy());
  record.go = true;
  WaitFor([&] { return !work.busy(); });
  EXPECT_EQ(record.requests, (std::vector<int>{1, 1000}));
}

TEST(NewestWork, StartsAreAtLeastThePeriodApart) {
  Record record;
  record.go = true;
  NewestWork<int> work(record.Work(), milliseconds(80));
  const Clock::time_point first = Clock::now();
  for (int request = 0; request < 3; ++request) {
    work.Ask(request);
    WaitFor([&] { return record.begun == request + 1; });
  }
  WaitFor([&] { return !work.busy(); });
  // A start is recorded late on a busy machine, and never early.
  for (std::size_t i = 0; i < record.starts.size(); ++i) {
    EXPECT_GE(record.starts[i] - first, milliseconds(80) * static_cast<int>(i));
  }
}

TEST(NewestWork, TheEndDropsWhatWaits) {
  Record record;
  {
    NewestWork<int> work(record.Work(), std::chrono::hours(1));
    work.Ask(1);
    WaitFor([&] { return record.begun == 1; });
    work.Ask(2);
    record.go = true;
  }
  EXPECT_EQ(record.requests, std::vector<int>{1});
}

}  // namespace
}  // namespace aquafarm_agents
