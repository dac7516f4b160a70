// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "draw/nautical.h"
#include "draw/symbols.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;
using aquafarm_msgs::FarmState;

void DrawArrow(cv::Mat& map, cv::Point2d from, double bearing_deg, double length_px,
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
  // One arm of the chart symbol, counter-clockwise as in the northern hemisphere.
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

void DrawCentre(cv::Mat& map, const DisasterState& disaster, const Layout& layout,
                const Fonts& fonts) {
  const cv::Point2d at = layout.view.ToPixel(disaster.x, disaster.y);
  const double radius = 8.0 * layout.unit;
  if (disaster.speed > 0.0F) {
    const double length =
        std::clamp(2.2 * layout.view.cell_px(), 40.0 * layout.unit, 60.0 * layout.unit);
    DrawArrow(map, at, disaster.heading_deg, length, layout);
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
                  Bgr(kPaper));
}

// Draws a pointer at the border towards a centre outside the map, with its heading and where it is
// from the middle of the farm: "typhoon, centre 89 km SE".
void DrawBorderPointer(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec,
                       const DisasterState& disaster, cv::Point2d centre, const Layout& layout,
                       const Fonts& fonts) {
  static const std::vector<cv::Point2f> kPointer{{0.0F, 1.0F}, {0.75F, -0.7F}, {-0.75F, -0.7F}};
  const double margin = std::min(13.0 * layout.unit, std::min(map.cols, map.rows) / 2.0);
  const cv::Point2d at(std::clamp(centre.x, margin, map.cols - margin),
                       std::clamp(centre.y, margin, map.rows - margin));
  const double bearing = std::atan2(centre.x - at.x, at.y - centre.y) * 180.0 / CV_PI;
  double top = at.y;
  double foot = at.y;
  if (disaster.speed > 0.0F) {  // next to the pointer, so that the whole arrow is on the map
    const double length = 40.0 * layout.unit;
    const double turn = disaster.heading_deg * CV_PI / 180.0;
    const cv::Point2d way(length * std::sin(turn), -length * std::cos(turn));
    const double room = std::min(2.0 * margin, std::min(map.cols, map.rows) / 2.0);
    const cv::Point2d head(std::clamp(at.x + way.x, room, map.cols - room),
                           std::clamp(at.y + way.y, room, map.rows - room));
    DrawArrow(map, head - way, disaster.heading_deg, length, layout);
    top = std::min({top, head.y, head.y - way.y});
    foot = std::max({foot, head.y, head.y - way.y});
  }
  const Pose2 placing{at, 9.0 * layout.unit, bearing};
  StrokeShape(map, kPointer, placing, Bgr(kPaper), layout.Px(3));
  FillShape(map, kPointer, placing, Bgr(GradeColor(disaster.grade)));
  const std::string text = DisasterName(disaster.kind) + ", centre " +
                           DistanceText(MetresFromFarm(spec, disaster.x, disaster.y)) + " " +
                           PointFromFarm(spec, disaster.x, disaster.y);
  const int width = fonts.bold.Width(text);
  const cv::Point words(std::clamp(cvRound(at.x) - width / 2, layout.Px(4),
                                   std::max(layout.Px(4), map.cols - width - layout.Px(4))),
                        at.y > map.rows / 2.0
                            ? cvRound(top) - layout.Px(15)
                            : cvRound(foot) + layout.Px(15) + fonts.bold.cap_height());
  fonts.bold.Draw(map, text, words + cv::Point(1, 1), Bgr(kInk));
  fonts.bold.Draw(map, text, words, Bgr(kPaper));
}

}  // namespace

void DrawDisasterSigns(cv::Mat& map, const aquafarm_msgs::FarmSpec& spec, const FarmState& state,
                       const Layout& layout, const Fonts& fonts) {
  for (const auto& disaster : state.disasters) {
    if (!IsDrawn(disaster)) continue;
    const cv::Point2d centre = layout.view.ToPixel(disaster.x, disaster.y);
    const bool inside =
        centre.x >= 0.0 && centre.y >= 0.0 && centre.x < map.cols && centre.y < map.rows;
    if (inside) {
      DrawCentre(map, disaster, layout, fonts);
    } else {
      DrawBorderPointer(map, spec, disaster, centre, layout, fonts);
    }
  }
}

}  // namespace aquafarm_viz
