// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/RescuePlan.h>

#include <boost/make_shared.hpp>
#include <string>

namespace aquafarm_viz::test {

/// Returns a plan of two ships and three devices. It starts on 2021-07-24 at 08:00 local time.
inline aquafarm_msgs::RescuePlanPtr MakePlan() {
  using aquafarm_msgs::RescueOrder;
  auto plan = boost::make_shared<aquafarm_msgs::RescuePlan>();
  plan->text = "1 of 2 ships leave.";
  plan->utc_offset_min = 480;
  plan->start = ros::Time(1627084800, 0);
  plan->no_departure_after = plan->start + ros::Duration(5.5 * 3600.0);
  plan->ports.resize(1);
  plan->ports[0].name = "port A";
  plan->ships.resize(2);
  plan->devices.resize(3);
  for (int i = 0; i < 3; ++i) {
    auto& device = plan->devices[static_cast<std::size_t>(i)];
    device.name = "D" + std::to_string(i + 1);
    device.ship = i == 1 ? 0 : -1;
    device.home = 0.874F;
    device.left_reason = i == 0 ? "too_late" : i == 2 ? "safe_in_place" : "";
    device.deadlines.resize(3);
    for (std::size_t k = 0; k < 3; ++k) {
      device.deadlines[k].probability = k == 0 ? 0.95F : k == 1 ? 0.8F : 0.5F;
      device.deadlines[k].possible = k > 0;
      device.deadlines[k].open = k == 2;
      device.deadlines[k].leave = plan->start + ros::Duration(3600.0);
    }
  }
  aquafarm_msgs::RescueRoute route;
  for (const std::uint8_t action : {RescueOrder::LEAVE, RescueOrder::FETCH, RescueOrder::DELIVER}) {
    RescueOrder order;
    order.action = action;
    order.stamp = plan->start + ros::Duration(8.0 * 3600.0 * action);
    order.port = action == RescueOrder::FETCH ? -1 : 0;
    order.device = action == RescueOrder::FETCH ? 1 : -1;
    if (action == RescueOrder::DELIVER) order.devices = {1};
    order.probability = 1.0F - 0.1F * static_cast<float>(action);
    route.orders.push_back(order);
  }
  plan->routes = {route};
  plan->ships[0].name = "ship 1";
  plan->ships[1].id = 1;
  plan->ships[1].name = "ship 2";
  return plan;
}

}  // namespace aquafarm_viz::test
