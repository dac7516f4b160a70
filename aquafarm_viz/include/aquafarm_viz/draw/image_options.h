// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The size of a picture and its optional content.

#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/TrainingStatus.h>

#include "aquafarm_viz/scene/layers.h"
#include "aquafarm_viz/scene/trail.h"
#include "aquafarm_viz/scene/values.h"

namespace aquafarm_viz {

inline constexpr int kMinImageSide = 160;   ///< min width and height [pixels]
inline constexpr int kMaxImageSide = 4096;  ///< max width and height [pixels]

/// The size of a picture [pixels]. FarmPainter and PlaceMap clamp each side to [kMinImageSide,
/// kMaxImageSide].
struct ImageSize {
  int width{800};
  int height{640};
  /// false: omits the panel at the right (lists, map of the region), so that the map is larger; the
  /// legend is then below the map, if there is space
  bool has_panel{true};
  double text_scale{1.0};  ///< factor of the sizes of texts and symbols, above 0
};

/// Optional content of a picture in addition to the state. A null pointer omits that content.
struct Overlays {
  const Trail* trail{};                             ///< recent trails of the ships
  const aquafarm_msgs::TrainingStatus* training{};  ///< progress of the learner
  const Trail* route{};                             ///< trails since the start of the episode
  Layers layers{};                                  ///< layers to draw
  const Values* values{};                           ///< values and greedy actions of a policy
  /// Actions that another policy chooses in one recorded state, for comparison with the recorded
  /// actions; drawn only if the picture shows that state.
  const aquafarm_msgs::PolicyChoice* choice{};
};

}  // namespace aquafarm_viz
