// SPDX-License-Identifier: BSD-3-Clause
// Sea layers below the farm, and rings that are not circles.
#include <gtest/gtest.h>

#include <stdexcept>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/markers/markers.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

constexpr ImageSize kSeaSize{800, 640};

/// Returns a ranch of 8 x 8 cells. The sea gets warmer to the north; the NE corner is unknown.
aquafarm_msgs::FarmSpec Warm() {
  aquafarm_msgs::FarmSpec spec = test::MakeSpec(8);
  spec.islands.clear();
  spec.rocks.clear();
  spec.ports.clear();
  std::string values;
  for (int i = 0; i < 64; ++i) {
    values += (i == 0 ? "[" : ", ") + (i == 63 ? std::string(".nan") : std::to_string(20 + i / 8));
  }
  spec.scenario_yaml =
      "seas:\n  layers:\n    - name: \"warmth\"\n      units: \"degC\"\n      values: " + values +
      "]\n";
  return spec;
}

cv::Vec3b At(const cv::Mat& picture, double x, double y) {
  const MapPlace place = PlaceMap(8, 8, kSeaSize);
  const cv::Point2d pixel = place.view.ToPixel(x, y);
  return picture.at<cv::Vec3b>(place.map.y + cvRound(pixel.y), place.map.x + cvRound(pixel.x));
}

Overlays With(const std::string& layers) {
  Overlays overlays;
  overlays.layers = ParseLayers(layers);
  return overlays;
}

TEST(SeaLayer, IsPaintedFromDarkToBrightBelowTheFarm) {
  const cv::Mat plain = DrawFarm(Warm(), test::MakeEmptyState(8), kSeaSize, With("none"));
  const cv::Mat warm = DrawFarm(Warm(), test::MakeEmptyState(8), kSeaSize, With("sea:warmth"));
  const auto brightness = [](const cv::Vec3b& pixel) { return pixel[0] + pixel[1] + pixel[2]; };
  EXPECT_NE(At(plain, 4, 1), At(warm, 4, 1));
  EXPECT_LT(brightness(At(warm, 4, 2)), brightness(At(warm, 4, 6)));
  EXPECT_EQ(At(plain, 7, 7), At(warm, 7, 7)) << "nothing is known there";
  FarmPainter painter(kSeaSize);
  painter.Draw(Warm(), test::MakeEmptyState(8), With("none"));
  EXPECT_EQ(At(painter.Draw(Warm(), test::MakeEmptyState(8), With("sea:warmth")), 4, 6),
            At(warm, 4, 6))
      << "the background follows the layer";
}

std::string Refused(const aquafarm_msgs::FarmSpec& spec, const std::string& layers) {
  try {
    DrawFarm(spec, test::MakeEmptyState(8), kSeaSize, With(layers));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "was drawn";
}

TEST(SeaLayer, ThatIsNotThereIsRefused) {
  EXPECT_EQ(Refused(Warm(), "sea:salt"),
            "layers: got 'sea:salt', expected one of the scenario's sea layers: warmth");
  EXPECT_EQ(Refused(test::MakeSpec(8), "sea:salt"),
            "layers: got 'sea:salt', but the scenario has no sea layers");
  EXPECT_EQ(Refused(Warm(), "sea:"),
            "layers: got 'sea:', expected some of: trail, risk, route, sight, values, moves, "
            "directions, labels, sea:NAME; or none");
  aquafarm_msgs::FarmSpec small = Warm();
  small.width = 7;
  EXPECT_EQ(Refused(small, "sea:warmth"), "layers: sea:warmth has another size than the farm");
}

TEST(SeaLayer, ThatWasRefusedIsRefusedAgain) {
  FarmPainter painter(kSeaSize);
  const cv::Mat warm = painter.Draw(Warm(), test::MakeEmptyState(8), With("sea:warmth")).clone();
  for (int i = 0; i < 2; ++i) {
    EXPECT_THROW(painter.Draw(Warm(), test::MakeEmptyState(8), With("sea:salt")),
                 std::invalid_argument)
        << i;
  }
  const cv::Mat again = painter.Draw(Warm(), test::MakeEmptyState(8), With("sea:warmth"));
  EXPECT_EQ(cv::norm(warm, again, cv::NORM_INF), 0.0) << "and what was drawn before is drawn whole";
}

/// Returns a state with a storm in the centre whose rings reach only to the north-east.
aquafarm_msgs::FarmState Lopsided() {
  aquafarm_msgs::FarmState state = test::MakeEmptyState(8);
  state.disasters.push_back(test::MakeDisaster(0, 3.5F, 3.5F));
  auto& storm = state.disasters[0];
  storm.radii = {3.0F};
  storm.risks = {-20.0F};
  storm.quadrants = {3.0F, 0.0F, 0.0F, 0.0F};
  return state;
}

TEST(Quadrants, AreShadedWhereTheyReach) {
  const cv::Mat calm = DrawFarm(Warm(), test::MakeEmptyState(8), kSeaSize, With("risk"));
  const cv::Mat storm = DrawFarm(Warm(), Lopsided(), kSeaSize, With("risk"));
  EXPECT_NE(At(storm, 5.2, 4.7), At(calm, 5.2, 4.7)) << "north-east";
  EXPECT_EQ(At(storm, 5.5, 2.0), At(calm, 5.5, 2.0)) << "south-east";
  EXPECT_EQ(At(storm, 1.5, 5.0), At(calm, 1.5, 5.0)) << "north-west";
}

TEST(Quadrants, AreBandsOfMarkersWhereTheyReach) {
  for (const auto& marker : StateMarkers(Warm(), Lopsided(), nullptr).markers) {
    if (marker.ns != "ring" || marker.action != 0) continue;
    ASSERT_FALSE(marker.points.empty());
    double farthest = 0.0;
    for (const auto& point : marker.points) {
      EXPECT_GE(point.x, -1e-6);
      EXPECT_GE(point.y, -1e-6);
      farthest = std::max(farthest, std::hypot(point.x, point.y));
    }
    EXPECT_NEAR(farthest, 3000.0, 1.0);
  }
}

TEST(Quadrants, ThatAreNotFourARingAreRefused) {
  aquafarm_msgs::FarmState state = Lopsided();
  state.disasters[0].quadrants.pop_back();
  EXPECT_NE(CheckState(state).find("quadrants.size: got 3, expected 0 or four per ring, 4"),
            std::string::npos);
}

}  // namespace
}  // namespace aquafarm_viz
