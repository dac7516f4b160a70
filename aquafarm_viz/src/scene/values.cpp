// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/values.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/names.h"
#include "base/marker_color.h"
#include "scene/arrow.h"

namespace aquafarm_viz {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;
using visualization_msgs::Marker;

// Above the sea and rviz's grids. Below ships if the side of a cell is more than 22 m.
constexpr double kHeight_m = 4.0;

void CheckField(const PointCloud2& cloud, const std::string& name, std::uint8_t type,
                std::uint32_t bytes) {
  for (const PointField& field : cloud.fields) {
    if (field.name != name) continue;
    if (field.datatype == type && bytes <= cloud.point_step &&
        field.offset <= cloud.point_step - bytes) {
      return;
    }
    throw std::invalid_argument("values/points: field " + name + ": got type " +
                                std::to_string(field.datatype) + " at byte " +
                                std::to_string(field.offset) + ", expected type " +
                                std::to_string(type) + " within point_step");
  }
  throw std::invalid_argument("values/points: got no field " + name +
                              ", expected x, y, value and action");
}

void Check(const PointCloud2& cloud) {
  for (const char* name : {"x", "y", "value"}) CheckField(cloud, name, PointField::FLOAT32, 4);
  CheckField(cloud, "action", PointField::UINT8, 1);
  const auto points = static_cast<std::uint64_t>(cloud.width) * cloud.height;
  const std::uint64_t size = cloud.data.size();
  // The division comes first, because the product of two input numbers may overflow.
  if (points <= size / cloud.point_step && points * cloud.point_step == size) return;
  throw std::invalid_argument("values/points: got " + std::to_string(size) + " bytes, expected " +
                              std::to_string(cloud.width) + " x " + std::to_string(cloud.height) +
                              " points of " + std::to_string(cloud.point_step));
}

Marker MakeMarker(const char* space, int id, int type, Rgb color) {
  Marker marker;
  marker.header.frame_id = names::kMapFrame;
  marker.ns = space;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.pose.position.z = kHeight_m;
  marker.color = Color(color, 0.9);
  return marker;
}

geometry_msgs::Point At(double x, double y) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  return point;
}

// Returns a marker of the cells that have a value, in the same colours as in pictures.
Marker ValueCells(const Values& values, double cell_m) {
  Marker cells = MakeMarker("values", 0, Marker::TRIANGLE_LIST, kPaper);
  cells.scale.x = cells.scale.y = cells.scale.z = 1.0;
  cells.pose.position.z = 0.0;  // between the sea and the land
  const double span = double(values.highest) - double(values.lowest);
  for (int y = 0; y < values.height; ++y) {
    for (int x = 0; x < values.width; ++x) {
      const auto value = double(values.values[values.Index(x, y)]);
      if (!std::isfinite(value)) continue;
      const double share = span > 0.0 ? (value - double(values.lowest)) / span : 0.5;
      const std_msgs::ColorRGBA color = Color(ValueColor(share), 0.62);
      for (const auto& [dx, dy] : {std::pair(-0.5, -0.5),
                                   {0.5, -0.5},
                                   {0.5, 0.5},
                                   {-0.5, -0.5},
                                   {0.5, 0.5},
                                   {-0.5, 0.5}}) {
        cells.points.push_back(At((x + dx) * cell_m, (y + dy) * cell_m));
        cells.colors.push_back(color);
      }
    }
  }
  return cells;
}

}  // namespace

void AddArrow(Marker& marker, double x, double y, int bearing_deg, double cell_m, double size) {
  static constexpr double kOutline[9][2]{{-0.05, -0.34}, {0.05, -0.34}, {0.05, 0.02},
                                         {-0.05, -0.34}, {0.05, 0.02},  {-0.05, 0.02},
                                         {-0.2, 0.02},   {0.2, 0.02},   {0.0, 0.36}};
  const double turn = bearing_deg * CV_PI / 180.0;
  for (const auto& [right, ahead] : kOutline) {
    const double east = right * std::cos(turn) + ahead * std::sin(turn);
    const double north = ahead * std::cos(turn) - right * std::sin(turn);
    marker.points.push_back(At((x + size * east) * cell_m, (y + size * north) * cell_m));
  }
}

void AddFrame(Marker& marker, double x, double y, double cell_m) {
  constexpr double kOuter = 0.5;
  constexpr double kInner = 0.4;
  for (const auto& [east, north] : {std::pair(1.0, 0.0), {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}) {
    const auto corner = [&, east = east, north = north](double out, double along) {
      return At((x + out * east - along * north) * cell_m,
                (y + out * north + along * east) * cell_m);
    };
    for (const auto& point :
         {corner(kInner, -kInner), corner(kOuter, -kOuter), corner(kOuter, kOuter),
          corner(kInner, -kInner), corner(kOuter, kOuter), corner(kInner, kInner)}) {
      marker.points.push_back(point);
    }
  }
}

Values ReadValues(const PointCloud2& cloud, const aquafarm_msgs::FarmSpec& spec) {
  Check(cloud);
  Values read;
  read.stamp = cloud.header.stamp;
  read.width = spec.width;
  read.height = spec.height;
  const std::size_t cells = read.Index(0, spec.height);
  read.values.assign(cells, std::numeric_limits<float>::quiet_NaN());
  read.actions.assign(cells, Values::kNoAction);
  sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x");
  sensor_msgs::PointCloud2ConstIterator<float> y(cloud, "y");
  sensor_msgs::PointCloud2ConstIterator<float> value(cloud, "value");
  sensor_msgs::PointCloud2ConstIterator<std::uint8_t> action(cloud, "action");
  const std::size_t points = std::size_t(cloud.width) * cloud.height;
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (std::size_t i = 0; i < points; ++i, ++x, ++y, ++value, ++action) {
    const double column = std::round(double(*x) / spec.cell_size_m);
    const double row = std::round(double(*y) / spec.cell_size_m);
    // The condition in brackets is false for NaN.
    if (!(column >= 0 && row >= 0 && column < spec.width && row < spec.height)) continue;
    const std::size_t cell = read.Index(int(column), int(row));
    read.actions[cell] = *action <= 9 ? *action : Values::kNoAction;
    if (!std::isfinite(*value)) continue;
    read.values[cell] = *value;
    lowest = std::min(lowest, *value);
    highest = std::max(highest, *value);
  }
  if (lowest <= highest) {
    read.lowest = lowest;
    read.highest = highest;
  }
  return read;
}

visualization_msgs::MarkerArray MoveMarkers(const Values& values,
                                            const aquafarm_msgs::FarmSpec& spec) {
  constexpr double kMaxAcross = 13.0;
  const int every = std::max(1, int(std::ceil(std::max(spec.width, spec.height) / kMaxAcross)));
  const double size = every == 1 ? 1.0 : 0.65 * every;
  Marker arrows = MakeMarker("moves", 0, Marker::TRIANGLE_LIST, kPaper);
  arrows.scale.x = arrows.scale.y = arrows.scale.z = 1.0;
  Marker pickups = MakeMarker("moves", 1, Marker::TRIANGLE_LIST, kPickupColor);
  Marker drop_offs = MakeMarker("moves", 2, Marker::TRIANGLE_LIST, kDropOffColor);
  for (Marker* frames : {&pickups, &drop_offs}) {
    frames->scale.x = frames->scale.y = frames->scale.z = 1.0;
  }
  for (const cv::Point cell : ShownActions(values, every)) {
    const std::uint8_t action = values.actions[values.Index(cell.x, cell.y)];
    if (const int bearing = MoveBearingDeg(action); bearing >= 0) {
      AddArrow(arrows, cell.x, cell.y, bearing, spec.cell_size_m, size);
    } else {
      AddFrame(action == 8 ? pickups : drop_offs, cell.x, cell.y, spec.cell_size_m);
    }
  }
  visualization_msgs::MarkerArray array;
  for (Marker& marker :
       std::vector<Marker>{arrows, pickups, drop_offs, ValueCells(values, spec.cell_size_m)}) {
    if (marker.points.empty()) marker.action = Marker::DELETE;  // rviz warns about empty lists
    array.markers.push_back(marker);
  }
  return array;
}

visualization_msgs::MarkerArray ChoiceMarkers(const aquafarm_msgs::PolicyChoice& choice,
                                              const aquafarm_msgs::FarmSpec& spec,
                                              const aquafarm_msgs::FarmState& state) {
  constexpr double kOverAll_m = 100.0;
  visualization_msgs::MarkerArray array;
  for (const auto& ship : state.ships) {
    Marker marker = MakeMarker("choice", ship.id, Marker::TRIANGLE_LIST, kChoiceColor);
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.pose.position.z = kOverAll_m;
    const auto id = static_cast<std::size_t>(ship.id);
    const bool is_shown = IsOf(choice, state) && ship.id >= 0 && id < choice.actions.size() &&
                          ship.visible && ship.active && InGrid(spec, ship.x, ship.y);
    if (is_shown) {
      const int bearing = MoveBearingDeg(choice.actions[id]);
      const double turn = bearing * CV_PI / 180.0;
      if (bearing >= 0) {
        AddArrow(marker, ship.x + 1.6 * std::sin(turn), ship.y + 1.6 * std::cos(turn), bearing,
                 spec.cell_size_m, 3.0);
      } else {
        // Four arrows towards the ship represent an action that is not a move.
        for (const int side : {0, 90, 180, 270}) {
          const double to = side * CV_PI / 180.0;
          AddArrow(marker, ship.x + 0.9 * std::sin(to), ship.y + 0.9 * std::cos(to), side + 180,
                   spec.cell_size_m, 1.2);
        }
      }
    } else {
      marker.action = Marker::DELETE;
    }
    array.markers.push_back(marker);
  }
  return array;
}

}  // namespace aquafarm_viz
