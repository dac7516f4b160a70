// SPDX-License-Identifier: BSD-3-Clause
// Storms drawn from the archive of a scenario.
#include "aquafarm/storms/draw_storm.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <set>
#include <unordered_set>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm/scenario/validate.h"
#include "count_allocations.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

const fs::path kShipped =
    fs::path(AQUAFARM_CORE_DIR).parent_path() / "scenarios" / "zhoushan_storms.yaml";

std::shared_ptr<const Scenario> Shipped() {
  static const auto scenario = std::make_shared<const Scenario>(LoadScenario(kShipped.string()));
  return scenario;
}

const StormsSpec& Storms(const Scenario& scenario) { return *scenario.disasters[0].storms; }

TEST(DrawnStorms, KeepTrainingAndEvaluationApart) {
  const auto scenario = Shipped();
  std::set<const ArchivedStorm*> seen;
  Farm farm(scenario);
  for (std::uint64_t episode = 0; episode < 2000; ++episode) {
    farm.Reset(7, episode);
    const ArchivedStorm& storm = *farm.DrawnStormOf(0);
    EXPECT_LE(storm.year, 2009);
    seen.insert(&storm);
  }
  EXPECT_EQ(seen.size(), Storms(*scenario).library->training.size()) << "each is drawn";
  for (std::uint64_t episode = 0; episode < 500; ++episode) {
    farm.Reset(7 | kEvaluationSeedBit, episode);
    EXPECT_GE(farm.DrawnStormOf(0)->year, 2010);
  }
  EXPECT_EQ(farm.DrawnStormOf(1), nullptr);
}

TEST(DrawnStorms, MakeAThousandEvaluationEpisodesDistinct) {
  Farm farm(Shipped());
  std::unordered_set<std::uint64_t> starts;
  for (std::uint64_t episode = 0; episode < 1000; ++episode) {
    farm.Reset(1000 | kEvaluationSeedBit, episode);
    starts.insert(farm.StartHash());
  }
  EXPECT_GE(starts.size(), 990U);
}

TEST(DrawnStorms, AreNearestWithinTheEpisode) {
  const auto scenario = Shipped();
  Farm farm(scenario);
  const double x = (scenario->width - 1) / 2.0;
  const double y = (scenario->height - 1) / 2.0;
  for (std::uint64_t episode = 0; episode < 300; ++episode) {
    farm.Reset(3, episode);
    double nearest = 1e9;
    double at = 0.0;
    for (double step = -200.0; step < 600.0; step += 0.5) {  // position between waypoints
      const std::vector<Waypoint>& track = *farm.tracks()[0];
      std::size_t next = 0;
      while (next < track.size() && static_cast<double>(track[next].step) <= step) ++next;
      if (next == 0 || next == track.size()) continue;
      const Waypoint& a = track[next - 1];
      const Waypoint& b = track[next];
      const double part =
          (step - static_cast<double>(a.step)) / static_cast<double>(b.step - a.step);
      const double distance =
          std::hypot(static_cast<double>(a.x) + part * static_cast<double>(b.x - a.x) - x,
                     static_cast<double>(a.y) + part * static_cast<double>(b.y - a.y) - y);
      if (distance < nearest) {
        nearest = distance;
        at = step;
      }
    }
    // 18 to 30 hours; an hour has 7.5 steps.
    EXPECT_GE(at, 18.0 * 7.5 - 1.0) << episode;
    EXPECT_LE(at, 30.0 * 7.5 + 1.0) << episode;
  }
}

TEST(DrawnStorms, AreRepeatedSavedAndLoaded) {
  Farm farm(Shipped());
  Farm other(Shipped());
  farm.Reset(5, 11);
  other.Reset(9, 2);
  other.Reset(5, 11);
  EXPECT_EQ(farm.Hash(), other.Hash());
  EXPECT_EQ(farm.StartHash(), other.StartHash());
  const std::vector<std::uint8_t> hold{static_cast<std::uint8_t>(Action::kHold)};
  for (int i = 0; i < 40; ++i) farm.Step(hold.data());
  other.Reset(1, 1);
  other.Load(farm.Save());
  EXPECT_EQ(farm.Hash(), other.Hash());
  EXPECT_EQ(farm.Save(), other.Save());
  for (int i = 0; i < 40; ++i) {
    farm.Step(hold.data());
    other.Step(hold.data());
    ASSERT_EQ(farm.Hash(), other.Hash());
  }
  EXPECT_EQ(other.DrawnStormOf(0)->id, farm.DrawnStormOf(0)->id);
  other.Reset(6, 0);
  farm.Reset(6, 0);
  EXPECT_EQ(farm.Hash(), other.Hash()) << "a loaded farm draws as before";
}

TEST(DrawnStorms, OfACopyAreThoseOfItsOwnScenario) {
  auto loaded = std::make_shared<const Scenario>(LoadScenario(kShipped.string()));
  Farm copy(Shipped());
  {
    Farm farm(loaded);
    farm.Reset(5, 11);
    copy.CopyStateFrom(farm);
    EXPECT_EQ(copy.Save(), farm.Save());
    EXPECT_NE(copy.DrawnStormOf(0), farm.DrawnStormOf(0));
    EXPECT_EQ(copy.DrawnStormOf(0)->id, farm.DrawnStormOf(0)->id);
    const auto before = allocations.load();
    copy.CopyStateFrom(farm);
    EXPECT_EQ(allocations, before) << "a further copy needs no memory";
  }
  loaded.reset();
  Farm same(Shipped());
  same.Reset(5, 11);
  EXPECT_EQ(copy.Hash(), same.Hash());
  EXPECT_EQ(copy.DrawnStormOf(0), same.DrawnStormOf(0));
}

TEST(DrawnStorms, AreReplacedByABulletinUntilTheNextEpisode) {
  Farm farm(Shipped());
  farm.Reset(5, 1);
  const std::uint64_t before = farm.Hash();
  DisasterSpec still;
  still.start = std::array<float, 2>{3.0F, 3.0F};
  farm.SetDisaster(0, still);
  EXPECT_NE(farm.Hash(), before);
  farm.Reset(5, 1);
  EXPECT_EQ(farm.Hash(), before);
  DisasterSpec archive = Shipped()->disasters[0];
  EXPECT_THROW(farm.SetDisaster(0, archive), InputError);
}

TEST(DrawnStorms, LeaveAnotherOwnersTrackAlone) {
  Farm farm(Shipped());
  farm.Reset(5, 1);
  const Track held = farm.tracks()[0];
  const std::vector<Waypoint> copy = *held;
  farm.Reset(5, 2);
  ASSERT_EQ(held->size(), copy.size());
  for (std::size_t i = 0; i < copy.size(); ++i) EXPECT_EQ((*held)[i].x, copy[i].x);
  EXPECT_NE(farm.tracks()[0], held);
}

TEST(DrawnStorms, AreDrawnWithoutAllocationInTwentyMicroseconds) {
  Farm farm(Shipped());
  for (std::uint64_t episode = 0; episode < 2000; ++episode) farm.Reset(2, episode);
  Scenario calm = *Shipped();
  calm.disasters[0].storms.reset();
  Farm fixed(std::make_shared<const Scenario>(calm));
  const auto time_us = [](Farm& one, std::uint64_t episode) {
    const auto start = std::chrono::steady_clock::now();
    one.Reset(2, episode);
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
        .count();
  };
  const long before = allocations;
  double drawn_us = 1e9;
  double fixed_us = 1e9;
  for (std::uint64_t round = 0; round < 40; ++round) {
    double sum = 0.0;
    double fixed_sum = 0.0;
    for (std::uint64_t episode = 0; episode < 50; ++episode) {
      sum += time_us(farm, episode);
      fixed_sum += time_us(fixed, episode);
    }
    drawn_us = std::min(drawn_us, sum / 50.0);
    fixed_us = std::min(fixed_us, fixed_sum / 50.0);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_LE(drawn_us - fixed_us, 20.0);
}

TEST(DrawnStorms, FollowTheTrackOfTheArchiveWithoutPerturbation) {
  Scenario scenario = *Shipped();
  scenario.disasters[0].storms->perturbation = {};
  Farm farm(std::make_shared<const Scenario>(scenario));
  farm.Reset(1, 0);
  const ArchivedStorm& storm = *farm.DrawnStormOf(0);
  const std::vector<Waypoint>& track = *farm.tracks()[0];
  ASSERT_EQ(track.size(), storm.path.points.size());
  for (std::size_t i = 0; i < track.size(); ++i) {
    EXPECT_FLOAT_EQ(track[i].x, static_cast<float>(storm.path.points[i].x));
    EXPECT_NEAR(track[i].step, storm.path.points[i].step, 1e-3);
    EXPECT_FLOAT_EQ(track[i].radii[2], static_cast<float>(storm.path.points[i].radius[2]));
  }
}

// --- The key in scenario files -------------------------------------------------------------------

constexpr const char* kRanchText = R"(name: test
grid: {width: 20, height: 14, origin: {latitude: 30.1, longitude: 122.6}}
time: {step_duration_s: 480}
disasters:
  - kind: typhoon
    duration: 360
    storms:
      years: [2000, 2009]
      evaluation_years: [2010, 2023]
      tracks: |
        aquafarm-storms 1
        storm 0102 2 CMA | Past
        200107010000 27 123 TY 35 960
        200107011200 30 123 TY 35 960
        200107020000 33 123 TY 35 960
        storm 1103 2 CMA | Later
        201107010000 27 122 STS 28 970 34=200,200,200,200
        201107011200 30 122 STS 28 970 34=200,200,200,200
        201107020000 33 122 STS 28 970 34=200,200,200,200
        storm 0503 2 CMA | Far
        200507010000 10 140 TY 40 960
        200507011200 12 140 TY 40 960
)";

std::string Refused(const std::string& what, const std::string& by) {
  std::string text = kRanchText;
  text.replace(text.find(what), what.size(), by);
  try {
    ParseScenario(text, "ranch.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StormsKey, KeepsTheStormsInReach) {
  const Scenario scenario = ParseScenario(kRanchText, "ranch.yaml");
  const StormLibrary& library = *Storms(scenario).library;
  ASSERT_EQ(library.training.size(), 1U);
  ASSERT_EQ(library.evaluation.size(), 1U);
  EXPECT_EQ(library.training[0].name, "Past");
  EXPECT_EQ(library.training[0].year, 2001);
  EXPECT_EQ(Storms(scenario).tracks.find("Far"), std::string::npos);
  const StormPath& later = library.evaluation[0].path;
  EXPECT_EQ(later.points[1].radius[2], 200.0) << "recorded";
  EXPECT_EQ(later.rings, 3U);
  EXPECT_EQ(scenario.disasters[0].radii.size(), 3U);
  const std::string text = ToYaml(scenario);
  EXPECT_NE(text.find("      tracks: |\n        aquafarm-storms 1\n"), std::string::npos);
  EXPECT_EQ(ToYaml(ParseScenario(text, "again")), text);
  EXPECT_EQ(ParseScenario(text, "again").hash, scenario.hash);
}

TEST(StormsKey, IsRefusedInOneLine) {
  EXPECT_EQ(Refused("[2010, 2023]", "[2009, 2023]"),
            "ranch.yaml:9: disasters[0].storms.evaluation_years: got [2009, 2023], expected years "
            "outside of 'years', [2000, 2009]: training must not see them");
  EXPECT_EQ(Refused("[2000, 2009]", "[2003, 2009]"),
            "ranch.yaml:8: disasters[0].storms.years: got [2003, 2009], but none of the "
            "archive's 3 storms is from these years, has gales and comes within within_km = 300 km "
            "of the middle of the farm; expected at least one: check the years, within_km and "
            "grid.origin");
  EXPECT_NE(Refused("latitude: 30.1", "latitude: -30.1").find("storms is from these years"),
            std::string::npos);
  EXPECT_EQ(
      Refused("[2000, 2009]", "[2009, 2000]"),
      "ranch.yaml:8: disasters[0].storms.years: got [2009, 2000], expected the smaller number "
      "first");
  EXPECT_EQ(Refused("      tracks: |", "      archive: [nowhere.txt]\n      tracks: |"),
            "ranch.yaml:11: disasters[0].storms.tracks: is used only if 'archive' is not set");
  EXPECT_EQ(Refused("duration: 360", "duration: 100"),
            "ranch.yaml:7: disasters[0].storms.approach_h: got 24 +- perturbation.start_h 0, "
            "expected a closest approach in the episode, [0, 13.333333333333334] hours; change "
            "approach_h, start_h or the disaster's duration");
  EXPECT_EQ(Refused(", origin: {latitude: 30.1, longitude: 122.6}", ""),
            "ranch.yaml:7: disasters[0].storms: needs grid.origin, which is missing");
  EXPECT_EQ(Refused("200107011200 30 123 TY", "200107011200 30 123 XY")
                .find("ranch.yaml:10: disasters[0].storms.tracks: tracks:4: grade: got 'XY'"),
            0U);
  EXPECT_EQ(Refused("    duration: 360\n", "    duration: 360\n    track: []\n"),
            "ranch.yaml:7: disasters[0].track: is used only if 'storms' is not set");
  EXPECT_EQ(Refused("    duration: 360\n", "    duration: 360\n    speed: 1\n"),
            "ranch.yaml:7: disasters[0].speed: is used only if 'storms' is not set");
}

TEST(StormsKey, NamesAnArchiveThatIsNotThere) {
  std::string text = kRanchText;
  text.resize(text.find("      tracks: |"));
  text += "      archive: [nowhere.txt]\n";
  try {
    ParseScenario(text, "ranch.yaml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "ranch.yaml:10: disasters[0].storms.archive[0]: nowhere.txt: cannot read: No such "
              "file or directory");
  }
}

TEST(StormsKey, ReadsTheFilesOfEverySource) {
  const fs::path folder = SharedData() / "tracks";
  if (!fs::exists(folder / "cma_archive")) GTEST_SKIP() << "no real files at " << folder;
  std::string text = kRanchText;
  text.resize(text.find("      tracks: |"));
  text += "      archive: [" + (folder / "bst_all_2015-2021.txt").string() + ", " +
          (folder / "cma_archive" / "CH2005BST.txt").string() + ", " +
          (folder / "bwp082014.dat").string() + ", " +
          (folder / "ibtracs.ACTIVE.list.v04r00.csv").string() + "]\n";
  const Scenario scenario = ParseScenario(text, "ranch.yaml");
  EXPECT_GE(Storms(scenario).library->training.size(), 2U);
  EXPECT_GE(Storms(scenario).library->evaluation.size(), 10U);
  for (const ArchivedStorm& storm : Storms(scenario).library->evaluation) {
    EXPECT_EQ(storm.path.rings, 3U);
    for (const StormPoint& point : storm.path.points) {
      EXPECT_LE(point.radius[0], point.radius[1]);
      EXPECT_LE(point.radius[1], point.radius[2]);
    }
  }
  EXPECT_EQ(ToYaml(ParseScenario(ToYaml(scenario), "again")), ToYaml(scenario));
}

TEST(StormsKey, OfAnArchiveOfDecadesIsReadInHalfASecond) {
  const fs::path folder = SharedData() / "tracks" / "cma_archive";
  if (!fs::exists(folder)) GTEST_SKIP() << "no real files at " << folder;
  std::string files;
  int years = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    files += (files.empty() ? "" : ", ") + entry.path().string();
    ++years;
  }
  std::string text = kRanchText;
  text.resize(text.find("      tracks: |"));
  text += "      archive: [" + files + "]\n";
  text.replace(text.find("[2000"), 5, "[1979");
  double least_s = 1e9;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();  // CPU time of this process
    ParseScenario(text, "ranch.yaml");
    least_s = std::min(least_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  EXPECT_LE(least_s * 45.0 / years, 0.5) << years << " years took " << least_s << " s";
}

}  // namespace
}  // namespace aquafarm
