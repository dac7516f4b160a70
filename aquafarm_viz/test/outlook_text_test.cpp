// SPDX-License-Identifier: BSD-3-Clause
#include "scene/outlook_text.h"

#include <gtest/gtest.h>

#include "outlooks.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

using test::kRecorded;
using test::Outlooks;
using test::WithWinds;

TEST(OutlookText, NamesTheWindsOfRingsThatTheScenarioGives) {
  Outlooks scene;
  scene.storms = ReadStormTracks(WithWinds("[50, 34]"), 1000.0);
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: gale reaches F3 in 30 min");
  EXPECT_EQ(DangerText(scene.spec, scene.outlook().devices[0]), "gale in 30 min");
  scene.state.step = 8;
  scene.state.disasters[0].x = 24.0F;
  scene.state.devices[0].x = 17;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: gale over F3 now, storm in 3 min");
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()), "F3: gale now, storm in 3 min");
  scene.state.devices[0].x = 22;
  EXPECT_EQ(DangerText(scene.spec, scene.outlook().devices[0]), "storm now");
}

TEST(OutlookText, HasTheNameOfAStormThatIsOnItsTrack) {
  Outlooks scene;
  scene.storms =
      ReadStormTracks(std::string(kRecorded).replace(std::string(kRecorded).find("    track:"), 0,
                                                     "    name: In-Fa\n"),
                      1000.0);
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon In-Fa: risk -5 reaches F3 in 30 min");
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::RED_TIDE;
  EXPECT_EQ(scene.course().name, "") << "a bulletin put another disaster in its place";
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::TYPHOON;
  scene.state.disasters[0].x += 3.0F;  // a bulletin has moved it, or it is another storm
  EXPECT_EQ(NameNow(scene.state.disasters[0], scene.course()), "typhoon");
}

TEST(OutlookText, NamesTheWorstRingToComeAfterTheNext) {
  Outlooks scene;
  DeviceOutlook device{3, 0.0, 0U, 0, {}};
  device.arrivals = {{10.0, -5.0, 0U, 34}, {40.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 64}};
  Outlook outlook;
  outlook.devices = {device};
  outlook.names = {"typhoon"};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F3 in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(DangerText(scene.spec, device), "gale in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(FirstAndWorstText(scene.spec, device), "gale in 30 min, 64 kt in 3.0 h");
}

TEST(OutlookText, NamesTheNextAndTheWorstArrivalOfAllDevices) {
  const Outlooks scene;
  Outlook outlook;
  outlook.is_known = true;
  outlook.names = {"typhoon", "red tide"};
  outlook.devices = {{1, -5.0, 0U, 34, {{30.0, -10.0, 0U, 50}}},
                     {2, -5.0, 0U, 34, {{40.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 64}}},
                     {5, 0.0, 0U, 0, {{3.0, -5.0, 0U, 34}, {50.0, -10.0, 0U, 50}}}};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale over F1 and F2 now, F5 in 9 min, "
            "hurricane force reaches F2 in 3.0 h");
  outlook.devices[2].arrivals = {{3.0, -8.0, 1U, 0}};
  EXPECT_NE(OutlookText(scene.spec, scene.state, outlook).find("now, red tide risk -8 reaches F5"),
            std::string::npos);
  outlook.devices.clear();
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook), "no device is deployed");
  EXPECT_EQ(FirstAndWorstText(scene.spec, {2, -5.0, 0U, 34, {{60.0, -20.0, 0U, 64}}}),
            "gale now, 64 kt in 3.0 h");
  EXPECT_EQ(FirstAndWorstText(scene.spec, {2, 0.0, 0U, 0, {{60.0, -20.0, 0U, 64}}}),
            "hurricane force in 3.0 h");
}

TEST(OutlookText, HasAPartForEachRing) {
  const Outlooks scene;
  const auto words = [&](const DeviceOutlook& device, bool is_brief) {
    std::string text;
    for (const DangerPart& part : PartsOf(scene.spec, device, is_brief)) {
      text += part.text + " (" + std::to_string(int(part.risk)) + ")|";
    }
    return text;
  };
  DeviceOutlook device{3, -5.0, 0U, 34, {{10.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 90}}};
  EXPECT_EQ(words(device, false),
            "gale now (-5)|storm in 30 min (-10)|hurricane force in 3.0 h (-20)|");
  EXPECT_EQ(words(device, true), "gale now (-5)|storm in 30 min (-10)|90 kt in 3.0 h (-20)|")
      << "the wind of the ring";
  EXPECT_EQ(words({3, -5.0, 0U, 0, {{60.0, -20.0, 0U, 0}}}, true),
            "risk -5 now (-5)|-20 in 3.0 h (-20)|");
  device.arrivals.clear();
  EXPECT_EQ(words(device, true), "gale now (-5)|");
  device.arrivals = {{10.0, -10.0, 0U, 50}, {60.0, -20.0, 0U, 60}};
  EXPECT_EQ(words(device, true), "gale now (-5)|storm in 30 min (-10)|60 kt in 3.0 h (-20)|")
      << "the worst ring has the same name";
  device.arrivals.back().risk = -10.0;
  EXPECT_EQ(words(device, true), "gale now (-5)|storm in 30 min (-10)|") << "it is not worse";
}

TEST(OutlookText, ShortensTheNameAndTheDangerOfADeviceUntilTheyFit) {
  Outlooks scene;
  DeviceOutlook device{3, 0.0, 0U, 0, {}};
  device.arrivals = {{10.0, -5.0, 0U, 34}, {60.0, -20.0, 0U, 64}};
  const auto words = [&](std::size_t letters) {
    const auto [name, danger] = NameAndDanger(scene.spec, "release", device,
                                              [letters](const auto& left, const auto& right) {
                                                return left.size() + right.size() <= letters;
                                              });
    return name + "|" + Joined(danger);
  };
  EXPECT_EQ(words(60), "F3 release|gale in 30 min, hurricane force in 3.0 h");
  EXPECT_EQ(words(43), "F3 release|gale in 30 min, 64 kt in 3.0 h");
  EXPECT_EQ(words(34), "F3|gale in 30 min, 64 kt in 3.0 h");
  EXPECT_EQ(words(30), "F3 release|64 kt in 3.0 h") << "the kind rather than the second word";
  EXPECT_EQ(words(26), "F3 release|64 kt in 3.0 h");
  EXPECT_EQ(words(17), "F3|64 kt in 3.0 h");
  EXPECT_EQ(words(0), "F3|-20 in 3.0 h") << "the worst risk if nothing fits";
}

TEST(OutlookText, StrengthHasMetresPerSecondAndKnots) {
  TrackPoint point;
  EXPECT_EQ(StrengthText(point), "");
  point.wind_mps = 37.0;
  EXPECT_EQ(StrengthText(point), " 37 m/s (72 kt)");
}

TEST(OutlookText, NamesATyphoonByTheClassOfItsWind) {
  Outlooks scene;
  Course course = scene.course();
  const auto text = [&](double wind_mps) {
    course.ahead.front().wind_mps = wind_mps;
    const Outlook outlook = ComputeOutlook(scene.spec, scene.state, {course});
    EXPECT_EQ(CentreText(scene.spec, scene.state.disasters[0], course).rfind(outlook.names[0], 0),
              0U);
    const std::string sentence = OutlookText(scene.spec, scene.state, outlook);
    return sentence.substr(0, sentence.find(':'));
  };
  EXPECT_EQ(text(17.1), "tropical depression");
  EXPECT_EQ(text(17.2), "tropical storm");
  EXPECT_EQ(text(24.5), "severe tropical storm");
  EXPECT_EQ(text(32.7), "typhoon");
  scene.state.disasters[0].kind = aquafarm_msgs::DisasterState::WAVE;
  EXPECT_EQ(text(17.2), "wave");
}

TEST(OutlookText, HasHeadlinesWithAndWithoutDirectionsAndAShortOne) {
  Outlooks scene;
  const std::vector<std::string> expected{
      "Typhoon in the E: risk -5 reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "Typhoon: risk -5 reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "Typhoon in the E: risk -5 reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "Typhoon: risk -5 reaches F3 in about 1.0 h, risk -20 in about 1.2 h",
      "F3: risk -5 in 1.0 h, -20 in 1.2 h"};
  EXPECT_EQ(Headlines(scene.spec, scene.state, scene.outlook()), expected);
  scene.state.disasters[0].x = 212.0F;
  EXPECT_EQ(Headlines(scene.spec, scene.state, scene.outlook())[0],
            "No known danger to devices for the next 3.0 h");
  scene.state.disasters[0].steps_left = 0;
  EXPECT_TRUE(Headlines(scene.spec, scene.state, scene.outlook()).empty());
}

TEST(OutlookText, SaysUntilWhenItIsKnown) {
  Outlooks scene;
  scene.state.disasters[0].x = 212.0F;  // it arrives after the 60 steps of an extrapolated course
  EXPECT_FALSE(IsInDanger(scene.outlook()));
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "no known danger to devices for the next 3.0 h");
  scene.state.disasters[0].steps_left = 60;
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()), "");
}

TEST(OutlookText, NamesTheDevicesThatTheSameRingReachesLater) {
  const Outlooks scene;
  Outlook outlook;
  outlook.is_known = true;
  outlook.names = {"typhoon", "red tide"};
  const auto arrivals = [](double steps, std::size_t disaster) {
    return std::vector<RingArrival>{{steps, -5.0, disaster, 34}};
  };
  outlook.devices = {{1, 0.0, 0U, 0, arrivals(40.0, 0U)}, {2, 0.0, 0U, 0, arrivals(44.0, 0U)}};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F1 in 2.0 h, F2 in 2.2 h");
  outlook.devices.push_back({4, 0.0, 0U, 0, arrivals(60.0, 0U)});
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F1 in 2.0 h, F2 and F4 within 3.0 h");
  outlook.devices.push_back({5, 0.0, 0U, 0, arrivals(50.0, 0U)});
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F1 in 2.0 h, 3 more within 3.0 h");
  outlook.devices.resize(1);
  outlook.devices.push_back({2, 0.0, 0U, 0, arrivals(44.0, 1U)});
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook), "typhoon: gale reaches F1 in 2.0 h")
      << "another disaster reaches F2";
}

TEST(OutlookText, StatesFromIfSomeDevicesAreReachedLater) {
  Outlooks scene;
  scene.spec.has_start_time = true;
  scene.spec.step_duration_s = 180.0;
  Outlook outlook;
  outlook.is_known = true;
  outlook.names = {"typhoon"};
  outlook.directions = {""};
  outlook.devices = {{1, 0.0, 0U, 0, {{240.0, -5.0, 0U, 34}}},
                     {2, 0.0, 0U, 0, {{240.0, -5.0, 0U, 34}}}};
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F1 and F2 in 12 h (Thu 12:51 UTC)");
  outlook.devices[1].arrivals[0].steps = 245.0;  // a quarter of an hour later, also "12 h"
  EXPECT_EQ(OutlookText(scene.spec, scene.state, outlook),
            "typhoon: gale reaches F1 and F2 in 12 h (from Thu 12:51 UTC)");
  EXPECT_EQ(Headlines(scene.spec, scene.state, outlook)[3],
            "Typhoon: gale reaches F1 and F2 in 12 h")
      << "a headline for little space has no times of day";
}

TEST(OutlookText, NamesTheNearestRingIfNoDeviceIsInDanger) {
  Outlooks scene;
  scene.state.disasters[0].y = 24.0F;  // passes 2 cells north of the device in 30 steps
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: risk -5 passes about 2.0 km from F3 in about 1.5 h; "
            "no known danger to devices for the next 3.0 h");
  const std::vector<std::string> headlines = Headlines(scene.spec, scene.state, scene.outlook());
  EXPECT_EQ(headlines.front().substr(0, 36), "Typhoon in the ENE: risk -5 passes a");
  EXPECT_EQ(
      headlines[3],
      "Typhoon: risk -5 passes about 2.0 km from F3 in about 1.5 h; no danger known for 3.0 h");
  EXPECT_EQ(headlines[4],
            "Risk -5 passes about 2.0 km from F3 in about 1.5 h; "
            "no known danger to devices for the next 3.0 h");
  EXPECT_EQ(headlines.back(),
            "Risk -5 passes about 2.0 km from F3 in about 1.5 h; no danger known for 3.0 h")
      << "also the shortest headline names the ring";
  scene.state.disasters[0].x = 10.0F;  // moves away
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()),
            "risk -5 is 2.0 km from F3 now; no known danger to devices for the next 3.0 h");
  scene.state.disasters[0].y = 24.96F;
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()).substr(0, 17), "risk -5 is 2.9 km")
      << "rounded down";
  scene.state.disasters[0].y = 34.96F;
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()).substr(0, 16), "risk -5 is 12 km");
  scene.state.disasters[0].y = 22.05F;
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()).substr(0, 31),
            "risk -5 is less than 100 m from");
}

TEST(OutlookText, SaysThatARingComesNearerWhereTheOutlookEnds) {
  Outlooks scene;
  scene.state.disasters[0].x = 85.0F;  // its ring reaches the device after 65 steps, 60 are known
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: risk -5 is about 5.0 km from F3 in about 3.0 h and comes nearer; "
            "no known danger to devices for the next 3.0 h");
  EXPECT_EQ(ShortOutlookText(scene.spec, scene.outlook()),
            "risk -5 is about 5.0 km from F3 in about 3.0 h and comes nearer; "
            "no known danger to devices for the next 3.0 h");
  scene.state.disasters[0].steps_left = 60;  // then it is over
  EXPECT_EQ(OutlookText(scene.spec, scene.state, scene.outlook()),
            "typhoon: risk -5 passes about 6.0 km from F3 in about 3.0 h");
}

TEST(OutlookText, CallsNothingKnownAfterTheLastComputedStep) {
  Outlooks scene;
  scene.storms = ReadStormTracks(R"(
disasters:
  - kind: typhoon
    risks: [-20, -5]
    track:
      - {step: 0, x: 40, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
      - {step: 5000, x: 39, y: 12, radii: [5, 10], grade: 3, risks: [-20, -5]}
)",
                                 1000.0);
  scene.state.disasters[0].steps_left = 5000;
  scene.spec.step_duration_s = 60.0;
  EXPECT_EQ(scene.outlook().known_until, 1000.0);
  EXPECT_NE(OutlookText(scene.spec, scene.state, scene.outlook())
                .find("no known danger to devices for the next 17 h"),
            std::string::npos)
      << OutlookText(scene.spec, scene.state, scene.outlook());
}

TEST(OutlookText, DevicesAreHitFirstByTheTimeAndTheRiskOfTheirFirstRing) {
  const Outlooks scene;
  Outlook outlook;
  outlook.devices = {{1, 0.0, 0U, 0, {{10.0, -5.0, 0U, 34}, {60.0, -20.0, 0U, 64}}},
                     {2, 0.0, 0U, 0, {{10.0, -5.0, 0U, 34}, {40.0, -10.0, 0U, 50}}},
                     {3, 0.0, 0U, 0, {{20.0, -5.0, 0U, 34}}},
                     {4, 0.0, 0U, 0, {}}};
  const auto hit = [&] {
    std::string ids;
    for (const DeviceOutlook& one : outlook.devices) {
      ids += IsHitFirst(scene.spec, outlook, one) ? std::to_string(one.id) : "";
    }
    return ids;
  };
  EXPECT_EQ(hit(), "12") << "what comes later does not matter";
  outlook.devices.erase(outlook.devices.begin() + 2);
  EXPECT_EQ(hit(), "") << "both devices in danger are hit at the same time";
}

TEST(OutlookText, DoesNotNameTheSameWindTwice) {
  const Outlooks scene;
  EXPECT_EQ(FirstAndWorstText(scene.spec, {2, -5.0, 0U, 34, {{60.0, -10.0, 0U, 34}}}),
            "risk -5 now, -10 in 3.0 h");
}

}  // namespace
}  // namespace aquafarm_viz
