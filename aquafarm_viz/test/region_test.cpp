// SPDX-License-Identifier: BSD-3-Clause
#include "draw/region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "aquafarm_viz/base/disaster_kinds.h"
#include "aquafarm_viz/base/palette.h"
#include "aquafarm_viz/draw/image.h"
#include "draw/course.h"
#include "draw/symbols.h"
#include "fixture.h"
#include "scene/nautical.h"

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::DisasterState;

constexpr ImageSize kRegionSize{640, 640};
constexpr const char* kTrack = R"(
disasters:
  - kind: red_tide
  - kind: typhoon
    track:
      - {step: 0, x: 100, y: -200, radii: [10], grade: 3}
      - {step: 10, x: 40, y: 12, radii: [10], grade: 3}
      - {step: 30, x: -160, y: 12, radii: [10], grade: 3}
)";

cv::Mat Panel(const cv::Mat& image) { return image(cv::Rect(460, 250, 180, 200)).clone(); }

TEST(Region, ReadsTheTracksOfAScenario) {
  const auto tracks = ReadStormTracks(kTrack, 1000.0).tracks;
  ASSERT_EQ(tracks.size(), 2U);
  EXPECT_TRUE(tracks[0].empty());
  ASSERT_EQ(tracks[1].size(), 3U);
  EXPECT_EQ(tracks[1][1].x, 40.0);
  EXPECT_TRUE(ReadStormTracks("", 1000.0).tracks.empty());
  EXPECT_TRUE(ReadStormTracks("disasters: [{track: [{step: first}]}]", 1000.0).tracks.empty());
}

TEST(Region, InterpolatesATrack) {
  const auto track = ReadStormTracks(kTrack, 1000.0).tracks[1];
  EXPECT_DOUBLE_EQ(TrackAt(track, 5.0).x, 70.0);
  EXPECT_DOUBLE_EQ(TrackAt(track, 5.0).y, -94.0);
  EXPECT_DOUBLE_EQ(TrackAt(track, -9.0).y, -200.0) << "before the track";
  EXPECT_DOUBLE_EQ(TrackAt(track, 99.0).x, -160.0) << "behind it";
}

TEST(Region, FindsWhereAStormIsNearest) {
  const auto spec = test::MakeSpec();  // 25 x 25 cells: the middle is (12, 12)
  const auto track = ReadStormTracks(kTrack, 1000.0).tracks[1];
  const TrackPoint nearest = ClosestApproach(spec, track, 0.0);
  EXPECT_NEAR(nearest.step, 12.8, 1e-9);  // x falls by 10 a step from 40 at step 10
  EXPECT_NEAR(MetresFromFarm(spec, nearest.x, nearest.y), 0.0, 1e-6);
  EXPECT_EQ(ClosestApproach(spec, track, 20.0).step, 20.0) << "it moves away";
}

TEST(Region, IsShownForADisasterWhoseCentreIsOutsideAlone) {
  auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.devices.clear();  // the key would explain dangers to them
  state.disasters = {test::MakeDisaster(0, 12.0F, 12.0F)};
  const cv::Mat near = Panel(DrawFarm(spec, state, kRegionSize));
  state.disasters[0].x = 13.0F;
  EXPECT_LT(cv::norm(near, Panel(DrawFarm(spec, state, kRegionSize)), cv::NORM_INF), 1.0)
      << "the map shows it";
  for (const float outside : {34.0F, 300.0F}) {
    state.disasters[0].x = outside;
    EXPECT_GT(cv::norm(near, Panel(DrawFarm(spec, state, kRegionSize))), 1000.0) << outside;
  }
  state.disasters[0].steps_left = 0;
  auto calm = state;
  calm.disasters[0].x = 12.0F;
  EXPECT_EQ(
      cv::norm(Panel(DrawFarm(spec, calm, kRegionSize)), Panel(DrawFarm(spec, state, kRegionSize))),
      0.0)
      << "it is over";
}

TEST(Region, ShowsATrackOnlyWhereItIsTheDisasters) {
  auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.step = 0;
  state.ships.clear();  // leaves space for the inset
  state.disasters = {test::MakeDisaster(0, -90.0F, 12.0F), test::MakeDisaster(1, 100.0F, -200.0F)};
  const cv::Mat without = Panel(DrawFarm(spec, state, kRegionSize));
  spec.scenario_yaml = kTrack;
  EXPECT_GT(cv::norm(without, Panel(DrawFarm(spec, state, kRegionSize))), 1000.0);
  auto seen = state;
  seen.observer = 0;
  EXPECT_EQ(cv::norm(without, Panel(DrawFarm(spec, seen, kRegionSize))), 0.0)
      << "a ship knows no track";
  auto replaced = state;
  replaced.disasters[1].x = 103.0F;
  auto no_track = spec;
  no_track.scenario_yaml.clear();
  EXPECT_EQ(cv::norm(Panel(DrawFarm(no_track, replaced, kRegionSize)),
                     Panel(DrawFarm(spec, replaced, kRegionSize))),
            0.0)
      << "set_disaster has moved it";
}

// The words for storms that follow their tracks; the middle of the farm is (12, 12).
struct Storms {
  aquafarm_msgs::FarmSpec spec = test::MakeSpec();
  aquafarm_msgs::FarmState state = test::MakeState();

  Storms() {
    state.step = 0;
    state.disasters.clear();
  }
  void Add(const std::string& track, float x, float y, const char* more = "") {
    if (spec.scenario_yaml.empty()) spec.scenario_yaml = "disasters:\n";
    spec.scenario_yaml += "  - risks: [-5]\n    track: [" + track + "]\n" + more;
    auto disaster = test::MakeDisaster(int(state.disasters.size()), x, y);
    disaster.radii = {10.0F};
    disaster.risks = {-5.0F};
    disaster.speed = 0.0F;
    disaster.steps_left = 30;
    state.disasters.push_back(disaster);
  }
  RegionWords words() const {
    const StormTracks tracks = ReadStormTracks(spec.scenario_yaml, spec.cell_size_m);
    std::vector<Course> courses;
    for (std::size_t i = 0; i < state.disasters.size(); ++i) {
      courses.push_back(CourseOf(spec, state, i, tracks));
    }
    return RegionText(spec, state, courses);
  }
};

constexpr const char* kAway =
    "{step: 0, x: 112, y: 12, radii: [10]}, {step: 30, x: 212, y: 12, radii: [10]}";

TEST(RegionWords, OfAStormThatLeaves) {
  Storms storms;
  storms.Add(kAway, 112.0F, 12.0F);
  EXPECT_EQ(storms.words().heading, "MOVING AWAY");
  EXPECT_EQ(storms.words().lines[0], "centre 100 km E");
  EXPECT_EQ(storms.words().lines[1], "dashed: course ahead");
}

TEST(RegionWords, NameTheWindThatArrivesAndWhen) {
  const char* const track =
      "{step: 0, x: 112, y: 12, radii: [2, 10]}, "
      "{step: 20, x: 12, y: 12, radii: [2, 10]}";
  for (const auto& [winds, heading] :
       {std::pair("[64, 34]", "GALE IN "), {"[34, 28]", "NEAR GALE IN "}}) {
    Storms storms;
    storms.Add(track, 112.0F, 12.0F, (std::string("    ring_winds_kt: ") + winds + "\n").c_str());
    storms.state.disasters[0].radii = {2.0F, 10.0F};
    storms.state.disasters[0].risks = {-10.0F, -5.0F};
    EXPECT_EQ(storms.words().heading.substr(0, std::string(heading).size()), heading);
    EXPECT_TRUE(storms.words().is_urgent);
  }
}

TEST(RegionWords, OfAStormThatStays) {
  Storms storms;
  storms.Add("{step: 0, x: 112, y: 12, radii: [10]}", 112.0F, 12.0F);
  EXPECT_EQ(storms.words().heading, "STAYS");
}

TEST(RegionWords, OfAStormOverTheFarmThatLeaves) {
  Storms storms;
  storms.Add("{step: 0, x: 30, y: 12, radii: [10]}, {step: 30, x: 212, y: 12, radii: [10]}", 30.0F,
             12.0F);
  EXPECT_EQ(storms.words().heading, "RISK -5 OVER PART OF THE RANCH");
  EXPECT_EQ(storms.words().lines[0], "centre 18 km E");
  storms = Storms();
  storms.Add("{step: 0, x: 30, y: 12, radii: [10]}, {step: 20, x: 12, y: 12, radii: [10]}", 30.0F,
             12.0F);
  EXPECT_EQ(storms.words().heading, "RISK -5 OVER PART OF THE RANCH");
  EXPECT_EQ(storms.words().lines[0].substr(0, 7), "closest");
}

TEST(RegionWords, NameADisasterWithoutATrackAndItsRiskOverTheFarm) {
  Storms storms;
  storms.Add("", 30.0F, 12.0F);
  EXPECT_EQ(storms.words().heading, RegionWords().heading);
  EXPECT_EQ(storms.words().lines[0], "typhoon, centre 18 km E");
  EXPECT_EQ(storms.words().lines[1], "risk -5 over part of the ranch");
}

TEST(RegionWords, OfAStormWithGrowingRings) {
  Storms storms;
  storms.Add("{step: 0, x: 112, y: 12, radii: [10]}, {step: 20, x: 122, y: 12, radii: [210]}",
             112.0F, 12.0F);
  EXPECT_EQ(storms.words().heading, "REACHES THE RANCH");
  EXPECT_EQ(storms.words().lines[0], "in 27 min, centre 100 km E");
}

TEST(RegionWords, AreAboutTheStormThatComesAndNotTheFirst) {
  Storms storms;
  storms.Add(kAway, 112.0F, 12.0F);
  storms.Add("{step: 0, x: 12, y: -188, radii: [10]}, {step: 25, x: 12, y: 12, radii: [10]}", 12.0F,
             -188.0F);
  EXPECT_EQ(storms.words().heading, "REACHES THE RANCH IN 1.1 h");
  storms.state.disasters[1].x = 42.0F;  // it has left its track
  storms.state.disasters[1].y = 12.0F;
  storms.state.disasters[1].heading_deg = 270;
  storms.state.disasters[1].speed = 1.0F;
  EXPECT_EQ(storms.words().heading, "REGION");
  EXPECT_EQ(storms.words().lines[1], "reaches the ranch in about 24 min");
  storms.state.disasters[1].x = 212.0F;  // comes nearer, but does not arrive while it is known
  storms.state.disasters[1].steps_left = 90;
  EXPECT_EQ(storms.words().heading, "REGION");
  EXPECT_EQ(storms.words().lines[1], "known until +3.0 h");
}

TEST(RegionWords, GiveTheWindAtTheClosestApproach) {
  Storms storms;
  storms.Add(
      "{step: 0, x: 112, y: 12, radii: [10], wind_mps: 30}, "
      "{step: 20, x: 12, y: 12, radii: [10], wind_mps: 40}",
      112.0F, 12.0F);
  EXPECT_EQ(storms.words().heading, "REACHES THE RANCH IN 48 min");
  EXPECT_EQ(storms.words().lines[1], "wind 40 m/s then");
  const Track track = ReadStormTracks(storms.spec.scenario_yaml, 1000.0).tracks[0];
  EXPECT_EQ(WindText(TrackAt(track, 6.0)), "33 m/s") << "interpolated";
  EXPECT_EQ(WindText(ReadStormTracks(kTrack, 1000.0).tracks[1][0]), "") << "the track has no wind";
}

TEST(RegionWords, GiveTheTimeOfTheClosestApproachInsideARing) {
  Storms storms;
  storms.Add(
      "{step: 0, x: 20, y: 12, radii: [10], wind_mps: 30}, "
      "{step: 20, x: 12, y: 12, radii: [10], wind_mps: 40}",
      20.0F, 12.0F);
  storms.spec.has_start_time = true;
  storms.spec.step_duration_s = 3600.0;
  storms.state.world_time.sec = 1627095600;  // 24 July 2021, 03:00 UTC
  EXPECT_EQ(storms.words().heading, "RISK -5 OVER PART OF THE RANCH");
  EXPECT_EQ(storms.words().lines[0].substr(0, 8), "closest ");
  EXPECT_EQ(storms.words().lines[1], "24 Jul 23:00 UTC, 40 m/s");
  storms.spec.has_origin = true;
  storms.spec.origin_longitude_deg = 122.3;
  EXPECT_EQ(storms.words().lines[1], "25 Jul 07:00 UTC+8, 40 m/s");
  storms.spec.origin_longitude_deg = -75.0;
  EXPECT_EQ(storms.words().lines[1], "24 Jul 18:00 UTC-5, 40 m/s");
}

TEST(RegionWords, NameTheWindOfTheWorstRingOverTheFarm) {
  constexpr const char* kRings =
      "{step: 0, x: 50, y: 12, radii: [5, 20, 60]}, {step: 20, x: 12, y: 12, radii: [5, 20, 60]}";
  Storms storms;
  storms.Add(kRings, 50.0F, 12.0F, "    ring_winds_kt: [64, 50, 34]\n");
  storms.state.disasters[0].radii = {5.0F, 20.0F, 60.0F};
  storms.state.disasters[0].risks = {-20.0F, -10.0F, -5.0F};
  EXPECT_EQ(storms.words().heading, "GALE OVER THE RANCH");
  storms = Storms();
  storms.Add(kRings, 50.0F, 12.0F);
  storms.state.disasters[0].radii = {5.0F, 20.0F, 60.0F};
  storms.state.disasters[0].risks = {-20.0F, -10.0F, -5.0F};
  EXPECT_EQ(storms.words().heading, "RISK -5 OVER THE RANCH") << "the winds are not given";
  storms.state.disasters[0].radii[2] = 51.0F;  // the farthest corner is 51.4 cells away
  EXPECT_EQ(storms.words().heading, "RISK -5 OVER PART OF THE RANCH");
}

TEST(Region, MarksHaveTheWindAhead) {
  const auto spec = test::MakeSpec();
  Course course;
  course.kind = Course::Kind::kRecorded;
  course.ahead = {{0.0, 2.0, 2.0, {}, {}, 30.0}, {400.0, 22.0, 22.0, {}, {}, 50.0}};
  cv::Mat image(640, 640, CV_8UC3, cv::Scalar(0, 0, 0));
  const Layout layout = MakeLayout(25, 25, kRegionSize);
  const auto marks = DrawCourse(
      image, spec, course,
      [](double x, double y) {
        return cv::Point2d{20.0 * x, 20.0 * y};
      },
      layout);
  ASSERT_FALSE(marks.empty());
  EXPECT_EQ(marks[0].longer.substr(0, marks[0].text.size() + 1), marks[0].text + " ");
  EXPECT_EQ(marks[0].longer.substr(marks[0].longer.size() - 4), " m/s");
  course.ahead[1].wind_mps.reset();
  EXPECT_EQ(DrawCourse(
                image, spec, course,
                [](double x, double y) {
                  return cv::Point2d{20.0 * x, 20.0 * y};
                },
                layout)[0]
                .longer,
            "");
}

TEST(RegionWords, SayUntilWhenAForecastIsKnown) {
  Storms storms;
  storms.Add(kAway, 112.0F, 12.0F,
             "    forecasts: [{step: 0, points: [{step: 9, x: 142, y: 12, radii: [10]}]}]\n");
  EXPECT_EQ(storms.words().lines[1], "known until +27 min");
}

// Mean colour of a part of the map.
cv::Scalar MeanAt(const cv::Mat& image, double x, double y, double cells) {
  const MapPlace place = PlaceMap(25, 25, kRegionSize);
  const cv::Point2d at = place.view.ToPixel(x, y);
  const int half = static_cast<int>(cells * place.view.cell_px() / 2.0);
  return cv::mean(image(place.map)(
      cv::Rect(static_cast<int>(at.x) - half, static_cast<int>(at.y) - half, 2 * half, 2 * half)));
}

TEST(Rings, LeaveTheWaterBlue) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.ships.clear();
  state.devices.clear();
  state.disasters = {test::MakeDisaster(0, 16.0F, 16.0F)};
  state.disasters[0].radii = {0.1F, 0.2F, 60.0F};
  state.disasters[0].risks = {-20.0F, -12.0F, -5.0F};
  const cv::Scalar water = MeanAt(DrawFarm(spec, state, kRegionSize), 20.0, 20.0, 4.0);
  EXPECT_GT(water[0], water[2] + 15.0) << "more blue than red in the gale";
}

TEST(DisasterKinds, HaveTheNamesOfTheConstantsOfTheMessage) {
  EXPECT_EQ(DisasterName(DisasterState::TYPHOON), "typhoon");
  EXPECT_EQ(DisasterName(DisasterState::STORM_SURGE), "storm surge");
  EXPECT_EQ(DisasterName(DisasterState::WAVE), "wave");
  EXPECT_EQ(DisasterName(DisasterState::RED_TIDE), "red tide");
  EXPECT_EQ(DisasterName(DisasterState::OIL_SPILL), "oil spill");
  EXPECT_EQ(DisasterName(DisasterState::CHEMICAL_SPILL), "chemical spill");
  EXPECT_EQ(DisasterName(DisasterState::CHEMICAL_SPILL + 1), "disaster");
}

TEST(Rings, HaveAPatternForEachKind) {
  const auto spec = test::MakeSpec();
  auto state = test::MakeState();
  state.disasters = {test::MakeDisaster(0, 16.0F, 16.0F)};
  state.disasters[0].speed = 0.0F;
  ASSERT_EQ(DisasterKindCount(), std::size_t{DisasterState::CHEMICAL_SPILL} + 1);
  std::vector<cv::Mat> drawn;
  for (std::uint8_t kind = DisasterState::TYPHOON; kind <= DisasterState::CHEMICAL_SPILL; ++kind) {
    state.disasters[0].kind = kind;
    const cv::Mat image = DrawFarm(spec, state, kRegionSize);
    const MapPlace place = PlaceMap(25, 25, kRegionSize);
    const cv::Point2d at = place.view.ToPixel(19.0, 19.0);  // away from the sign at the centre
    drawn.push_back(image(place.map)(cv::Rect(int(at.x) - 14, int(at.y) - 14, 28, 28)).clone());
    for (std::size_t i = 0; i + 1 < drawn.size(); ++i) {
      EXPECT_GT(cv::norm(drawn[i], drawn.back()), 100.0) << i << " and " << int(kind);
    }
  }
}

TEST(Nautical, WritesDistancesBearingsAndTimes) {
  auto spec = test::MakeSpec();
  EXPECT_EQ(DistanceText(850.0), "850 m");
  EXPECT_EQ(DistanceText(1840.0), "1.8 km");
  EXPECT_EQ(DistanceText(89400.0), "89 km");
  EXPECT_EQ(PointFromFarm(spec, 112.0, 12.0), "E");
  EXPECT_EQ(PointFromFarm(spec, 2.0, 2.0), "SW");
  EXPECT_EQ(NauticalZone(122.7), 8);
  EXPECT_EQ(NauticalZone(-3.0), 0);
  EXPECT_EQ(NauticalZone(-179.9), -12);
  EXPECT_EQ(HoursText(27000.0), "7.5 h");
  EXPECT_EQ(HoursText(136800.0), "38 h");
  EXPECT_EQ(TimeText(1627095600, "%d %b %H:%M UTC"), "24 Jul 03:00 UTC");
  spec.has_origin = false;
  spec.step_duration_s = 0.0;
  EXPECT_EQ(MotionText(spec, 315, 0.5), "NW, 0.50 cells a step");
  EXPECT_EQ(MotionText(spec, 315, 0.0), "stands still");
  spec.has_origin = true;
  spec.cell_size_m = 1000.0;
  spec.step_duration_s = 480.0;
  EXPECT_EQ(MotionText(spec, 90, 2.4), "E at 18 km/h");
}

}  // namespace
}  // namespace aquafarm_viz
