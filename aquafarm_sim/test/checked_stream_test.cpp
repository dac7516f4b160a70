// SPDX-License-Identifier: BSD-3-Clause
// Requests whose arrays state more entries than follow are refused before memory is allocated.
#include "aquafarm_sim/checked_stream.h"

#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/LoadState.h>
#include <aquafarm_msgs/SetDisaster.h>
#include <aquafarm_msgs/Step.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>

#include "aquafarm_sim/checked_topics.h"

namespace aquafarm_sim {
namespace {

namespace ser = ros::serialization;

aquafarm_msgs::SetDisaster::Request Sample() {
  aquafarm_msgs::SetDisaster::Request request;
  request.info.radii = {2.0F, 4.0F};
  request.info.risks = {-20.0F, -10.0F};
  request.info.track.resize(3);
  request.info.track[1].radii = {1.0F, 2.0F};
  request.info.track[2].step = 7;
  return request;
}

TEST(CheckedStream, ReadsWhatWasWritten) {
  const auto message = ser::serializeMessage(Sample());
  aquafarm_msgs::SetDisaster::Request request;
  ReadMessage(message, request);
  EXPECT_EQ(request, Sample());
}

TEST(CheckedStream, RefusesEveryRequestThatIsCutOff) {
  auto message = ser::serializeMessage(Sample());
  while (--message.num_bytes >= 4) {
    aquafarm_msgs::SetDisaster::Request request;
    EXPECT_THROW(ReadMessage(message, request), ser::StreamOverrunException);
  }
}

/// Serialises a request and makes each of its four-byte words a length of four billion in turn.
template <typename Request>
int RefusedLengths(const Request& sample) {
  const auto message = ser::serializeMessage(sample);
  int refused = 0;
  for (std::size_t at = 4; at + 4 <= message.num_bytes; ++at) {
    auto changed = ser::serializeMessage(sample);
    std::memset(changed.buf.get() + at, 0xf0, 4);
    Request request;
    try {
      ReadMessage(changed, request);
    } catch (const ser::StreamOverrunException&) {
      ++refused;
    }
  }
  return refused;
}

TEST(CheckedStream, RefusesLengthsBeforeItAllocates) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit small{rlim_t{1} << 30U, before.rlim_max};  // more throws std::bad_alloc
  ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
  const int of_disaster = RefusedLengths(Sample());
  aquafarm_msgs::LoadState::Request load;
  load.data.resize(9);
  const int of_load = RefusedLengths(load);
  aquafarm_msgs::Step::Request step;
  step.actions.resize(5);
  const int of_step = RefusedLengths(step);
  setrlimit(RLIMIT_AS, &before);
  EXPECT_GT(of_disaster, 20);
  EXPECT_GT(of_load, 0);
  EXPECT_GT(of_step, 0);
}

aquafarm_msgs::FarmState SampleOfTopic() {
  aquafarm_msgs::FarmState state;
  state.step = 7;
  state.ships.resize(2);
  state.devices.resize(3);
  return state;
}

ros::VoidConstPtr Receive(ros::SerializedMessage message) {
  const auto subscription = boost::make_shared<CheckedSubscription<aquafarm_msgs::FarmState>>(
      [](const aquafarm_msgs::FarmStateConstPtr&) {});
  ros::SubscriptionCallbackHelperDeserializeParams params;
  params.buffer = message.message_start;
  params.length = static_cast<std::uint32_t>(message.num_bytes - 4);
  return subscription->deserialize(params);
}

TEST(CheckedSubscription, ReadsWhatWasWritten) {
  const auto state = Receive(ser::serializeMessage(SampleOfTopic()));
  EXPECT_EQ(*boost::static_pointer_cast<const aquafarm_msgs::FarmState>(state), SampleOfTopic());
}

TEST(CheckedSubscription, RefusesLengthsBeforeItAllocates) {
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit small{rlim_t{1} << 30U, before.rlim_max};  // more throws std::bad_alloc
  ASSERT_EQ(setrlimit(RLIMIT_AS, &small), 0);
  const auto message = ser::serializeMessage(SampleOfTopic());
  int refused = 0;
  for (std::size_t at = 4; at + 4 <= message.num_bytes; ++at) {
    auto changed = ser::serializeMessage(SampleOfTopic());
    std::memset(changed.buf.get() + at, 0xf0, 4);
    try {
      Receive(changed);
    } catch (const ser::StreamOverrunException&) {
      ++refused;
    }
  }
  setrlimit(RLIMIT_AS, &before);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace aquafarm_sim
