// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <aquafarm_msgs/FarmSpec.h>

namespace rviz {
class ViewController;
class VisualizationManager;
}  // namespace rviz

namespace aquafarm_viz {

/// Keeps rviz's view from above on the whole farm, until somebody moves it.
class WholeView {
 public:
  /// Shows a farm anew when it or the window has another size than before.
  void Follow(rviz::VisualizationManager& rviz, const aquafarm_msgs::FarmSpec& spec);
  /// Whether the view is where it was put, or will be put there by the first farm.
  bool IsKept(rviz::VisualizationManager& rviz) const;

  bool wanted{};  ///< as the configuration says

 private:
  struct Place {
    float x_m, y_m, scale, angle;  // of the view's middle; pixels a metre; as rviz counts it
    bool operator==(const Place& other) const {
      return x_m == other.x_m && y_m == other.y_m && scale == other.scale && angle == other.angle;
    }
  };
  static rviz::ViewController* FromAbove(rviz::VisualizationManager& rviz);
  static Place Read(rviz::ViewController& view);

  double width_m_{};  // of the farm that was put into view; 0: none yet
  double height_m_{};
  Place place_{};
};

}  // namespace aquafarm_viz
