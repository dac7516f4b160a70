// SPDX-License-Identifier: BSD-3-Clause
/// The arrows at the ports and the labels of the devices (Fig. 5).

#include "aquafarm_viz/scene/directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/draw/image.h"
#include "aquafarm_viz/markers/markers.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

// The displacement of each action, as in aquafarm/grid/action.h: N, S, W, E, NW, NE, SW, SE.
constexpr int kMoves[8][2]{{0, 1}, {0, -1}, {-1, 0}, {1, 0}, {-1, 1}, {1, 1}, {-1, -1}, {1, -1}};

// Slow oracle: searches every island and rock for every neighbour.
std::set<int> LegalAt(const aquafarm_msgs::FarmSpec& spec, const aquafarm_msgs::Cell& port) {
  std::set<int> legal;
  for (int action = 0; action < 8; ++action) {
    const int x = port.x + kMoves[action][0];
    const int y = port.y + kMoves[action][1];
    bool free = x >= 0 && y >= 0 && x < spec.width && y < spec.height;
    for (const auto& cell : spec.islands) free = free && !(cell.x == x && cell.y == y);
    for (const auto& rock : spec.rocks) free = free && !(rock.cell.x == x && rock.cell.y == y);
    if (free) legal.insert(action);
  }
  return legal;
}

std::vector<Marker> In(const MarkerArray& array, const std::string& space) {
  std::vector<Marker> found;
  for (const auto& marker : array.markers) {
    if (marker.ns == space) found.push_back(marker);
  }
  return found;
}

TEST(LegalDirections, LeadToCellsWithoutIslandOrRock) {
  std::set<std::size_t> counts;
  for (const int side : {5, 8, 13, 25, 40}) {
    const auto spec = test::MakeSpec(side);
    const auto ports = LegalDirections(spec);
    ASSERT_EQ(ports.size(), spec.ports.size());
    for (std::size_t i = 0; i < ports.size(); ++i) {
      EXPECT_EQ(ports[i].port, spec.ports[i].id);
      const std::set<int> actions(ports[i].actions.begin(), ports[i].actions.end());
      EXPECT_EQ(actions, LegalAt(spec, spec.ports[i].cell)) << "side " << side << ", port " << i;
      counts.insert(actions.size());
    }
  }
  EXPECT_GT(counts.size(), 2U);  // the farms differ
}

TEST(LegalDirections, OfAPortOutsideTheGridAreNotListed) {
  auto spec = test::MakeSpec();
  spec.ports[2].cell.x = 25;
  const auto ports = LegalDirections(spec);
  ASSERT_EQ(ports.size(), 3U);
  EXPECT_EQ(ports[2].port, 3);
}

TEST(LegalDirections, AreMarkersOnlyIfTheLayerIsOn) {
  auto spec = test::MakeSpec();
  spec.cell_size_m = 250.0;
  EXPECT_TRUE(In(SpecMarkers(spec, true), "port_direction").empty());
  EXPECT_TRUE(
      In(SpecMarkers(spec, true, ParseLayers("trail,risk,labels")), "port_direction").empty());
  const auto markers = In(SpecMarkers(spec, true, ParseLayers("directions")), "port_direction");
  ASSERT_EQ(markers.size(), 4U);
  for (const auto& marker : markers) {
    const auto& port = spec.ports[static_cast<std::size_t>(marker.id)].cell;
    EXPECT_DOUBLE_EQ(marker.pose.position.x, port.x * 250.0);
    EXPECT_DOUBLE_EQ(marker.pose.position.y, port.y * 250.0);
    std::set<int> shown;
    for (std::size_t i = 8; i < marker.points.size(); i += 9) {  // point 8 of an arrow is its tip
      const double east = marker.points[i].x;
      const double north = marker.points[i].y;
      for (int action = 0; action < 8; ++action) {
        const double length = std::hypot(kMoves[action][0], kMoves[action][1]);
        const double along = (east * kMoves[action][0] + north * kMoves[action][1]) / length;
        if (std::abs(along - std::hypot(east, north)) < 1e-6) shown.insert(action);
      }
    }
    EXPECT_EQ(shown, LegalAt(spec, port)) << "port " << marker.id;
    EXPECT_EQ(marker.points.size(), 9 * shown.size());
  }
}

TEST(DeviceLabels, AreMarkersOfDeployedDevicesOnlyIfTheLayerIsOn) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();  // device 1 is delivered
  state.devices[2].status = aquafarm_msgs::DeviceState::ABOARD;
  EXPECT_TRUE(In(StateMarkers(spec, state, nullptr, ParseLayers("risk")), "device_label").empty());
  const auto markers =
      In(StateMarkers(spec, state, nullptr, ParseLayers("labels")), "device_label");
  ASSERT_EQ(markers.size(), 4U);
  for (const int id : {0, 3}) {
    const auto& marker = markers[static_cast<std::size_t>(id)];
    EXPECT_EQ(marker.action, Marker::ADD);
    EXPECT_EQ(marker.id, id);
    EXPECT_EQ(marker.text, "F" + std::to_string(id));
  }
  for (const std::size_t id : {1U, 2U}) EXPECT_EQ(markers[id].action, Marker::DELETE);
}

TEST(DeviceLabels, AreAtACornerOfTheDeviceWhereNoShipIs) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeEmptyState();
  state.devices.push_back(test::MakeDevice(0, 0, 10, 10, 1.0F));
  const auto place = [&] {
    const auto marker =
        In(StateMarkers(spec, state, nullptr, ParseLayers("labels")), "device_label").at(0);
    return cv::Point2d(marker.pose.position.x, marker.pose.position.y) / spec.cell_size_m;
  };
  const cv::Point2d first = place();
  EXPECT_GT(first.x, 10.0);
  EXPECT_LT(first.y, 10.0);
  state.ships.push_back(test::MakeShip(0, int(std::lround(first.x)), int(std::lround(first.y))));
  EXPECT_LT(place().x, 10.0) << "south-west";
  state.ships[0].visible = false;
  EXPECT_EQ(place(), first) << "a ship that is not visible does not matter";
}

// Returns the number of pixels that a layer changes near a cell, by octant: the bearing of its
// middle, seen from the centre of the cell [degrees].
std::map<int, int> ChangedAround(const aquafarm_msgs::FarmSpec& spec, const std::string& layer,
                                 int x, int y) {
  auto state = test::MakeState();
  state.disasters.clear();
  state.ships.clear();
  Overlays overlays;
  overlays.layers = ParseLayers("none");
  constexpr ImageSize kSize{1200, 1200};
  const cv::Mat without = DrawFarm(spec, state, kSize, overlays);
  overlays.layers = ParseLayers(layer);
  const cv::Mat with = DrawFarm(spec, state, kSize, overlays);
  const MapPlace place = PlaceMap(spec.width, spec.height, kSize);
  const cv::Point2d middle = place.view.ToPixel(x, y) + cv::Point2d(place.map.tl());
  std::map<int, int> changed;
  for (int row = 0; row < with.rows; ++row) {
    for (int column = 0; column < with.cols; ++column) {
      if (with.at<cv::Vec3b>(row, column) == without.at<cv::Vec3b>(row, column)) continue;
      const cv::Point2d offset = cv::Point2d(column, row) - middle;
      if (cv::norm(offset) > 1.9 * place.view.cell_px()) continue;
      const double bearing_deg = std::atan2(offset.x, -offset.y) * 180.0 / CV_PI + 360.0;
      ++changed[int(std::lround(bearing_deg / 45.0)) % 8 * 45];
    }
  }
  return changed;
}

TEST(Image, ShowsAnArrowForEachLegalMoveAtAPort) {
  auto spec = test::MakeSpec();
  spec.islands.clear();
  spec.rocks.clear();
  spec.ports.resize(1);
  spec.ports[0].cell = test::MakeCell(12, 5);
  spec.islands = {test::MakeCell(13, 5), test::MakeCell(12, 4)};  // east and south
  spec.rocks.resize(1);
  spec.rocks[0].cell = test::MakeCell(11, 6);  // north-west
  const auto changed = ChangedAround(spec, "directions", 12, 5);
  for (const int bearing : {0, 45, 135, 225, 270}) {
    ASSERT_EQ(changed.count(bearing), 1U) << bearing;
    EXPECT_GT(changed.at(bearing), 60) << bearing;
  }
  for (const int bearing : {90, 180, 315}) EXPECT_EQ(changed.count(bearing), 0U) << bearing;
}

TEST(Image, LabelsDeployedDevicesToTheirRight) {
  const auto spec = test::MakeSpec();
  const auto deployed = test::MakeState().devices[0];
  const auto changed = ChangedAround(spec, "labels", deployed.x, deployed.y);
  int pixels = 0;
  for (const auto& [bearing, count] : changed) {
    EXPECT_TRUE(bearing >= 45 && bearing <= 135) << bearing;
    pixels += count;
  }
  EXPECT_GT(pixels, 20);
  const auto delivered = test::MakeState().devices[1];
  EXPECT_TRUE(ChangedAround(spec, "labels", delivered.x, delivered.y).empty());
}

}  // namespace
}  // namespace aquafarm_viz
