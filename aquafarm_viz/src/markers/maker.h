// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Creates markers of one farm at given positions and layers; private to this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/names.h"
#include "base/marker_color.h"
#include "base/text_scale.h"

namespace aquafarm_viz {

/// Heights of markers, from bottom to top, in units of Maker::layer_m().
enum Layer {
  kSeaLayer = -1,  // below the grids, which rviz draws at height 0
  kLandLayer = 1,
  kRingLayer,
  kRockLayer,
  kPortLayer,
  kDeviceLayer,
  kShipLayer,
  kDeckLayer,
  kCargoLayer,
  kBarLayer,
  kSignLayer,
  kWordLayer
};

/// Distance of a ship from the port in its cell along each axis, so that both are visible, in units
/// of Maker::thing_m().
constexpr double kShipAside = 0.8;
/// Number of the line above the farm in which the clock is written, see Maker::LineAbove.
constexpr double kLineOfClock = 2.0;

/// Returns a point of a marker [m].
inline geometry_msgs::Point Point(double x, double y, double z = 0.0) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// Adds the triangles of a filled outline around the position of the marker. Each line from the
/// origin to a corner must lie inside the outline.
/// @param size_m  length of one unit of the outline [m]
void AddFilled(visualization_msgs::Marker& marker, const std::vector<cv::Point2f>& outline,
               double size_m);

/// Creates the markers of one farm. Positions are given in cells and converted to metres; sizes
/// depend on the size of the farm.
class Maker {
 public:
  Maker(const aquafarm_msgs::FarmSpec& spec, const std_msgs::Header& header)
      : cell_m_(spec.cell_size_m),
        // On large farms objects are drawn larger than a cell to stay visible.
        thing_m_(spec.cell_size_m * std::max(1.0, std::max(spec.width, spec.height) / 40.0)),
        // In a view of 628 pixels with the whole farm, rviz's letters have 11 pixels or more.
        word_m_(std::max(0.6 * thing_m_, 0.028 * TextScale(spec) *
                                             std::max(spec.width, spec.height) * spec.cell_size_m)),
        layer_m_(std::min(0.03 * spec.cell_size_m, 8.0)),
        line_m_(0.029 * TextScale(spec) * std::max(spec.width, spec.height) * spec.cell_size_m),
        height_(spec.height),
        header_(header) {
    header_.frame_id = names::kMapFrame;
  }

  /// Returns the side of a cell [m].
  double cell_m() const { return cell_m_; }
  /// Returns the size of ships, devices and ports: a cell, or a 40th of the longer side of
  /// the farm if that is more [m].
  double thing_m() const { return thing_m_; }
  /// Returns the height of texts on the farm [m].
  double word_m() const { return word_m_; }
  /// Returns the height of one layer [m].
  double layer_m() const { return layer_m_; }
  /// Returns the height of the lines of text above the farm [m].
  double line_m() const { return line_m_; }
  /// Returns the y of the middle of line 0, 1, … above the farm [cells].
  double LineAbove(double line) const {
    return height_ - 0.5 + (0.75 + 1.25 * line) * line_m_ / cell_m_;
  }

  /// Returns a marker to be completed by the caller. @param x, y  position [cells]
  visualization_msgs::Marker Make(const char* space, int id, int type, Layer layer, double x,
                                  double y) const {
    visualization_msgs::Marker marker;
    marker.header = header_;
    marker.ns = space;
    marker.id = id;
    marker.type = type;
    marker.action = visualization_msgs::Marker::ADD;
    marker.pose.position = Point(x * cell_m_, y * cell_m_, layer * layer_m_);
    marker.pose.orientation.w = 1.0;
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    return marker;
  }

  /// Returns a marker that deletes the marker with this namespace and id.
  visualization_msgs::Marker Delete(const char* space, int id) const {
    visualization_msgs::Marker marker;
    marker.header = header_;
    marker.ns = space;
    marker.id = id;
    marker.action = visualization_msgs::Marker::DELETE;
    marker.pose.orientation.w = 1.0;
    return marker;
  }

  /// Returns a text marker.
  /// @param x, y  middle of the text [cells]
  /// @param size_m  height of the letters [m]
  visualization_msgs::Marker Text(const char* space, int id, double x, double y,
                                  const std::string& text, double size_m, Rgb color) const {
    visualization_msgs::Marker marker =
        Make(space, id, visualization_msgs::Marker::TEXT_VIEW_FACING, kWordLayer, x, y);
    marker.text = text;
    marker.scale.z = size_m;
    marker.color = Color(color);
    return marker;
  }

  /// Returns a line of text north of the farm. The text starts at the western edge of the farm.
  /// @param line  number of the line, see LineAbove
  visualization_msgs::Marker Line(const char* space, double line, const std::string& text,
                                  Rgb color) const;

  /// Returns a flat shape as triangles around its origin. Each line from the origin to a corner
  /// must lie inside the shape.
  /// @param size_m  length of one unit of the outline [m]
  visualization_msgs::Marker Shape(const char* space, int id, Layer layer, double x, double y,
                                   const std::vector<cv::Point2f>& outline, double size_m,
                                   Rgb color) const {
    visualization_msgs::Marker marker =
        Make(space, id, visualization_msgs::Marker::TRIANGLE_LIST, layer, x, y);
    marker.color = Color(color);
    AddFilled(marker, outline, size_m);
    return marker;
  }

 private:
  double cell_m_;
  double thing_m_;
  double word_m_;
  double layer_m_;
  double line_m_;
  int height_;
  std_msgs::Header header_;
};

/// Adds the triangles of an outline, drawn as a narrow band around the position of the marker.
/// @param size_m  length of one unit of the outline [m]
void AddOutline(visualization_msgs::Marker& marker, const std::vector<cv::Point2f>& outline,
                double size_m);

/// Returns the orientation of a marker that points along a bearing. Bearings are clockwise from
/// north, but the yaw of a marker is counter-clockwise.
/// @param rest_deg  yaw at which the marker points north
inline geometry_msgs::Quaternion Turned(double bearing_deg, double rest_deg) {
  const double yaw = (rest_deg - bearing_deg) * CV_PI / 180.0;
  geometry_msgs::Quaternion turned;
  turned.z = std::sin(yaw / 2.0);
  turned.w = std::cos(yaw / 2.0);
  return turned;
}

/// Returns the width of the longest line of a text in rviz, in heights of its letters.
double TextWidth(const std::string& text);

/// Adds a text on a dark plate, so that it can be read on any background. The namespace of the
/// plate is `space` with "_plate" appended.
/// @param at  middle of the text [cells]
/// @param size_m  width and height of the plate [m]
void AddOnPlate(visualization_msgs::MarkerArray& array, const Maker& maker,
                const std::string& space, std::int32_t id, cv::Point2d at, cv::Size2d size_m,
                const std::string& text);

/// Radii to the NE, SE, SW and NW [m].
using QuadrantRadii = std::array<double, 4>;

/// Adds the triangles of the flat band between two rings, whose centre is the position of the
/// marker. Quadrants in which `outer` is not larger than `inner` get no triangles.
void AddBand(visualization_msgs::Marker& marker, const QuadrantRadii& inner,
             const QuadrantRadii& outer);

}  // namespace aquafarm_viz
