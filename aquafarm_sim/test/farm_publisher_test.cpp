// SPDX-License-Identifier: BSD-3-Clause
// The order of messages for a subscriber that connects while a farm is stepped. The roscpp thread
// that sends messages is stopped until several messages are published, as on a busy machine.
#include "aquafarm_sim/node/farm_publisher.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <ros/callback_queue.h>
#include <ros/connection_manager.h>
#include <ros/init.h>
#include <ros/poll_manager.h>
#include <ros/serialization.h>
#include <rosgraph_msgs/Clock.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <string>
#include <vector>

#include "farm_server_fixture.h"

namespace aquafarm_sim {
namespace {

constexpr std::int32_t kFarms = 3;
constexpr int kWait_s = 20;

std::string Frame(const std::string& content) {
  const auto size = static_cast<std::uint32_t>(content.size());
  return std::string(reinterpret_cast<const char*>(&size), sizeof size) + content;
}

/// A subscriber of a topic of this process. It has its own connection, because roscpp uses none
/// inside a process.
template <typename Message>
class Subscriber {
 public:
  explicit Subscriber(const std::string& topic) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval limit{kWait_s, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port =
        htons(static_cast<std::uint16_t>(ros::ConnectionManager::instance()->getTCPPort()));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(socket_, reinterpret_cast<sockaddr*>(&place), sizeof place) != 0) {
      throw std::runtime_error("no connection to the publisher");
    }
    const std::string header =
        Frame(Frame("callerid=/late") + Frame("topic=" + ros::names::resolve(topic)) +
              Frame(std::string("type=") + ros::message_traits::datatype<Message>()) +
              Frame(std::string("md5sum=") + ros::message_traits::md5sum<Message>()));
    if (write(socket_, header.data(), header.size()) != static_cast<ssize_t>(header.size())) {
      throw std::runtime_error("the publisher does not read");
    }
    Read();  // its header; the publisher knows the subscriber now
  }
  ~Subscriber() { close(socket_); }
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  Message Next() {
    std::string data = Read();
    Message message;
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(data.data()),
                                       static_cast<std::uint32_t>(data.size()));
    ros::serialization::deserialize(stream, message);
    return message;
  }

 private:
  std::string Read() {
    std::uint32_t size = 0;
    Fill(reinterpret_cast<char*>(&size), sizeof size);
    std::string data(size, '\0');
    Fill(data.data(), size);
    return data;
  }

  void Fill(char* to, std::size_t size) {
    while (size > 0) {
      const ssize_t got = recv(socket_, to, size, 0);
      if (got <= 0) throw std::runtime_error("no message within 20 s");
      to += got;
      size -= static_cast<std::size_t>(got);
    }
  }

  int socket_;
};

/// Stops the roscpp thread that sends messages, until this object is destroyed.
class HeldSender {
 public:
  HeldSender() {
    listener_ = ros::PollManager::instance()->addPollThreadListener([this] {
      if (holds_.exchange(true)) return;
      held_.set_value();
      released_.get_future().wait();
    });
    ros::PollManager::instance()->getPollSet().signal();
    held_.get_future().wait();
  }
  ~HeldSender() {
    released_.set_value();
    ros::PollManager::instance()->removePollThreadListener(listener_);
  }
  HeldSender(const HeldSender&) = delete;
  HeldSender& operator=(const HeldSender&) = delete;

 private:
  std::atomic<bool> holds_{};
  std::promise<void> held_;
  std::promise<void> released_;
  boost::signals2::connection listener_;
};

class FarmPublisherTest : public ::testing::Test {
 protected:
  FarmPublisherTest() {
    params_.record = true;
    ranch_ = test::MakeRanch(aquafarm::test::TinyScenario(), kFarms);
    publisher_ = std::make_unique<FarmPublisher>(ros::NodeHandle(), params_, *ranch_);
  }

  /// Starts two episodes and lets the publisher greet its new subscriber. No message is sent
  /// meanwhile.
  /// @returns the time of the last episode's start
  ros::Time PublishWhileHeld() {
    std::future<void> greeting;
    {
      const HeldSender held;
      test::ResetTo(*ranch_, 7);
      test::ResetTo(*ranch_, 8);
      greeting = std::async(std::launch::async, [] {
        ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
      });
      greeting.wait_for(std::chrono::milliseconds(300));
    }
    greeting.wait();
    return test::StateOf(*ranch_).header.stamp;
  }

  template <typename Message, typename TimeOf>
  void ExpectTimesInOrder(const std::string& topic, const TimeOf& time_of) {
    Subscriber<Message> late(topic);
    const ros::Time last = PublishWhileHeld();
    std::vector<ros::Time> times;
    for (int i = 0; i < 2; ++i) times.push_back(time_of(late.Next()));
    test::ResetTo(*ranch_, 9);  // follows what was sent to greet the subscriber
    const ros::Time end = test::StateOf(*ranch_).header.stamp;
    while (times.back() < end) times.push_back(time_of(late.Next()));
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LE(times[i - 1], times[i]) << topic;
    EXPECT_LT(last, end);
    EXPECT_GE(times.size(), 3U);
  }

  SimParams params_;
  std::unique_ptr<FarmServer> ranch_;
  std::unique_ptr<FarmPublisher> publisher_;
};

TEST_F(FarmPublisherTest, TheClockOfALateRecorderDoesNotGoBack) {
  ExpectTimesInOrder<rosgraph_msgs::Clock>(names::kClock,
                                           [](const auto& message) { return message.clock; });
}

TEST_F(FarmPublisherTest, TheStatesOfALateRecorderDoNotGoBack) {
  ExpectTimesInOrder<aquafarm_msgs::FarmState>(
      names::kState, [](const auto& message) { return message.header.stamp; });
}

TEST_F(FarmPublisherTest, TheObservationsOfALateDriverDoNotGoBack) {
  ExpectTimesInOrder<aquafarm_msgs::FarmState>(
      names::Observation(0), [](const auto& message) { return message.header.stamp; });
}

TEST_F(FarmPublisherTest, ALateSubscriberOfAFarmThatRestsGetsClockStateAndRisk) {
  Subscriber<rosgraph_msgs::Clock> clock(names::kClock);
  Subscriber<aquafarm_msgs::FarmState> state(names::kState);
  Subscriber<nav_msgs::OccupancyGrid> risk(names::kRisk);
  const ros::Time now = test::StateOf(*ranch_).header.stamp;
  const auto end = ros::WallTime::now() + ros::WallDuration(1.0);
  while (ros::WallTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
  }
  EXPECT_EQ(now, clock.Next().clock);
  EXPECT_EQ(now, state.Next().header.stamp);
  EXPECT_EQ(now, risk.Next().header.stamp);
}

}  // namespace
}  // namespace aquafarm_sim

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "farm_publisher_test");
  const ros::NodeHandle node;  // starts roscpp
  return RUN_ALL_TESTS();
}
