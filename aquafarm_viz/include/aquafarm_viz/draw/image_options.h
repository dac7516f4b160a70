// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The size of a picture and what it may show besides the state.

#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/TrainingStatus.h>

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

}  // namespace aquafarm_viz
