// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace aquafarm_viz {
namespace {

class AnyFont : public testing::TestWithParam<bool> {
 protected:
  Font font_{14, GetParam() ? FindFontFile(false) : ""};
};

TEST_P(AnyFont, DrawsAtTheGivenPosition) {
  cv::Mat image(40, 200, CV_8UC3, cv::Scalar::all(0));
  const int width = font_.Draw(image, "step 17", {20, 30}, cv::Scalar::all(255));
  EXPECT_EQ(width, font_.Width("step 17"));
  cv::Mat grey;
  cv::extractChannel(image, grey, 0);
  EXPECT_GT(cv::countNonZero(grey(cv::Rect(20, 30 - font_.cap_height(), width, 18))), 50);
  EXPECT_EQ(cv::countNonZero(grey(cv::Rect(0, 0, 18, 40))), 0);
  EXPECT_EQ(cv::countNonZero(grey(cv::Rect(24 + width, 0, 200 - 24 - width, 40))), 0);
}

TEST_P(AnyFont, CutsWhatIsTooWide) {
  const std::string cut = font_.Fit("a scenario with a very long name", 90);
  EXPECT_LE(font_.Width(cut), 90);
  EXPECT_EQ(cut.substr(0, 3), "a s");
  EXPECT_EQ(cut.substr(cut.size() - 3), "…");
  EXPECT_EQ(font_.Fit("short", 90), "short");
}

TEST_P(AnyFont, SurvivesAnyBytesAnywhere) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar::all(0));
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<char>(i));
  for (const cv::Point at : {cv::Point(-500, -500), {-3, 10}, {10, 3}, {500, 500}}) {
    font_.Draw(image, bytes, at, cv::Scalar::all(255));
    font_.Draw(image, "\xf0\x9f", at, cv::Scalar::all(255));
  }
  EXPECT_GT(font_.Width(bytes), 0);
}

INSTANTIATE_TEST_SUITE_P(InstalledAndStrokes, AnyFont, testing::Bool());

TEST(Number, IsWrittenAsPeopleDo) {
  EXPECT_EQ(Number(-42.549, 1), "-42.5");
  EXPECT_EQ(Number(-0.01, 1), "0.0");
  EXPECT_EQ(Number(0.0, 0), "0");
  EXPECT_EQ(Number(std::numeric_limits<double>::quiet_NaN(), 1), "-");
  EXPECT_EQ(Number(std::numeric_limits<double>::infinity(), 1), "-");
  EXPECT_EQ(Number(3e38, 1), "3.0e+38");
}

TEST(Count, HasCommasBetweenThousands) {
  EXPECT_EQ(Count(0), "0");
  EXPECT_EQ(Count(999), "999");
  EXPECT_EQ(Count(1000), "1,000");
  EXPECT_EQ(Count(1234567), "1,234,567");
}

TEST(SeedText, NamesTheSeedsOfEvaluationEpisodesAsCommandsDo) {
  EXPECT_EQ(SeedText(7), "7");
  EXPECT_EQ(SeedText(9223372036854776808U), "evaluation 1000");
}

TEST(Text, FormatsAFractionBelowOneAsLessThan100Percent) {
  EXPECT_EQ(Percent(1.0), "100 %");
  EXPECT_EQ(Percent(0.997), "99 %");
  EXPECT_EQ(Percent(0.956), "96 %");
  EXPECT_EQ(Percent(0.0), "0 %");
  EXPECT_EQ(Percent(std::nan("")), "-");
}

}  // namespace
}  // namespace aquafarm_viz
