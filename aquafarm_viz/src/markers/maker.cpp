// SPDX-License-Identifier: BSD-3-Clause
#include "markers/maker.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace aquafarm_viz {
namespace {

constexpr int kCircleCorners = 72;

geometry_msgs::Point OnCircle(double radius_m, int corner) {
  const double angle = 2.0 * CV_PI * corner / kCircleCorners;
  return Point(radius_m * std::cos(angle), radius_m * std::sin(angle));
}

// Returns the approximate width of a letter of Liberation Sans in rviz, in heights of a letter.
double LetterWidth(char letter) {
  constexpr double kScale = 0.9;  // rviz draws a letter of 1 em 0.9 heights wide
  const auto is_in = [letter](const char* letters) {
    return std::string(letters).find(letter) != std::string::npos;
  };
  if (letter == ' ') return 0.28 * kScale;  // narrow_spaces.cpp
  if (is_in("ijl.,:;'|!()[]ft/I-r")) return 0.3 * kScale;
  if (is_in("mwMW%")) return 0.82 * kScale;
  return (letter >= 'A' && letter <= 'Z' ? 0.68 : 0.55) * kScale;
}

}  // namespace

double TextWidth(const std::string& text) {
  double longest = 0.0;
  double width = 0.0;
  for (const char letter : text) {
    width = letter == '\n' ? 0.0 : width + LetterWidth(letter);
    longest = std::max(longest, width);
  }
  return longest;
}

void AddOnPlate(visualization_msgs::MarkerArray& array, const Maker& maker,
                const std::string& space, std::int32_t id, cv::Point2d at, cv::Size2d size_m,
                const std::string& text) {
  visualization_msgs::Marker plate = maker.Make(
      (space + "_plate").c_str(), id, visualization_msgs::Marker::CUBE, kWordLayer, at.x, at.y);
  plate.pose.position.z -= 0.5 * maker.layer_m();
  plate.scale.x = size_m.width;
  plate.scale.y = size_m.height;
  plate.scale.z = 0.1 * maker.layer_m();
  plate.color = Color(kInk, 0.72);
  array.markers.push_back(plate);
  array.markers.push_back(maker.Text(space.c_str(), id, at.x, at.y, text, maker.word_m(), kPaper));
}

void AddBand(visualization_msgs::Marker& marker, const QuadrantRadii& inner,
             const QuadrantRadii& outer) {
  static_assert(kCircleCorners % 4 == 0, "quadrants begin at a corner");
  constexpr std::array<std::size_t, 4> kAnticlockwiseFromEast{0, 3, 2, 1};
  marker.points.reserve(6 * kCircleCorners);
  for (int corner = 0; corner < kCircleCorners; ++corner) {
    const std::size_t quadrant =
        kAnticlockwiseFromEast[static_cast<std::size_t>(4 * corner / kCircleCorners)];
    const double inner_m = inner[quadrant];
    const double outer_m = outer[quadrant];
    if (outer_m <= inner_m) continue;
    const auto a = OnCircle(inner_m, corner);
    const auto b = OnCircle(outer_m, corner);
    const auto c = OnCircle(outer_m, corner + 1);
    const auto d = OnCircle(inner_m, corner + 1);
    marker.points.insert(marker.points.end(), {a, b, c});
    if (inner_m > 0.0) marker.points.insert(marker.points.end(), {a, c, d});
  }
}

}  // namespace aquafarm_viz
