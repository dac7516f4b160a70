// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "aquafarm_viz/draw/image.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

// Sizes are in design units unless stated. A picture of 640 x 640 has one pixel per unit.
constexpr double kDesignSide = 640.0;
constexpr double kTop = 46.0;
constexpr double kBottom = 44.0;
constexpr double kPanelWidth = 184.0;     // min width of the panel
constexpr double kPanelShare = 0.26;      // preferred width of the panel [widths of the picture]
constexpr double kMaxPanelWidth = 276.0;  // max width; the panel takes what the map leaves free
constexpr double kAxisLeft = 52.0;
constexpr double kAxisBottom = 18.0;
constexpr double kGap = 10.0;
constexpr double kKeyBelow = 72.0;   // height of a legend below the map, four rows
constexpr double kKeyWidth = 450.0;  // its min width
constexpr int kSmallest = 300;       // min side of a picture with texts around the map [pixels]
constexpr double kWholePixels = 6;   // from this size [pixels] on, the size of a cell is an integer

}  // namespace

int Layout::Px(double units) const { return std::max(1, cvRound(units * unit)); }

double Layout::device_radius_px() const {
  return std::clamp(0.40 * view.cell_px(), 6.0 * unit, 22.0 * unit);
}

double Layout::port_radius_px() const {
  return std::clamp(0.46 * view.cell_px(), 7.5 * unit, 14.0 * unit);
}

double Layout::ship_radius_px() const {
  return std::clamp(0.60 * view.cell_px(), 9.0 * unit, 30.0 * unit);
}

Layout MakeLayout(int width, int height, ImageSize size, const Style& style) {
  Layout layout;
  layout.style = &style;
  const int short_side = std::min(size.width, size.height);
  layout.unit = std::max(size.text_scale * short_side / kDesignSide, 0.7);
  cv::Rect room(0, 0, size.width, size.height);
  if (short_side >= kSmallest) {
    layout.top = {0, 0, size.width, layout.Px(kTop)};
    layout.bottom = {0, size.height - layout.Px(kBottom), size.width, layout.Px(kBottom)};
    const int panel = std::clamp(cvRound(kPanelShare * size.width), layout.Px(kPanelWidth),
                                 layout.Px(kMaxPanelWidth));
    const int middle = layout.bottom.y - layout.top.height;  // height between top and bottom
    const int right = size.has_panel ? size.width - panel : size.width;
    if (size.has_panel) layout.panel = {right, layout.top.height, panel, middle};
    room = {layout.Px(kAxisLeft), layout.top.height + layout.Px(kGap),
            right - layout.Px(kAxisLeft) - layout.Px(kGap),
            middle - layout.Px(kAxisBottom) - layout.Px(kGap)};
  }
  double cell_px = std::min(double(room.width) / width, double(room.height) / height);
  if (cell_px >= kWholePixels) cell_px = std::floor(cell_px);
  const cv::Size map(std::clamp(cvRound(cell_px * width), 1, room.width),
                     std::clamp(cvRound(cell_px * height), 1, room.height));
  if (!layout.panel.empty()) {  // the panel takes the width that the map leaves
    const int spare =
        std::min(room.width - map.width, layout.Px(kMaxPanelWidth) - layout.panel.width);
    layout.panel.x -= spare;
    layout.panel.width += spare;
    room.width -= spare;
  }
  // A wide map that is much lower than its place has the legend below it.
  if (short_side >= kSmallest && room.width >= layout.Px(kKeyWidth) &&
      room.height - map.height >= layout.Px(kKeyBelow)) {
    room.height -= layout.Px(kKeyBelow);
    layout.key = {room.x, room.br().y + layout.Px(kAxisBottom + 4.0), room.width,
                  layout.Px(kKeyBelow - 4.0)};
  }
  layout.map = {room.x + (room.width - map.width) / 2, room.y + (room.height - map.height) / 2,
                map.width, map.height};
  layout.view = MapView(width, height, cell_px);
  return layout;
}

MapPlace PlaceMap(int width, int height, ImageSize size) {
  const auto side = [](int pixels) { return std::clamp(pixels, kMinImageSide, kMaxImageSide); };
  const Layout layout = MakeLayout(
      width, height, {side(size.width), side(size.height), size.has_panel, size.text_scale});
  return {layout.map, layout.view};
}

void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout) {
  DrawLabel(image, font, text, top_left, layout, layout.style->label);
}

void DrawLabel(cv::Mat& image, const Font& font, const std::string& text, cv::Point top_left,
               const Layout& layout, Rgb color) {
  const cv::Point base = top_left + cv::Point(0, font.cap_height());
  const int width = layout.Px(1.2);
  for (int dy = -width; dy <= width; ++dy) {
    for (int dx = -width; dx <= width; ++dx) {
      if (dx == 0 && dy == 0) continue;
      font.Draw(image, text, base + cv::Point(dx, dy), Bgr(layout.style->halo));
    }
  }
  font.Draw(image, text, base, Bgr(color));
}

Fonts::Fonts(double unit)
    : small(std::max(8, cvRound(11.0 * unit)), FindFontFile(false)),
      bold(std::max(8, cvRound(11.0 * unit)), FindFontFile(true)),
      title(std::max(9, cvRound(14.0 * unit)), FindFontFile(true)),
      headline(std::max(8, cvRound(12.5 * unit)), FindFontFile(true)) {}

}  // namespace aquafarm_viz
