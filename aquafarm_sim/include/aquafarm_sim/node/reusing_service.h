// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_callback_helper.h>

#include <functional>
#include <string>
#include <utility>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/node/checked_service.h"

namespace aquafarm_sim {

/// Serves calls one at a time. Every request is deserialized into the same object, and the response
/// is serialized without a copy. If all requests have the same size of at most 64 KiB, each call
/// allocates only the buffer of the serialized response.
template <typename Service>
class ReusingService : public ros::ServiceCallbackHelper {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  /// Receives the request and the name of the calling node. The returned response must stay valid
  /// and unchanged until the next call.
  using Handler = std::function<const Response&(const Request&, const std::string&)>;

  explicit ReusingService(Handler handler) : handler_(std::move(handler)) {}

  bool call(ros::ServiceCallbackHelperCallParams& params) override {
    const aquafarm::MutexLock lock(mutex_);
    if (params.request.num_bytes > kMaxKeptBytes) request_ = Request();
    ReadMessage(params.request, request_);
    params.response = ros::serialization::serializeServiceResponse(
        true, handler_(request_, (*params.connection_header)["callerid"]));
    if (params.request.num_bytes > kMaxKeptBytes) request_ = Request();
    return true;
  }

  static ros::ServiceServer Advertise(ros::NodeHandle& node, const std::string& name,
                                      Handler handler) {
    return AdvertiseHelper<Service>(node, name,
                                    boost::make_shared<ReusingService>(std::move(handler)));
  }

 private:
  // The memory of larger requests is freed after the call.
  static constexpr std::size_t kMaxKeptBytes = std::size_t{1} << 16U;

  aquafarm::Mutex mutex_;
  const Handler handler_;
  Request request_ AQUAFARM_GUARDED_BY(mutex_);
};

}  // namespace aquafarm_sim
