// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws the farm as a picture, without an X server.
///
///     .-----------------------------------------.
///     | next danger, or how the episode ended   |
///     | scenario episode step return world time |
///     |-----------------------------.-----------|
///     |                             | devices   |
///     |                             | disasters |
///     |   map, north up             | ships     |
///     |                             | policy    |
///     |                             | region    |
///     |                             | legend    |
///     |-----------------------------'-----------|
///     | reward terms of the last step           |
///     | training                                |
///     '-----------------------------------------'
///
/// If the map leaves enough height, the legend is below the map.
///
/// A picture with a side below 300 pixels consists of the map only. The map then also contains how
/// the episode ended, the scale of values and the actions that a policy chooses.

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>

#include <memory>
#include <opencv2/core.hpp>

#include "aquafarm_viz/draw/image_options.h"
#include "aquafarm_viz/draw/map_view.h"
#include "aquafarm_viz/draw/style.h"

namespace aquafarm_viz {

/// Position of the map in a picture.
struct MapPlace {
  cv::Rect map;  ///< part of the picture that contains the map
  MapView view;  ///< maps cells to pixels of this part
};

/// Returns the position of the map of a width x height farm in a picture of the given size.
MapPlace PlaceMap(int width, int height, ImageSize size);

/// Draws pictures of one size. Caches the parts that do not change between pictures.
class FarmPainter {
 public:
  /// @param style  must outlive the painter
  explicit FarmPainter(ImageSize size, const Style& style = DarkStyle());
  ~FarmPainter();
  FarmPainter(FarmPainter&&) noexcept;
  FarmPainter& operator=(FarmPainter&&) noexcept;

  /// Draws a state. The returned 8-bit BGR picture is valid until the next call.
  /// The spec must pass CheckSpec and the state CheckState.
  /// @throws std::invalid_argument if the scenario has no usable sea layer of the requested name
  const cv::Mat& Draw(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      const Overlays& overlays = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Draws one picture.
/// @throws std::invalid_argument with the reason if the spec, the state or the requested sea layer
///         cannot be drawn
cv::Mat DrawFarm(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                 ImageSize size = {}, const Overlays& overlays = {},
                 const Style& style = DarkStyle());

}  // namespace aquafarm_viz
