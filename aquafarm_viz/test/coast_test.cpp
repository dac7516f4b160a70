// SPDX-License-Identifier: BSD-3-Clause
#include "scene/coast.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "fixture.h"

namespace aquafarm_viz {
namespace {

// A farm of cells of 1 km whose cell (0, 0) is at a position.
aquafarm_msgs::FarmSpec FarmAt(double latitude, double longitude) {
  auto spec = test::MakeSpec();
  spec.has_origin = true;
  spec.origin_latitude_deg = latitude;
  spec.origin_longitude_deg = longitude;
  return spec;
}

// Returns whether a point [cells] is on land: in an odd number of rings.
bool IsLand(const std::vector<CoastRing>& coast, float x, float y) {
  int count = 0;
  for (const CoastRing& ring : coast) {
    const std::vector<cv::Point2f> corners(ring.corners.begin(), ring.corners.end());
    count += cv::pointPolygonTest(corners, cv::Point2f(x, y), false) > 0.0 ? 1 : 0;
  }
  return count % 2 == 1;
}

bool IsLandAt(double latitude, double longitude) {
  return IsLand(CoastAround(FarmAt(latitude, longitude)), 0.0F, 0.0F);
}

TEST(Coast, HasLandAndSeaWhereTheyAre) {
  EXPECT_TRUE(IsLandAt(30.27, 120.15)) << "Hangzhou";
  EXPECT_TRUE(IsLandAt(23.7, 120.9)) << "Taiwan";
  EXPECT_TRUE(IsLandAt(-17.8, 178.0)) << "Viti Levu, near the date line";
  EXPECT_TRUE(IsLandAt(67.0, -176.0)) << "Chukotka, beyond the date line";
  EXPECT_TRUE(IsLandAt(45.5, -70.0)) << "Maine";
  EXPECT_TRUE(IsLandAt(-25.0, 133.0)) << "Australia";
  EXPECT_FALSE(IsLandAt(30.15, 124.0)) << "East China Sea";
  EXPECT_FALSE(IsLandAt(35.5, 123.0)) << "Yellow Sea";
  EXPECT_FALSE(IsLandAt(-18.0, -179.5)) << "Koro Sea, beyond the date line";
  EXPECT_FALSE(IsLandAt(40.0, -40.0)) << "Atlantic";
}

TEST(Coast, IsAtTheRightDistance) {
  const auto coast = CoastAround(FarmAt(30.15, 122.65));  // one cell: 1 km
  EXPECT_TRUE(IsLand(coast, -240.0F, 15.0F)) << "Hangzhou, 240 km west";
  EXPECT_TRUE(IsLand(coast, -180.0F, -710.0F)) << "Taiwan, 710 km south";
  EXPECT_FALSE(IsLand(coast, 300.0F, 0.0F)) << "East China Sea";
  EXPECT_FALSE(IsLand(coast, 3000.0F, 0.0F)) << "Pacific";
  EXPECT_FALSE(IsLand(coast, 2500.0F, -2500.0F)) << "Pacific, south-east";
}

TEST(Coast, NeedsAPosition) {
  EXPECT_TRUE(CoastAround(test::MakeSpec()).empty());
  for (const CoastRing& ring : CoastAround(FarmAt(30.15, 122.65))) {
    ASSERT_GE(ring.corners.size(), 3U);
    const cv::Rect2d box(ring.box.tl() - cv::Point2d(0.1, 0.1),
                         ring.box.size() + cv::Size2d(0.2, 0.2));
    for (const cv::Point2d& corner : ring.corners) EXPECT_TRUE(box.contains(corner));
  }
}

}  // namespace
}  // namespace aquafarm_viz
