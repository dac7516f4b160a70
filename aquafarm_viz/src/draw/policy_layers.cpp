// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/free_space.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

constexpr Rgb kNoValue{0x4c, 0x54, 0x5c};  // colour of cells of rocks; no value is grey
constexpr double kValueShare = 0.82;       // opacity of V_π over the sea
constexpr double kArrowSpacing = 34.0;     // min distance between arrows [design units]
constexpr double kLargestArrow = 19.0;     // max size of a symbol [design units]

cv::Mat Colors(const cv::Mat& shares) {
  static const cv::Mat3b kTable = [] {
    cv::Mat3b table(256, 1);
    for (int i = 0; i < table.rows; ++i) {
      const Rgb color = ValueColor(i / 255.0);
      table(i, 0) = {color.b, color.g, color.r};
    }
    return table;
  }();
  cv::Mat colors;
  cv::applyColorMap(shares, colors, kTable);
  return colors;
}

}  // namespace

void DrawArrow(cv::Mat& map, cv::Point2d middle, int bearing_deg, double size_px,
               const cv::Scalar& color, int thickness) {
  const Pose2 placing{middle, size_px, double(bearing_deg)};
  const cv::Point2d tip = Place({0.0, 0.40}, placing);
  DrawLine(map, Place({0.0, -0.36}, placing), tip, color, thickness);
  DrawLine(map, Place({-0.20, 0.12}, placing), tip, color, thickness);
  DrawLine(map, Place({0.20, 0.12}, placing), tip, color, thickness);
}

void DrawValues(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const Values& values,
                const Layout& layout) {
  // Refers to the values without copying them, and is only read. Row 0 is the southernmost.
  const cv::Mat from_south(values.height, values.width, CV_32F,
                           const_cast<float*>(values.values.data()));
  cv::Mat north_up;
  cv::flip(from_south, north_up, 0);
  const cv::Mat known = north_up == north_up;  // not NaN
  cv::Mat shares(north_up.size(), CV_8U, cv::Scalar(128));
  if (const double span = double(values.highest) - double(values.lowest); span > 0.0) {
    // Subtracts the lowest value before scaling, because values far from 0 would lose precision.
    cv::subtract(north_up, cv::Scalar(double(values.lowest)), north_up);
    north_up.convertTo(shares, CV_8U, 255.0 / span);
  }
  cv::Mat large;
  cv::Mat mask;
  cv::resize(Colors(shares), large, map.size(), 0, 0, cv::INTER_NEAREST);
  cv::resize(known, mask, map.size(), 0, 0, cv::INTER_NEAREST);
  cv::addWeighted(large, kValueShare, map, 1.0 - kValueShare, 0.0, large);
  large.copyTo(map, mask);
  const double cell = layout.view.cell_px();
  for (const auto& rock : spec.rocks) {
    if (!InGrid(spec, rock.cell.x, rock.cell.y)) continue;
    const cv::Point2d at = layout.view.ToPixel(rock.cell.x, rock.cell.y);
    const cv::Point2d half(cell / 2.0, cell / 2.0);
    Tint(map, {cv::Point(at - half), cv::Point(at + half)}, Bgr(kNoValue), 0.85);
    DrawRock(map, at, std::max(0.42 * cell, 1.5));
  }
}

void DrawValueScale(cv::Mat& map, const Values& values, FreeSpace& space, const Layout& layout,
                    const Fonts& fonts) {
  if (!(values.highest > values.lowest)) return;
  const std::string low = "value " + Number(values.lowest, 1);
  const std::string high =
      Number(values.highest, 1) + (values.step ? ", step " + Count(*values.step) : "");
  const int gap = layout.Px(5);
  const int bar = layout.Px(80);
  const int width = fonts.small.Width(low) + fonts.small.Width(high) + bar + 4 * gap;
  const auto place =
      space.Take({width, layout.Px(20)}, cv::Point2d(0.0, map.rows), double(map.cols + map.rows));
  if (!place) return;
  const cv::Rect plate = *place;
  Tint(map, plate, Bgr(layout.style->panel), 0.85);
  const int base = plate.y + (plate.height + fonts.small.cap_height()) / 2;
  int x = plate.x + gap;
  x += fonts.small.Draw(map, low, {x, base}, Bgr(layout.style->words)) + gap;
  cv::Mat1b ramp(1, bar);
  for (int i = 0; i < bar; ++i)
    ramp(0, i) = static_cast<std::uint8_t>(255 * i / std::max(1, bar - 1));
  cv::Mat part = map(cv::Rect(x, plate.y + gap, bar, plate.height - 2 * gap));
  cv::resize(Colors(ramp), part, part.size(), 0, 0, cv::INTER_NEAREST);
  fonts.small.Draw(map, high, {x + bar + gap, base}, Bgr(layout.style->words));
}

void DrawMove(cv::Mat& map, cv::Point2d at, std::uint8_t action, double size_px,
              const Layout& layout) {
  const int thickness = std::max(1, cvRound(size_px / 17.0));
  if (const int bearing = MoveBearingDeg(action); bearing >= 0) {
    DrawArrow(map, at, bearing, size_px, Bgr(kInk), thickness + 2);
    DrawArrow(map, at, bearing, size_px, Bgr(kPaper), thickness);
  } else if (action == 8) {
    FillCircle(map, at, 0.22 * size_px, Bgr(kPaper));
  } else if (action == 9) {
    StrokeCircle(map, at, 0.22 * size_px, Bgr(kPaper), layout.Px(1.5));
  }
}

int MoveSpacing(const Layout& layout) {
  return std::max(1, int(std::ceil(kArrowSpacing * layout.unit / layout.view.cell_px())));
}

MoveSigns::MoveSigns(const Layout& layout)
    : view_(layout.view),
      every_(MoveSpacing(layout)),
      size_px_(std::min(0.8 * every_ * view_.cell_px(), kLargestArrow * layout.unit)) {
  // `phase_` is the same for all cells if the size of a cell is an integer.
  const int half = cvCeil(0.5 * size_px_) + 3;
  const cv::Point2d middle = view_.ToPixel(0, view_.height() - 1);
  phase_ = middle - cv::Point2d(std::floor(middle.x), std::floor(middle.y));
  for (std::uint8_t action = 0; action < kSigns; ++action) {
    signs_.emplace_back(cv::Size(2 * half + 1, 2 * half + 1), cv::Point(half, half),
                        [&](cv::Mat& map) {
                          DrawMove(map, cv::Point2d(half, half) + phase_, action, size_px_, layout);
                        });
  }
}

void MoveSigns::Draw(cv::Mat& map, const Values& values, const FreeSpace* space) const {
  const int half = cvCeil(0.4 * size_px_);
  for (const cv::Point cell : ShownActions(values, every_)) {
    const std::uint8_t action = values.actions[values.Index(cell.x, cell.y)];
    const cv::Point2d at = view_.ToPixel(cell.x, cell.y) - phase_;
    const cv::Point middle(cvRound(at.x), cvRound(at.y));
    const cv::Rect part(middle - cv::Point(half, half), cv::Size(2 * half + 1, 2 * half + 1));
    const cv::Rect seen = part & cv::Rect({0, 0}, map.size());
    if (space == nullptr || space->IsFree(seen)) signs_[action].LayOver(map, middle);
  }
}

Overlay::Overlay(cv::Size size, cv::Point middle, const std::function<void(cv::Mat& map)>& draw) {
  cv::Mat3b on_black(size, cv::Vec3b::all(0));
  cv::Mat3b on_white(size, cv::Vec3b::all(255));
  draw(on_black);
  draw(on_white);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const cv::Vec3b color = on_black(y, x);
      const int keep = int(on_white(y, x)[1]) - int(color[1]);
      if (keep < 255) pixels_.push_back({cv::Point(x, y) - middle, color, std::max(0, keep)});
    }
  }
}

void Overlay::LayOver(cv::Mat& map, cv::Point middle) const {
  const cv::Rect whole({0, 0}, map.size());
  for (const Pixel& pixel : pixels_) {
    const cv::Point at = middle + pixel.at;
    if (!whole.contains(at)) continue;
    auto& below = map.at<cv::Vec3b>(at);
    for (int i = 0; i < 3; ++i) {
      const int sum = int(pixel.color[i]) + (int(below[i]) * pixel.keep + 127) / 255;
      below[i] = static_cast<std::uint8_t>(std::min(255, sum));
    }
  }
}

void DrawChoice(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                const aquafarm_msgs::FarmState& state, const aquafarm_msgs::PolicyChoice& choice,
                const Layout& layout) {
  if (!IsOf(choice, state)) return;
  for (const auto& ship : state.ships) {
    const auto id = static_cast<std::size_t>(ship.id);
    if (ship.id < 0 || id >= choice.actions.size() || !ship.active) continue;
    if (!ship.visible || !InGrid(spec, ship.x, ship.y)) continue;
    const int bearing = MoveBearingDeg(choice.actions[id]);
    const cv::Point2d at = ShipPlace(spec, state, ship, layout);
    const double radius = layout.ship_radius_px();
    if (bearing < 0) {
      StrokeCircle(map, at, 1.5 * radius, Bgr(kChoiceColor), layout.Px(2.5));
      continue;
    }
    const Pose2 placing{at, radius, double(bearing)};
    DrawArrow(map, Place({0.0, 2.0}, placing), bearing, 2.4 * radius, Bgr(kInk), layout.Px(5));
    DrawArrow(map, Place({0.0, 2.0}, placing), bearing, 2.4 * radius, Bgr(kChoiceColor),
              layout.Px(2.5));
  }
}

void DrawChoiceWords(cv::Mat& map, const aquafarm_msgs::FarmState& state,
                     const aquafarm_msgs::PolicyChoice& choice, FreeSpace& space,
                     const Layout& layout, const Fonts& fonts) {
  if (!IsOf(choice, state)) return;
  std::string words = choice.policy + ":";
  for (const auto& ship : state.ships) {
    const std::string one = ChoiceText(choice, ship);
    if (!one.empty()) words += " " + one;
  }
  const int width = fonts.bold.Width(words) + layout.Px(12);
  const auto place = space.Take({width, layout.Px(20)}, cv::Point2d(map.cols, map.rows),
                                double(map.cols + map.rows));
  const cv::Rect plate = place.value_or(
      cv::Rect(map.cols - width - layout.Px(6), map.rows - layout.Px(26), width, layout.Px(20)));
  Tint(map, plate, Bgr(layout.style->panel), 0.85);
  fonts.bold.Draw(map, words,
                  {plate.x + layout.Px(6), plate.y + (plate.height + fonts.bold.cap_height()) / 2},
                  Bgr(layout.style->words));
}

}  // namespace aquafarm_viz
