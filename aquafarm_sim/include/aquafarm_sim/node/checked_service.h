// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_callback_helper.h>

#include <functional>
#include <string>
#include <utility>

#include "aquafarm_sim/checked_stream.h"

namespace aquafarm_sim {

/// Serves the calls of a service with a function (Handler).
template <typename Service>
class CheckedService : public ros::ServiceCallbackHelper {
 public:
  /// Receives the request and the name of the calling node, and fills the response. Returns whether
  /// the call succeeded.
  using Handler = std::function<bool(typename Service::Request&, typename Service::Response&,
                                     const std::string&)>;

  explicit CheckedService(Handler handler) : handler_(std::move(handler)) {}

  /// @throws ros::serialization::StreamOverrunException if the request is too short; roscpp then
  ///         logs an error, and the call fails
  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    typename Service::Request request;
    typename Service::Response response;
    ReadMessage(params.request, request);
    const bool is_done = handler_(request, response, (*params.connection_header)["callerid"]);
    params.response = ros::serialization::serializeServiceResponse(is_done, response);
    return is_done;
  }

 private:
  const Handler handler_;
};

/// Advertises a service. `helper` serves its calls.
template <typename Service>
ros::ServiceServer AdvertiseHelper(ros::NodeHandle& node, const std::string& name,
                                   const ros::ServiceCallbackHelperPtr& helper) {
  ros::AdvertiseServiceOptions options;
  options.service = name;
  options.md5sum = ros::service_traits::md5sum<Service>();
  options.datatype = ros::service_traits::datatype<Service>();
  options.req_datatype = ros::message_traits::datatype<typename Service::Request>();
  options.res_datatype = ros::message_traits::datatype<typename Service::Response>();
  options.helper = helper;
  return node.advertiseService(options);
}

}  // namespace aquafarm_sim
