// SPDX-License-Identifier: BSD-3-Clause
#include "markers/maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace aquafarm_viz {
namespace {

constexpr int kCircleCorners = 72;

geometry_msgs::Point OnCircle(double radius_m, int corner) {
  const double angle = 2.0 * CV_PI * corner / kCircleCorners;
  return Point(radius_m * std::cos(angle), radius_m * std::sin(angle));
}

// Widths of the letters from space to "~" [1/1000 em]. Liberation Sans has the metrics of Helvetica
// (Adobe Core 14 AFM, Helvetica.afm).
constexpr std::array<int, 95> kWidths{
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

// Returns the width of a letter in rviz, in heights of a letter.
double LetterWidth(char letter) {
  constexpr double kEm = 0.853;  // width of 1 em in rviz, measured [heights of a letter]
  const auto i = static_cast<std::size_t>(letter - ' ');  // large for other characters
  return kEm * (i < kWidths.size() ? kWidths[i] : 556) / 1000.0;
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

visualization_msgs::Marker Maker::Line(const char* space, double line, const std::string& text,
                                       Rgb color) const {
  const double half = 0.5 * TextWidth(text) * line_m_ / cell_m_;
  return Text(space, 0, half - 0.5, LineAbove(line), text, line_m_, color);
}

void AddFilled(visualization_msgs::Marker& marker, const std::vector<cv::Point2f>& outline,
               double size_m) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const cv::Point2f a = outline[i];
    const cv::Point2f b = outline[(i + 1) % outline.size()];
    marker.points.push_back(Point(0.0, 0.0));
    marker.points.push_back(Point(a.x * size_m, a.y * size_m));
    marker.points.push_back(Point(b.x * size_m, b.y * size_m));
  }
}

void AddOutline(visualization_msgs::Marker& marker, const std::vector<cv::Point2f>& outline,
                double size_m) {
  constexpr double kInner = 0.78;  // side of the inner edge, relative to the outer one
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const cv::Point2d a = cv::Point2d(outline[i]) * size_m;
    const cv::Point2d b = cv::Point2d(outline[(i + 1) % outline.size()]) * size_m;
    for (const cv::Point2d& corner : {a, b, kInner * b, a, kInner * b, kInner * a}) {
      marker.points.push_back(Point(corner.x, corner.y));
    }
  }
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
