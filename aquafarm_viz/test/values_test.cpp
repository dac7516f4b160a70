// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/scene/values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "aquafarm_viz/draw/image.h"
#include "draw/free_space.h"
#include "draw/symbols.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

using visualization_msgs::Marker;

TEST(Values, AreReadByCellWithTheirRange) {
  const Values values = ReadValues(test::MakeCloud(), test::MakeSpec());
  EXPECT_EQ(values.values[values.Index(3, 4)], 7.0F);
  EXPECT_EQ(values.actions[values.Index(3, 4)], 5);
  EXPECT_EQ(values.lowest, 0.0F);
  EXPECT_EQ(values.highest, 48.0F);
}

TEST(Values, FarFromZeroHaveTheColoursOfTheirDifferences) {
  const auto drawn = [](float lowest) {
    Values values;
    values.width = 3;
    values.height = 1;
    values.lowest = lowest;
    values.highest = lowest + 4.0F;
    values.values = {lowest, lowest + 1.0F, lowest + 4.0F};
    cv::Mat map(10, 30, CV_8UC3, cv::Scalar::all(0));
    DrawValues(map, {}, values, MakeLayout(3, 1, {64, 64}));
    return map;
  };
  EXPECT_EQ(cv::norm(drawn(0.0F), drawn(-1.0e7F), cv::NORM_INF), 0.0);
}

TEST(Values, LeaveRocksGrey) {
  auto spec = test::MakeSpec(8);
  spec.rocks.resize(1);
  spec.rocks.front().cell = test::MakeCell(3, 4);
  Values values;
  values.width = values.height = 8;
  values.highest = 1.0F;
  values.values.assign(64, 0.0F);
  values.values[4 * 8 + 3] = std::numeric_limits<float>::quiet_NaN();
  const Layout layout = MakeLayout(8, 8, {400, 400});
  cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar(255, 0, 0));
  DrawValues(map, spec, values, layout);
  const cv::Point2d corner =
      layout.view.ToPixel(3, 4) + cv::Point2d(0.42, 0.42) * layout.view.cell_px();
  const auto grey = map.at<cv::Vec3b>(cv::Point(corner));
  EXPECT_LT(int(grey[0]), 240) << "not the blue of the map";
  EXPECT_GT(int(grey[2]), 60);
}

TEST(Values, AreVisibleInsideRings) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeEmptyState();
  const Values values = ReadValues(test::MakeCloud(), spec);
  const auto at_centre = [&](const char* layers) {
    Overlays overlays;
    overlays.values = &values;
    overlays.layers = ParseLayers(layers);
    const ImageSize size{640, 640};
    const Layout layout = MakeLayout(spec.width, spec.height, size);
    const cv::Mat map = DrawFarm(spec, state, size, overlays)(layout.map);
    const cv::Point at(layout.view.ToPixel(11, 15));
    return map(cv::Rect(at.x - 6, at.y - 6, 12, 12)).clone();
  };
  const cv::Mat values_alone = at_centre("risk,values");
  const cv::Mat sea_alone = at_centre("risk");
  state.disasters = {test::MakeDisaster(0, 11.0F, 12.0F)};
  state.disasters[0].radii = {8.0F};
  state.disasters[0].risks = {-5.0F};
  EXPECT_EQ(cv::norm(at_centre("risk,values"), values_alone, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(at_centre("risk"), sea_alone, cv::NORM_INF), 0.0) << "a pattern and a tint";
}

TEST(Values, LeavesOutInvalidCellsActionsAndNumbers) {
  auto cloud = test::MakeCloud();
  sensor_msgs::PointCloud2Iterator<float> at(cloud, "x");
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "value");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> action(cloud, "action");
  at[0] = -5000.0F;  // cell (0, 0)
  ++at;
  at[0] = std::numeric_limits<float>::quiet_NaN();  // (1, 0)
  value += 2;
  *value = std::numeric_limits<float>::infinity();  // (2, 0)
  action += 3;
  *action = 200;  // (3, 0)
  const Values values = ReadValues(cloud, test::MakeSpec());
  EXPECT_TRUE(std::isnan(values.values[0]));
  EXPECT_EQ(values.actions[0], Values::kNoAction);
  EXPECT_TRUE(std::isnan(values.values[1]));
  EXPECT_TRUE(std::isnan(values.values[2]));
  EXPECT_EQ(values.actions[2], 5);
  EXPECT_EQ(values.actions[3], Values::kNoAction);
  EXPECT_EQ(values.highest, 48.0F);
}

std::string FaultOf(const std::function<void(sensor_msgs::PointCloud2&)>& spoil) {
  auto cloud = test::MakeCloud();
  spoil(cloud);
  try {
    ReadValues(cloud, test::MakeSpec());
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

TEST(Values, RefusesACloudOfAnotherKind) {
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.fields.pop_back(); }),
            "values/points: got no field action, expected x, y, value and action");
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.fields[0].datatype = 8; }),
            "values/points: field x: got type 8 at byte 0, expected type 7 within point_step");
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.fields[3].offset = 4000000000U; }),
            "values/points: field value: got type 7 at byte 4000000000, expected type 7 within "
            "point_step");
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.data.resize(100); }),
            "values/points: got 100 bytes, expected 625 x 1 points of 17");
  EXPECT_EQ(FaultOf([](auto& cloud) {
              cloud.width = cloud.height = 1U << 31U;
              cloud.point_step = 32;  // the product of 2^67 bytes overflows 64 bits
              cloud.data.clear();
            }),
            "values/points: got 0 bytes, expected 2147483648 x 2147483648 points of 32");
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.fields[3].offset = 4294967294U; }),
            "values/points: field value: got type 7 at byte 4294967294, expected type 7 within "
            "point_step");
  EXPECT_EQ(FaultOf([](auto& cloud) { cloud.point_step = 0; }),
            "values/points: field x: got type 7 at byte 0, expected type 7 within point_step");
}

// Max difference of a colour channel, in [0, 255]. An edge is blended from many strokes, and OpenCV
// rounds after each stroke. A cached drawing is blended and rounded only once.
constexpr double kRounding = 12.0;

// A painter caches the drawing of values. It must never show the cache for other values.
TEST(Values, APainterDrawsThemAsOneThatHasDrawnNothingElse) {
  using Farms = std::vector<const aquafarm_msgs::FarmSpec*>;
  using Maps = std::vector<const Values*>;
  const auto spec = test::MakeSpec();
  auto other = spec;
  other.rocks.clear();
  const auto state = test::MakeState();
  const Values values = ReadValues(test::MakeCloud(), spec);
  Values changed = values;
  changed.values[changed.Index(20, 3)] = std::nanf("");
  Values turned = changed;
  turned.actions[turned.Index(4, 22)] = 2;  // a cell whose move is shown
  FarmPainter painter({640, 640});
  const auto draw = [&state](FarmPainter& with, const auto& farm, const Values* of,
                             const char* layers) {
    return with.Draw(farm, state, {nullptr, nullptr, nullptr, ParseLayers(layers), of}).clone();
  };
  for (const char* layers : {"risk,values,moves", "moves", "risk,values"}) {
    for (const auto* farm : Farms{&spec, &other, &spec}) {
      for (const Values* of : Maps{&values, &values, &changed, &turned, nullptr, &turned}) {
        FarmPainter fresh({640, 640});
        const cv::Mat picture = draw(painter, *farm, of, layers);
        EXPECT_LE(cv::norm(picture, draw(fresh, *farm, of, layers), cv::NORM_INF), kRounding);
      }
      FarmPainter away({640, 640});
      EXPECT_GT(cv::norm(draw(painter, *farm, &turned, layers), draw(away, *farm, &values, layers),
                         cv::NORM_INF),
                2 * kRounding);
      draw(painter, farm == &spec ? other : spec, nullptr, layers);  // with a different background
    }
  }
}

// If the size of a cell is an integer, cached symbols are at the exact position. If not, they are
// at the nearest pixel.
TEST(Values, SignsPutOnAMapAreThoseDrawnOnIt) {
  for (const int side : {10, 25, 33, 100, 500}) {
    auto values = ReadValues(test::MakeCloud(side), test::MakeSpec(side));
    for (std::size_t i = 0; i < values.actions.size(); ++i) values.actions[i] = i % 12;
    const Layout layout = MakeLayout(side, side, {640, 640});
    cv::Mat3b drawn(layout.map.size());
    cv::RNG rng(1);
    rng.fill(drawn, cv::RNG::UNIFORM, 0, 256);
    const cv::Mat below = drawn.clone();
    cv::Mat put = drawn.clone();
    const MoveSigns signs(layout);
    signs.Draw(put, values);
    for (const cv::Point cell : ShownActions(values, signs.every())) {
      DrawMove(drawn, layout.view.ToPixel(cell.x, cell.y),
               values.actions[values.Index(cell.x, cell.y)], signs.size_px(), layout);
    }
    const auto apart = [&drawn](const cv::Mat& other) {
      return cv::norm(other, drawn, cv::NORM_L1) / double(3 * other.total());
    };
    EXPECT_GT(apart(below), 2.0) << side;
    if (layout.view.cell_px() == std::floor(layout.view.cell_px())) {
      EXPECT_LE(cv::norm(put, drawn, cv::NORM_INF), kRounding) << side;
      EXPECT_LE(apart(put), 0.25) << side;
    } else {
      EXPECT_LE(apart(put), 0.4 * apart(below)) << side;
    }
  }
}

TEST(Values, BestMovesAreOneMarkerAKindWithStableIds) {
  auto values = ReadValues(test::MakeCloud(), test::MakeSpec());
  values.actions[0] = 8;
  const auto array = MoveMarkers(values, test::MakeSpec());
  ASSERT_EQ(array.markers.size(), 4U);
  const auto& cells = array.markers[3];
  EXPECT_EQ(cells.ns, "values");
  ASSERT_EQ(cells.points.size(), 25U * 25U * 6U);
  ASSERT_EQ(cells.colors.size(), cells.points.size());
  // Viridis (matplotlib) without its last fifth: dark violet at the lowest value, green (0x7ad151)
  // at the highest.
  EXPECT_LT(cells.colors.front().g, 0.1F);
  EXPECT_NEAR(cells.colors.back().r, 0x7a / 255.0, 0.02);
  EXPECT_NEAR(cells.colors.back().g, 0xd1 / 255.0, 0.02);
  EXPECT_EQ(cells.points.front().x, -500.0);
  EXPECT_EQ(array.markers[0].points.size(), 12U * 12U * 9U) << "every second cell";
  EXPECT_EQ(array.markers[1].points.size(), 24U) << "the frame of one cell";
  EXPECT_EQ(array.markers[2].action, Marker::DELETE);
  for (int id = 0; id < 3; ++id) {
    EXPECT_EQ(array.markers[std::size_t(id)].ns, "moves");
    EXPECT_EQ(array.markers[std::size_t(id)].id, id);
    EXPECT_TRUE(array.markers[std::size_t(id)].lifetime.isZero());
  }
}

TEST(Values, ArrowsLeaveTheMapReadable) {
  for (const int side : {10, 25, 100, 500}) {
    const auto spec = test::MakeSpec(side);
    const Values values = ReadValues(test::MakeCloud(side), spec);
    const auto arrows = MoveMarkers(values, spec).markers[0].points.size() / 9U;
    EXPECT_LE(arrows, 13U * 13U) << side;
    EXPECT_GE(arrows, 36U) << side;
    for (const ImageSize size : {ImageSize{640, 640}, {1280, 720}}) {
      const Layout layout = MakeLayout(side, side, size);
      const MoveSigns signs(layout);
      EXPECT_GE(signs.every() * layout.view.cell_px(), 34.0 * layout.unit) << side;
      EXPECT_LE(signs.size_px(), 0.8 * signs.every() * layout.view.cell_px()) << side;
    }
  }
}

TEST(Values, AFewPickupsAreShownWhereverTheyAre) {
  Values values = ReadValues(test::MakeCloud(), test::MakeSpec());
  const auto pickups = [&values] {
    std::size_t count = 0;
    for (const cv::Point cell : ShownActions(values, 5)) {
      count += values.actions[values.Index(cell.x, cell.y)] == 8 ? 1U : 0U;
    }
    return count;
  };
  for (int x = 0; x < 12; ++x) values.actions[values.Index(x, 3)] = 8;
  EXPECT_EQ(pickups(), 12U);
  for (int x = 0; x < 13; ++x) values.actions[values.Index(x, 3)] = 8;
  EXPECT_EQ(pickups(), 0U) << "only the regular cells";
}

TEST(Values, SignsCoverNothingThatUsesTheMap) {
  const auto values = ReadValues(test::MakeCloud(), test::MakeSpec());
  const Layout layout = MakeLayout(25, 25, {640, 640});
  FreeSpace space(layout.map.size());
  const cv::Rect used(100, 100, 150, 80);
  space.Block(used);
  cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(90));
  MoveSigns(layout).Draw(map, values, &space);
  EXPECT_EQ(cv::norm(map(used), cv::Mat(used.size(), CV_8UC3, cv::Scalar::all(90))), 0.0);
  EXPECT_GT(cv::norm(map - cv::Scalar::all(90)), 1000.0);
}

TEST(Values, AnArrowPointsWhereTheMoveGoes) {
  auto values = ReadValues(test::MakeCloud(10), test::MakeSpec(10));
  const auto tip = [&](std::uint8_t action) {
    values.actions[0] = action;
    const auto point = MoveMarkers(values, test::MakeSpec(10)).markers[0].points[8];
    return cv::Point2d(point.x, point.y);
  };
  EXPECT_NEAR(tip(0).y, 360.0, 1e-6);   // N
  EXPECT_NEAR(tip(1).y, -360.0, 1e-6);  // S
  EXPECT_NEAR(tip(2).x, -360.0, 1e-6);  // W
  EXPECT_NEAR(tip(3).x, 360.0, 1e-6);   // E
  EXPECT_GT(tip(5).x, 200.0);           // NE
  EXPECT_GT(tip(5).y, 200.0);
}

TEST(Values, AChoiceIsMarkedInItsStateAndDeletedInOthers) {
  const auto spec = test::MakeSpec();
  auto choice = test::MakeChoice();
  auto array = ChoiceMarkers(choice, spec, test::MakeState());
  ASSERT_EQ(array.markers.size(), 1U);
  EXPECT_EQ(array.markers[0].action, Marker::ADD);
  EXPECT_EQ(array.markers[0].points.size(), 9U);
  choice.actions = {9};
  EXPECT_EQ(ChoiceMarkers(choice, spec, test::MakeState()).markers[0].points.size(), 36U);
  choice.step = 3;
  EXPECT_EQ(ChoiceMarkers(choice, spec, test::MakeState()).markers[0].action, Marker::DELETE);
  choice = test::MakeChoice();
  choice.actions.clear();
  EXPECT_EQ(ChoiceMarkers(choice, spec, test::MakeState()).markers[0].action, Marker::DELETE);
}

}  // namespace
}  // namespace aquafarm_viz
