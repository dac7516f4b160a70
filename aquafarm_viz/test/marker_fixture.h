// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace aquafarm_viz::test {

using Key = std::pair<std::string, int>;  // namespace and id of a marker

inline std::map<Key, visualization_msgs::Marker> ByKey(
    const visualization_msgs::MarkerArray& array) {
  std::map<Key, visualization_msgs::Marker> result;
  for (const auto& marker : array.markers) {
    EXPECT_TRUE(result.emplace(Key(marker.ns, marker.id), marker).second)
        << marker.ns << " " << marker.id << " twice";
  }
  return result;
}

// Returns the bearing along which a marker points. @param rest_deg  as in Turned (markers/maker.h)
inline double BearingDeg(const visualization_msgs::Marker& marker, double rest_deg) {
  const auto& q = marker.pose.orientation;
  const double yaw_deg = 2.0 * std::atan2(q.z, q.w) * 180.0 / M_PI;
  return std::fmod(rest_deg - yaw_deg + 720.0, 360.0);
}

}  // namespace aquafarm_viz::test
