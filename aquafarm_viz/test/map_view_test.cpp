// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/map_view.h"

#include <gtest/gtest.h>

#include "aquafarm_viz/draw/image.h"

namespace aquafarm_viz {
namespace {

TEST(MapView, NorthIsUp) {
  const MapView view(10, 8, 20.0);
  EXPECT_LT(view.ToPixel(3, 7).y, view.ToPixel(3, 0).y);
}

TEST(MapView, EastIsRight) {
  const MapView view(10, 8, 20.0);
  EXPECT_GT(view.ToPixel(9, 0).x, view.ToPixel(0, 0).x);
}

TEST(MapView, CornerCellsLieInTheCornersOfTheMap) {
  const MapView view(10, 8, 20.0);
  EXPECT_DOUBLE_EQ(view.ToPixel(0, 0).x, 9.5);
  EXPECT_DOUBLE_EQ(view.ToPixel(0, 0).y, 8 * 20.0 - 10.5);
  EXPECT_DOUBLE_EQ(view.ToPixel(9, 7).x, 10 * 20.0 - 10.5);
  EXPECT_DOUBLE_EQ(view.ToPixel(9, 7).y, 9.5);
}

struct Case {
  int width;
  int height;
  ImageSize size;
};

class PlaceMapOf : public testing::TestWithParam<Case> {};

TEST_P(PlaceMapOf, KeepsTheWholeMapInThePictureWithSquareCells) {
  const auto [width, height, size] = GetParam();
  const MapPlace place = PlaceMap(width, height, size);
  EXPECT_EQ(place.map & cv::Rect(0, 0, size.width, size.height), place.map);
  EXPECT_NEAR(place.map.width, std::max(1.0, place.view.cell_px() * width), 1.0);
  EXPECT_NEAR(place.map.height, std::max(1.0, place.view.cell_px() * height), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PlaceMapOf,
                         testing::Values(Case{10, 10, {640, 640}}, Case{25, 25, {640, 640}},
                                         Case{500, 500, {640, 640}}, Case{25, 25, {1920, 1080}},
                                         Case{1, 4096, {640, 640}}, Case{4096, 1, {800, 640}},
                                         Case{1, 1, {160, 160}}, Case{300, 20, {160, 4096}}));

}  // namespace
}  // namespace aquafarm_viz
