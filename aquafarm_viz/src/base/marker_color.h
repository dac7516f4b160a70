// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts colours to those of markers. This is not in palette.h, because palette.h is also used
/// without ROS.

#include <ros/duration.h>  // ColorRGBA.h needs it but does not include it
#include <std_msgs/ColorRGBA.h>

#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {

/// Converts a colour to that of a marker. Alpha 0 is transparent, 1 is opaque.
inline std_msgs::ColorRGBA Color(Rgb color, double alpha = 1.0) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(color.r) / 255.0F;
  result.g = static_cast<float>(color.g) / 255.0F;
  result.b = static_cast<float>(color.b) / 255.0F;
  result.a = static_cast<float>(alpha);
  return result;
}

}  // namespace aquafarm_viz
