// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "aquafarm_viz/draw/image.h"
#include "draw/free_space.h"
#include "draw/legend.h"
#include "draw/map_labels.h"
#include "draw/symbols.h"
#include "fixture.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

// A ranch with one device at (10, 12) and a storm that moves west by one cell a step from (40, 12).
struct Outlooks {
  aquafarm_msgs::FarmSpec spec = test::MakeSpec();
  aquafarm_msgs::FarmState state = test::MakeState();
  StormTracks storms;

  Outlooks() {
    state.step = 0;
    state.devices = {test::MakeDevice(3, 0, 10, 12, 1.0F)};
    state.disasters = {test::MakeDisaster(0, 40.0F, 12.0F)};
    state.disasters[0].heading_deg = 270;
    state.disasters[0].speed = 1.0F;
    state.disasters[0].radii = {5.0F, 10.0F};
    state.disasters[0].risks = {-20.0F, -5.0F};
  }
  Course course() const { return CourseOf(spec, state, 0, storms); }
  Outlook outlook() const { return ComputeOutlook(spec, state, {course()}); }
};

constexpr const char* kRecorded = R"(
disasters:
  - kind: typhoon
    risks: [-20, -5]
    track:
      - {step: -10, x: 60, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 0, x: 40, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 10, x: 20, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 30, x: 20, y: 40, radii: [0, 0], grade: 1, risks: [-20, -5]}
)";

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
            "typhoon, risk -5, reaches F3 in about 1.0 h, risk -20 in about 1.2 h");
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
            "typhoon, risk -5, reaches F3 in 5.0 h (Thu 05:51 UTC)")
      << "5 h after the state's time, 0 h 51 min";
  scene.spec.has_start_time = false;
  scene.spec.step_duration_s = 0.0;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon, risk -5, reaches F3 in 10 steps");
}

// Returns kRecorded with the winds of its rings.
std::string WithWinds(const std::string& winds) {
  return std::string(kRecorded).replace(std::string(kRecorded).find("    track:"), 0,
                                        "    ring_winds_kt: " + winds + "\n");
}

TEST(Outlook, NamesTheWindsOfRingsThatTheScenarioGives) {
  Outlooks scene;
  scene.storms = ReadStormTracks(WithWinds("[50, 34]"), 1000.0);
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon, gale, reaches F3 in 30 min");
  EXPECT_EQ(DangerText(scene.spec, scene.outlook().devices[0]), "gale in 30 min");
  EXPECT_EQ(RiskText(scene.spec, scene.outlook().devices[0]), "-5 in 30 min");
  scene.state.step = 8;
  scene.state.disasters[0].x = 24.0F;
  scene.state.devices[0].x = 17;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: gale over F3 now, storm in 3 min");
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()), "F3: gale now, storm in 3 min");
  scene.state.devices[0].x = 22;
  EXPECT_EQ(DangerText(scene.spec, scene.outlook().devices[0]), "storm now");
}

TEST(Outlook, HasTheNameOfAStormThatIsOnItsTrack) {
  Outlooks scene;
  scene.storms =
      ReadStormTracks(std::string(kRecorded).replace(std::string(kRecorded).find("    track:"), 0,
                                                     "    name: In-Fa\n"),
                      1000.0);
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon In-Fa, risk -5, reaches F3 in 30 min");
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::RED_TIDE;
  EXPECT_EQ(scene.course().name, "") << "a bulletin put another disaster in its place";
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::TYPHOON;
  scene.state.disasters[0].x += 3.0F;  // a bulletin has moved it, or it is another storm
  EXPECT_EQ(NameNow(scene.state.disasters[0], scene.course()), "typhoon");
}

TEST(Outlook, NamesTheWorstRingToComeAfterTheNext) {
  Outlooks scene;
  DeviceOutlook device{3, 0.0, 0U, 0, {}};
  device.arrivals = {{10.0, -5.0, 0U, 34}, {40.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 64}};
  Outlook outlook;
  outlook.devices = {device};
  outlook.names = {"typhoon"};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon, gale, reaches F3 in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(DangerText(scene.spec, device), "gale in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(WorstText(scene.spec, device), "hurricane force in 3.0 h");
}

TEST(Outlook, NamesTheNextAndTheWorstArrivalOfAllDevices) {
  const Outlooks scene;
  Outlook outlook;
  outlook.is_known = true;
  outlook.names = {"typhoon", "red tide"};
  outlook.devices = {{1, -5.0, 0U, 34, {{30.0, -10.0, 0U, 50}}},
                     {2, -5.0, 0U, 34, {{40.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 64}}},
                     {5, 0.0, 0U, 0, {{3.0, -5.0, 0U, 34}, {50.0, -10.0, 0U, 50}}}};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale over F1 and F2 now, gale reaches F5 in 9 min, "
            "hurricane force reaches F2 in 3.0 h");
  outlook.devices[2].arrivals = {{3.0, -8.0, 1U, 0}};
  EXPECT_NE(OutlookText(scene.spec, scene.state, outlook).find("now, red tide risk -8 reaches F5"),
            std::string::npos);
  outlook.devices.clear();
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook), "no device is deployed");
  EXPECT_EQ(NowAndWorstText(scene.spec, {2, -5.0, 0U, 34, {{60.0, -20.0, 0U, 64}}}),
            "gale now, hurricane in 3.0 h");
}

TEST(Outlook, ShortensTheNameAndTheDangerOfADeviceUntilTheyFit) {
  Outlooks scene;
  DeviceOutlook device{3, 0.0, 0U, 0, {}};
  device.arrivals = {{10.0, -5.0, 0U, 34}, {60.0, -20.0, 0U, 64}};
  const auto words = [&](std::size_t letters) {
    const auto [name, danger] = NameAndDanger(scene.spec, "release", device,
                                              [letters](const auto& left, const auto& right) {
                                                return left.size() + right.size() <= letters;
                                              });
    return name + "|" + danger;
  };
  EXPECT_EQ(words(60), "F3 release|gale in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(words(43), "F3|gale in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(words(30), "F3 release|hurricane in 3.0 h") << "the kind rather than the second word";
  EXPECT_EQ(words(27), "F3|hurricane force in 3.0 h");
  EXPECT_EQ(words(0), "F3|" + RiskText(scene.spec, device, ", ")) << "the shortest if nothing fits";
}

TEST(Outlook, StrengthHasMetresPerSecondAndKnots) {
  TrackPoint point;
  EXPECT_EQ(StrengthText(point), "");
  point.wind_mps = 37.0;
  EXPECT_EQ(StrengthText(point), " 37 m/s (72 kt)");
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
  EXPECT_TRUE(MakeRiskKey(scene.state, {named, CourseOf(scene.spec, scene.state, 1, {})}).empty());
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

TEST(Outlook, NamesATyphoonByTheClassOfItsWind) {
  Outlooks scene;
  Course course = scene.course();
  const auto text = [&](double wind_mps) {
    course.ahead.front().wind_mps = wind_mps;
    const Outlook outlook = ComputeOutlook(scene.spec, scene.state, {course});
    EXPECT_EQ(CentreText(scene.spec, scene.state.disasters[0], course).rfind(outlook.names[0], 0),
              0U);
    const std::string sentence = OutlookText(scene.spec, scene.state, outlook);
    return sentence.substr(0, sentence.find(','));
  };
  EXPECT_EQ(text(17.1), "tropical depression");
  EXPECT_EQ(text(17.2), "tropical storm");
  EXPECT_EQ(text(24.5), "severe tropical storm");
  EXPECT_EQ(text(32.7), "typhoon");
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::WAVE;
  EXPECT_EQ(text(17.2), "wave");
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
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()).substr(0, 36),
            "typhoon: risk -5 over 3 devices now,");
}

TEST(Outlook, OfADeviceInARingNamesTheWorseRingToCome) {
  Outlooks scene;
  scene.state.disasters[0].x = 18.0F;
  const Outlook outlook = scene.outlook();
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: risk -5 over F3 now, risk -20 in about 9 min");
  EXPECT_EQ(DangerText(scene.spec, outlook.devices[0]), "risk -5 now, -20 in 9 min");
}

TEST(Outlook, HasHeadlinesWithAndWithoutDirectionsAndAShortOne) {
  Outlooks scene;
  const std::vector<std::string> expected{
      "Typhoon in the E, risk -5, reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "Typhoon, risk -5, reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "F3: risk -5 in 1.0 h, -20 in 1.2 h"};
  EXPECT_EQ(Headlines(scene.spec, scene.state, scene.outlook()), expected);
  scene.state.disasters[0].x = 212.0F;
  EXPECT_EQ(Headlines(scene.spec, scene.state, scene.outlook())[0],
            "No known danger to devices until +3.0 h");
  scene.state.disasters[0].steps_left = 0;
  EXPECT_TRUE(Headlines(scene.spec, scene.state, scene.outlook()).empty());
}

TEST(Outlook, SaysUntilWhenItIsKnown) {
  Outlooks scene;
  scene.state.disasters[0].x = 212.0F;  // it arrives after the 60 steps of an extrapolated course
  EXPECT_FALSE(IsInDanger(scene.outlook()));
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "no known danger to devices until +3.0 h");
  scene.state.disasters[0].steps_left = 60;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()), "");
}

TEST(Outlook, UsesTheRadiusOfTheQuadrant) {
  Outlooks scene;
  scene.state.disasters[0].y = 9.0F;  // the device is to the north-west
  scene.state.disasters[0].quadrants = {1.0F, 1.0F, 1.0F, 1.0F, 10.0F, 10.0F, 10.0F, 5.1F};
  const Outlook outlook = scene.outlook();
  ASSERT_FALSE(outlook.devices[0].arrivals.empty());
  EXPECT_EQ(outlook.devices[0].arrivals[0].steps, 26.0) << "radius 5.1: 4 cells west, 3 north";
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
  EXPECT_EQ(ApproachText(scene.spec, scene.state.disasters[0], scene.course()), "W at 20 km/h")
      << "the present motion does not say when a storm is closest";
  scene.storms = ReadStormTracks(kRecorded, 1000.0);
  EXPECT_EQ(ApproachText(scene.spec, scene.state.disasters[0], scene.course()),
            "W at 20 km/h, closest 8.0 km E in 30 min");
}

}  // namespace
}  // namespace aquafarm_viz
