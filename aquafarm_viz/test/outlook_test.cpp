// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook.h"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <utility>

#include "aquafarm_viz/draw/image.h"
#include "draw/free_space.h"
#include "draw/legend.h"
#include "draw/map_labels.h"
#include "draw/symbols.h"
#include "outlooks.h"
#include "scene/nautical.h"
#include "scene/outlook_text.h"

namespace aquafarm_viz {
namespace {

using test::kRecorded;
using test::Outlooks;
using test::WithWinds;

TEST(Outlook, OfAPresentCourseNamesEachRingAndItsTime) {
  const Outlooks scene;
  const Outlook outlook = scene.outlook();
  ASSERT_EQ(outlook.devices.size(), 1U);
  EXPECT_TRUE(outlook.is_known);
  EXPECT_TRUE(outlook.is_extrapolated);
  ASSERT_EQ(outlook.devices[0].arrivals.size(), 2U);
  EXPECT_EQ(outlook.devices[0].arrivals[0].steps, 20.0);  // 30 cells away, ring of 10
  EXPECT_EQ(outlook.devices[0].arrivals[0].risk, -5.0);
  EXPECT_EQ(outlook.devices[0].arrivals[1].steps, 25.0);
  EXPECT_EQ(outlook.devices[0].arrivals[1].risk, -20.0);
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -5 reaches F3 in about 1.0 h, risk -20 in about 1.2 h");
}

TEST(Outlook, FollowsTheRecordedTrackAndItsShrinkingRings) {
  Outlooks scene;
  scene.storms = ReadStormTracks(kRecorded, 1000.0);
  EXPECT_EQ(scene.course().kind, Course::Kind::kRecorded);
  EXPECT_EQ(scene.course().past.size(), 2U);
  const Outlook outlook = scene.outlook();
  EXPECT_FALSE(outlook.is_extrapolated);
  ASSERT_EQ(outlook.devices[0].arrivals.size(), 1U) << "the inner ring never comes";
  EXPECT_EQ(outlook.devices[0].arrivals[0].steps, 10.0);
  scene.spec.has_start_time = true;
  scene.spec.step_duration_s = 1800.0;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -5 reaches F3 in 5.0 h (Thu 05:51 UTC)")
      << "5 h after the state's time, 0 h 51 min";
  scene.spec.has_start_time = false;
  scene.spec.step_duration_s = 0.0;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -5 reaches F3 in 10 steps");
}

TEST(Outlook, NamesNoWindThatIsNotGiven) {
  Outlooks scene;
  scene.storms = ReadStormTracks(WithWinds("[50, 34]"), 1000.0);
  scene.state.disasters[0].radii = {2.0F, 5.0F, 10.0F};  // from a bulletin with other rings
  scene.state.disasters[0].risks = {-20.0F, -10.0F, -5.0F};
  EXPECT_TRUE(scene.course().ring_winds_kt.empty());
  scene.state.disasters[0].radii = {5.0F, 10.0F};
  scene.state.disasters[0].risks = {-20.0F, -5.0F};
  EXPECT_EQ(scene.course().ring_winds_kt.size(), 2U);
  scene.state.disasters[0].y = 20.0F;  // away from its track
  EXPECT_TRUE(scene.course().ring_winds_kt.empty());
}

TEST(RiskKey, NamesRingsOnlyIfAllAreGiven) {
  Outlooks scene;
  scene.storms = ReadStormTracks(WithWinds("[50, 34]"), 1000.0);
  const RiskKey key = MakeRiskKey(scene.state, {scene.course()});
  ASSERT_EQ(key.size(), 2U);
  EXPECT_EQ(key[0].wind_kt, 34);
  EXPECT_EQ(key[0].risk, -5.0);
  EXPECT_EQ(key[1].wind_kt, 50);
  const Course named = scene.course();
  scene.state.disasters.push_back(test::MakeDisaster(1, 5.0F, 5.0F));
  const RiskKey mixed = MakeRiskKey(scene.state, {named, CourseOf(scene.spec, scene.state, 1, {})});
  ASSERT_FALSE(mixed.empty());
  for (const KeyRing& ring : mixed) EXPECT_EQ(ring.wind_kt, 0);
}

TEST(RiskKey, ListsRisksOfRingsWithoutNamesOnceTheMildestFirst) {
  Outlooks scene;
  scene.state.disasters.push_back(test::MakeDisaster(1, 5.0F, 5.0F));
  scene.state.disasters[1].kind = aquafarm_msgs::DisasterState::RED_TIDE;
  scene.state.disasters[1].radii = {2.0F, 4.0F};
  scene.state.disasters[1].risks = {-8.0F, -5.0F};
  const RiskKey rings =
      MakeRiskKey(scene.state, {scene.course(), CourseOf(scene.spec, scene.state, 1, {})});
  ASSERT_EQ(rings.size(), 3U);
  EXPECT_EQ(rings[0].risk, -5.0);
  EXPECT_EQ(rings[1].risk, -8.0);
  EXPECT_EQ(rings[1].kind, aquafarm_msgs::DisasterState::RED_TIDE);
  EXPECT_EQ(rings[2].risk, -20.0);
}

TEST(RiskKey, LeavesOutARingThatTheDisasterNeverHas) {
  Outlooks scene;
  scene.storms = ReadStormTracks(WithWinds("[50, 34]"), 1000.0);
  Course course = scene.course();
  for (TrackPoint& point : course.ahead) point.radii[0] = {};
  const RiskKey key = MakeRiskKey(scene.state, {course});
  ASSERT_EQ(key.size(), 1U);
  EXPECT_EQ(key[0].wind_kt, 34);
}

TEST(Outlook, OfADeviceInARingIsNow) {
  Outlooks scene;
  scene.state.disasters[0].x = 12.0F;
  scene.state.disasters[0].speed = 0.0F;
  const Outlook outlook = scene.outlook();
  EXPECT_EQ(outlook.devices[0].risk_now, -20.0);
  EXPECT_TRUE(outlook.devices[0].arrivals.empty());
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook), "typhoon: risk -20 over F3 now");
  EXPECT_EQ(DangerText(scene.spec, outlook.devices[0]), "risk -20 now");
}

TEST(Outlook, ListsTheDeviceThatIsReachedFirst) {
  Outlooks scene;
  scene.state.devices.push_back(test::MakeDevice(4, 1, 20, 12, 1.0F));
  scene.state.devices.push_back(test::MakeDevice(5, 1, 24, 12, 1.0F));
  scene.state.devices.back().status = aquafarm_msgs::DeviceState::DELIVERED;
  const Outlook outlook = scene.outlook();
  ASSERT_EQ(outlook.devices.size(), 2U) << "a delivered device is safe";
  EXPECT_EQ(outlook.devices[0].id, 4);
  EXPECT_EQ(outlook.devices[1].id, 3);
}

TEST(Outlook, ListsADeviceInARingBeforeOneThatIsReachedLater) {
  Outlooks scene;
  scene.state.devices.push_back(test::MakeDevice(2, 1, 21, 12, 1.0F));
  scene.state.devices.push_back(test::MakeDevice(6, 1, 17, 12, 1.0F));
  scene.state.disasters[0].x = 22.0F;
  const Outlook outlook = scene.outlook();
  ASSERT_EQ(outlook.devices.size(), 3U);
  EXPECT_EQ(outlook.devices[0].id, 2);
  EXPECT_EQ(outlook.devices[0].risk_now, -20.0);
  EXPECT_EQ(outlook.devices[1].id, 6) << "on the edge of the inner ring";
  EXPECT_EQ(outlook.devices[2].id, 3) << "reached in 2 steps";
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -20 over F2 and F6 now, risk -5 reaches F3 in about 6 min, "
            "risk -20 in about 21 min");
  EXPECT_EQ(ShortOutlookText(scene.spec, outlook), "F2: risk -20 now");
}

TEST(Outlook, PutsTheSoonerNextArrivalFirstAndCountsManyDevicesInOneRing) {
  Outlooks scene;
  scene.state.disasters[0].x = 18.0F;  // moves to the west; the device 3 is in the outer ring
  const auto three = scene.state.devices[0];
  scene.state.devices.push_back(test::MakeDevice(0, 1, three.x - 1, three.y, 1.0F));
  const Outlook two = scene.outlook();
  ASSERT_EQ(two.devices.size(), 2U);
  EXPECT_EQ(two.devices[0].risk_now, two.devices[1].risk_now);
  EXPECT_EQ(two.devices[0].id, 3) << "its next ring comes sooner";
  scene.state.devices.push_back(test::MakeDevice(1, 1, three.x, three.y + 1, 1.0F));
  const auto begin = [&] {
    const std::string text = OutlookText(scene.spec, scene.state, scene.outlook());
    return text.substr(0, text.find(" now"));
  };
  EXPECT_EQ(begin(), "typhoon: risk -5 over F0, F1 and F3");
  scene.state.devices.push_back(test::MakeDevice(4, 1, three.x - 1, three.y + 1, 1.0F));
  EXPECT_EQ(begin(), "typhoon: risk -5 over 4 devices");
}

TEST(Outlook, OfADeviceInARingNamesTheWorseRingToCome) {
  Outlooks scene;
  scene.state.disasters[0].x = 18.0F;
  const Outlook outlook = scene.outlook();
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -5 over F3 now, risk -20 in about 9 min");
  EXPECT_EQ(DangerText(scene.spec, outlook.devices[0]), "risk -5 now, -20 in 9 min");
}

// Returns the distance of a point from the area of the rings, from points on a grid of 0.02 cells.
double SlowDistance(const TrackPoint& storm, double x, double y) {
  double nearest = 1e9;
  for (double east = -12.0; east <= 12.0; east += 0.02) {
    for (double north = -12.0; north <= 12.0; north += 0.02) {
      const std::size_t quadrant = north >= 0.0 ? (east >= 0.0 ? 0U : 3U) : (east >= 0.0 ? 1U : 2U);
      if (std::hypot(east, north) > storm.radii[0][quadrant]) continue;
      nearest = std::min(nearest, std::hypot(storm.x + east - x, storm.y + north - y));
    }
  }
  return nearest;
}

TEST(Outlook, MeasuresTheDistanceToTheNearestPartOfARing) {
  Outlooks scene;
  scene.state.disasters[0].radii = {10.0F};
  scene.state.disasters[0].risks = {-5.0F};
  scene.state.disasters[0].quadrants = {10.0F, 3.0F, 1.0F, 6.0F};
  scene.state.disasters[0].speed = 0.0F;
  for (const auto& [x, y] :
       {std::pair(24.0F, 15.0F), std::pair(6.0F, 22.0F), std::pair(7.0F, 14.0F),
        std::pair(12.0F, 16.5F), std::pair(-1.0F, 3.0F)}) {
    scene.state.disasters[0].x = x;
    scene.state.disasters[0].y = y;
    const Outlook outlook = scene.outlook();
    ASSERT_FALSE(IsInDanger(outlook)) << x;
    EXPECT_NEAR(outlook.miss.cells, SlowDistance(scene.course().ahead.front(), 10.0, 12.0), 0.03)
        << x;
    EXPECT_EQ(outlook.miss.steps, 0.0);
    EXPECT_EQ(outlook.miss.device, 3);
  }
  scene.state.disasters[0].x = 90.0F;
  EXPECT_TRUE(std::isinf(scene.outlook().miss.cells)) << "farther than a diagonal of the farm";
}

TEST(Outlook, UsesTheRadiusOfTheQuadrant) {
  Outlooks scene;
  scene.state.disasters[0].y = 9.0F;  // the device is to the north-west
  scene.state.disasters[0].quadrants = {1.0F, 1.0F, 1.0F, 1.0F, 10.0F, 10.0F, 10.0F, 5.1F};
  const Outlook outlook = scene.outlook();
  ASSERT_FALSE(outlook.devices[0].arrivals.empty());
  EXPECT_EQ(outlook.devices[0].arrivals[0].steps, 26.0) << "radius 5.1: 4 cells west, 3 north";
}

TEST(Outlook, CountsAnAxisToTheQuadrantThatFollowsClockwiseAsTheFarmDoes) {
  constexpr std::array<std::pair<float, float>, 4> kCentres{
      // seen from them, the device is due
      {{10.0F, 9.0F}, {7.0F, 12.0F}, {10.0F, 15.0F}, {13.0F, 12.0F}}};  // north, east, south, west
  for (std::size_t i = 0; i < 4; ++i) {
    Outlooks scene;
    auto& disaster = scene.state.disasters[0];
    std::tie(disaster.x, disaster.y) = kCentres[i];
    disaster.speed = 0.0F;
    disaster.radii = {5.0F};
    disaster.risks = {-5.0F};
    for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
      disaster.quadrants = {1.0F, 1.0F, 1.0F, 1.0F};
      disaster.quadrants[quadrant] = 5.0F;
      EXPECT_EQ(scene.outlook().devices[0].risk_now, quadrant == i ? -5.0 : 0.0)
          << i << ", " << quadrant;
    }
  }
}

TEST(Outlook, SaysNothingOfTooManyDevicesAndOfDisastersThatAreOver) {
  Outlooks scene;
  scene.state.disasters[0].steps_left = 0;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()), "");
  Outlooks crowd;
  crowd.state.devices.assign(1000, crowd.state.devices[0]);
  EXPECT_NE(OutlookText(crowd.spec, crowd.state, crowd.outlook()), "") << "the most of a scenario";
  crowd.state.devices.push_back(crowd.state.devices[0]);
  EXPECT_FALSE(crowd.outlook().is_known);
  EXPECT_EQ(OutlookText(crowd.spec, crowd.state, crowd.outlook()), "");
}

TEST(Course, OfAnObservationOrAMovedStormIsExtrapolated) {
  Outlooks scene;
  scene.storms = ReadStormTracks(kRecorded, 1000.0);
  scene.state.observer = 0;
  EXPECT_EQ(scene.course().kind, Course::Kind::kExtrapolated);
  scene.state.observer = -1;
  scene.state.disasters[0].x = 43.0F;
  EXPECT_EQ(scene.course().kind, Course::Kind::kExtrapolated);
}

TEST(Course, IsTheNewestPublishedForecastThatHasNotExpired) {
  Outlooks scene;
  scene.storms = ReadStormTracks(std::string(kRecorded) + R"(
    forecasts:
      - {step: -9, points: [{step: 20, x: 0, y: 12}]}
      - {step: -1, points: [{step: 20, x: 40, y: 50}]}
      - {step: 5, points: [{step: 20, x: -9, y: 12}]}
)",
                                 1000.0);
  ASSERT_EQ(scene.storms.forecasts.size(), 1U);
  const Course course = scene.course();
  EXPECT_EQ(course.kind, Course::Kind::kPublished);
  EXPECT_DOUBLE_EQ(TrackAt(course.ahead, 10.0).y, 31.0);
  EXPECT_EQ(TrackAt(course.ahead, 10.0).radii.size(), 2U) << "rings of the true storm";
  EXPECT_EQ(scene.outlook().devices[0].arrivals.size(), 0U);
}

TEST(Course, ContinuesAfterTheLastPointOfAForecast) {
  // The true storm comes to (20, 12); the forecast stops short of it, on its way to the device.
  Outlooks scene;
  const auto forecast = [&scene](const char* points) {
    scene.storms = ReadStormTracks(
        std::string(kRecorded) + "    forecasts: [{step: 0, points: [" + points + "]}]\n", 1000.0);
    return scene.course();
  };
  const Course two = forecast("{step: 5, x: 35, y: 12}, {step: 10, x: 30, y: 14, radii: [5, 10]}");
  EXPECT_EQ(two.kind, Course::Kind::kPublished);
  EXPECT_EQ(two.known_until, 10.0);
  EXPECT_DOUBLE_EQ(TrackAt(two.ahead, 20.0).x, 20.0);
  EXPECT_DOUBLE_EQ(TrackAt(two.ahead, 20.0).y, 18.0);
  EXPECT_DOUBLE_EQ(TrackAt(two.ahead, 30.0).x, 10.0) << "until the true track ends";
  EXPECT_DOUBLE_EQ(TrackAt(two.ahead, 500.0).x, 10.0) << "and it stays there";
  EXPECT_FALSE(scene.outlook().devices[0].arrivals.empty());
  const Course one = forecast("{step: 10, x: 30, y: 12, radii: [5, 10]}");
  EXPECT_DOUBLE_EQ(TrackAt(one.ahead, 25.0).x, 15.0) << "with the present motion";
  scene.state.disasters[0].steps_left = 8;
  EXPECT_DOUBLE_EQ(scene.course().ahead.back().step, 8.0);
  EXPECT_DOUBLE_EQ(scene.course().ahead.back().x, 32.0);
}

TEST(Course, OfAStormThatHasNoRingsYetHasTheRisksOfItsForecast) {
  Outlooks scene;
  scene.state.disasters[0].radii.clear();
  scene.state.disasters[0].risks.clear();
  scene.storms = ReadStormTracks(R"(
disasters:
  - risks: [-20, -5]
    track: [{step: 0, x: 40, y: 12}, {step: 40, x: 0, y: 12}]
    forecasts: [{step: 0, points: [{step: 30, x: 10, y: 12, radii: [5, 10]}]}]
)",
                                 1000.0);
  const Outlook outlook = scene.outlook();
  ASSERT_EQ(outlook.devices[0].arrivals.size(), 2U);
  EXPECT_EQ(outlook.devices[0].arrivals[0].risk, -5.0);
  EXPECT_EQ(outlook.devices[0].arrivals[1].risk, -20.0);
}

TEST(Course, OfADisasterWithoutATrackGrowsButNeverShrinks) {
  Outlooks scene;
  scene.state.disasters[0].speed = 0.0F;  // 30 cells east of the device
  EXPECT_TRUE(scene.outlook().devices[0].arrivals.empty());
  scene.storms = ReadStormTracks("disasters: [{radius_growth: 0.5}]", 1000.0);
  ASSERT_EQ(scene.outlook().devices[0].arrivals.size(), 2U);
  EXPECT_EQ(scene.outlook().devices[0].arrivals[0].steps, 40.0) << "from radius 10 to 30";
  scene.storms = ReadStormTracks("disasters: [{radius_growth: -0.5}]", 1000.0);
  EXPECT_EQ(scene.course().ahead.back().radii, scene.course().ahead.front().radii);
  scene.storms = ReadStormTracks("disasters: [{radius_growth: 0.5}]", 1000.0);
  scene.state.disasters[0].quadrants = {0, 5, 5, 5, 0, 10, 10, 10};
  EXPECT_EQ(scene.course().ahead.back().radii[0][0], 0.0) << "a missing quadrant";
  EXPECT_EQ(scene.course().ahead.back().radii[0][1], 35.0);
}

TEST(Course, HasAConeWhereForecastsHaveAnError) {
  Outlooks scene;
  scene.spec.step_duration_s = 3600.0;
  scene.storms =
      ReadStormTracks(std::string(kRecorded) + "view: {forecast_error_km: [48, 96]}\n", 1000.0);
  const Course course = scene.course();
  ASSERT_EQ(course.errors.size(), course.ahead.size());
  EXPECT_DOUBLE_EQ(course.errors.front(), 0.0);
  EXPECT_DOUBLE_EQ(course.errors[1], 20.0);  // 10 h: 10 / 24 of 48 km
  EXPECT_DOUBLE_EQ(MeanForecastError({48.0, 96.0}, 36.0), 72.0);
  EXPECT_DOUBLE_EQ(MeanForecastError({48.0, 96.0}, 72.0), 144.0) << "along the last two";
  const auto draw = [&scene](const char* more) {
    scene.spec.scenario_yaml = std::string(kRecorded) + more;
    return DrawFarm(scene.spec, scene.state, {640, 640});
  };
  EXPECT_GT(cv::norm(draw(""), draw("view: {forecast_error_km: [48, 96]}\n")), 1000.0);
}

// Returns the number of separate parts of a map that a drawing changes.
template <typename Draw>
int CountParts(const Layout& layout, Draw draw) {
  cv::Mat map(layout.map.size(), CV_8UC3, cv::Scalar::all(0));
  draw(map);
  cv::Mat changed;
  cv::inRange(map, cv::Scalar::all(0), cv::Scalar::all(0), changed);
  cv::bitwise_not(changed, changed);
  cv::Mat labels;
  return cv::connectedComponents(changed, labels) - 1;
}

TEST(LabelDanger, NamesEveryDeviceThatHasAFreePlaceNearby) {
  Outlooks scene;
  scene.state.disasters[0].x = 12.0F;
  scene.state.disasters[0].speed = 0.0F;
  scene.state.disasters[0].radii = {1.0F, 100.0F};
  scene.state.devices.clear();
  for (int i = 0; i < 9; ++i) {
    scene.state.devices.push_back(test::MakeDevice(i, 0, 3 + 8 * (i % 3), 3 + 8 * (i / 3), 1.0F));
  }
  const Layout layout = MakeLayout(25, 25, {960, 960});
  const Fonts fonts(layout.unit);
  const auto count = [&](const FreeSpace& symbols) {
    LabelSpace space(symbols, scene.spec, layout);
    return CountParts(layout, [&](cv::Mat& map) {
      LabelDanger(map, scene.spec, scene.state, scene.outlook(), space, layout, fonts);
    });
  };
  EXPECT_EQ(count(FreeSpace(layout.map.size())), 9);
  FreeSpace full(layout.map.size());
  full.Block(cv::Rect({0, 0}, layout.map.size()));
  EXPECT_EQ(count(full), 0) << "a label covers nothing";
}

TEST(Outlook, GivesTheMotionAndTheClosestApproach) {
  Outlooks scene;
  EXPECT_EQ(ApproachText(scene.spec, scene.state.disasters[0], scene.course()), "W at 20 km/h now")
      << "the present motion does not say when a storm is closest";
  scene.state.disasters[0].visible = false;
  EXPECT_EQ(MotionNow(scene.spec, scene.state.disasters[0]), "W at 20 km/h")
      << "the last known one";
  scene.state.disasters[0].visible = true;
  scene.storms = ReadStormTracks(kRecorded, 1000.0);
  EXPECT_EQ(ApproachText(scene.spec, scene.state.disasters[0], scene.course()),
            "W at 20 km/h now, closest 8.0 km E in 30 min");
  Course course = scene.course();
  course.known_until = course.ahead.front().step + 1.0;  // as of a forecast that ends early
  EXPECT_EQ(ClosestText(scene.spec, course), "8.0 km E in about 30 min");
}

}  // namespace
}  // namespace aquafarm_viz
