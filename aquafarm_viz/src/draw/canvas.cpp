// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace aquafarm_viz {
namespace {

std::vector<cv::Point> Placed(const std::vector<cv::Point2f>& outline, const Pose2& placing) {
  std::vector<cv::Point> points;
  points.reserve(outline.size());
  for (const auto& point : outline) points.push_back(Fixed(Place(point, placing)));
  return points;
}

}  // namespace

cv::Point Fixed(cv::Point2d point) {
  // Far outside any image, but small enough that the shifted coordinate fits in an int.
  constexpr double kFar = 1.0e6;
  return {cvRound(std::clamp(point.x, -kFar, kFar) * (1 << kSubPixelBits)),
          cvRound(std::clamp(point.y, -kFar, kFar) * (1 << kSubPixelBits))};
}

cv::Point2d Place(cv::Point2d point, const Pose2& placing) {
  const double bearing = placing.bearing_deg * CV_PI / 180.0;
  const double east = point.x * std::cos(bearing) + point.y * std::sin(bearing);
  const double north = -point.x * std::sin(bearing) + point.y * std::cos(bearing);
  return placing.at + cv::Point2d(east, -north) * placing.size_px;
}

void FillShape(cv::Mat& image, const std::vector<cv::Point2f>& outline, const Pose2& placing,
               const cv::Scalar& color) {
  cv::fillPoly(image, Placed(outline, placing), color, cv::LINE_AA, kSubPixelBits);
}

void StrokeShape(cv::Mat& image, const std::vector<cv::Point2f>& outline, const Pose2& placing,
                 const cv::Scalar& color, int thickness) {
  cv::polylines(image, Placed(outline, placing), true, color, thickness, cv::LINE_AA,
                kSubPixelBits);
}

void FillCircle(cv::Mat& image, cv::Point2d centre, double radius_px, const cv::Scalar& color) {
  cv::circle(image, Fixed(centre), cvRound(radius_px * (1 << kSubPixelBits)), color, cv::FILLED,
             cv::LINE_AA, kSubPixelBits);
}

void StrokeCircle(cv::Mat& image, cv::Point2d centre, double radius_px, const cv::Scalar& color,
                  int thickness) {
  cv::circle(image, Fixed(centre), cvRound(radius_px * (1 << kSubPixelBits)), color, thickness,
             cv::LINE_AA, kSubPixelBits);
}

void DrawLine(cv::Mat& image, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
              int thickness) {
  cv::line(image, Fixed(from), Fixed(to), color, thickness, cv::LINE_AA, kSubPixelBits);
}

void Tint(cv::Mat& image, cv::Rect part, const cv::Scalar& color, double share) {
  const cv::Rect seen = part & cv::Rect({0, 0}, image.size());
  if (seen.empty()) return;
  cv::Mat pixels = image(seen);
  pixels.convertTo(pixels, -1, 1.0 - share);
  cv::add(pixels, color * share, pixels);
}

}  // namespace aquafarm_viz
