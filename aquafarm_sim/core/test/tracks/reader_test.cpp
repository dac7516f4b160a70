// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

#include "aquafarm/base/check.h"
#include "aquafarm/charts/ascii_grid.h"
#include "aquafarm/charts/coast.h"
#include "aquafarm/charts/map_file.h"
#include "aquafarm/storms/notices.h"
#include "storm_samples.h"

namespace aquafarm {
namespace {

TEST(TrackFormat, IsKnownByItsContent) {
  const std::vector<std::pair<const char*, TrackFormat>> files{
      {"cma.txt", TrackFormat::kCma},
      {"jma.txt", TrackFormat::kJma},
      {"atcf.dat", TrackFormat::kAtcf},
      {"ibtracs.csv", TrackFormat::kIbtracs},
      {"bulletin.json", TrackFormat::kBulletin},
      {"zhejiang.js", TrackFormat::kBulletin},
      {"weather_service.json", TrackFormat::kWeatherService}};
  for (const auto& [name, format] : files) {
    EXPECT_EQ(DetectTrackFormat(Sample(name)), format) << name;
    EXPECT_EQ(Load(name).format, format) << name;
  }
  EXPECT_EQ(DetectTrackFormat("name: paper\n"), std::nullopt);
  EXPECT_EQ(ToString(TrackFormat::kIbtracs), "IBTrACS");
  EXPECT_EQ(ToString(TrackFormat::kWeatherService), "weather service track");
}

// Storms without a number have a serial number that restarts each year.
TEST(StormFile, DistinguishesStormsOfOneId) {
  const std::string years =
      "66666 0000 01 0012 0000 0 6 (nameless) 20200101\n"
      "2019072500 1 297 1230 1000 12\n"
      "66666 0000 01 0012 0000 0 6 (nameless) 20220101\n"
      "2021072500 1 297 1230 1000 12\n";
  EXPECT_EQ(Warnings(years),
            "x:1: storm CMA12 occurs 2 times; this one is called CMA12-1\n"
            "x:3: storm CMA12 occurs 2 times; this one is called CMA12-2\n");
  const StormFile file = ParseStormFile(years, "x");
  EXPECT_EQ(FindTrack(file, "cma12-1").line, 1);
  EXPECT_EQ(FindTrack(file, "cma12-2").line, 3);
  try {
    FindTrack(file, "CMA12");
    FAIL() << "took one of two";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "storm: got 'CMA12', expected an id, because several storms match: CMA12-1 from "
                 "2019-07-25T00:00:00Z, CMA12-2 from 2021-07-25T00:00:00Z");
  }
  try {
    FindTrack(Load("bulletin.json"), "infa");
    FAIL() << "took a storm of another name";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what())
                  .rfind("storm: got 'infa' (did you mean 'IN-FA'?), expected one of: ", 0),
              0U)
        << error.what();
  }
  const std::string storm = R"({"tfbh": "202106", "points": [
    {"time": "2021-07-25T14:00:00", "lat": 30, "lng": 122}]})";
  const std::string twice = storm + ",\n" + storm;
  EXPECT_EQ(Warnings("[" + twice + "]"),
            "x:1: [0]: storm 202106 occurs 2 times; this one is called 202106-1\n"
            "x:3: [1]: storm 202106 occurs 2 times; this one is called 202106-2\n");
  const std::string taken = With(storm, "202106", "202106-2");
  EXPECT_EQ(ParseStormFile("[" + twice + "," + taken + "]", "x").tracks[1].id, "202106-3");
}

TEST(FindTrack, NamesWhatThereIs) {
  const StormFile file = Load("cma.txt");
  try {
    FindTrack(file, "Rai");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "storm: got 'Rai', expected one of: 7127,7128 Faye(Gloria), 2106 In-fa, CMA12");
  }
}

TEST(FindTrack, SaysHowManyMoreThereAre) {
  StormFile file;
  file.tracks.resize(62);
  for (StormTrack& track : file.tracks) track.id = "x";
  try {
    FindTrack(file, "y");
    FAIL();
  } catch (const InputError& error) {
    const std::string words = error.what();
    EXPECT_EQ(words.substr(words.size() - 12), "x, x, 2 more");
  }
}

TEST(FindTrack, TakesIdsBeforeNamesAndNoEmptyWord) {
  StormFile file;
  file.tracks.resize(3);
  file.tracks[0].id = "1";
  file.tracks[1].id = "2";
  file.tracks[1].name = "One";
  file.tracks[2].id = "One";
  for (StormTrack& track : file.tracks) track.fixes.emplace_back();
  EXPECT_EQ(FindTrack(file, "one").id, "One") << "not the storm of that name";
  file.tracks.pop_back();
  EXPECT_EQ(FindTrack(file, "one").id, "2");
  try {
    FindTrack(file, "");
    FAIL() << "took the storm without a name";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "storm: got '', expected one of: 1, 2 One");
  }
}

// A reader neither waits for a pipe nor reads endlessly from a device.
TEST(LoadStormFile, NamesAFileThatIsNot) {
  const std::string pipe =
      (std::filesystem::temp_directory_path() / ("hazard_file_test." + std::to_string(getpid())))
          .string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string no_file = ": cannot read: not a regular file";
  for (const auto& [path, words] :
       {std::pair(std::string("/nowhere/track.txt"),
                  std::string(": cannot read: No such file or directory")),
        std::pair(pipe, no_file), std::pair(std::string("/dev/zero"), no_file),
        std::pair(std::string("/tmp"), no_file)}) {
    const auto refused = [&path = path](auto load) -> std::string {
      try {
        load(path);
      } catch (const InputError& error) {
        return error.what();
      }
      return "was read";
    };
    EXPECT_EQ(refused(LoadStormFile), path + words);
    EXPECT_EQ(refused(LoadNotices), path + words);
    EXPECT_EQ(refused(LoadCoast), path + words);
    EXPECT_EQ(refused(LoadAsciiGrid), path + words);
    EXPECT_EQ(refused(LoadMap), path + words);
  }
  std::filesystem::remove(pipe);
}

TEST(LoadStormFile, RefusesAHugeFileWithoutReadingIt) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("huge_test." + std::to_string(getpid()))).string();
  for (const auto& [start, limit] : {std::pair("\n [", 67108864), std::pair("666", 536870912)}) {
    std::ofstream(path) << start;
    std::filesystem::resize_file(path, static_cast<std::uintmax_t>(limit) + 1);  // sparse
    try {
      LoadStormFile(path);
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(),
                path + ": got " + std::to_string(limit + 1) + " bytes, expected at most " +
                    std::to_string(limit) +
                    " in this format; cut the file to the storms or the area that you need");
    }
  }
  std::filesystem::remove(path);
}

// Searching the line of each bad value would take a minute for a file of 150 MB.
TEST(StormFile, OfManyBadValuesIsReadInTime) {
  const std::string point =
      R"({"time": "2021-07-25T14:00:00", "lat": 30, "lng": 122, "pressure": 50})";
  std::string text = R"([{"tfbh": "202106", "points": [)" + point;
  constexpr int kPoints = 40000;  // 3 MB
  for (int i = 1; i < kPoints; ++i) text += ",\n" + point;
  const std::clock_t begin = std::clock();
  const StormFile file = ParseStormFile(text + "]}]", "x");
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, 10.0);
  EXPECT_LE(file.warnings.size(), 3U);
}

// Every truncated sample is read, or rejected with a line number.
TEST(StormFile, EveryCutOfASampleIsReadOrRefused) {
  for (const char* name : {"cma.txt", "jma.txt", "atcf.dat", "ibtracs.csv", "bulletin.json",
                           "zhejiang.js", "weather_service.json"}) {
    const std::string text = Sample(name);
    for (std::size_t size = 0; size < text.size(); ++size) {
      try {
        EXPECT_FALSE(ParseStormFile(text.substr(0, size), "x").tracks.empty());
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).substr(0, 2), "x:");
      }
    }
  }
}

}  // namespace
}  // namespace aquafarm
