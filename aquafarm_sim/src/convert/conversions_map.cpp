// SPDX-License-Identifier: BSD-3-Clause
// Conversions to grids and frames: cells and compass bearings to metres and ROS axes.
#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "aquafarm/base/angle.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm_sim/convert/conversions.h"

namespace aquafarm_sim {
namespace {

using aquafarm::kRadiansPerDegree;
using aquafarm::kWorstRisk;

void FillGridInfo(const aquafarm::Scenario& scenario, const MessageContext& context,
                  nav_msgs::OccupancyGrid& message) {
  message.header.stamp = context.stamp;
  message.header.frame_id = context.map_frame;
  message.info.map_load_time = context.stamp;
  message.info.resolution = static_cast<float>(scenario.cell_size_m);
  message.info.width = static_cast<std::uint32_t>(scenario.width);
  message.info.height = static_cast<std::uint32_t>(scenario.height);
  message.info.origin.position.x = -0.5 * scenario.cell_size_m;
  message.info.origin.position.y = -0.5 * scenario.cell_size_m;
  message.info.origin.orientation.w = 1.0;
  message.data.resize(static_cast<std::size_t>(scenario.CellCount()));
}

}  // namespace

nav_msgs::OccupancyGrid ChartToMsg(const aquafarm::Farm& farm, const MessageContext& context) {
  nav_msgs::OccupancyGrid message;
  FillGridInfo(farm.scenario(), context, message);
  const std::uint8_t* cells = farm.layout().cells.data();
  for (std::size_t i = 0; i < message.data.size(); ++i) {
    message.data[i] = (cells[i] & aquafarm::kBlockedBits) != 0 ? 100 : 0;
  }
  return message;
}

void RiskToMsg(const std::vector<aquafarm::Disaster>& disasters, const aquafarm::Scenario& scenario,
               const MessageContext& context, nav_msgs::OccupancyGrid& message) {
  FillGridInfo(scenario, context, message);
  aquafarm::Grid<float> risk(scenario.height, scenario.width);
  aquafarm::FillRisk(scenario, disasters, risk);
  for (std::size_t i = 0; i < message.data.size(); ++i) {
    const float share = risk.data()[i] / kWorstRisk;
    message.data[i] = static_cast<std::int8_t>(std::lround(100.0F * std::fmin(share, 1.0F)));
  }
}

void SeaToMsg(const aquafarm::SeaLayer& layer, const aquafarm::Scenario& scenario,
              const MessageContext& context, nav_msgs::OccupancyGrid& message) {
  FillGridInfo(scenario, context, message);
  float min = std::numeric_limits<float>::infinity();
  float max = -min;
  for (const float value : layer.values) {  // fmin and fmax ignore NaN
    min = std::fmin(min, value);
    max = std::fmax(max, value);
  }
  const float scale = max > min ? 100.0F / (max - min) : 0.0F;
  for (std::size_t i = 0; i < message.data.size(); ++i) {
    const float value = layer.values[i];
    message.data[i] =
        static_cast<std::int8_t>(std::isnan(value) ? -1L : std::lround((value - min) * scale));
  }
}

std_msgs::Float32MultiArray SeaToMsg(const aquafarm::SeaLayer& layer,
                                     const aquafarm::Scenario& scenario) {
  std_msgs::Float32MultiArray message;
  const auto width = static_cast<std::uint32_t>(scenario.width);
  const auto height = static_cast<std::uint32_t>(scenario.height);
  const auto add = [&message](const std::string& label, std::uint32_t size, std::uint32_t stride) {
    message.layout.dim.emplace_back();
    message.layout.dim.back().label = label;
    message.layout.dim.back().size = size;
    message.layout.dim.back().stride = stride;
  };
  add(layer.name + " [" + layer.units + "]", 1, height * width);
  add("y", height, height * width);
  add("x", width, width);
  message.data = layer.values;
  return message;
}

geometry_msgs::TransformStamped PoseToMsg(const std::string& frame, double x, double y,
                                          std::int32_t bearing_deg,
                                          const aquafarm::Scenario& scenario,
                                          const MessageContext& context) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = context.stamp;
  message.header.frame_id = context.map_frame;
  message.child_frame_id = frame;
  message.transform.translation.x = x * scenario.cell_size_m;
  message.transform.translation.y = y * scenario.cell_size_m;
  // A bearing is clockwise from north; yaw is counter-clockwise from east.
  const double yaw = (90.0 - bearing_deg) * kRadiansPerDegree;
  message.transform.rotation.z = std::sin(yaw / 2.0);
  message.transform.rotation.w = std::cos(yaw / 2.0);
  return message;
}

geometry_msgs::TransformStamped EarthToMsg(const aquafarm::GeoPoint& origin,
                                           const std::string& earth_frame,
                                           const MessageContext& context) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = context.stamp;
  message.header.frame_id = earth_frame;
  message.child_frame_id = context.map_frame;
  std::vector<double> rotation(9);  // [3, 3] row-major, from (east, north, up) to ECEF
  auto& translation = message.transform.translation;
  GeographicLib::Geocentric::WGS84().Forward(origin.latitude, origin.longitude, 0.0, translation.x,
                                             translation.y, translation.z, rotation);
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d matrix = Eigen::Map<const RowMajor>(rotation.data());
  const Eigen::Quaterniond q(matrix);
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  message.transform.rotation.w = q.w();
  return message;
}

std::int32_t BearingOf(aquafarm::Action action, std::int32_t fallback) {
  switch (action) {
    case aquafarm::Action::kNorth:
      return 0;
    case aquafarm::Action::kNorthEast:
      return 45;
    case aquafarm::Action::kEast:
      return 90;
    case aquafarm::Action::kSouthEast:
      return 135;
    case aquafarm::Action::kSouth:
      return 180;
    case aquafarm::Action::kSouthWest:
      return 225;
    case aquafarm::Action::kWest:
      return 270;
    case aquafarm::Action::kNorthWest:
      return 315;
    default:
      return fallback;
  }
}

}  // namespace aquafarm_sim
