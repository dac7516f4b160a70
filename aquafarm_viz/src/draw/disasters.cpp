// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "aquafarm_viz/base/disaster_kinds.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmState;

void DrawHeading(cv::Mat& map, cv::Point2d from, double bearing_deg, double length_px,
                 const Layout& layout) {
  const float length = static_cast<float>(length_px / layout.unit);
  const float neck = length - 11.0F;
  const std::vector<cv::Point2f> outline{{-2.2F, 0.0F},  {2.2F, 0.0F},  {2.2F, neck}, {7.0F, neck},
                                         {0.0F, length}, {-7.0F, neck}, {-2.2F, neck}};
  const Pose2 placing{from, layout.unit, bearing_deg};
  StrokeShape(map, outline, placing, Bgr(kInk), layout.Px(2.5));
  FillShape(map, outline, placing, Bgr(kPaper));
}

void DrawTyphoonEye(cv::Mat& map, cv::Point2d at, double radius_px, const cv::Scalar& color) {
  // One arm of the symbol of a typhoon on charts, counter-clockwise as in the northern hemisphere.
  static const std::vector<cv::Point2f> kArm = [] {
    constexpr int kCorners = 14;
    std::vector<cv::Point2f> points;
    for (int i = 0; i <= kCorners; ++i) {
      const double turn = double(i) / kCorners;
      const double angle = 2.6 * turn;
      const double radius = 2.1 - 1.2 * turn;
      points.emplace_back(float(radius * std::cos(angle)), float(radius * std::sin(angle)));
    }
    for (int i = kCorners; i >= 0; --i) {
      const double turn = double(i) / kCorners;
      const double angle = 2.6 * turn + 0.12;
      const double radius = 2.0 - 1.5 * std::sqrt(turn);
      points.emplace_back(float(radius * std::cos(angle)), float(radius * std::sin(angle)));
    }
    return points;
  }();
  for (const double bearing : {45.0, 225.0}) {
    StrokeShape(map, kArm, {at, radius_px, bearing}, Bgr(kInk), 3);
  }
  for (const double bearing : {45.0, 225.0}) FillShape(map, kArm, {at, radius_px, bearing}, color);
}

void DrawCentre(cv::Mat& map, const DisasterState& disaster, const SignPlace& sign,
                const Layout& layout, const Fonts& fonts) {
  const cv::Point2d at = sign.at;
  const double radius = 8.0 * layout.unit;
  if (sign.arrow_to != at) {
    DrawHeading(map, at, disaster.heading_deg, cv::norm(sign.arrow_to - at), layout);
  }
  const cv::Scalar color = Bgr(GradeColor(disaster.grade));
  const bool typhoon = disaster.kind == DisasterState::TYPHOON;
  if (typhoon) DrawTyphoonEye(map, at, radius * 0.85, color);
  FillCircle(map, at, radius + 1.5 * layout.unit, Bgr(kInk));
  FillCircle(map, at, radius, color);
  if (typhoon) {
    FillCircle(map, at, radius * 0.4, Bgr(kPaper));
    return;
  }
  std::string letter = DisasterName(disaster.kind).substr(0, 1);
  letter[0] = static_cast<char>(letter[0] - 'a' + 'A');
  fonts.bold.Draw(map, letter,
                  {cvRound(at.x + 0.5 - fonts.bold.Width(letter) / 2.0),
                   cvRound(at.y + 0.5 + fonts.bold.cap_height() / 2.0)},
                  Bgr(disaster.grade == 2 ? kInk : kPaper));
}

// Draws a pointer at the border. It points in the direction from the middle of the map to the
// centre of the disaster.
void DrawBorderPointer(cv::Mat& map, const DisasterState& disaster, const SignPlace& sign,
                       const Layout& layout) {
  const cv::Point2d middle(map.cols / 2.0, map.rows / 2.0);
  const cv::Point2d away = layout.view.ToPixel(disaster.x, disaster.y) - middle;
  const double bearing = std::atan2(away.x, -away.y) * 180.0 / CV_PI;
  const Pose2 placing{sign.at, 10.0 * layout.unit, bearing};
  StrokeShape(map, PointerOutline(), placing, Bgr(layout.style->halo), layout.Px(5));
  StrokeShape(map, PointerOutline(), placing, Bgr(layout.style->label), layout.Px(3));
  FillShape(map, PointerOutline(), placing, Bgr(GradeColor(disaster.grade)));
}

}  // namespace

SignPlace PlaceSign(const DisasterState& disaster, const Layout& layout) {
  const cv::Size map = layout.map.size();
  const cv::Point2d centre = layout.view.ToPixel(disaster.x, disaster.y);
  SignPlace sign{centre, centre, true};
  sign.is_inside =
      centre.x >= 0.0 && centre.y >= 0.0 && centre.x < map.width && centre.y < map.height;
  if (sign.is_inside) {
    const double turn = disaster.heading_deg % 360 * CV_PI / 180.0;
    const cv::Point2d heading(std::sin(turn), -std::cos(turn));
    const double length =
        std::clamp(2.2 * layout.view.cell_px(), 40.0 * layout.unit, 60.0 * layout.unit);
    const cv::Point2d tip = centre + heading * length;
    const bool fits = cv::Rect2d({0.0, 0.0}, cv::Size2d(map)).contains(tip);
    if (disaster.speed > 0.0F && fits) sign.arrow_to = tip;
    return sign;
  }
  // The pointer lies on the line from the middle of the map to the centre, just inside the edge.
  const cv::Point2d middle(map.width / 2.0, map.height / 2.0);
  const double margin = std::min(16.0 * layout.unit, std::min(middle.x, middle.y));
  const cv::Point2d away = centre - middle;
  const double beyond = std::max(std::abs(away.x) / std::max(1.0, middle.x - margin),
                                 std::abs(away.y) / std::max(1.0, middle.y - margin));
  sign.at = middle + away / std::max(1.0, beyond);
  sign.arrow_to = sign.at;
  return sign;
}

std::vector<SignPlace> PlaceSigns(const FarmState& state, const Layout& layout) {
  const double apart = 42.0 * layout.unit;  // space for labels of two lines
  const cv::Rect2d inside({0.0, 0.0}, cv::Size2d(layout.map.size()));
  const cv::Point2d middle(layout.map.width / 2.0, layout.map.height / 2.0);
  std::vector<SignPlace> signs;
  std::vector<cv::Point2d> pointers;
  for (const auto& disaster : state.disasters) {
    SignPlace sign = PlaceSign(disaster, layout);
    signs.push_back(sign);
    if (sign.is_inside || !IsDrawn(disaster)) continue;
    const cv::Point2d from_middle = sign.at - middle;
    // True if the pointer is at the left or right border.
    const bool is_aside = std::abs(from_middle.x) * middle.y > std::abs(from_middle.y) * middle.x;
    std::vector<cv::Point2d> places{sign.at};  // also places next to other pointers
    for (const cv::Point2d other : pointers) {
      for (const double along : {apart, -apart}) {
        places.push_back(is_aside ? cv::Point2d(sign.at.x, other.y + along)
                                  : cv::Point2d(other.x + along, sign.at.y));
      }
    }
    std::stable_sort(places.begin(), places.end(), [&sign](cv::Point2d a, cv::Point2d b) {
      return cv::norm(a - sign.at) < cv::norm(b - sign.at);
    });
    const auto free = std::find_if(places.begin(), places.end(), [&](cv::Point2d at) {
      const bool is_near = std::any_of(pointers.begin(), pointers.end(), [&](cv::Point2d other) {
        return cv::norm(other - at) < 0.99 * apart;
      });
      return !is_near && (at == sign.at || inside.contains(at));
    });
    if (free != places.end()) signs.back().at = signs.back().arrow_to = *free;
    pointers.push_back(signs.back().at);
  }
  return signs;
}

void DrawDisasterSigns(cv::Mat& map, const FarmState& state, const Layout& layout,
                       const Fonts& fonts) {
  const std::vector<SignPlace> signs = PlaceSigns(state, layout);
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const DisasterState& disaster = state.disasters[i];
    if (!IsDrawn(disaster)) continue;
    if (signs[i].is_inside) {
      DrawCentre(map, disaster, signs[i], layout, fonts);
    } else {
      DrawBorderPointer(map, disaster, signs[i], layout);
    }
  }
}

}  // namespace aquafarm_viz
