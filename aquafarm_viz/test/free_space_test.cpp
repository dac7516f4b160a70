// SPDX-License-Identifier: BSD-3-Clause
#include "draw/free_space.h"

#include <gtest/gtest.h>

namespace aquafarm_viz {
namespace {

TEST(FreeSpace, ReturnsPlacesThatCoverNeitherUsedPartsNorEachOther) {
  FreeSpace space({300, 200});
  const cv::Rect used(120, 60, 60, 60);
  space.Block(used);
  std::vector<cv::Rect> places;
  for (int i = 0; i < 40; ++i) {
    const auto place = space.Take({40, 12}, {150.0, 90.0}, 500.0);
    if (!place) break;
    EXPECT_EQ((*place & used).area(), 0);
    for (const cv::Rect& other : places) EXPECT_EQ((*place & other).area(), 0);
    EXPECT_EQ(*place & cv::Rect(0, 0, 300, 200), *place);
    places.push_back(*place);
  }
  EXPECT_GT(places.size(), 20U);
}

TEST(FreeSpace, OfACopyIsItsOwn) {
  FreeSpace space({300, 200});
  FreeSpace copy = space;
  copy.Block({10, 10, 20, 20});
  EXPECT_TRUE(space.IsFree({10, 10, 20, 20}));
  EXPECT_FALSE(copy.IsFree({10, 10, 20, 20}));
}

TEST(FreeSpace, KnowsWhatIsFreeAndWhichLabelALineCrosses) {
  FreeSpace space({300, 200});
  EXPECT_TRUE(space.IsFree({10, 10, 20, 20}));
  EXPECT_FALSE(space.IsFree({290, 10, 20, 20})) << "partly outside";
  const cv::Rect label = *space.Take({40, 12}, {150.0, 100.0}, 20.0);
  EXPECT_FALSE(space.IsFree(label));
  EXPECT_TRUE(space.CrossesLabel({150.0, 20.0}, {150.0, 180.0}, {}));
  EXPECT_FALSE(space.CrossesLabel({150.0, 20.0}, {150.0, 180.0}, label)) << "its own";
  EXPECT_FALSE(space.CrossesLabel({20.0, 20.0}, {20.0, 180.0}, {}));
  space.BlockLine({20.0, 20.0}, {20.0, 180.0}, 3);
  EXPECT_FALSE(space.IsFree({10, 90, 20, 10}));
}

TEST(FreeSpace, TakesTheNearestPlaceThatCoversNothing) {
  FreeSpace space({300, 200});
  const cv::Rect symbol(100, 80, 40, 40);
  space.Block(symbol);
  const auto first = space.Take({30, 12}, {120.0, 100.0}, 100.0);
  ASSERT_TRUE(first);
  EXPECT_EQ((*first & symbol).area(), 0);
  const auto second = space.Take({30, 12}, {120.0, 100.0}, 100.0);
  ASSERT_TRUE(second);
  EXPECT_EQ((*second & symbol).area(), 0);
  EXPECT_EQ((*second & *first).area(), 0);
  EXPECT_FALSE(space.Take({30, 12}, {120.0, 100.0}, 5.0)) << "out of reach";
  EXPECT_FALSE(space.Take({400, 12}, {120.0, 100.0}, 1e4)) << "wider than the map";
  space.Block({-50, -50, 1000, 1000});
  EXPECT_FALSE(space.Take({3, 3}, {120.0, 100.0}, 1e4));
}

}  // namespace
}  // namespace aquafarm_viz
