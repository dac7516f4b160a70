// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/FarmSpec.h>

namespace rviz {
class ViewController;
class VisualizationManager;
}  // namespace rviz

namespace aquafarm_viz {

/// Adjusts rviz's top-down view to the whole farm until the user moves the view.
class WholeView {
 public:
  /// Adjusts the view if the size of the farm or of the window has changed. Sets `wanted` to false
  /// if the user has moved the view.
  void Follow(rviz::VisualizationManager& rviz, const aquafarm_msgs::FarmSpec& spec);
  /// Returns true if `wanted` and the user has not moved the view.
  bool IsKept(rviz::VisualizationManager& rviz) const;

  bool wanted{};  ///< true: the view is adjusted; read from the configuration of rviz

 private:
  struct Place {
    float x_m, y_m, scale, angle;  // centre of the view, pixels per metre, and angle of rviz
    bool operator==(const Place& other) const {
      return x_m == other.x_m && y_m == other.y_m && scale == other.scale && angle == other.angle;
    }
  };
  static rviz::ViewController* FromAbove(rviz::VisualizationManager& rviz);
  static Place Read(rviz::ViewController& view);

  double width_m_{};  // size of the farm to which the view is adjusted; 0 before the first farm
  double height_m_{};
  Place place_{};
};

}  // namespace aquafarm_viz
