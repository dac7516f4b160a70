// SPDX-License-Identifier: BSD-3-Clause
// Colours under simulated colour blindness, in grey print, and the contrast of text.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "aquafarm_viz/draw/style.h"

namespace aquafarm_viz {
namespace {

// Machado, Oliveira and Fernandes (2009), doi:10.1109/TVCG.2009.113, severity 1.0, on linear RGB:
// normal vision, protanopia, deuteranopia, tritanopia.
const std::array<cv::Matx33d, 4> kVision{
    cv::Matx33d::eye(),
    {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998},
    {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881},
    {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900}};

double Linear(std::uint8_t value) {  // IEC 61966-2-1 (sRGB)
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

cv::Vec3d LinearOf(Rgb c) { return {Linear(c.r), Linear(c.g), Linear(c.b)}; }

// Relative luminance (WCAG 2.1).
double Luminance(Rgb c) { return LinearOf(c).dot({0.2126, 0.7152, 0.0722}); }

double Contrast(Rgb a, Rgb b) {
  const double x = Luminance(a) + 0.05;
  const double y = Luminance(b) + 0.05;
  return std::max(x, y) / std::min(x, y);
}

// CIELAB of a colour as seen with one of kVision.
cv::Vec3f Lab(Rgb color, const cv::Matx33d& vision) {
  const cv::Vec3d seen = vision * LinearOf(color);
  cv::Mat3f pixel(1, 1);
  for (int i = 0; i < 3; ++i) {
    const double v = std::clamp(seen[i], 0.0, 1.0);
    pixel(0, 0)[i] = float(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
  }
  cv::Mat3f lab;
  cv::cvtColor(pixel, lab, cv::COLOR_RGB2Lab);
  return lab(0, 0);
}

// Returns the smallest difference (CIE76) of two colours over all kinds of vision.
double Difference(Rgb a, Rgb b) {
  double least = 1e9;
  for (const cv::Matx33d& vision : kVision) {
    least = std::min(least, cv::norm(Lab(a, vision) - Lab(b, vision)));
  }
  return least;
}

class Colours : public testing::TestWithParam<const char*> {
 protected:
  const Style& style_ = StyleByName(GetParam());
};

TEST_P(Colours, OfRisksDifferForColourBlindPeople) {
  for (std::size_t i = 0; i < style_.risks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(Difference(style_.risks[i], style_.risks[j]), 10.0) << i << " and " << j;
    }
    for (const Rgb sea : {style_.sea_north, style_.sea_south}) {
      EXPECT_GT(Difference(style_.risks[i], sea), 25.0) << i << " and the sea";
    }
  }
}

TEST_P(Colours, OfDevicesDifferFromThoseOfRisks) {
  for (std::size_t i = 0; i < style_.risks.size(); ++i) {
    for (std::uint8_t kind = 0; kind < 4; ++kind) {
      EXPECT_GT(Difference(style_.risks[i], DeviceColor(kind)), 15.0)
          << "risk " << i << " and " << DeviceName(kind);
    }
  }
}

TEST_P(Colours, OfAChoiceDifferFromThoseOfRisksValuesAndTheSea) {
  for (std::size_t i = 0; i < style_.risks.size(); ++i) {
    EXPECT_GT(Difference(style_.risks[i], kChoiceColor), 15.0) << "risk " << i;
  }
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    EXPECT_GT(Difference(ValueColor(share), kChoiceColor), 15.0) << "value " << share;
  }
  EXPECT_GT(Difference(kChoiceColor, kInk), 40.0) << "its outline";
}

TEST(LightStyle, HasRisksThatGetDarkerInGreyPrint) {
  const auto& risks = LightStyle().risks;
  for (std::size_t i = 1; i < risks.size(); ++i) {
    EXPECT_GT(Lab(risks[i - 1], kVision[0])[0] - Lab(risks[i], kVision[0])[0], 8.0F) << i;
  }
}

TEST_P(Colours, OfTextHaveTheContrastOfWcagAA) {
  std::vector<Rgb> texts{style_.words, style_.faint, style_.good, style_.bad};
  texts.insert(texts.end(), style_.grades.begin(), style_.grades.end());
  for (const double severity : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}) {
    texts.push_back(style_.RiskText(severity));
  }
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_GE(Contrast(texts[i], style_.panel), 4.5) << i;
  }
  EXPECT_GE(Contrast(style_.label, style_.halo), 7.0);
}

INSTANTIATE_TEST_SUITE_P(Styles, Colours, testing::Values("dark", "light"));

TEST(ShipColours, DifferForColourBlindPeople) {
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      EXPECT_GT(Difference(ShipColor(i), ShipColor(j)), 10.0) << i << " and " << j;
    }
  }
}

TEST(Styles, AreDarkAndLight) {
  EXPECT_LT(Luminance(DarkStyle().panel), 0.05);
  EXPECT_GT(Luminance(LightStyle().panel), 0.9);
  try {
    StyleByName("blue");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "style: got 'blue', expected dark or light");
  }
}

}  // namespace
}  // namespace aquafarm_viz
