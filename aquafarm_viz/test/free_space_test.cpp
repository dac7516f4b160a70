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

}  // namespace
}  // namespace aquafarm_viz
