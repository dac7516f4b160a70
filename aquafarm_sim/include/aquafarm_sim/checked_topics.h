// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Subscribes to topics and calls services of other nodes, and reads their messages with
/// CheckedStream. Our C++ nodes use these functions instead of ros::NodeHandle::subscribe and
/// ros::ServiceClient::call.

#include <ros/node_handle.h>
#include <ros/service_client.h>
#include <ros/subscription_callback_helper.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "aquafarm_sim/checked_stream.h"

namespace aquafarm_sim {

/// Reads the messages of a topic with CheckedStream and passes them to a function.
template <typename Message>
class CheckedSubscription
    : public ros::SubscriptionCallbackHelperT<const boost::shared_ptr<const Message>&> {
 public:
  using ros::SubscriptionCallbackHelperT<
      const boost::shared_ptr<const Message>&>::SubscriptionCallbackHelperT;

  /// @throws ros::serialization::StreamOverrunException if the message is too short; roscpp then
  ///         logs an error and drops the message
  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    auto message = boost::make_shared<Message>();
    CheckedStream stream(params.buffer, params.length);
    ros::serialization::deserialize(stream, *message);
    return message;
  }
};

/// Subscribes to a topic. The subscription ends when the last copy of the result is destroyed.
/// @param queue max number of queued messages
template <typename Message>
ros::Subscriber Subscribe(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue,
                          std::function<void(const boost::shared_ptr<const Message>&)> callback,
                          const ros::TransportHints& hints = {}) {
  ros::SubscribeOptions options(topic, queue, ros::message_traits::md5sum<Message>(),
                                ros::message_traits::datatype<Message>());
  options.helper = boost::make_shared<CheckedSubscription<Message>>(std::move(callback));
  options.transport_hints = hints;
  return node.subscribe(options);
}

/// Calls a service. @returns false if the call failed, or its response cannot be read
template <typename Service>
bool Call(ros::ServiceClient& client, Service& service) {
  ros::SerializedMessage response;
  const bool is_done = client.call(ros::serialization::serializeMessage(service.request), response,
                                   ros::service_traits::md5sum(service));
  if (!is_done) return false;
  try {
    ReadMessage(response, service.response);
  } catch (const ros::serialization::StreamOverrunException& error) {
    ROS_ERROR_STREAM("the response of " << client.getService()
                                        << " cannot be read: " << error.what());
    return false;
  }
  return true;
}

}  // namespace aquafarm_sim
