// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/markers/danger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/markers/markers.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

using visualization_msgs::Marker;
using Key = std::pair<std::string, int>;

// A farm of 25 x 25 cells of 1 km. One device is in the outer ring, and one is far away.
struct Scene {
  aquafarm_msgs::FarmSpec spec = test::MakeSpec();
  aquafarm_msgs::FarmState state = test::MakeState();
  DangerMarkers danger;

  Scene() {
    state.devices = {test::MakeDevice(0, 0, 4, 12, 1.0F), test::MakeDevice(1, 1, 22, 22, 1.0F)};
    state.disasters = {test::MakeDisaster(0, -8.0F, 12.0F)};
    state.disasters[0].speed = 0.0F;
    state.disasters[0].radii = {2.0F, 14.0F};
    state.disasters[0].risks = {-20.0F, -5.0F};
  }

  // Sets the track of the disaster: from (-8, 12) to (x, 12) in ten steps.
  void SetTrackTo(int x) {
    state.step = 0;
    spec.scenario_yaml = R"(
disasters:
  - risks: [-20, -5]
    track:
      - {step: 0, x: -8, y: 12, radii: [2, 14], grade: 3, risks: [-20, -5]}
      - {step: 10, x: )" +
                         std::to_string(x) +
                         R"(, y: 12, radii: [2, 14], grade: 3, risks: [-20, -5]}
)";
  }

  std::map<Key, Marker> Draw(const Trail* trail = nullptr) {
    std::map<Key, Marker> result;
    for (const auto& marker : danger.Of(spec, state, trail).markers) {
      EXPECT_TRUE(result.emplace(Key(marker.ns, marker.id), marker).second) << marker.ns;
    }
    return result;
  }
};

TEST(DangerMarkers, NameTheDeviceTheRiskAndTheCentreOutsideTheFarm) {
  Scene scene;
  const auto markers = scene.Draw();
  EXPECT_EQ(markers.at({"alarm", 0}).text, "Typhoon: risk -5 over F0 now");
  EXPECT_EQ(markers.at({"danger_label", 0}).text, "F0: risk -5 now");
  EXPECT_EQ(markers.at({"danger_label", 1}).action, Marker::DELETE);
  EXPECT_EQ(markers.at({"danger", 1}).action, Marker::DELETE);
  EXPECT_EQ(markers.at({"outside", 0}).text, "typhoon, centre 20 km W, stands still");
  const Marker& circle = markers.at({"danger", 0});
  EXPECT_EQ(circle.action, Marker::ADD);
  EXPECT_EQ(circle.pose.position.x, 4000.0);
  EXPECT_FLOAT_EQ(circle.color.r, SeverityColor(Severity(-5)).r / 255.0F);
  EXPECT_LT(markers.at({"pointer", 0}).pose.position.x, 1000.0) << "at the western edge";
  EXPECT_EQ(markers.at({"pointer", 0}).pose.position.y, 12000.0);
}

TEST(DangerMarkers, DrawTwoCirclesAroundADeviceThatIsHitFirst) {
  Scene scene;
  scene.state.disasters[0].speed = 0.25F;  // moves to the east
  scene.state.disasters[0].heading_deg = 90;
  scene.state.devices = {test::MakeDevice(0, 0, 4, 12, 1.0F), test::MakeDevice(1, 0, 4, 13, 1.0F),
                         test::MakeDevice(2, 0, 9, 12, 1.0F)};
  const auto markers = scene.Draw();
  const auto points = [&](int id) { return markers.at({"danger", id}).points.size(); };
  EXPECT_EQ(points(0), 2 * points(2)) << "the second ring reaches device 2 later";
  EXPECT_GT(points(2), 0U);
}

TEST(DangerMarkers, ExplainTheSignsThatAreOnTheMap) {
  Scene scene;
  Trail trail;
  auto& ship = scene.state.ships.front();
  ship.aboard.clear();
  for (int i = 0; i < 3; ++i, ++ship.x) trail.Update(scene.state);
  const auto words = [&scene](const Trail* paths) {
    std::string result;
    for (const auto& [key, marker] : scene.Draw(paths)) {
      const bool is_text = key.first == "sign_legend_text" && marker.action == Marker::ADD;
      if (is_text) result += marker.text + "|";
    }
    return result;
  };
  EXPECT_EQ(words(&trail), "danger|to the centre|at risk|dashed: empty ship|");
  EXPECT_EQ(words(nullptr), "danger|to the centre|at risk|");
  scene.state.devices.push_back(test::MakeDevice(5, 0, 9, 12, 1.0F));  // hit later
  scene.state.disasters[0].speed = 0.25F;
  scene.state.disasters[0].heading_deg = 90;
  EXPECT_EQ(words(nullptr), "danger|hit first|to the centre|at risk|");
  scene.state.disasters[0].x = 24.0F;
  scene.state.disasters[0].radii = {1.0F, 2.0F};
  EXPECT_EQ(words(nullptr), "at risk|");
  scene.state.disasters[0].steps_left = 0;
  EXPECT_EQ(words(nullptr), "");
}

TEST(DangerMarkers, ReplaceTheLabelOfTheDevice) {
  Scene scene;
  const auto markers = scene.Draw();
  EXPECT_EQ(markers.at({"device_label", 0}).action, Marker::DELETE) << "F0 is in danger";
  EXPECT_EQ(markers.count({"device_label", 1}), 0U);
}

TEST(DangerMarkers, ReplaceMarkersOfTheStateWithTheSameId) {
  Scene scene;
  const auto array =
      Joined(StateMarkers(scene.spec, scene.state), scene.danger.Of(scene.spec, scene.state));
  std::map<Key, Marker> all;
  for (const auto& marker : array.markers) {
    EXPECT_TRUE(all.emplace(Key(marker.ns, marker.id), marker).second) << marker.ns;
  }
  EXPECT_EQ(all.at({"device_label", 0}).action, Marker::DELETE) << "F0 is in danger";
  EXPECT_EQ(all.at({"device_label", 1}).text, "F1");
}

TEST(DangerMarkers, AreDeletedWhenTheDangerIsOver) {
  Scene scene;
  auto before = scene.Draw();
  EXPECT_EQ(before.erase({"device_label", 0}), 1U);  // StateMarkers has the label again
  scene.state.disasters[0].steps_left = 0;
  const auto after = scene.Draw();
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [key, marker] : after) {
    EXPECT_TRUE(before.count(key)) << key.first;
    EXPECT_EQ(marker.action, Marker::DELETE) << key.first << " " << key.second;
  }
}

TEST(DangerMarkers, HaveNoPointerToACentreInTheFarm) {
  Scene scene;
  scene.state.disasters[0].x = 2.0F;
  EXPECT_EQ(scene.Draw().at({"pointer", 0}).action, Marker::DELETE);
  EXPECT_EQ(scene.Draw().at({"outside", 0}).action, Marker::DELETE);
}

TEST(DangerMarkers, NameSeveralDisastersOutsideBelowTheNextDanger) {
  Scene scene;
  scene.state.disasters.push_back(test::MakeDisaster(1, 60.0F, 12.0F));
  scene.state.disasters[1].kind = aquafarm_msgs::DisasterState::RED_TIDE;
  const auto markers = scene.Draw();
  EXPECT_EQ(markers.at({"outside", 0}).text,
            "typhoon, centre 20 km W, stands still\nred tide, centre 48 km E, E at 10 km/h now");
  EXPECT_LT(markers.at({"outside", 0}).pose.position.y, markers.at({"alarm", 0}).pose.position.y);
}

TEST(DangerMarkers, HaveLabelsInTheFarmThatCoverNeitherEachOtherNorDevices) {
  Scene scene;
  scene.state.devices.clear();
  for (int i = 0; i < 4; ++i) {
    scene.state.devices.push_back(test::MakeDevice(i, 0, 0, 11 + i, 1.0F));
  }
  const auto markers = scene.Draw();
  const auto half = [](const Marker& label) { return 0.21 * label.scale.z * label.text.size(); };
  for (int i = 0; i < 4; ++i) {
    const Marker& label = markers.at({"danger_label", i});
    EXPECT_GE(label.pose.position.x - half(label), -501.0);
    const Marker& plate = markers.at({"danger_label_plate", i});
    EXPECT_EQ(plate.pose.position.x, label.pose.position.x);
    EXPECT_LT(plate.pose.position.z, label.pose.position.z);
    EXPECT_GE(plate.scale.x, 2.0 * half(label) - 1.0);
    for (int j = 0; j < i; ++j) {
      const Marker& other = markers.at({"danger_label", j});
      EXPECT_TRUE(std::abs(label.pose.position.y - other.pose.position.y) >= label.scale.z ||
                  std::abs(label.pose.position.x - other.pose.position.x) >= half(label))
          << i << " over " << j;
    }
  }
}

TEST(DangerMarkers, LabelEveryDeviceInDangerThatHasAFreePlaceAndTheFirstInAnyCase) {
  Scene scene;
  scene.state.disasters[0].radii = {30.0F, 60.0F};
  scene.state.devices.clear();
  for (int i = 0; i < 9; ++i) {
    scene.state.devices.push_back(test::MakeDevice(i, 0, 3 + 8 * (i % 3), 3 + 8 * (i / 3), 1.0F));
  }
  const auto count = [&scene] {
    int labels = 0;
    for (const auto& [key, marker] : scene.Draw()) {
      labels += key.first == "danger_label" && marker.action == Marker::ADD ? 1 : 0;
    }
    return labels;
  };
  EXPECT_EQ(count(), 9);
  scene.state.devices.clear();
  for (int i = 0; i < 625; ++i) {  // no place is free
    scene.state.devices.push_back(test::MakeDevice(i, 0, i % 25, i / 25, 1.0F));
  }
  EXPECT_EQ(count(), 1);
}

TEST(DangerMarkers, PutNoLabelOnARockWhereAnotherPlaceIsFree) {
  Scene scene;
  scene.spec.rocks.clear();
  const double first = scene.Draw().at({"danger_label", 0}).pose.position.y;
  aquafarm_msgs::RockInfo rock;
  rock.cell = test::MakeCell(4, static_cast<int>(std::lround(first / 1000.0)));
  scene.spec.rocks.push_back(rock);
  EXPECT_GT(std::abs(scene.Draw().at({"danger_label", 0}).pose.position.y - first), 500.0);
}

TEST(DangerMarkers, PutNoLabelOnAnIslandWhereWaterIsFree) {
  Scene scene;
  scene.spec.rocks.clear();
  scene.spec.islands.clear();
  const double first = scene.Draw().at({"danger_label", 0}).pose.position.y;
  scene.spec.islands.push_back(test::MakeCell(4, static_cast<int>(std::lround(first / 1000.0))));
  EXPECT_GT(std::abs(scene.Draw().at({"danger_label", 0}).pose.position.y - first), 500.0);
}

// A storm in the south-east whose pointer lies next to the device that it reaches first.
struct SceneNextToAPointer : Scene {
  SceneNextToAPointer() {
    spec.width = 20;
    spec.height = 14;
    spec.rocks.clear();
    state.devices = {test::MakeDevice(0, 0, 12, 1, 1.0F), test::MakeDevice(1, 2, 18, 11, 1.0F)};
    state.disasters[0].x = 110.0F;
    state.disasters[0].y = -110.0F;
    state.disasters[0].radii = {2.0F, 400.0F};
    state.disasters[0].speed = 0.5F;
    state.disasters[0].heading_deg = 315;
  }
};

bool Covers(const Marker& plate, double x, double y) {
  return std::abs(x - plate.pose.position.x) < 0.5 * plate.scale.x &&
         std::abs(y - plate.pose.position.y) < 0.5 * plate.scale.y;
}

TEST(DangerMarkers, PutThePointerOnNoDevice) {
  SceneNextToAPointer scene;
  for (int x = 3; x < 20; ++x) {
    for (const int y : {0, 1, 2, 3}) {
      scene.state.devices[0].x = x;
      scene.state.devices[0].y = y;
      const auto markers = scene.Draw();
      const auto& pointer = markers.at({"pointer", 0}).pose.position;
      EXPECT_GT(std::hypot(pointer.x - 1000.0 * x, pointer.y - 1000.0 * y), 900.0)
          << "device at " << x << ", " << y;
    }
  }
}

TEST(DangerMarkers, CoverARockRatherThanGoFarAway) {
  Scene scene;
  scene.spec.rocks.clear();
  for (int x = 0; x < 25; ++x) {
    for (int y = 0; y < 25; ++y) {
      aquafarm_msgs::RockInfo rock;
      rock.cell = test::MakeCell(x, y);
      scene.spec.rocks.push_back(rock);
    }
  }
  const auto markers = scene.Draw();
  const auto& circle = markers.at({"danger", 0}).pose.position;
  const auto& label = markers.at({"danger_label", 0}).pose.position;
  EXPECT_LT(std::hypot(label.x - circle.x, label.y - circle.y), 5000.0);
}

TEST(DangerMarkers, HaveALineFromADistantLabelThatCrossesNoOther) {
  Scene scene;
  scene.state.disasters[0].radii = {30.0F, 60.0F};
  scene.state.devices.clear();
  for (int i = 0; i < 16; ++i) {
    scene.state.devices.push_back(test::MakeDevice(i, 0, 10 + i % 4, 10 + i / 4, 1.0F));
  }
  const auto markers = scene.Draw();
  int lines = 0;
  for (const auto& [key, marker] : markers) {
    if (key.first != "danger_label_leader" || marker.action != Marker::ADD) continue;
    ++lines;
    const auto& from = marker.points[0];
    const auto& to = marker.points[1];
    for (const auto& [other, plate] : markers) {
      if (other.first != "danger_label_plate" || other.second == key.second) continue;
      if (plate.action != Marker::ADD) continue;
      for (double share = 0.0; share <= 1.0; share += 0.02) {
        EXPECT_FALSE(
            Covers(plate, from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)))
            << key.second << " through " << other.second;
      }
    }
  }
  EXPECT_GT(lines, 2);
}

TEST(DangerMarkers, SayWhenAStormOutsideIsClosest) {
  Scene scene;
  scene.SetTrackTo(-3);
  scene.state.disasters[0].speed = 0.5F;
  EXPECT_EQ(scene.Draw().at({"outside", 0}).text,
            "typhoon, centre 20 km W, E at 10 km/h now, closest 15 km W in 30 min");
}

TEST(DangerMarkers, FollowTheTrackOfTheScenario) {
  Scene scene;
  scene.SetTrackTo(2);
  EXPECT_EQ(scene.Draw().at({"alarm", 0}).text, "Typhoon: risk -5 over F0 now, risk -20 in 30 min");
  scene.spec.scenario_yaml.replace(scene.spec.scenario_yaml.find("    track:"), 0,
                                   "    ring_winds_kt: [64, 34]\n");
  const auto named = scene.Draw();
  EXPECT_EQ(named.at({"alarm", 0}).text, "Typhoon: gale over F0 now, hurricane force in 30 min");
  EXPECT_EQ(named.at({"danger_label", 0}).text, "F0: gale now, 64 kt in 30 min");
}

TEST(DangerMarkers, PutAHeadlineThatIsWiderThanTheFarmInTwoLines) {
  Scene scene;
  scene.spec.scenario_yaml = R"(
disasters:
  - risks: [-20, -10, -5]
    ring_winds_kt: [64, 50, 34]
    track:
      - {step: 0, x: -8, y: 12, radii: [2, 8, 14], grade: 3, risks: [-20, -10, -5]}
      - {step: 10, x: 2, y: 12, radii: [2, 8, 14], grade: 3, risks: [-20, -10, -5]}
)";
  scene.spec.has_start_time = scene.spec.has_origin = true;
  scene.spec.origin_longitude_deg = 122.7;
  scene.spec.step_duration_s = 3600.0;
  scene.state.step = 0;
  scene.state.world_time = ros::Time(1627143360, 0);
  scene.state.disasters[0].radii = {2.0F, 8.0F, 14.0F};
  scene.state.disasters[0].risks = {-20.0F, -10.0F, -5.0F};
  scene.state.devices.push_back(test::MakeDevice(10, 0, 4, 12, 1.0F));
  const Marker alarm = scene.Draw().at({"alarm", 0});
  EXPECT_EQ(alarm.text,
            "Typhoon: gale over F0 and F10 now, storm in 4.0 h (Sun 04:16 UTC+8),\n"
            "hurricane force in 10 h (Sun 10:16)");
  // whole_view.cpp leaves 3.5 % of the farm free on its right. On the screen, letters are 0.40 of
  // their height wide on average.
  const double line_m = 0.40 * alarm.scale.z * double(alarm.text.find('\n'));
  EXPECT_LT(line_m, 1.07 * 25000.0);
}

}  // namespace
}  // namespace aquafarm_viz
