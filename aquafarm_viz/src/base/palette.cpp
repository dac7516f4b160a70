// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/base/palette.h"

#include <aquafarm_msgs/DeviceState.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DeviceState;

std::vector<cv::Point2f> RegularPolygon(int corners, double radius, double first_deg) {
  std::vector<cv::Point2f> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = first_deg * CV_PI / 180.0 + 2.0 * CV_PI * i / corners;
    points.emplace_back(static_cast<float>(radius * std::cos(angle)),
                        static_cast<float>(radius * std::sin(angle)));
  }
  return points;
}

}  // namespace

Rgb Mix(Rgb from, Rgb to, double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const auto mix = [s](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * s));
  };
  return {mix(from.r, to.r), mix(from.g, to.g), mix(from.b, to.b)};
}

Rgb DeviceColor(std::uint8_t kind) {
  switch (kind) {
    case DeviceState::TEMPORARY_BREEDING:
      return {0xe8, 0xdc, 0xc8};
    case DeviceState::MONITORING:
      return {0xa8, 0xe6, 0xa0};
    case DeviceState::BREEDING_RELEASE:
      return {0xc4, 0xc4, 0xff};
    case DeviceState::DEEP_WATER_BREEDING:
      return {0x7f, 0xd4, 0xd4};
    default:
      return kUnknown;
  }
}

std::string DeviceName(std::uint8_t kind) {
  switch (kind) {
    case DeviceState::TEMPORARY_BREEDING:
      return "temporary";
    case DeviceState::MONITORING:
      return "monitoring";
    case DeviceState::BREEDING_RELEASE:
      return "release";
    case DeviceState::DEEP_WATER_BREEDING:
      return "deep water";
    default:
      return "kind " + std::to_string(kind);
  }
}

const std::vector<cv::Point2f>& DeviceOutline(std::uint8_t kind) {
  static const std::array<std::vector<cv::Point2f>, 5> kOutlines{
      RegularPolygon(4, 1.0, 45.0), RegularPolygon(3, 1.0, 90.0), RegularPolygon(6, 0.95, 0.0),
      RegularPolygon(28, 0.88, 0.0), RegularPolygon(4, 0.9, 0.0)};
  return kOutlines[std::min<std::size_t>(kind, kOutlines.size() - 1)];
}

Rgb HealthColor(double health) {
  constexpr Rgb kGood{0x3d, 0xdc, 0x6f};
  constexpr Rgb kFair{0xff, 0xc2, 0x2e};
  constexpr Rgb kBad{0xf0, 0x3e, 0x3e};
  const double h = std::clamp(health, 0.0, 1.0);
  return h < 0.5 ? Mix(kBad, kFair, 2.0 * h) : Mix(kFair, kGood, 2.0 * h - 1.0);
}

Rgb ShipColor(std::int32_t id) {
  // Five colours of Okabe and Ito (2008), jfly.uni-koeln.de/color, which colour-blind people can
  // distinguish, and dark grey.
  static constexpr std::array<Rgb, 6> kDecks{{{0xd5, 0x5e, 0x00},
                                              {0x00, 0x72, 0xb2},
                                              {0x00, 0x9e, 0x73},
                                              {0xcc, 0x79, 0xa7},
                                              {0xe6, 0x9f, 0x00},
                                              {0x30, 0x30, 0x30}}};
  return kDecks[static_cast<std::uint32_t>(id) % kDecks.size()];
}

const std::vector<cv::Point2f>& HullOutline() {
  static const std::vector<cv::Point2f> kHull{{0.0F, 1.0F},    {-0.25F, 0.68F},  {-0.42F, 0.2F},
                                              {-0.44F, -0.3F}, {-0.34F, -0.92F}, {0.34F, -0.92F},
                                              {0.44F, -0.3F},  {0.42F, 0.2F},    {0.25F, 0.68F}};
  return kHull;
}

const std::vector<cv::Point2f>& PointerOutline() {
  // Long and notched, so that its direction is clear.
  static const std::vector<cv::Point2f> kPointer{
      {0.0F, 1.25F}, {-0.65F, -0.85F}, {0.0F, -0.4F}, {0.65F, -0.85F}};
  return kPointer;
}

double Severity(double risk) { return std::clamp((-risk - 5.0) / 15.0, 0.0, 1.0); }

Rgb SeverityColor(double severity) {
  static constexpr std::array<Rgb, 4> kScale{
      {{0xff, 0xd4, 0x3b}, {0xff, 0x92, 0x2b}, {0xe0, 0x31, 0x31}, {0xe6, 0x4f, 0xe0}}};
  const double at = std::clamp(severity, 0.0, 1.0) * (kScale.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kScale.size() - 2);
  return Mix(kScale[i], kScale[i + 1], at - static_cast<double>(i));
}

Rgb GradeColor(std::uint8_t grade) {
  static constexpr std::array<Rgb, 4> kGrades{
      {{0x33, 0x8d, 0xf0}, {0xfc, 0xd5, 0x2b}, {0xfd, 0x7e, 0x14}, {0xe0, 0x31, 0x31}}};
  return grade >= 1 && grade <= kGrades.size() ? kGrades[grade - 1U] : kUnknown;
}

Rgb ValueColor(double share) {
  static const cv::Mat3b kColors = [] {
    cv::Mat1b ramp(1, 256);
    for (int i = 0; i < ramp.cols; ++i) ramp(0, i) = static_cast<std::uint8_t>(i);
    cv::Mat3b colors;
    cv::applyColorMap(ramp, colors, cv::COLORMAP_VIRIDIS);
    return colors;
  }();
  constexpr double kLast = 0.8 * 255.0;
  const auto i = static_cast<int>(std::lround(kLast * std::clamp(share, 0.0, 1.0)));
  const cv::Vec3b& bgr = kColors(0, i);
  return {bgr[2], bgr[1], bgr[0]};
}

int MoveBearingDeg(std::uint8_t action) {
  static constexpr std::array<int, 8> kBearings{0, 180, 270, 90, 315, 45, 225, 135};
  return action < kBearings.size() ? kBearings[action] : -1;
}

std::string CompassPoint(int bearing_deg) {
  static constexpr std::array<const char*, 16> kPoints{"N",  "NNE", "NE", "ENE", "E",  "ESE",
                                                       "SE", "SSE", "S",  "SSW", "SW", "WSW",
                                                       "W",  "WNW", "NW", "NNW"};
  const int in_circle = ((bearing_deg % 360) + 360) % 360;
  return kPoints[static_cast<std::size_t>(((4 * in_circle + 45) / 90) % 16)];
}

std::string PortLetter(std::int32_t id) {
  std::string letters;
  for (std::int32_t rest = std::max(id, 0); rest >= 0; rest = rest / 26 - 1) {
    letters.insert(letters.begin(), static_cast<char>('A' + rest % 26));
  }
  return letters;
}

}  // namespace aquafarm_viz
