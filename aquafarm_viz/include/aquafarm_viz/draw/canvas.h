// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Draws anti-aliased shapes with sub-pixel positions on 8-bit BGR images.

#include <opencv2/core.hpp>
#include <vector>

#include "aquafarm_viz/base/palette.h"

namespace aquafarm_viz {

/// Pose of an outline in an image. In the outline, y points up, and the bow points to +y (north).
struct Pose2 {
  cv::Point2d at;        ///< position of the outline's origin in the image [pixels]
  double size_px{1.0};   ///< pixels per unit of the outline
  double bearing_deg{};  ///< rotation, clockwise from north
};

/// Number of fractional bits of fixed-point coordinates. OpenCV's drawing functions call this
/// number `shift`. Such coordinates have a resolution of 1/16 pixel.
inline constexpr int kSubPixelBits = 4;
/// Converts an image point [pixels] to fixed-point coordinates. Coordinates beyond +-1e6 pixels are
/// clamped.
cv::Point Fixed(cv::Point2d point);

/// Converts a point of an outline to pixels of the image.
cv::Point2d Place(cv::Point2d point, const Pose2& placing);

/// Fills an outline, which need not be convex.
void FillShape(cv::Mat& image, const std::vector<cv::Point2f>& outline, const Pose2& placing,
               const cv::Scalar& color);

/// Draws the edge of an outline, `thickness` pixels wide.
void StrokeShape(cv::Mat& image, const std::vector<cv::Point2f>& outline, const Pose2& placing,
                 const cv::Scalar& color, int thickness);

/// Fills a circle.
void FillCircle(cv::Mat& image, cv::Point2d centre, double radius_px, const cv::Scalar& color);

/// Draws a circle's edge, `thickness` pixels wide.
void StrokeCircle(cv::Mat& image, cv::Point2d centre, double radius_px, const cv::Scalar& color,
                  int thickness);

/// Draws a straight line.
void DrawLine(cv::Mat& image, cv::Point2d from, cv::Point2d to, const cv::Scalar& color,
              int thickness);

/// Blends a colour over a part of the image: `share` 0 changes nothing, 1 replaces the part.
void Tint(cv::Mat& image, cv::Rect part, const cv::Scalar& color, double share);

}  // namespace aquafarm_viz
