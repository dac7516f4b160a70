// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/markers/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "aquafarm_viz/base/checks.h"
#include "aquafarm_viz/base/palette.h"
#include "fixture.h"
#include "marker_fixture.h"
#include "markers/legend.h"

namespace aquafarm_viz {
namespace {

using test::BearingDeg;
using test::ByKey;
using test::Key;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std::set<Key> Keys(const MarkerArray& array) {
  std::set<Key> keys;
  for (const auto& marker : array.markers) keys.emplace(marker.ns, marker.id);
  return keys;
}

TEST(SpecMarkers, ShowEveryThingThatStandsStill) {
  const auto spec = test::MakeSpec();
  const auto markers = ByKey(SpecMarkers(spec, false));
  EXPECT_EQ(markers.at({"island", 0}).points.size(), 6 * spec.islands.size());
  EXPECT_EQ(markers.at({"rocks", 0}).points.size(), 12 * spec.rocks.size());
  EXPECT_DOUBLE_EQ(markers.at({"sea", 0}).scale.x, 25000.0);
}

TEST(SpecMarkers, HaveAShoreLineWhereLandMeetsWater) {
  auto spec = test::MakeSpec();
  spec.islands = {test::MakeCell(5, 5), test::MakeCell(6, 5), test::MakeCell(0, 9)};
  const Marker shore = ByKey(SpecMarkers(spec, false)).at({"shore", 0});
  // Two neighbouring cells have six borders with water. A cell at the edge of the farm has three.
  EXPECT_EQ(shore.points.size(), 6U * 9U);
  for (const auto& point : shore.points) {
    EXPECT_FALSE(std::abs(point.x - 5500.0) < 100.0 && std::abs(point.y - 5000.0) < 300.0)
        << "between two cells of land";
  }
}

// Returns the position (x, y) of each text of the axes [m].
std::map<std::string, std::pair<double, double>> AxisTexts(const aquafarm_msgs::FarmSpec& spec) {
  std::map<std::string, std::pair<double, double>> texts;
  for (const auto& marker : SpecMarkers(spec, false).markers) {
    if (marker.ns != "axis" || marker.text.empty()) continue;
    texts[marker.text] = {marker.pose.position.x, marker.pose.position.y};
  }
  return texts;
}

TEST(SpecMarkers, NameLongitudesBelowAndLatitudesOnTheLeft) {
  auto spec = test::MakeSpec();
  spec.has_origin = true;
  spec.origin_latitude_deg = 30.1;
  spec.origin_longitude_deg = 122.6;
  const auto texts = AxisTexts(spec);
  const auto east = texts.at("122-40E");
  const double m_per_degree = 111320.0 * std::cos(30.1 * M_PI / 180.0);
  EXPECT_NEAR(east.first, (122.0 + 40.0 / 60.0 - 122.6) * m_per_degree, 100.0);
  EXPECT_LT(east.second, -500.0);
  const auto north = texts.at("30-10N");
  EXPECT_LT(north.first, -500.0);
  EXPECT_NEAR(north.second, (30.0 + 10.0 / 60.0 - 30.1) * 110850.0, 100.0);
  spec.origin_latitude_deg = -30.1;
  EXPECT_EQ(AxisTexts(spec).count("30-00S"), 1U);
}

TEST(SpecMarkers, NumberCellsWithoutAPlace) {
  const auto texts = AxisTexts(test::MakeSpec());
  EXPECT_EQ(texts.count("24"), 1U);
  EXPECT_EQ(texts.count("25"), 0U);
}

TEST(StateMarkers, NameADisasterOnTheSideThatItsArrowLeavesFree) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  for (const auto& [heading_deg, is_above] :
       {std::pair(0, false), {90, false}, {135, true}, {180, true}, {225, true}, {315, false}}) {
    state.disasters[0].heading_deg = heading_deg;
    state.disasters[0].speed = 0.5F;
    const auto markers = ByKey(StateMarkers(spec, state));
    const auto& name = markers.at({"disaster_name", 0}).pose.position;
    EXPECT_EQ(name.y > markers.at({"disaster", 0}).pose.position.y, is_above) << heading_deg;
  }
}

TEST(StateMarkers, NameADisasterOutsideSmallRingsAndNextToTheCentreOfLargeOnes) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  auto& disaster = state.disasters[0];
  disaster.heading_deg = 180;
  disaster.speed = 0.5F;
  disaster.y = 12.0F;
  for (const auto& [radius, is_outside] : {std::pair(4.0F, true), {8.0F, false}, {14.0F, false}}) {
    disaster.radii.back() = radius;
    const auto at = ByKey(StateMarkers(spec, state)).at({"disaster_name", 0}).pose.position;
    EXPECT_EQ(at.y / spec.cell_size_m > 12.0 + double(radius), is_outside) << radius;
    EXPECT_LT(at.y / spec.cell_size_m, spec.height);
  }
}

TEST(SpecMarkers, AreInMetresOfFrameMap) {
  auto spec = test::MakeSpec();
  spec.cell_size_m = 250.0;
  const auto port = ByKey(StateMarkers(spec, test::MakeState())).at({"port", 1});
  EXPECT_EQ(port.header.frame_id, "map");
  EXPECT_DOUBLE_EQ(port.pose.position.x, spec.ports[1].cell.x * 250.0);
  EXPECT_DOUBLE_EQ(port.pose.position.y, spec.ports[1].cell.y * 250.0);
}

TEST(SpecMarkers, DeleteAllOnceAndFirstWhenTheEpisodeStarts) {
  const auto spec = test::MakeSpec();
  const auto array = SpecMarkers(spec, true);
  EXPECT_EQ(array.markers.front().action, Marker::DELETEALL);
  for (std::size_t i = 1; i < array.markers.size(); ++i) {
    EXPECT_EQ(array.markers[i].action, Marker::ADD);
  }
  for (const auto& marker : SpecMarkers(spec, false).markers) {
    EXPECT_EQ(marker.action, Marker::ADD);
  }
}

TEST(StateMarkers, NeverDeleteAll) {
  for (const auto& marker : StateMarkers(test::MakeSpec(), test::MakeState()).markers) {
    EXPECT_NE(marker.action, Marker::DELETEALL);
  }
}

TEST(StateMarkers, ShowEveryShipDeviceAndDisaster) {
  const auto state = test::MakeState();
  const auto markers = ByKey(StateMarkers(test::MakeSpec(), state));
  EXPECT_EQ(markers.at({"ship", 0}).action, Marker::ADD);
  for (const auto& device : state.devices) {
    EXPECT_EQ(markers.at({"device", device.id}).action, Marker::ADD);
  }
  EXPECT_EQ(markers.at({"disaster", 0}).action, Marker::ADD);
  EXPECT_EQ(markers.at({"heading", 0}).type, Marker::ARROW);
}

TEST(StateMarkers, KeepTheirIdsWhateverHappens) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  const auto before = Keys(StateMarkers(spec, state));
  ++state.step;
  state.disasters.front().steps_left = 0;
  state.devices[0].status = aquafarm_msgs::DeviceState::ABOARD;
  state.devices[2].status = aquafarm_msgs::DeviceState::DELIVERED;
  state.ships.front().visible = false;
  EXPECT_EQ(Keys(StateMarkers(spec, state)), before);
}

TEST(StateMarkers, LiveUntilReplaced) {
  for (const auto& marker : StateMarkers(test::MakeSpec(), test::MakeState()).markers) {
    EXPECT_TRUE(marker.lifetime.isZero());
    EXPECT_EQ(marker.header.frame_id, "map");
  }
}

TEST(StateMarkers, HaveRingsAtTheRadiiOfTheDisaster) {
  const auto spec = test::MakeSpec();
  const auto state = test::MakeState();
  const auto markers = ByKey(StateMarkers(spec, state));
  const auto& disaster = state.disasters.front();
  for (std::size_t ring = 0; ring < disaster.radii.size(); ++ring) {
    const auto& edge = markers.at({"ring_edge", static_cast<int>(ring)});
    EXPECT_NEAR(edge.pose.position.x, static_cast<double>(disaster.x) * spec.cell_size_m, 0.5);
    double outermost = 0.0;
    for (const auto& point : edge.points) {
      outermost = std::max(outermost, std::hypot(point.x, point.y));
    }
    EXPECT_NEAR(outermost, static_cast<double>(disaster.radii[ring]) * spec.cell_size_m, 1e-6);
    const double inner = ring == 0 ? 0.0 : static_cast<double>(disaster.radii[ring - 1]);
    for (const auto& point : markers.at({"ring", static_cast<int>(ring)}).points) {
      const double radius = std::hypot(point.x, point.y) / spec.cell_size_m;
      EXPECT_GE(radius, inner - 1e-9);
      EXPECT_LE(radius, static_cast<double>(disaster.radii[ring]) + 1e-9);
    }
  }
  EXPECT_EQ(markers.at({"ring", 3}).action, Marker::DELETE);
}

// Returns the corners of a marker's triangles in cells of the farm.
std::vector<cv::Point2d> Corners(const Marker& marker, double cell_m) {
  std::vector<cv::Point2d> corners;
  for (const auto& point : marker.points) {
    corners.emplace_back((marker.pose.position.x + point.x) / cell_m,
                         (marker.pose.position.y + point.y) / cell_m);
  }
  return corners;
}

TEST(StateMarkers, KeepRingsAndTheirPatternOnTheFarm) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  for (std::uint8_t kind = 0; kind <= aquafarm_msgs::DisasterState::CHEMICAL_SPILL; ++kind) {
    state.disasters[0].kind = kind;
    state.disasters[0].x = -3.0F;  // the farm lies in the outer ring
    state.disasters[0].radii = {1.0F, 2.0F, 60.0F};
    const auto markers = ByKey(StateMarkers(spec, state));
    EXPECT_EQ(markers.at({"ring", 0}).action, Marker::DELETE) << "outside";
    double area = 0.0;
    for (const auto& key : {std::pair<std::string, int>("ring", 2), {"ring_pattern", 0}}) {
      const Marker& marker = markers.at(key);
      ASSERT_EQ(marker.points.size() % 3, 0U);
      const auto corners = Corners(marker, spec.cell_size_m);
      ASSERT_FALSE(corners.empty()) << key.first << " of kind " << int(kind);
      for (const auto& corner : corners) {
        EXPECT_TRUE(corner.x > -0.6 && corner.x < 24.6 && corner.y > -0.6 && corner.y < 24.6);
      }
      if (key.first != "ring") continue;
      for (std::size_t i = 0; i < corners.size(); i += 3) {
        area += 0.5 * std::abs((corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]));
      }
    }
    EXPECT_NEAR(area, 625.0, 0.01) << "the band covers the farm";
    EXPECT_EQ(markers.at({"ring_pattern", 0}).color.a, 1.0F) << "rviz multiplies the alphas";
    EXPECT_EQ(markers.at({"ring_pattern", 0}).colors.size(),
              markers.at({"ring_pattern", 0}).points.size());
  }
}

TEST(StateMarkers, HaveAPatternThatDiffersByKindAndEndsAtTheRing) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  std::set<std::vector<double>> seen;
  for (std::uint8_t kind = 0; kind <= aquafarm_msgs::DisasterState::CHEMICAL_SPILL; ++kind) {
    auto& disaster = state.disasters[0];
    disaster.kind = kind;
    const Marker pattern = ByKey(StateMarkers(spec, state)).at({"ring_pattern", 0});
    std::vector<double> places;
    for (const auto& point : pattern.points) {
      places.push_back(point.x);
      places.push_back(point.y);
      EXPECT_LT(std::hypot(point.x, point.y) / spec.cell_size_m, double(disaster.radii[2]) + 0.2);
    }
    EXPECT_TRUE(seen.insert(places).second) << "kind " << int(kind);
  }
}

TEST(StateMarkers, HideACentreOutsideTheFarmWhereAPointerShowsIt) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.disasters[0].x = -3.0F;
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"disaster", 0}).action, Marker::DELETE);
  Layers layers;
  layers.risk = false;  // without pointers
  EXPECT_EQ(ByKey(StateMarkers(spec, state, nullptr, layers)).at({"disaster", 0}).action,
            Marker::ADD);
}

TEST(StateMarkers, ShadeWorseRingsMoreStrongly) {
  const auto markers = ByKey(StateMarkers(test::MakeSpec(), test::MakeState()));
  EXPECT_GT(markers.at({"ring", 0}).color.a, markers.at({"ring", 1}).color.a);
  EXPECT_GT(markers.at({"ring", 1}).color.a, markers.at({"ring", 2}).color.a);
}

TEST(StateMarkers, PointTheArrowWhereTheDisasterHeads) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  for (const int heading : {0, 45, 90, 180, 270, 359}) {
    state.disasters.front().heading_deg = heading;
    const auto arrow = ByKey(StateMarkers(spec, state)).at({"heading", 0});
    EXPECT_NEAR(BearingDeg(arrow, 90.0), heading, 1e-6);
  }
  state.disasters.front().heading_deg = 90;
  const auto east = ByKey(StateMarkers(spec, state)).at({"heading", 0}).pose.orientation;
  EXPECT_NEAR(east.z, 0.0, 1e-12);  // without rotation rviz arrows point east
  EXPECT_NEAR(east.w, 1.0, 1e-12);
}

TEST(StateMarkers, DeleteADisasterThatIsOver) {
  auto state = test::MakeState();
  state.disasters.front().steps_left = 0;
  const auto markers = ByKey(StateMarkers(test::MakeSpec(), state));
  for (int ring = 0; ring < kMaxRings; ++ring) {
    EXPECT_EQ(markers.at({"ring", ring}).action, Marker::DELETE);
    EXPECT_EQ(markers.at({"ring_edge", ring}).action, Marker::DELETE);
  }
  EXPECT_EQ(markers.at({"heading", 0}).action, Marker::DELETE);
  EXPECT_EQ(markers.at({"disaster", 0}).action, Marker::DELETE);
}

TEST(StateMarkers, ShowHealthAsTheLengthAndColourOfABar) {
  auto state = test::MakeState();
  state.devices[0].health = 1.0F;
  state.devices[2].health = 0.25F;
  const auto markers = ByKey(StateMarkers(test::MakeSpec(), state));
  const auto& full = markers.at({"health", 0});
  const auto& poor = markers.at({"health", 2});
  EXPECT_NEAR(poor.scale.x / full.scale.x, 0.25, 1e-6);
  EXPECT_GT(full.color.g, full.color.r);
  EXPECT_GT(poor.color.r, poor.color.g);
  state.devices[2].health_known = false;
  EXPECT_EQ(ByKey(StateMarkers(test::MakeSpec(), state)).at({"health", 2}).action, Marker::DELETE);
}

TEST(StateMarkers, DistinguishDeviceKinds) {
  auto state = test::MakeState();
  for (auto& device : state.devices) {
    device.health = 1.0F;
    device.status = aquafarm_msgs::DeviceState::DEPLOYED;
  }
  const auto markers = ByKey(StateMarkers(test::MakeSpec(), state));
  std::set<std::size_t> shapes;
  std::set<std::pair<float, float>> colors;
  for (int id = 0; id < 4; ++id) {
    shapes.insert(markers.at({"device", id}).points.size());
    colors.emplace(markers.at({"device", id}).color.r, markers.at({"device", id}).color.b);
  }
  EXPECT_EQ(shapes.size(), 4U);
  EXPECT_EQ(colors.size(), 4U);
}

TEST(StateMarkers, ShowASelfPropelledDeviceThatWasDeliveredOnlyAsDevice) {
  auto state = test::MakeState();
  state.ships.push_back(test::MakeShip(1, 9, 9));
  state.ships.back().own_device = 2;
  const auto spec = test::MakeSpec();
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"ship", 1}).action, Marker::ADD);
  state.ships.back().active = false;
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"ship", 1}).action, Marker::DELETE);
}

TEST(StateMarkers, StayBelowTheHeightAtWhichRvizCutsOff) {
  auto spec = test::MakeSpec();
  spec.cell_size_m = 50000.0;
  const auto state = test::MakeState();
  for (const auto& array : {SpecMarkers(spec, false), StateMarkers(spec, state)}) {
    for (const auto& marker : array.markers) EXPECT_LT(marker.pose.position.z, 400.0);
  }
}

TEST(StateMarkers, HaveTextOfElevenPixelsInAWindowOf1280x720) {
  // In this window the view is about 628 pixels high. It contains the farm and the lines above and
  // below it: 34.5 % of the side of the farm times TextScale, see whole_view.cpp.
  constexpr double kView_px = 628.0 / (1.0 + 0.345 * 1.2);
  // Measured on the screen: capitals have 0.6 of the scale, and 0.69 of the size of Liberation
  // Sans.
  constexpr double kFontSize = 0.6 / 0.69;
  Layers layers;
  layers.labels = true;
  for (const int side : {10, 25, 40, 60, 200}) {
    const auto spec = test::MakeSpec(side);
    int texts = 0;
    for (const auto& array : {SpecMarkers(spec, false, layers),
                              StateMarkers(spec, test::MakeState(), nullptr, layers)}) {
      for (const auto& marker : array.markers) {
        if (marker.type != Marker::TEXT_VIEW_FACING || marker.action != Marker::ADD) continue;
        ++texts;
        EXPECT_GE(kFontSize * marker.scale.z / (side * spec.cell_size_m) * kView_px, 11.0)
            << marker.ns << " on " << side << " cells";
      }
    }
    EXPECT_GT(texts, 5);
  }
}

TEST(ValueLegend, HasTheRangeTheColoursAndTheSymbolsWithinTheViewOfTheFarm) {
  const auto spec = test::MakeSpec();
  Values values;
  values.lowest = -3.9F;
  values.highest = 157.7F;
  values.actions = {9, 8};  // drop-off and pickup
  const auto draw = [&] {
    MarkerArray array;
    AddValueLegend(array, spec, values);
    return array;
  };
  std::string words;
  for (const auto& marker : draw().markers) {
    words += marker.text + "|";
    const double side_m = 25.0 * spec.cell_size_m;
    EXPECT_GT(marker.pose.position.y - 0.5 * marker.scale.z, -0.165 * 1.2 * side_m - 500.0)
        << marker.text;
    EXPECT_LT(marker.pose.position.x + 0.3 * marker.scale.z * double(marker.text.size()), side_m);
    if (marker.colors.empty()) continue;
    EXPECT_LT(marker.colors.front().g, 0.15F) << "viridis begins with dark violet";
    EXPECT_GT(marker.colors.back().g, 0.75F) << "and ends with green";
  }
  EXPECT_EQ(words, "value -3.9||157.7||best move||pickup||drop-off|");
  values.actions[0] = 0;
  int without_drop_off = 0;
  for (const auto& marker : draw().markers) {
    without_drop_off += marker.action == Marker::DELETE ? 1 : 0;
  }
  EXPECT_EQ(without_drop_off, 2) << "the symbol of a move that does not occur, and its name";
  values.actions[0] = 9;
  const auto keys = Keys(draw());
  values.highest = values.lowest;
  EXPECT_EQ(Keys(draw()), keys) << "a policy without values deletes the range";
  int deleted = 0;
  for (const auto& marker : draw().markers) deleted += marker.action == Marker::DELETE ? 1 : 0;
  EXPECT_EQ(deleted, 3);
}

TEST(StateMarkers, SayTheLocalTimeOfAFarmWithAPlace) {
  auto spec = test::MakeSpec();
  spec.has_start_time = spec.has_origin = true;
  spec.origin_longitude_deg = 122.7;
  auto state = test::MakeState();
  state.world_time = ros::Time(1627143360, 0);
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"status", 0}).text,
            "2021-07-25 00:16 UTC+8 (24 Jul 16:16 UTC)  episode 12  step 17  return -42.5");
}

TEST(SpecMarkers, NameTheRisksByTheirWindsIfAllAreGiven) {
  auto spec = test::MakeSpec();
  spec.disasters = {test::MakeDisaster(0, 12.0F, 12.0F)};
  spec.disasters[0].radii = {2.0F, 5.0F};
  spec.disasters[0].risks = {-10.0F, -5.0F};
  const auto words = [&spec] {
    std::string text;
    for (const auto& marker : SpecMarkers(spec, false).markers) {
      if (marker.ns == "legend_text") text += marker.text + "|";
    }
    return text;
  };
  EXPECT_EQ(words(), "5 km|risk|-5|-10|");
  spec.scenario_yaml = "disasters:\n  - ring_winds_kt: [50, 34]\n";
  EXPECT_EQ(words(), "5 km|risk|gale -5|storm -10|");
  spec.disasters.push_back(spec.disasters[0]);
  EXPECT_EQ(words(), "5 km|risk|-5|-10|") << "the winds of one are not given";
  spec.disasters.clear();
  EXPECT_EQ(words(), "5 km|risk|-5|-10|-15|-20|") << "disasters can come later";
}

TEST(StateMarkers, SayEpisodeStepAndReturn) {
  const auto status = ByKey(StateMarkers(test::MakeSpec(), test::MakeState())).at({"status", 0});
  EXPECT_EQ(status.text, "0 h 51 min  episode 12  step 17  return -42.5");
}

}  // namespace
}  // namespace aquafarm_viz
