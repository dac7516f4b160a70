// SPDX-License-Identifier: BSD-3-Clause
// The program behind `aquafarm scenario`.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "aquafarm/scenario/scenario_yaml.h"
#include "ranch_request.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

// Runs the program; returns its exit code and its output.
std::pair<int, std::string> RunApp(const std::string& arguments) {
  FILE* pipe = popen((AQUAFARM_SCENARIO_APP " " + arguments + " 2>&1").c_str(), "r");
  std::string text;
  std::array<char, 4096> part{};
  while (fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  return {WEXITSTATUS(pclose(pipe)), text};
}

TEST(Program, SaysWhatToTrainWith) {
  const fs::path path = fs::temp_directory_path() / ("many_" + std::to_string(getpid()) + ".yaml");
  const auto now = [&path](const std::string& arguments) {
    const std::string text = RunApp("--size 20x20 -o " + path.string() + " " + arguments).second;
    const std::string made = "next step: ./aquafarm train scenario:=" + path.string();
    const std::size_t at = text.find(made);
    return at == std::string::npos ? text : text.substr(at + made.size());
  };
  EXPECT_EQ(now("--devices 3"), "\n");
  EXPECT_EQ(now("--devices 14"), "\n");
  EXPECT_EQ(now("--devices 15"), " algorithm:=dqn options:=train_interval=4 steps:=1200000\n");
  EXPECT_EQ(now("--devices 3 --ships 2"), " algorithm:=auto\n");
  fs::remove(path);
}

TEST(Program, MakesAFileAndSaysWhatItDecided) {
  const fs::path path = fs::temp_directory_path() / ("bay_" + std::to_string(getpid()) + ".yaml");
  const std::string data = kData.string();
  const auto [code, text] = RunApp(
      "--chart " + data + "/coast.json --center 30.03,122.05 --size 24x20 --cell 0.5km --track " +
      data + "/cma.txt --storm in-fa --devices 6 --layout linear -o " + path.string());
  EXPECT_EQ(code, 0) << text;
  EXPECT_NE(text.find("nearest: "), std::string::npos);
  EXPECT_NE(text.find("\nnext step: ./aquafarm plan " + path.string() +
                      " --bulletin FILE   (which ship fetches which device before a storm)\n" +
                      "or: ./aquafarm train scenario:=" + path.string()),
            std::string::npos)
      << text;
  const Scenario scenario = LoadScenario(path.string());
  EXPECT_EQ(scenario.name, path.stem().string());
  EXPECT_EQ(scenario.devices.count, 6);
  fs::remove(path);
}

TEST(Program, MakesARanchWithAStormOfAnArchiveInEveryEpisode) {
  const fs::path path = fs::temp_directory_path() / ("gulf_" + std::to_string(getpid()) + ".yaml");
  const std::string archive =
      (fs::path(AQUAFARM_CORE_DIR).parent_path() / "scenarios" / "archives" / "zhoushan_cma.txt")
          .string();
  const std::string place = "--center 30.1,122.7 --archive " + archive;
  const auto [code, text] = RunApp(place + " --years 1990:2009 --within 250 -o " + path.string());
  EXPECT_EQ(code, 0) << text;
  EXPECT_NE(text.find("archive: zhoushan_cma.txt: "), std::string::npos) << text;
  const Scenario scenario = LoadScenario(path.string());
  const StormsSpec& storms = *scenario.disasters.at(0).storms;
  EXPECT_EQ(storms.years.min, 1990);
  EXPECT_EQ(storms.evaluation_years.min, 2010);
  EXPECT_EQ(storms.within_km, 250.0);
  EXPECT_GE(storms.library->training.size(), 20U);
  EXPECT_NE(storms.tracks.find("storm 2106 2 CMA | In-fa"), std::string::npos);
  fs::remove(path);
  EXPECT_EQ(RunApp(place + " --years 1990").second,
            "years: got '1990', expected FIRST:LAST such as 1979:2009\n");
  EXPECT_NE(
      RunApp(place + " --years 1990:1990 --within 10").second.find("storms is from these years"),
      std::string::npos);
  EXPECT_NE(RunApp("--archive " + archive + " --years 1990:2009").second.find("center: got none"),
            std::string::npos);
}

TEST(Program, RefusesWrongArguments) {
  const std::vector<std::pair<const char*, const char*>> cases{
      {"--center 30", "center: got '30', expected LATITUDE,LONGITUDE in degrees"},
      {"--center 95,120", "expected a latitude in [-90, 90] and a longitude in [-180, 360]"},
      {"--size 25", "size: got '25', expected WIDTHxHEIGHT in cells"},
      {"--size 1x25", "size: got '1x25', expected whole numbers in [2, 4096]"},
      {"--cell 20furlongs", "cell: got '20furlongs', expected a length such as 200m or 0.2km"},
      {"--layout explicit", "layout: got 'explicit', expected one of uniform, linear, random"},
      {"--sea salt:so --value 3", "sea: got 'salt:so', expected NAME=FILE:VARIABLE"},
      {"--value 3", "value: got no sea layer, expected at least one for expression '3'"},
      {"--rings oval --track x",
       "rings: got 'oval', expected one of equal_area, largest, quadrants"},
      {"--storm Rai", "--storm requires --track"},
      {"--radii x", "--radii requires --track"},
      {"--rings largest", "--rings requires --track"},
      {"--lead 4", "--lead requires --track"},
      {"--sea-risk 1", "--sea-risk requires --sea"},
      {"--sea-level nan", "sea_level: got nan, expected [-100000, 100000]"},
      {"--start noon",
       "start: got 'noon', expected a UTC time such as 2021-07-24T12:00Z, or a local one with its "
       "zone, such as 2021-07-24T20:00+08:00"},
      {"--chart /nowhere.json --center 30,122", "/nowhere.json: cannot read: No such file"},
      {"--devices 0", "--devices: Value 0 not in range"},
      {"--frob", "The following argument was not expected: --frob"},
      {"-o /nowhere/x.yaml", "/nowhere/x.yaml: cannot be written: No such file or directory"}};
  for (const auto& [arguments, words] : cases) {
    const auto [code, text] = RunApp(arguments);
    EXPECT_EQ(code, std::string(words).find("cannot be written") == std::string::npos ? 2 : 3)
        << arguments;
    EXPECT_NE(text.find(words), std::string::npos) << text;
  }
}

TEST(Program, RefusesAWrongRuleOfTheSeaByItsOption) {
  const fs::path path = fs::temp_directory_path() / ("rule." + std::to_string(getpid()) + ".nc");
  WriteSea(path.string(), "t", {29.0, 31.0}, {121.0, 123.0}, {20.0F, 20.0F, 20.0F, 20.0F});
  const std::string sea = "--center 30,122 --sea t=" + path.string() + ":t ";
  EXPECT_EQ(RunApp(sea + "--sea-risk 't > '").second.substr(0, 53),
            "sea_risk: got 't > ', expected an expression: Unexpec");
  EXPECT_EQ(RunApp(sea + "--value 't > '").second.substr(0, 50),
            "value: got 't > ', expected an expression: Unexpec");
  fs::remove(path);
}

TEST(Program, RefusesASizeForAChartWithItsOwn) {
  const fs::path path = fs::temp_directory_path() / ("own." + std::to_string(getpid()) + ".asc");
  std::ofstream(path) << "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 150\n"
                         "-1 -1 -1 -1\n-1 5 -1 -1\n-1 -1 -1 -1\n";
  const std::string chart = "--ports 2 --chart " + path.string();
  const auto [size_code, size] = RunApp(chart + " --size 9x9");
  EXPECT_EQ(size_code, 2);
  EXPECT_EQ(size, "size: got '9x9', expected the chart's own size; omit --size\n");
  const auto [cell_code, cell] = RunApp(chart + " --cell 1km");
  EXPECT_EQ(cell_code, 2);
  EXPECT_EQ(cell, "cell: got '1km', expected the chart's own value; omit --cell\n");
  EXPECT_EQ(RunApp(chart).first, 0);
  fs::remove(path);
}

}  // namespace
}  // namespace aquafarm
