// SPDX-License-Identifier: BSD-3-Clause
#include "service_caller.h"

#include <aquafarm_msgs/Pause.h>
#include <aquafarm_msgs/SaveState.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "aquafarm_sim/node/checked_service.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::Pause;
using Clock = std::chrono::steady_clock;

constexpr double kLimit_s = 0.5;

bool AnswerLate(Pause::Request&, Pause::Response&) {
  ros::WallDuration(5.0).sleep();
  return true;
}

bool AnswerQuickly(Pause::Request&, Pause::Response& response) {
  ros::WallDuration(0.1).sleep();
  return response.ok = true;
}

bool AnswerSoon(Pause::Request&, Pause::Response& response) {
  ros::WallDuration(2.0).sleep();
  return response.ok = true;
}

// Answers with an array whose stated length is a gibibyte, and which contains nothing.
class Overstater : public ros::ServiceCallbackHelper {
 public:
  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    aquafarm_msgs::SaveState::Response response;
    response.ok = true;
    params.response = ros::serialization::serializeServiceResponse(true, response);
    const std::uint32_t stated = 1U << 30U;  // the length of the array precedes the hash
    std::memcpy(params.response.buf.get() + params.response.num_bytes - sizeof(response.hash) -
                    sizeof(stated),
                &stated, sizeof(stated));
    return true;
  }
};

std::int64_t PeakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class ServiceCallerTest : public testing::Test {
 protected:
  ServiceCallerTest() : spinner_(1) { spinner_.start(); }

  // Calls a service and waits for its line. The call itself must return immediately.
  template <typename Service = Pause>
  std::string LineOf(const std::string& name) {
    std::mutex mutex;
    std::condition_variable came;
    std::string line;
    ServiceCaller caller(node_, kLimit_s, [&](const std::string& text) {
      const std::lock_guard<std::mutex> lock(mutex);
      line = text;
      came.notify_all();
    });
    const auto start = Clock::now();
    caller.Call<Service>(name, Service(), [](const Service&) { return std::string("done"); });
    EXPECT_LT(SecondsSince(start), 0.4);
    std::unique_lock<std::mutex> lock(mutex);
    came.wait_for(lock, std::chrono::seconds(60), [&] { return !line.empty(); });
    return line;
  }

  // Calls a service `clicks` times and waits for as many lines.
  std::vector<std::string> LinesOf(const std::string& name, std::size_t clicks) {
    std::mutex mutex;
    std::condition_variable came;
    std::vector<std::string> lines;
    ServiceCaller caller(node_, 3.0, [&](const std::string& text) {
      const std::lock_guard<std::mutex> lock(mutex);
      lines.push_back(text);
      came.notify_all();
    });
    for (std::size_t i = 0; i < clicks; ++i) {
      caller.Call<Pause>(name, Pause(), [](const Pause&) { return std::string("done"); });
    }
    std::unique_lock<std::mutex> lock(mutex);
    came.wait_for(lock, std::chrono::seconds(60), [&] { return lines.size() >= clicks; });
    return lines;
  }

  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
};

TEST_F(ServiceCallerTest, ReportsTheAnswerOrTheError) {
  bool ok = true;
  const auto server = node_.advertiseService<Pause::Request, Pause::Response>(
      "pause", [&ok](Pause::Request&, Pause::Response& response) {
        response.ok = ok;
        response.message = "not now";
        return true;
      });
  EXPECT_EQ(LineOf("pause"), "done");
  ok = false;
  EXPECT_EQ(LineOf("pause"), "pause: not now");
}

TEST_F(ServiceCallerTest, SaysThatThereIsNoSuchService) {
  EXPECT_EQ(LineOf("nothing"), "/nothing: service not available; is a ranch running?");
}

TEST_F(ServiceCallerTest, AllocatesNoEntriesThatAResponseStatesAndDoesNotContain) {
  const auto server = aquafarm_sim::AdvertiseHelper<aquafarm_msgs::SaveState>(
      node_, "overstated", boost::make_shared<Overstater>());
  const std::int64_t before = PeakKilobytes();
  EXPECT_EQ(LineOf<aquafarm_msgs::SaveState>("overstated"), "/overstated: the call failed");
  EXPECT_LT(PeakKilobytes() - before, 100 << 10);
}

TEST_F(ServiceCallerTest, CutsOffACallWithoutAnAnswer) {
  const auto server = node_.advertiseService("slow", AnswerLate);
  const auto start = Clock::now();
  EXPECT_EQ(LineOf("slow"), "/slow: no answer within 0.5 s");
  EXPECT_LT(SecondsSince(start), 4.0);
}

TEST_F(ServiceCallerTest, EachCallOfOneCallerHasTheWholeLimit) {
  const auto server = node_.advertiseService("soon", AnswerSoon);
  EXPECT_EQ(LinesOf("soon", 2), std::vector<std::string>(2, "done"));
}

TEST_F(ServiceCallerTest, ACallTooManyIsRefusedWithALine) {
  const auto server = node_.advertiseService("quick", AnswerQuickly);
  const auto lines = LinesOf("quick", 11);  // at most one is running and eight wait
  EXPECT_EQ(lines.size(), 11U);
  const std::string refused = "/quick: not called: 8 calls are already waiting";
  const auto refusals = std::count(lines.begin(), lines.end(), refused);
  EXPECT_GE(refusals, 2);
  EXPECT_EQ(refusals + std::count(lines.begin(), lines.end(), "done"), 11);
}

TEST_F(ServiceCallerTest, AWindowThatIsClosedDoesNotWaitForAnAnswer) {
  const auto server = node_.advertiseService("slow", AnswerLate);
  const auto start = Clock::now();
  {
    ServiceCaller caller(node_, 60.0, [](const std::string&) {});
    caller.Call<Pause>("slow", Pause(), [](const Pause&) { return std::string("done"); });
    ros::WallDuration(0.2).sleep();
  }
  EXPECT_LT(SecondsSince(start), 4.0);
}

}  // namespace
}  // namespace aquafarm_viz

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "service_caller_test");
  return RUN_ALL_TESTS();
}
