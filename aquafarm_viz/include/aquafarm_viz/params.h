// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <sstream>
#include <stdexcept>

namespace aquafarm_viz {

/// Reads a number. Leaves `value` unchanged if the parameter is not set.
/// @throws std::invalid_argument "/viz/rate_hz: got x, expected a number in [low, high]"
template <typename Value>
void ReadParam(const ros::NodeHandle& node, const char* name, Value& value, Value low, Value high) {
  XmlRpc::XmlRpcValue raw;
  if (!node.getParam(name, raw)) return;
  if (node.getParam(name, value) && value >= low && value <= high) return;
  std::ostringstream line;
  line << node.resolveName(name) << ": got " << raw << ", expected a number in [" << low << ", "
       << high << "]";
  throw std::invalid_argument(line.str());
}

/// Reads a boolean. Leaves `value` unchanged if the parameter is not set.
/// @throws std::invalid_argument "/replay/loop: got x, expected true or false"
inline void ReadParam(const ros::NodeHandle& node, const char* name, bool& value) {
  XmlRpc::XmlRpcValue raw;
  if (!node.getParam(name, raw) || node.getParam(name, value)) return;
  std::ostringstream line;
  line << node.resolveName(name) << ": got " << raw << ", expected true or false";
  throw std::invalid_argument(line.str());
}

}  // namespace aquafarm_viz
