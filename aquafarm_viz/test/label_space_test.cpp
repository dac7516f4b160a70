// SPDX-License-Identifier: BSD-3-Clause
#include "draw/label_space.h"

#include <gtest/gtest.h>

#include "draw/symbols.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

const cv::Size kLabel(80, 16);

// A picture of 640 x 640 pixels with one island in its middle and a path along row 20.
struct LabelScene {
  LabelScene() {
    spec.islands = {test::MakeCell(12, 12)};
    spec.rocks.clear();
    state.ships.resize(1);
    for (int x = 0; x < 25; ++x) {
      state.step = std::uint64_t(x);
      state.ships[0].x = x;
      state.ships[0].y = 20;
      path.Update(state);
    }
  }
  LabelSpace Space() const {
    LabelSpace space(FreeSpace(layout.map.size()), spec, layout);
    space.BlockPaths(state, path, layout);
    return space;
  }
  cv::Point2d At(double x, double y) const { return layout.view.ToPixel(x, y); }

  aquafarm_msgs::FarmSpec spec = test::MakeSpec();
  aquafarm_msgs::FarmState state = test::MakeState();
  Trail path{Trail::kWhole};
  Layout layout = MakeLayout(25, 25, {640, 640});
};

TEST(LabelSpace, FindsPlacesByWhatALabelMayCover) {
  const LabelScene scene;
  const cv::Point2d island = scene.At(12, 12);
  const cv::Point2d path = scene.At(12, 20);
  const double near = 4.0;
  for (const Cover cover : {Cover::kNothing, Cover::kPaths, Cover::kPathsAndLand}) {
    EXPECT_TRUE(scene.Space().Take(cover, kLabel, scene.At(12, 5), near)) << "open water";
    EXPECT_EQ(scene.Space().Take(cover, kLabel, path, near).has_value(), cover != Cover::kNothing);
    EXPECT_EQ(scene.Space().Take(cover, kLabel, island, near).has_value(),
              cover == Cover::kPathsAndLand);
  }
}

TEST(LabelSpace, CoversLittleBeforeItCoversMore) {
  const LabelScene scene;
  const cv::Point2d path = scene.At(12, 20);
  LabelSpace space = scene.Space();
  const auto aside = space.Take(kLabel, path, 60.0);
  ASSERT_TRUE(aside);
  EXPECT_FALSE(aside->contains(cv::Point(path))) << "next to the path, not on it";
  const auto on_it = scene.Space().Take(kLabel, path, 4.0);
  ASSERT_TRUE(on_it);
  EXPECT_TRUE(on_it->contains(cv::Point(path))) << "nothing else is in reach";
}

TEST(LabelSpace, OfOneLabelIsUsedForAllOthersAndForLines) {
  const LabelScene scene;
  LabelSpace space = scene.Space();
  const auto first = space.Take(Cover::kNothing, kLabel, scene.At(12, 5), 4.0);
  ASSERT_TRUE(first);
  EXPECT_FALSE(space.space(Cover::kPathsAndLand).IsFree(*first));
  const cv::Point2d left = cv::Point2d(first->tl()) + cv::Point2d(-30.0, 8.0);
  const cv::Point2d right = cv::Point2d(first->br()) + cv::Point2d(30.0, -8.0);
  EXPECT_FALSE(space.AddLine(left, right, {}, 3)) << "across the label";
  EXPECT_TRUE(space.AddLine(left, right, *first, 3)) << "to the label";
  EXPECT_FALSE(space.space(Cover::kNothing).IsFree({cv::Point(left), cv::Size(1, 1)}));
}

}  // namespace
}  // namespace aquafarm_viz
