// SPDX-License-Identifier: BSD-3-Clause
// The key of a picture, its list of devices, and ports next to ships.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/scene/labels.h"
#include "draw/legend.h"
#include "draw/map_labels.h"
#include "draw/paths.h"
#include "draw/symbols.h"
#include "fixture.h"
#include "scene/ship_place.h"

namespace aquafarm_viz {
namespace {

constexpr ImageSize kSignsSize{640, 640};

TEST(Signs, HaveOneLineOfTheKeyEach) {
  auto spec = test::MakeSpec();
  spec.view_mode = aquafarm_msgs::FarmSpec::PARTIAL;
  auto state = test::MakeState();
  state.devices.push_back(
      test::MakeDevice(9, 0, cvRound(state.disasters[0].x), cvRound(state.disasters[0].y), 1.0F));
  state.disasters.push_back(test::MakeDisaster(1, 60.0F, 12.0F));
  Trail trail;
  const auto aboard = state.ships.front().aboard;
  for (int x = 3; x < 9; ++x) {
    state.ships.front().x = x;
    state.ships.front().aboard.assign(x > 5 ? 1 : 0, 0);
    trail.Update(state);
  }
  state.ships.front().aboard = aboard;
  Overlays overlays;
  overlays.trail = &trail;
  overlays.layers = ParseLayers("trail,risk,directions,sight");
  std::vector<Course> courses;
  for (std::size_t i = 0; i < 2; ++i) courses.push_back(CourseOf(spec, state, i, {}));
  const Outlook outlook = ComputeOutlook(spec, state, courses);
  const Layout layout = MakeLayout(25, 25, kSignsSize);
  const auto signs = SignsOf(spec, state, overlays, outlook, {}, layout);
  std::set<std::string> words;
  const Fonts fonts(layout.unit);
  for (const Sign sign : signs) {
    EXPECT_TRUE(words.insert(SignWords(sign)).second) << SignWords(sign);
    EXPECT_LE(fonts.small.Width(SignWords(sign)),
              SignSpan(sign) * (layout.panel.width - 16) / 2 - 20)
        << SignWords(sign) << " fits";
  }
  EXPECT_EQ(words,
            (std::set<std::string>{"at risk", "hit first", "in danger, colour by risk", "in port",
                                   "loaded", "empty", "to centre", "heading", "legal move",
                                   "sensors", "fetched", "port", "rock", "health"}));
  const RiskKey key{{34, -5.0, aquafarm_msgs::DisasterState::TYPHOON}};
  EXPECT_EQ(SignsOf(spec, state, overlays, outlook, key, layout).size() + 1, signs.size())
      << "the key of risks shows the pattern";
  overlays.layers = ParseLayers("none");
  state.disasters.clear();
  state.devices.clear();
  spec.rocks.clear();
  spec.ports.clear();
  EXPECT_TRUE(SignsOf(spec, state, overlays, {}, {}, layout).empty());
}

TEST(Paths, OfShipsWithNothingAboardAreDashed) {
  const auto spec = test::MakeSpec();
  const Layout layout = MakeLayout(spec.width, spec.height, kSignsSize);
  // Counts the cells whose middle the path covers.
  const auto covered = [&](bool is_loaded, std::int32_t own_device) {
    auto state = test::MakeState();
    auto& ship = state.ships.front();
    ship.own_device = own_device;
    ship.aboard.assign(is_loaded ? 1 : 0, 0);
    Trail trail;
    for (ship.x = 3; ship.x < 12; ++ship.x) trail.Update(state);
    cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(0));
    DrawPaths(map, state, trail, layout);
    int count = 0;
    for (int x = 4; x < 11; ++x) {
      const cv::Point at(layout.view.ToPixel(x, ship.y));
      count += cv::norm(map.at<cv::Vec3b>(at)) > 50.0 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(covered(true, -1), 7);
  EXPECT_EQ(covered(false, -1), 0) << "gaps are at the middles of cells";
  EXPECT_EQ(covered(false, 0), 7) << "a self-propelled device";
}

TEST(RiskSample, DiffersByKindAndRiskAndStaysInItsBox) {
  const Layout layout = MakeLayout(25, 25, kSignsSize);
  const cv::Rect box(10, 8, 15, 12);
  std::vector<cv::Mat> samples;
  for (const double risk : {-5.0, -20.0}) {
    for (std::size_t kind = 0; kind < DisasterKindCount(); ++kind) {
      cv::Mat image(30, 40, CV_8UC3, cv::Scalar::all(7));
      DrawRiskSample(image, box, static_cast<std::uint8_t>(kind), risk, true, layout);
      samples.push_back(image(box).clone());
      image(box).setTo(cv::Scalar::all(7));
      EXPECT_EQ(cv::norm(image - cv::Scalar::all(7)), 0.0) << kind;
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(cv::norm(samples[i] - samples[j]), 50.0) << i << " and " << j;
    }
  }
  cv::Mat small(4, 4, CV_8UC3, cv::Scalar::all(7));
  DrawRiskSample(small, box, 0, -5.0, true, layout);  // outside the picture
  EXPECT_EQ(cv::norm(small - cv::Scalar::all(7)), 0.0);
}

TEST(RiskSample, HasWholeDotsForRedTides) {
  constexpr int kPeriod = 12;
  for (const cv::Point dot :
       {cv::Point(kPeriod, 2 * kPeriod), {kPeriod / 2, kPeriod}, {3 * kPeriod / 2, 3 * kPeriod}}) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        EXPECT_LT(DistanceToPattern(aquafarm_msgs::DisasterState::RED_TIDE, dot.x + dx, dot.y + dy,
                                    kPeriod),
                  0.7F)
            << dot << dx << dy;
      }
    }
  }
}

TEST(Layout, HasAPanelOfAQuarterOfAWidePicture) {
  EXPECT_GE(MakeLayout(20, 14, {960, 640}).panel.width, 250);
  EXPECT_LT(MakeLayout(20, 14, {640, 640}).panel.width, 250) << "less is left next to a small map";
  for (const auto& [width, height] : {std::pair(2000, 300), {300, 2000}, {301, 301}}) {
    const Layout layout = MakeLayout(20, 14, {width, height});
    EXPECT_EQ(layout.map & cv::Rect(0, 0, layout.panel.x, height), layout.map)
        << width << " x " << height << ": the map is next to the panel";
    EXPECT_GT(std::max(double(layout.map.width) / width, double(layout.map.height) / height), 0.35)
        << width << " x " << height;
  }
}

TEST(Layout, HasTheLegendBelowAWideMapThatIsMuchLowerThanItsPlace) {
  const Layout layout = MakeLayout(20, 14, {1920, 1280});
  EXPECT_GE(layout.key.y, layout.map.br().y + layout.Px(18.0)) << "below the axis";
  EXPECT_LE(layout.key.br().y, layout.bottom.y);
  EXPECT_TRUE((layout.key & layout.panel).empty());
  EXPECT_TRUE(MakeLayout(25, 25, {1680, 1280}).key.empty()) << "the map leaves no space";
  EXPECT_TRUE(MakeLayout(25, 25, {640, 640}).key.empty()) << "too narrow";
  // All signs at once, in at most three rows below the key of risks.
  std::vector<Sign> signs;
  for (int sign = 0; sign <= int(Sign::kHealth); ++sign) signs.push_back(Sign(sign));
  cv::Mat image(1280, 1920, CV_8UC3, cv::Scalar::all(0));
  const RiskKey key{{34, -5.0, aquafarm_msgs::DisasterState::TYPHOON},
                    {64, -20.0, aquafarm_msgs::DisasterState::TYPHOON}};
  const Fonts fonts(layout.unit);
  DrawKeys(image, &key, /*is_filled=*/true, signs, {}, layout, fonts);
  EXPECT_GT(cv::norm(image(layout.key)), 1000.0);
  const cv::Point margin(layout.Px(3.0), layout.Px(3.0));  // symbols may be a little wider
  image(cv::Rect(layout.key.tl() - margin, layout.key.br() + margin)).setTo(cv::Scalar::all(0));
  EXPECT_EQ(cv::norm(image), 0.0) << "nothing is drawn elsewhere";
  EXPECT_EQ(LegendPx(&key, signs, layout), 0) << "the panel has no legend";
}

TEST(Signs, HaveNoKeyOfRisksWithoutRisks) {
  const Layout layout = MakeLayout(25, 25, kSignsSize);
  const std::vector<Sign> signs{Sign::kPort, Sign::kRock};
  const RiskKey key{{34, -5.0, aquafarm_msgs::DisasterState::TYPHOON}};
  EXPECT_EQ(LegendPx(&key, signs, layout) - LegendPx(nullptr, signs, layout), layout.Px(16.0));
  const Fonts fonts(layout.unit);
  const auto draw = [&](const RiskKey* risks) {
    cv::Mat image(640, 640, CV_8UC3, cv::Scalar::all(0));
    DrawKeys(image, risks, /*is_filled=*/true, signs, {}, layout, fonts);
    cv::Mat1b is_yellow;
    const cv::Scalar color = Bgr(RiskColor(-5.0, layout));
    cv::inRange(image, color - cv::Scalar::all(12), color + cv::Scalar::all(12), is_yellow);
    return cv::countNonZero(is_yellow);
  };
  EXPECT_GT(draw(&key), 10) << "the edge of the sample";
  EXPECT_EQ(draw(nullptr), 0);
}

TEST(Signs, OfShipsAndDevicesInPortHaveItsName) {
  const auto spec = test::MakeSpec();
  const auto& cell = spec.ports[1].cell;
  EXPECT_EQ(PortText(spec, cell.x, cell.y), "port B");
  EXPECT_EQ(PortText(spec, cell.x + 1, cell.y), "");
}

TEST(Signs, OfAShipStandNextToThePortInItsCell) {
  auto spec = test::MakeSpec();
  spec.ports[2].cell = test::MakeCell(12, 15);  // next to each other
  spec.ports[3].cell = test::MakeCell(11, 15);
  const Layout layout = MakeLayout(spec.width, spec.height, kSignsSize);
  auto state = test::MakeState();
  for (const auto& port : spec.ports) {
    state.ships.front().x = port.cell.x;
    state.ships.front().y = port.cell.y;
    const cv::Point2d at = ShipPlace(spec, state, state.ships.front(), layout);
    for (const auto& other : spec.ports) {
      const cv::Point2d there = layout.view.ToPixel(other.cell.x, other.cell.y);
      EXPECT_GE(cv::norm(at - there), layout.ship_radius_px() + layout.port_radius_px())
          << PortLetter(port.id) << PortLetter(other.id);
    }
    EXPECT_FALSE(BlockSymbols(spec, state, {}, layout).IsFree({cv::Point(at), cv::Size(1, 1)}))
        << "labels keep off";
  }
}

TEST(Signs, OfAShipStandOnWaterNextToAPort) {
  auto spec = test::MakeSpec();
  auto state = test::MakeState();
  spec.ports.front().cell = test::MakeCell(12, 12);
  const auto cell = spec.ports.front().cell;
  state.ships.front().x = cell.x;
  state.ships.front().y = cell.y;
  spec.rocks.clear();
  spec.islands.clear();
  for (int gap = 0; gap < 4; ++gap) {  // land in three of the four diagonal cells
    spec.islands.clear();
    const std::array<cv::Point, 4> sides{cv::Point(-1, -1), {1, -1}, {-1, 1}, {1, 1}};
    for (int side = 0; side < 4; ++side) {
      const cv::Point at = sides[std::size_t(side)];
      if (side != gap) spec.islands.push_back(test::MakeCell(cell.x + at.x, cell.y + at.y));
    }
    const cv::Point2d there = ShipPlace(spec, state, cell.x, cell.y, 1.0);
    EXPECT_EQ(there, cv::Point2d(cell.x, cell.y) + cv::Point2d(sides[std::size_t(gap)]));
  }
}

// Returns the right end of the first row below the heading DEVICES.
cv::Mat FirstState(const aquafarm_msgs::FarmState& state, const Trail* trail = nullptr) {
  Overlays overlays;
  overlays.trail = trail;
  return DrawFarm(test::MakeSpec(), state, kSignsSize, overlays)(cv::Rect(570, 74, 65, 16)).clone();
}

TEST(Layout, HasLargerTextsWithALargerTextScale) {
  const ImageSize size{1280, 1280};
  ImageSize large = size;
  large.text_scale = 1.5;
  EXPECT_DOUBLE_EQ(MakeLayout(25, 25, large).unit, 1.5 * MakeLayout(25, 25, size).unit);
  EXPECT_LT(MakeLayout(25, 25, large).map.width, MakeLayout(25, 25, size).map.width);
}

TEST(Signs, OfDangersHaveTheColourOfEachRing) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.disasters = {test::MakeDisaster(0, 12.0F, 12.0F)};
  state.devices = {test::MakeDevice(0, 1, 17, 12, 1.0F)};  // in the outermost ring
  state.disasters[0].speed = 0.2F;  // eastwards, so that the inner rings reach the device later
  const ImageSize size{1280, 1280};
  const Layout layout = MakeLayout(spec.width, spec.height, size);
  const auto count = [&](double risk) {
    const cv::Mat list = DrawFarm(spec, state, size)(
        cv::Rect(layout.panel.x, layout.panel.y, layout.panel.width, layout.Px(70.0)));
    cv::Mat1b is_there;
    const cv::Scalar color = Bgr(RiskTextColor(risk, layout));
    cv::inRange(list, color, color, is_there);
    return cv::countNonZero(is_there);
  };
  EXPECT_GT(count(-5.0), 20) << "now";
  EXPECT_GT(count(-20.0), 20) << "later";
  state.disasters[0].heading_deg = 270;  // away from the device
  EXPECT_GT(count(-5.0), 20);
  EXPECT_EQ(count(-20.0), 0);
}

TEST(Signs, OfADeviceThatNothingThreatensHaveItsState) {
  auto state = test::MakeState();
  state.disasters.clear();
  const cv::Mat deployed = FirstState(state);
  EXPECT_GT(cv::norm(deployed - cv::Mat(deployed.size(), CV_8UC3, Bgr(DarkStyle().panel))), 500.0);
  state.devices.front().status = aquafarm_msgs::DeviceState::ABOARD;
  EXPECT_GT(cv::norm(deployed - FirstState(state)), 100.0);
}

TEST(Signs, OfAFetchedDeviceHaveItsTime) {
  auto state = test::MakeState();
  state.disasters.clear();
  Trail trail;
  trail.Update(state);
  EXPECT_FALSE(trail.ChangedAt(0));
  ++state.step;
  state.world_time.sec += 180;
  state.devices.front().status = aquafarm_msgs::DeviceState::DELIVERED;
  trail.Update(state);
  EXPECT_EQ(trail.ChangedAt(0), std::optional<std::int64_t>(18 * 180));
  EXPECT_FALSE(trail.ChangedAt(2));
  EXPECT_GT(cv::norm(FirstState(state, &trail) - FirstState(state)), 100.0);
  ++state.episode;
  trail.Update(state);
  EXPECT_FALSE(trail.ChangedAt(0)) << "of another episode";
}

TEST(Signs, OfRingsHaveTheirKnotsInANarrowPanelToo) {
  const Layout layout = MakeLayout(25, 25, kSignsSize);
  const Fonts fonts(layout.unit);
  EXPECT_EQ(FittingRingName(64, 500, fonts.small), "hurricane force (64 kt)");
  const int room = layout.panel.width - fonts.small.Width("risk -20") - 46;
  for (const std::int32_t wind_kt : {30, 34, 50, 64}) {
    const std::string name = FittingRingName(wind_kt, room, fonts.small);
    EXPECT_NE(name.find("(" + std::to_string(wind_kt) + " kt)"), std::string::npos) << name;
    EXPECT_LE(fonts.small.Width(name), room) << name;
  }
}

// Returns the distances of a pixel from the rings of a disaster at y = 8, ascending.
std::vector<double> FromRings(cv::Point2d pixel, const aquafarm_msgs::DisasterState& disaster,
                              const Layout& layout) {
  const double away = cv::norm(pixel - layout.view.ToPixel(double(disaster.x), 8.0));
  std::vector<double> found;
  for (const float radius : disaster.radii) {
    found.push_back(std::abs(away - double(radius) * layout.view.cell_px()));
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Signs, OfCentresOutsideTheMapAreApartAtTheBorder) {
  const Layout layout = MakeLayout(25, 25, kSignsSize);
  aquafarm_msgs::FarmState state;
  for (const auto& [x, y] : {std::pair(-9.0F, 12.0F),
                             {-7.0F, 12.2F},
                             {-6.0F, 11.9F},
                             {12.0F, 12.0F},
                             {40.0F, 40.0F},
                             {42.0F, 42.0F}}) {
    state.disasters.push_back(test::MakeDisaster(int(state.disasters.size()), x, y));
  }
  const std::vector<SignPlace> signs = PlaceSigns(state, layout);
  ASSERT_EQ(signs.size(), state.disasters.size());
  EXPECT_TRUE(signs[3].is_inside);
  EXPECT_EQ(signs[3].at, layout.view.ToPixel(12.0, 12.0));
  const cv::Size map = layout.map.size();
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (i == 3) continue;
    const cv::Point2d at = signs[i].at;
    const double edge = std::min({at.x, at.y, map.width - at.x, map.height - at.y});
    EXPECT_NEAR(edge, 16.0 * layout.unit, 1e-6) << i;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(cv::norm(at - signs[j].at), 25.0 * layout.unit) << i << " and " << j;
    }
  }
  EXPECT_EQ(signs[0].at.y, PlaceSign(state.disasters[0], layout).at.y) << "the first stays";
}

TEST(Signs, OfRingsAreLabelledOnTheirOwnLineAndOffTheLand) {
  const auto spec = test::MakeSpec();
  const Layout layout = MakeLayout(spec.width, spec.height, kSignsSize);
  auto state = test::MakeState();
  const Fonts fonts(layout.unit);
  for (const float x : {3.0F, 8.0F, 12.0F, -2.0F}) {
    auto& disaster = state.disasters.front();
    disaster.x = x;
    disaster.y = 8.0F;
    std::vector<Course> courses{CourseOf(spec, state, 0, {})};
    LabelSpace space(BlockSymbols(spec, state, {}, layout), spec, layout);
    cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(90));
    LabelRings(map, state, courses, space, layout, fonts);
    cv::Mat1b written;
    cv::inRange(map, Bgr(layout.style->words), Bgr(layout.style->words), written);
    cv::Mat1b joined;  // one part for each label
    cv::dilate(written, joined, cv::Mat1b::ones(3, 11));
    cv::Mat1i parts;
    cv::Mat sizes;
    cv::Mat1d middles;
    const int count = cv::connectedComponentsWithStats(joined, parts, sizes, middles);
    EXPECT_GT(count, 1) << x;
    for (int part = 1; part < count; ++part) {
      EXPECT_LT(FromRings({middles(part, 0), middles(part, 1)}, disaster, layout)[0],
                8.0 * layout.unit)
          << x;
      std::vector<cv::Point> pixels;
      cv::findNonZero((parts == part) & written, pixels);
      for (const cv::Point pixel : pixels) {
        EXPECT_GT(FromRings(pixel, disaster, layout)[1], 1.5) << x << ": the line of another ring";
        for (const auto& cell : spec.islands) {
          const cv::Point2d off = cv::Point2d(pixel) - layout.view.ToPixel(cell.x, cell.y);
          EXPECT_GT(std::max(std::abs(off.x), std::abs(off.y)), 0.45 * layout.view.cell_px()) << x;
        }
      }
    }
  }
}

TEST(Signs, OfRingsOfSeveralDisastersAreOnlyTheirRisks) {
  const auto spec = test::MakeSpec();
  const Layout layout = MakeLayout(spec.width, spec.height, kSignsSize);
  const Fonts fonts(layout.unit);
  auto state = test::MakeEmptyState();
  const auto written = [&](Rgb color) {
    std::vector<Course> courses;
    for (std::size_t i = 0; i < state.disasters.size(); ++i) {
      courses.push_back(CourseOf(spec, state, i, {}));
    }
    LabelSpace space(BlockSymbols(spec, state, {}, layout), spec, layout);
    cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(90));
    LabelRings(map, state, courses, space, layout, fonts);
    cv::Mat1b found;
    cv::inRange(map, Bgr(color), Bgr(color), found);
    return cv::countNonZero(found);
  };
  const Style& style = *layout.style;
  const Rgb number = Mix(style.Risk(Severity(-5.0)), style.label, 0.3);
  state.disasters = {test::MakeDisaster(0, 6.0F, 18.0F)};
  state.disasters[0].radii = {3.0F};
  state.disasters[0].risks = {-5.0F};
  const int alone = written(style.words);
  EXPECT_GT(alone, 0) << "on a plate";
  EXPECT_EQ(written(number), 0);
  state.disasters.push_back(state.disasters[0]);
  state.disasters[1].x = 19.0F;
  EXPECT_EQ(written(style.words), 0);
  EXPECT_GT(written(number), 0);
}

TEST(Signs, OfDevicesStandNextToTheirDeviceAndNotNearerToARock) {
  auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.disasters.clear();
  state.ships.clear();
  state.devices.resize(1);
  state.devices.front().status = aquafarm_msgs::DeviceState::DEPLOYED;
  const cv::Point cell(9, 20);
  state.devices.front().x = cell.x;
  state.devices.front().y = cell.y;
  spec.rocks.resize(1);
  const Layout layout = MakeLayout(spec.width, spec.height, kSignsSize);
  const Fonts fonts(layout.unit);
  for (const cv::Point side : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, -1)}) {
    spec.rocks.front().cell.x = cell.x + side.x;
    spec.rocks.front().cell.y = cell.y + side.y;
    LabelSpace space(BlockSymbols(spec, state, {}, layout), spec, layout);
    cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(90));
    LabelDevices(map, spec, state, {}, space, layout, fonts);
    cv::Mat1b written;
    cv::inRange(map, Bgr(layout.style->label), Bgr(layout.style->label), written);
    const cv::Moments moments = cv::moments(written, true);
    ASSERT_GT(moments.m00, 5.0);
    const cv::Point2d label(moments.m10 / moments.m00, moments.m01 / moments.m00);
    const auto away = [&](cv::Point of) {
      return cv::norm(label - layout.view.ToPixel(of.x, of.y));
    };
    EXPECT_LT(away(cell), away(cell + side)) << side;
    EXPECT_LT(away(cell), 2.0 * layout.view.cell_px()) << side;
  }
}

TEST(Paths, OppositeWaysAreOnBothSidesOfTheCells) {
  const Layout layout = MakeLayout(25, 25, {800, 640});
  ShipTrail way;
  way.places = {{5, 5}, {6, 5}, {7, 5}, {7, 6}, {7, 5}};
  way.loaded = {false, false, false, false, true};
  aquafarm_msgs::FarmState state;
  state.ships.resize(1);
  const auto moves = MovesOf(state, 0, way, layout);
  ASSERT_EQ(moves.size(), 5U) << "one joins the sides at the sharp turn";
  const cv::Point2d start = layout.view.ToPixel(5, 5);
  EXPECT_GT(moves[0].from.y, start.y) << "to the right of a move to the east is south";
  EXPECT_EQ(moves[1].to, moves[2].from) << "a right angle is joined";
  EXPECT_GT(moves[2].from.x, layout.view.ToPixel(7, 5).x);
  EXPECT_EQ(moves[2].to, moves[3].from);
  EXPECT_EQ(moves[3].to, moves[4].from);
  EXPECT_LT(moves[4].from.x, layout.view.ToPixel(7, 6).x) << "the way back is on the other side";
  EXPECT_TRUE(moves[2].is_dashed);
  EXPECT_FALSE(moves[4].is_dashed);
  state.ships.resize(2);
  EXPECT_NE(MovesOf(state, 1, way, layout)[0].from.y, moves[0].from.y);
}

TEST(Paths, OfSeveralShipsShowThePresentTrip) {
  const Layout layout = MakeLayout(25, 25, {800, 640});
  ShipTrail way;
  way.places = {{5, 5}, {6, 5}, {7, 5}, {8, 5}};
  way.loaded = {false, false, true, true};
  aquafarm_msgs::FarmState state;
  state.ships.resize(2);
  EXPECT_EQ(MovesOf(state, 0, way, layout).size(), 3U) << "the first trip";
  way.places.push_back({9, 5});
  way.loaded.push_back(false);
  const auto moves = MovesOf(state, 0, way, layout);
  ASSERT_EQ(moves.size(), 1U) << "without the moves before the drop-off at (8, 5)";
  EXPECT_TRUE(moves[0].is_dashed);
  state.terminated = true;
  EXPECT_EQ(MovesOf(state, 0, way, layout).size(), 4U);
  state.terminated = false;
  state.ships.resize(1);
  EXPECT_EQ(MovesOf(state, 0, way, layout).size(), 4U);
}

}  // namespace
}  // namespace aquafarm_viz
