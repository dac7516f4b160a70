// SPDX-License-Identifier: BSD-3-Clause
#include "whole_view.h"

#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <rviz/visualization_manager.h>

#include <algorithm>

#include "base/text_scale.h"

namespace aquafarm_viz {

// Space for the texts around the farm, in units of TextScale times the longer side of the farm:
// latitudes on the left, five lines above, longitudes and three lines of the legend below.
constexpr double kLeft = 0.115;
constexpr double kRight = 0.035;
constexpr double kAbove = 0.195;
constexpr double kBelow = 0.165;

rviz::ViewController* WholeView::FromAbove(rviz::VisualizationManager& rviz) {
  rviz::ViewController* view = rviz.getViewManager()->getCurrent();
  return view != nullptr && view->getClassId() == "rviz/TopDownOrtho" ? view : nullptr;
}

WholeView::Place WholeView::Read(rviz::ViewController& view) {
  const auto value = [&view](const char* name) { return view.subProp(name)->getValue().toFloat(); };
  return {value("X"), value("Y"), value("Scale"), value("Angle")};
}

bool WholeView::IsKept(rviz::VisualizationManager& rviz) const {
  if (!wanted || width_m_ == 0.0) return wanted;
  rviz::ViewController* view = FromAbove(rviz);
  return view != nullptr && Read(*view) == place_;
}

void WholeView::Follow(rviz::VisualizationManager& rviz, const aquafarm_msgs::FarmSpec& spec) {
  rviz::ViewController* view = FromAbove(rviz);
  const QWidget* window = rviz.getRenderPanel();
  if (!wanted || view == nullptr || window == nullptr) return;
  const Place now = Read(*view);
  if (width_m_ != 0.0 && !(now == place_)) {  // the user moved the view
    wanted = false;
    return;
  }
  const double width_m = spec.width * spec.cell_size_m;
  const double height_m = spec.height * spec.cell_size_m;
  const bool is_new = width_m != width_m_ || height_m != height_m_;
  const double unit_m = TextScale(spec) * std::max(width_m, height_m);
  const double scale = std::min(window->width() / (width_m + (kLeft + kRight) * unit_m),
                                window->height() / (height_m + (kAbove + kBelow) * unit_m)) *
                       window->devicePixelRatioF();
  const double x_m = 0.5 * (width_m - spec.cell_size_m + (kRight - kLeft) * unit_m);
  const double y_m = 0.5 * (height_m - spec.cell_size_m + (kAbove - kBelow) * unit_m);
  const Place wanted_place{static_cast<float>(x_m), static_cast<float>(y_m),
                           static_cast<float>(scale), now.angle};
  if (!is_new && wanted_place == place_) return;
  const auto set = [view](const char* name, float value) {
    rviz::Property* property = view->subProp(name);
    property->setShouldBeSaved(false);  // else rviz asks the user to save this change
    property->setValue(value);
    property->setShouldBeSaved(true);
  };
  set("X", wanted_place.x_m);
  set("Y", wanted_place.y_m);
  set("Scale", wanted_place.scale);
  width_m_ = width_m;
  height_m_ = height_m;
  place_ = Read(*view);
}

}  // namespace aquafarm_viz
