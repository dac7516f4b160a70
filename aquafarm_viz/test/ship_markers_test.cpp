// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "aquafarm_viz/markers/markers.h"
#include "fixture.h"
#include "marker_fixture.h"

namespace aquafarm_viz {
namespace {

using test::BearingDeg;
using test::ByKey;
using visualization_msgs::Marker;

TEST(ShipMarkers, NameShipsOnlyIfThereAreSeveral) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.ships.resize(1);
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"ship_name", 0}).action, Marker::DELETE);
  state.ships.push_back(state.ships[0]);
  state.ships[1].id = 1;
  state.ships[1].x += 3;
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"ship_name", 0}).text, "0");
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"ship_name", 1}).text, "1");
}

TEST(ShipMarkers, ShowTheLastMovesOfAShip) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.ships.resize(1);
  Trail trail;
  EXPECT_EQ(ByKey(StateMarkers(spec, state)).at({"path", 0}).action, Marker::DELETE);
  for (int step = 0; step < 3; ++step) {
    state.step = std::uint64_t(step);
    state.ships[0].x = 5 + step;
    state.ships[0].y = 7;
    trail.Update(state);
  }
  const auto path = ByKey(StateMarkers(spec, state, &trail)).at({"path", 0});
  ASSERT_EQ(path.points.size(), 2U * 6U);
  for (const auto& point : path.points) {
    EXPECT_NEAR(point.x, 6 * spec.cell_size_m, 1.3 * spec.cell_size_m);
    EXPECT_NEAR(point.y, 7 * spec.cell_size_m, 0.3 * spec.cell_size_m);
  }
  EXPECT_LT(path.colors.front().a, path.colors.back().a) << "the oldest is faint";
  EXPECT_EQ(path.colors.back().a, 1.0F);
}

TEST(ShipMarkers, ShowMovesWithNothingAboardAsDashes) {
  const auto spec = test::MakeSpec();
  // Returns the length of the drawn part of three moves [cells].
  const auto drawn = [&](bool is_loaded, std::int32_t own_device) {
    auto state = test::MakeState();
    state.ships.resize(1);
    state.ships[0].own_device = own_device;
    state.ships[0].aboard.assign(is_loaded ? 1 : 0, 0);
    Trail trail;
    for (int step = 0; step < 4; ++step) {
      state.step = std::uint64_t(step);
      state.ships[0].x = 5 + step;
      trail.Update(state);
    }
    const auto path = ByKey(StateMarkers(spec, state, &trail)).at({"path", 0});
    double length = 0.0;
    for (std::size_t i = 0; i + 5 < path.points.size(); i += 6) {
      length += (path.points[i + 1].x - path.points[i].x) / spec.cell_size_m;
    }
    return length;
  };
  EXPECT_GE(drawn(true, -1), 3.0);
  EXPECT_NEAR(drawn(false, -1), 1.8, 0.01);
  EXPECT_GE(drawn(false, 0), 3.0) << "a self-propelled device";
}

TEST(ShipMarkers, ShowTheOutlineOfAFetchedDeviceInItsFormerCell) {
  auto spec = test::MakeSpec();
  auto state = test::MakeState();
  spec.devices = state.devices;
  spec.devices[1].x = 3;
  spec.devices[1].y = 4;
  const auto markers = ByKey(StateMarkers(spec, state));
  EXPECT_EQ(markers.at({"fetched", 0}).action, Marker::DELETE) << "still deployed";
  const Marker& outline = markers.at({"fetched", 1});
  ASSERT_EQ(outline.action, Marker::ADD);
  EXPECT_DOUBLE_EQ(outline.pose.position.x, 3 * spec.cell_size_m);
  EXPECT_DOUBLE_EQ(outline.pose.position.y, 4 * spec.cell_size_m);
  for (const auto& point : outline.points) {
    EXPECT_GT(std::hypot(point.x, point.y), 0.1 * spec.cell_size_m) << "hollow";
  }
}

TEST(ShipMarkers, ShowAShipNextToThePortInItsCell) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  for (int port = 0; port < 4; ++port) {
    const auto& cell = spec.ports[std::size_t(port)].cell;
    for (const bool has_ship : {false, true}) {
      state.ships[0].x = has_ship ? cell.x : 12;
      state.ships[0].y = has_ship ? cell.y : 20;
      const auto markers = ByKey(StateMarkers(spec, state));
      const Marker& disc = markers.at({"port", port});
      const Marker& letter = markers.at({"port_letter", port});
      EXPECT_EQ(letter.text, std::string(1, char('A' + port)));
      EXPECT_EQ(letter.pose.position.x, disc.pose.position.x);
      EXPECT_EQ(disc.pose.position.x, cell.x * spec.cell_size_m);
      EXPECT_EQ(disc.pose.position.y, cell.y * spec.cell_size_m);
      const Marker& ship = markers.at({"ship", 0});
      const double away = std::hypot(ship.pose.position.x / spec.cell_size_m - state.ships[0].x,
                                     ship.pose.position.y / spec.cell_size_m - state.ships[0].y);
      if (has_ship) {
        EXPECT_GT(away, 1.0) << "port " << port << " is covered";
        EXPECT_LT(away, 1.5);
      } else {
        EXPECT_EQ(away, 0.0);
      }
    }
  }
}

TEST(ShipMarkers, TurnAShipTowardsItsMove) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  for (const auto& [action, bearing] : {std::pair{0, 0}, {3, 90}, {5, 45}, {6, 225}}) {
    state.ships.front().action = static_cast<std::uint8_t>(action);
    const auto ship = ByKey(StateMarkers(spec, state)).at({"ship", 0});
    EXPECT_NEAR(BearingDeg(ship, 0.0), bearing, 1e-6);
  }
}

}  // namespace
}  // namespace aquafarm_viz
