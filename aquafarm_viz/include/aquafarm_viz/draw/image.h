// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The farm as a picture, without an X server.
///
///     .---------------------------------------.
///     | scenario                   world time |
///     | episode  step  return                 |
///     |-----------------------------.---------|
///     |                             | ships   |
///     |   map, north up             | devices |
///     |                             | danger  |
///     |                             | legend  |
///     |-----------------------------'---------|
///     | reward terms of the last step         |
///     | training                              |
///     '---------------------------------------'

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/TrainingStatus.h>

#include <memory>
#include <opencv2/core.hpp>

#include "aquafarm_viz/draw/map_view.h"
#include "aquafarm_viz/scene/layers.h"
#include "aquafarm_viz/scene/trail.h"
#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

inline constexpr int kMinImageSide = 160;   ///< pixels
inline constexpr int kMaxImageSide = 4096;  ///< pixels

/// The size of a picture in pixels; values are brought into [kMinImageSide, kMaxImageSide].
struct ImageSize {
  int width{800};
  int height{640};
};

/// What a picture may show besides the state; nullptr leaves it out.
struct Extras {
  const Wake* wake{};                               ///< the ways ships came
  const aquafarm_msgs::TrainingStatus* training{};  ///< how the learner gets on
  const Wake* route{};                              ///< of the whole episode so far
  Layers layers{};                                  ///< which of them, and of the state, are drawn
  const Values* values{};                           ///< what a policy thinks of each cell
  const aquafarm_msgs::PolicyChoice* choice{};      ///< what another policy would do in this state
};

/// Where the map lies in a picture.
struct MapPlace {
  cv::Rect map;  ///< the part of the picture that the map fills
  MapView view;  ///< cells to pixels of that part
};

/// The place of the map of a width x height farm in a picture of the given size.
MapPlace PlaceMap(int width, int height, ImageSize size);

/// Draws pictures of one size, keeping what stays the same from picture to picture.
class FarmPainter {
 public:
  explicit FarmPainter(ImageSize size);
  ~FarmPainter();
  FarmPainter(FarmPainter&&) noexcept;
  FarmPainter& operator=(FarmPainter&&) noexcept;

  /// Draws a state; the 8-bit BGR picture is valid until the next call.
  /// The spec must pass CheckSpec and the state CheckState.
  const cv::Mat& Draw(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                      const Extras& extras = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Draws one picture.
/// @throws std::invalid_argument for a spec or state that cannot be drawn, saying why.
cv::Mat DrawFarm(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::FarmState& state,
                 ImageSize size = {}, const Extras& extras = {});

}  // namespace aquafarm_viz
