// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/draw/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/palette.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

constexpr ImageSize kSize{640, 640};

cv::Mat1b Near(const cv::Mat& image, Rgb color, int tolerance = 6) {
  const cv::Scalar middle = Bgr(color);
  cv::Mat1b found;
  cv::inRange(image, middle - cv::Scalar::all(tolerance), middle + cv::Scalar::all(tolerance),
              found);
  return found;
}

// Returns the centre of all pixels that differ between two pictures.
cv::Point2d MiddleOfDifference(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat difference;
  cv::absdiff(a, b, difference);
  cv::Mat1b grey;
  cv::extractChannel(difference, grey, 1);
  std::vector<cv::Point> points;
  cv::findNonZero(grey > 40, points);
  cv::Point2d sum;
  for (const auto& point : points) sum += cv::Point2d(point);
  return points.empty() ? cv::Point2d(-1, -1) : sum / double(points.size());
}

cv::Mat MapOf(const cv::Mat& image, int side = 25, ImageSize size = kSize) {
  return image(PlaceMap(side, side, size).map).clone();
}

TEST(Image, HasTheSizeAskedForWithinLimits) {
  const auto spec = test::MakeSpec();
  const auto state = test::MakeState();
  EXPECT_EQ(DrawFarm(spec, state, {800, 640}).size(), cv::Size(800, 640));
  EXPECT_EQ(DrawFarm(spec, state, {1, 1}).size(), cv::Size(kMinImageSide, kMinImageSide));
}

TEST(Image, ShowsAShipInTheNorthAboveOneInTheSouth) {
  const auto spec = test::MakeSpec();
  const auto empty = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  const auto at = [&](int x, int y) {
    auto state = test::MakeEmptyState();
    state.ships.push_back(test::MakeShip(0, x, y));
    return MiddleOfDifference(empty, MapOf(DrawFarm(spec, state, kSize)));
  };
  EXPECT_LT(at(12, 22).y, at(12, 2).y);
  EXPECT_GT(at(22, 12).x, at(10, 12).x);
  const cv::Point2d expected = PlaceMap(25, 25, kSize).view.ToPixel(12, 20);
  EXPECT_NEAR(at(12, 20).x, expected.x, 2.0);
  EXPECT_NEAR(at(12, 20).y, expected.y, 3.0);
}

TEST(Image, PointsTheBowWhereTheShipMoves) {
  const auto spec = test::MakeSpec();
  const auto middle = [&](std::uint8_t action) {
    auto state = test::MakeEmptyState();
    state.ships.push_back(test::MakeShip(0, 12, 12));
    state.ships.front().action = action;
    const auto map = MapOf(DrawFarm(spec, state, kSize));
    // The deck is behind the centre of the ship.
    std::vector<cv::Point> deck;
    cv::findNonZero(Near(map, ShipColor(0)), deck);
    cv::Point2d sum;
    for (const auto& point : deck) sum += cv::Point2d(point);
    return sum / double(deck.size());
  };
  EXPECT_GT(middle(0).y, middle(1).y);  // north: deck to the south, lower in the picture
  EXPECT_LT(middle(3).x, middle(2).x);  // east: deck to the west
}

TEST(Image, ShowsEveryDeviceKindInItsColour) {
  const auto spec = test::MakeSpec();
  for (std::uint8_t kind = 0; kind < 4; ++kind) {
    auto state = test::MakeEmptyState();
    state.devices.push_back(test::MakeDevice(0, kind, 12, 18, 1.0F));
    const auto map = MapOf(DrawFarm(spec, state, kSize));
    EXPECT_GT(cv::countNonZero(Near(map, DeviceColor(kind))), 15) << DeviceName(kind);
  }
}

TEST(Image, ShowsHealthAsTheLengthOfABar) {
  const auto spec = test::MakeSpec();
  const auto lit = [&](float health) {
    auto state = test::MakeEmptyState();
    state.devices.push_back(test::MakeDevice(0, 0, 12, 18, health));
    return cv::countNonZero(Near(MapOf(DrawFarm(spec, state, kSize)), HealthColor(health)));
  };
  EXPECT_GT(lit(1.0F), lit(0.5F));
  EXPECT_GT(lit(0.5F), lit(0.2F));
}

TEST(Image, MovesTheDisaster) {
  const auto spec = test::MakeSpec();
  const auto empty = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  const auto at = [&](float x, float y) {
    auto state = test::MakeEmptyState();
    state.disasters.push_back(test::MakeDisaster(0, x, y));
    state.disasters.front().speed = 0.0F;  // no arrow, so the difference is symmetric
    Overlays overlays;
    overlays.layers = ParseLayers("none");  // rings have labels, which are not symmetric
    return MiddleOfDifference(empty, MapOf(DrawFarm(spec, state, kSize, overlays)));
  };
  const MapView view = PlaceMap(25, 25, kSize).view;
  for (const auto& [x, y] : {std::pair{10.0F, 15.0F}, {10.5F, 15.0F}, {15.0F, 17.25F}}) {
    const cv::Point2d expected = view.ToPixel(double(x), double(y));
    EXPECT_NEAR(at(x, y).x, expected.x, 4.0);
    EXPECT_NEAR(at(x, y).y, expected.y, 4.0);
  }
  EXPECT_GT(at(10.5F, 15.0F).x, at(10.0F, 15.0F).x);
}

TEST(Image, ShadesCellsOfARingAndNoneOutside) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeEmptyState();
  state.disasters.push_back(test::MakeDisaster(0, 12.0F, 14.0F));
  const auto empty = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  const auto map = MapOf(DrawFarm(spec, state, kSize));
  const MapView view = PlaceMap(25, 25, kSize).view;
  const auto changed = [&](double x, double y) {
    const cv::Point at(view.ToPixel(x, y));
    return cv::norm(empty(cv::Rect(at, cv::Size(1, 1))), map(cv::Rect(at, cv::Size(1, 1)))) > 10;
  };
  EXPECT_TRUE(changed(7.97, 9.97));   // 5.7 cells south-west; the label is on the line in the south
  EXPECT_FALSE(changed(7.54, 9.54));  // 6.3 cells south-west
  EXPECT_TRUE(changed(6.3, 14.0));    // 5.7 cells west
  EXPECT_FALSE(changed(5.7, 14.0));   // 6.3 cells west
  EXPECT_TRUE(changed(12.0, 19.7));   // 5.7 cells north
  EXPECT_FALSE(changed(12.0, 20.3));  // 6.3 cells north
}

TEST(Image, ShowsNoDisasterThatIsOverOrUnknown) {
  const auto spec = test::MakeSpec();
  const auto empty = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  auto state = test::MakeEmptyState();
  state.disasters.push_back(test::MakeDisaster(0, 12.0F, 14.0F));
  state.disasters.front().steps_left = 0;
  EXPECT_EQ(cv::norm(empty, MapOf(DrawFarm(spec, state, kSize))), 0.0);
  state.disasters.front().steps_left = 9;
  state.disasters.front().known = false;
  EXPECT_EQ(cv::norm(empty, MapOf(DrawFarm(spec, state, kSize))), 0.0);
}

TEST(Image, PointsToADisasterOutside) {
  const auto spec = test::MakeSpec();
  const auto empty = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  auto state = test::MakeEmptyState();
  state.disasters.push_back(test::MakeDisaster(0, 60.0F, 12.0F));
  const auto middle = MiddleOfDifference(empty, MapOf(DrawFarm(spec, state, kSize)));
  EXPECT_GT(middle.x, 0.7 * empty.cols);
  EXPECT_NEAR(middle.y, empty.rows / 2.0, 40.0) << "its label stands next to the pointer";
}

TEST(Image, ShowsIslandAndPorts) {
  const auto spec = test::MakeSpec();
  const auto map = MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize));
  const MapView view = PlaceMap(25, 25, kSize).view;
  const auto land = map.at<cv::Vec3b>(cv::Point(view.ToPixel(1, 2)));
  EXPECT_GT(land[1], land[0]);  // green above blue
  const auto sea = map.at<cv::Vec3b>(cv::Point(view.ToPixel(12, 20)));
  EXPECT_GT(sea[0], sea[2]);  // blue above red
  for (const auto& port : spec.ports) {
    const cv::Rect around(cv::Point(view.ToPixel(port.cell.x, port.cell.y)) - cv::Point(8, 8),
                          cv::Size(17, 17));
    const auto disc = map(around & cv::Rect({0, 0}, map.size()));
    EXPECT_GT(cv::countNonZero(Near(disc, kPort, 30)), 20) << PortLetter(port.id);
  }
}

TEST(Image, ShowsRocksWhereTheyAre) {
  const auto spec = test::MakeSpec();
  ASSERT_FALSE(spec.rocks.empty());
  auto bare = spec;
  bare.rocks.clear();
  cv::Mat difference;
  cv::absdiff(MapOf(DrawFarm(spec, test::MakeEmptyState(), kSize)),
              MapOf(DrawFarm(bare, test::MakeEmptyState(), kSize)), difference);
  const MapView view = PlaceMap(25, 25, kSize).view;
  for (const auto& rock : spec.rocks) {
    const cv::Rect around(cv::Point(view.ToPixel(rock.cell.x, rock.cell.y)) - cv::Point(8, 8),
                          cv::Size(17, 17));
    EXPECT_GT(cv::norm(difference(around & cv::Rect({0, 0}, difference.size()))), 100.0)
        << rock.cell.x << ", " << rock.cell.y;
  }
}

TEST(Image, PointsADisastersArrowWhereItIsHeading) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeEmptyState();
  state.disasters.push_back(test::MakeDisaster(0, 12.0F, 12.0F));
  state.disasters.front().speed = 0.0F;
  const auto still = MapOf(DrawFarm(spec, state, kSize));
  const cv::Point2d centre = PlaceMap(25, 25, kSize).view.ToPixel(12.0, 12.0);
  state.disasters.front().speed = 0.5F;
  const auto ahead = [&](int heading_deg) {
    state.disasters.front().heading_deg = heading_deg;
    return MiddleOfDifference(still, MapOf(DrawFarm(spec, state, kSize))) - centre;
  };
  EXPECT_LT(ahead(0).y, -5.0);   // north is up
  EXPECT_GT(ahead(90).x, 5.0);   // east
  EXPECT_GT(ahead(180).y, 5.0);  // south
  EXPECT_LT(ahead(270).x, -5.0);
}

TEST(Image, WritesEpisodeStepAndReturn) {
  const auto spec = test::MakeSpec();
  const auto top = [&](const aquafarm_msgs::FarmState& state) {
    return cv::Mat(DrawFarm(spec, state, kSize), cv::Rect(0, 0, 640, 46)).clone();
  };
  const auto state = test::MakeState();
  const cv::Mat before = top(state);
  EXPECT_EQ(cv::norm(before, top(state)), 0.0);
  for (const char* what : {"episode", "step", "return"}) {
    auto other = state;
    if (what[0] == 'e') other.episode += 7;
    if (what[0] == 's') other.step += 7;
    if (what[0] == 'r') other.joint_return += 77.0F;
    EXPECT_GT(cv::norm(before, top(other)), 100.0) << what;
  }
}

TEST(Image, WritesLegendAndLines) {
  const auto before = DrawFarm(test::MakeSpec(), test::MakeState(), kSize);
  const auto variety = [](const cv::Mat& part) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(part, mean, deviation);
    return deviation[0];
  };
  EXPECT_GT(variety(before(cv::Rect(0, 0, 640, 46))), 10.0);       // episode, step, return
  EXPECT_GT(variety(before(cv::Rect(490, 50, 150, 200))), 10.0);   // devices, disasters, ships
  EXPECT_GT(variety(before(cv::Rect(490, 450, 150, 140))), 10.0);  // legend, north, scale
  EXPECT_GT(variety(before(cv::Rect(0, 598, 640, 20))), 10.0);     // reward terms
}

TEST(Image, WritesTheDangerInTheFirstLineEvenWhereThereIsLittleSpace) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.devices = {test::MakeDevice(3, 0, 12, 12, 1.0F)};
  state.disasters = {test::MakeDisaster(0, 12.0F, 12.0F)};
  state.seed = 18446744073709551615ULL;
  state.joint_return = -123456.7F;
  auto worse = state;
  for (float& risk : worse.disasters[0].risks) risk -= 1.0F;
  for (const int width : {640, 320}) {
    const auto head = [&](const aquafarm_msgs::FarmState& shown) {
      const cv::Mat image = DrawFarm(spec, shown, {width, width});
      return image(cv::Rect(0, 0, width, width == 640 ? 22 : 15)).clone();
    };
    EXPECT_GT(cv::norm(head(state), head(worse)), 100.0) << "another risk, " << width;
  }
}

TEST(Image, HasALargerMapWithoutThePanel) {
  const ImageSize with{640, 640};
  const ImageSize without{640, 640, /*has_panel=*/false};
  const MapPlace larger = PlaceMap(25, 25, without);
  EXPECT_GT(larger.map.width, PlaceMap(25, 25, with).map.width + 100);
  EXPECT_GT(larger.map.y, 40) << "the lines above the map stay";
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  const cv::Mat before = DrawFarm(spec, state, without);
  state.step += 7;
  const cv::Rect top(0, 0, 640, 40);
  EXPECT_GT(cv::norm(before(top), DrawFarm(spec, state, without)(top)), 100.0);
  cv::Mat1b grey;
  cv::cvtColor(before(cv::Rect(0, 60, larger.map.x - 4, 500)), grey, cv::COLOR_BGR2GRAY);
  EXPECT_GT(cv::countNonZero(grey > 100), 50) << "numbers of the axis";
}

TEST(Image, SaysHowTheEpisodeEndedAboveTheMap) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  const auto before = DrawFarm(spec, state, kSize);
  state.terminated = true;
  state.reason = aquafarm_msgs::FarmState::ALL_RETRIEVED;
  const auto after = DrawFarm(spec, state, kSize);
  const cv::Rect top(0, 0, 320, 22);
  EXPECT_GT(cv::norm(before(top), after(top)), 100.0);
  EXPECT_EQ(cv::norm(MapOf(before), MapOf(after)), 0.0) << "the words cover nothing of the map";
}

TEST(Image, IsTheSameFromAPainterThatHasDrawnOtherFarms) {
  FarmPainter painter(kSize);
  painter.Draw(test::MakeSpec(50), test::MakeState(50));
  painter.Draw(test::MakeSpec(), test::MakeState());
  auto moved = test::MakeSpec();
  moved.rocks.pop_back();
  const cv::Mat again = painter.Draw(moved, test::MakeState()).clone();
  EXPECT_EQ(cv::norm(again, DrawFarm(moved, test::MakeState(), kSize)), 0.0);
  EXPECT_GT(cv::norm(again, DrawFarm(test::MakeSpec(), test::MakeState(), kSize)), 0.0);
}

class ImageOf : public testing::TestWithParam<int> {};

TEST_P(ImageOf, FarmsOfAnySizeShowTheirThings) {
  const int side = GetParam();
  const auto spec = test::MakeSpec(side);
  for (const ImageSize size : {ImageSize{640, 640}, {1280, 960}, {160, 160}}) {
    auto state = test::MakeState(side);
    state.disasters.clear();
    const auto map = MapOf(DrawFarm(spec, state, size), side, size);
    EXPECT_GT(cv::countNonZero(Near(map, DeviceColor(0))), 5) << size.width;
    EXPECT_GT(cv::countNonZero(Near(map, ShipColor(0))), 3) << size.width;
  }
}

INSTANTIATE_TEST_SUITE_P(Sides, ImageOf, testing::Values(10, 25, 100, 500));

TEST(Image, SurvivesWhatAnObservationOrAnAttackerMaySend) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.ships.front().x = std::numeric_limits<int>::min();
  state.ships.front().aboard = {-1, 77, 0, 1, 2, 3};
  state.ships.push_back(test::MakeShip(-5, 3, 24));
  state.ships.back().own_device = 99;
  state.devices[0].kind = 200;
  state.devices[1].x = 1000000000;
  state.devices[2].health = -3.0F;
  state.disasters.front().radii = {0.0F, 1e6F};
  state.disasters.front().risks = {3e38F, -3e38F};
  state.disasters.push_back(test::MakeDisaster(1, -1e6F, 1e6F));
  state.disasters.back().heading_deg = std::numeric_limits<int>::min();
  state.joint_return = std::numeric_limits<float>::quiet_NaN();
  aquafarm_msgs::TrainingStatus training;
  training.phase = 99;
  training.steps_per_second = std::numeric_limits<float>::infinity();
  training.time_left_s = -std::numeric_limits<double>::infinity();
  Trail trail;
  trail.Update(state);
  EXPECT_NO_THROW(DrawFarm(spec, state, kSize, {&trail, &training}));
}

TEST(Image, ShowsByArrowheadsWhereAShipCameFrom) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeEmptyState();
  state.ships.push_back(test::MakeShip(0, 0, 20));
  const auto heads = [&](int first, int last) {
    Trail route(Trail::kWhole);
    for (int x = first; x != last; x += first < last ? 1 : -1) {
      state.ships.front().x = x;
      ++state.step;
      route.Update(state);
    }
    const MapView view = PlaceMap(25, 25, kSize).view;
    const cv::Rect between(cv::Point(view.ToPixel(5, 22)), cv::Point(view.ToPixel(19, 18)));
    const Overlays with{nullptr, nullptr, &route, ParseLayers("route")};
    cv::Mat difference;
    cv::absdiff(MapOf(DrawFarm(spec, state, kSize, with))(between),
                MapOf(DrawFarm(spec, state, kSize))(between), difference);
    cv::Mat grey;
    cv::cvtColor(difference, grey, cv::COLOR_BGR2GRAY);
    std::vector<int> heights;  // of the path, by column
    for (int x = 0; x < grey.cols; ++x) heights.push_back(cv::countNonZero(grey.col(x) > 20));
    return heights;
  };
  // Returns the largest rise and fall of the heights from left to right. An arrowhead is highest at
  // its rear end, where the height changes most.
  const auto steepest = [](const std::vector<int>& heights) {
    std::vector<int> changes(heights.size());
    std::adjacent_difference(heights.begin(), heights.end(), changes.begin());
    const auto [fall, rise] = std::minmax_element(changes.begin() + 1, changes.end());
    return std::pair(*rise, -*fall);
  };
  const std::vector<int> east = heads(1, 24);
  EXPECT_GE(*std::max_element(east.begin(), east.end()), 7);
  EXPECT_GT(steepest(east).first, steepest(east).second);
  const std::vector<int> west = heads(24, 1);
  EXPECT_LT(steepest(west).first, steepest(west).second);
}

// Returns the number of pixels that a layer changes.
int Changed(const char* layers, const char* others) {
  auto spec = test::MakeSpec();
  spec.view_mode = aquafarm_msgs::FarmSpec::PARTIAL;
  spec.sensor_radius = 5.0F;
  auto state = test::MakeState();
  Trail trail;
  Trail route(Trail::kWhole);
  for (int i = 0; i < 60; ++i) {
    state.ships.front().x = 2 + (i < 18 ? i : 18);
    state.ships.front().y = 2 + (i < 18 ? 0 : i % 18);
    state.ships.front().action = 3;
    ++state.step;
    trail.Update(state);
    route.Update(state);
  }
  const Values values = ReadValues(test::MakeCloud(), spec);
  const auto draw = [&](const char* names) {
    return DrawFarm(spec, state, kSize, {&trail, nullptr, &route, ParseLayers(names), &values});
  };
  const cv::Mat one = draw(layers);
  const cv::Mat other = draw(others);
  cv::Mat difference;
  cv::absdiff(one, other, difference);
  return cv::countNonZero(difference.reshape(1));
}

TEST(Image, EachLayerShowsSomethingAndCanBeLeftOut) {
  for (const char* layer :
       {"trail", "risk", "route", "sight", "values", "moves", "directions", "labels"}) {
    EXPECT_GT(Changed(layer, "none"), 300) << layer;
  }
  EXPECT_GT(Changed("trail", "route"), 300);
  EXPECT_EQ(Changed("trail,risk,values,moves", "moves,values,risk,trail"), 0);
}

TEST(Image, ShowsTheChoiceOfAnotherPolicyInItsStateAlone) {
  const auto spec = test::MakeSpec();
  const auto state = test::MakeState();
  auto choice = test::MakeChoice();
  Overlays overlays;
  overlays.choice = &choice;
  const auto pink = [&] {
    const cv::Mat picture = DrawFarm(spec, state, kSize, overlays);
    cv::Mat found;
    cv::inRange(picture, Bgr(kChoiceColor), Bgr(kChoiceColor), found);
    return cv::countNonZero(found);
  };
  EXPECT_GT(pink(), 100);
  choice.actions = {8};
  EXPECT_GT(pink(), 100);
  choice.step = 16;
  EXPECT_EQ(pink(), 0);
}

TEST(Image, ValuesOfAnotherFarmAreLeftOut) {
  const auto spec = test::MakeSpec(10);
  const Values values = ReadValues(test::MakeCloud(), test::MakeSpec());
  Overlays overlays;
  overlays.layers = ParseLayers("values,moves");
  const cv::Mat without = DrawFarm(spec, test::MakeState(10), kSize, overlays);
  overlays.values = &values;
  EXPECT_EQ(cv::norm(without, DrawFarm(spec, test::MakeState(10), kSize, overlays), cv::NORM_INF),
            0.0);
}

TEST(Image, TheFormerNameOfTheTrailIsAcceptedWithALine) {
  testing::internal::CaptureStderr();
  EXPECT_TRUE(ParseLayers("wake").trail);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "layers: wake is now called trail\n");
}

TEST(Image, LayersThatThereAreNotHaveTheirLine) {
  for (const char* wrong : {"rain", "", "trail,", "trail,rain"}) {
    try {
      ParseLayers(wrong);
      FAIL() << wrong;
    } catch (const std::invalid_argument& fault) {
      const std::string name = std::string(wrong).find("rain") == std::string::npos ? "" : "rain";
      EXPECT_EQ("layers: got '" + name +
                    "', expected some of: trail, risk, route, sight, "
                    "values, moves, directions, labels, sea:NAME; or none",
                fault.what());
    }
  }
}

TEST(Image, HasALightStyleOnWhite) {
  const cv::Mat dark = DrawFarm(test::MakeSpec(), test::MakeState(), kSize);
  const cv::Mat light = DrawFarm(test::MakeSpec(), test::MakeState(), kSize, {}, LightStyle());
  EXPECT_LT(cv::mean(dark)[1], 120.0);
  EXPECT_GT(cv::mean(light)[1], 190.0);
}

TEST(Image, RefusesWhatCannotBeDrawn) {
  auto spec = test::MakeSpec();
  spec.width = -1;
  try {
    DrawFarm(spec, test::MakeState());
    FAIL() << "drew a farm of width -1";
  } catch (const std::invalid_argument& fault) {
    EXPECT_STREQ(fault.what(), "spec.width: got -1, expected [1, 4096]");
  }
}

}  // namespace
}  // namespace aquafarm_viz
