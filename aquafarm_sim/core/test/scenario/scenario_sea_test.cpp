// SPDX-License-Identifier: BSD-3-Clause
// The sea of a scenario: given as values, read from a netCDF file or computed by rules, and its
// effect on episodes.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "aquafarm/base/check.h"
#include "aquafarm/observation/encoder.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "tiny_farms.h"
#include "write_sea.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// The 5 × 5 farm with a temperature of 20 degrees in the south, increasing by 1 per row, and
/// unknown in the north-east corner.
Scenario Warm() {
  Scenario scenario = test::TinyScenario();
  SeaLayer warmth{"warmth", "degC", {}};
  for (int i = 0; i < 25; ++i) warmth.values.push_back(20.0F + static_cast<float>(i / 5));
  warmth.values.back() = kUnknown;
  scenario.seas = SeaSpec{{warmth}, {}, {}};
  return scenario;
}

std::string WithRules(const std::string& rules) {
  std::string text = ToYaml(Warm());
  return text.replace(text.find("seas:\n"), 6, "seas:\n" + rules);
}

std::string Refused(const std::string& text) {
  try {
    ParseScenario(text, "x.yaml");
  } catch (const InputError& error) {
    const std::string line = error.what();
    return line.substr(line.find("seas"));
  }
  return "was taken";
}

TEST(Seas, AreWrittenAndReadBackWithTheUnknown) {
  const Scenario read = ParseScenario(ToYaml(Warm()), "x.yaml");
  ASSERT_TRUE(read.seas);
  EXPECT_EQ(read.seas->layers[0].units, "degC");
  EXPECT_EQ(read.seas->layers[0].values[7], 21.0F);
  EXPECT_TRUE(std::isnan(read.seas->layers[0].values[24]));
  EXPECT_EQ(ToYaml(read), ToYaml(Warm()));
}

TEST(Seas, ArePartOfTheHash) {
  Scenario other = Warm();
  other.seas->layers[0].values[3] = 20.5F;
  EXPECT_NE(HashScenario(other), HashScenario(Warm()));
  EXPECT_NE(HashScenario(Warm()), HashScenario(test::TinyScenario()));
}

TEST(Seas, GiveRisksByRuleThatAreFeltLikeThoseOfDisasters) {
  const Scenario scenario = ParseScenario(WithRules("  risk: 'warmth > 22 ? -8 : 0'\n"), "x.yaml");
  Farm farm(std::make_shared<const Scenario>(scenario));
  EXPECT_EQ(farm.RiskAt({0, 2}), 0.0F);
  EXPECT_EQ(farm.RiskAt({0, 3}), -8.0F);
  EXPECT_EQ(farm.RiskAt({4, 4}), 0.0F) << "nothing is known there";
  for (int i = 0; i < 2; ++i) test::StepOne(farm, Action::kNorth);
  EXPECT_EQ(farm.ships()[0].terms.disaster, 0.0F);
  const Ship& ship = test::StepOne(farm, Action::kNorth);
  EXPECT_EQ(ship.cell, (Cell{2, 3}));
  EXPECT_EQ(ship.reward, -8.0F) << "instead of the -1 of a step";
  View view;
  Observe(farm, 0, view);
  EXPECT_EQ(KnownRiskAt(view, {2, 3}), -8.0F);
  const Encoder encoder(farm.scenario());
  std::vector<std::uint8_t> planes(encoder.planes_size());
  encoder.Planes(view, planes.data());
  for (std::int32_t i = 0; i < 25; ++i) {
    const int expected = i / 5 > 2 && i < 24 ? 102 : 0;  // 255 · 8 / 20
    EXPECT_EQ(planes[static_cast<std::size_t>(i)], expected) << i;
    EXPECT_EQ(planes[static_cast<std::size_t>(25 + i)], expected) << "forecast, " << i;
  }
}

TEST(Seas, AreNoMoreThanTheWorstOfAllRisks) {
  Scenario scenario = ParseScenario(WithRules("  risk: '-8'\n"), "x.yaml");
  scenario.disasters = {test::StillDisaster(2, 2, {1.0F, 2.0F}, {-20.0F, -5.0F})};
  const Farm farm = test::MakeFarm(scenario);
  EXPECT_EQ(farm.RiskAt({2, 2}), -20.0F);
  EXPECT_EQ(farm.RiskAt({2, 4}), -8.0F);
  Grid<float> risk(5, 5);
  FillRisk(scenario, farm.disasters(), risk);
  for (std::int32_t i = 0; i < 25; ++i) {
    EXPECT_EQ(risk.data()[i], farm.RiskAt({i % 5, i / 5}));
  }
}

TEST(Seas, WearDevicesDownAsDisastersDo) {
  Scenario scenario = ParseScenario(WithRules("  risk: '-8'\n"), "x.yaml");
  scenario.damage.exposure_damage = 0.01F;
  Farm farm = test::MakeFarm(scenario);
  test::StepOne(farm, Action::kNorth);
  EXPECT_FLOAT_EQ(farm.devices()[0].health, 0.92F);
}

TEST(Seas, GiveDrawnDevicesTheirValueByRule) {
  std::string text = WithRules("  device_value: '2 * warmth'\n");
  Scenario scenario = ParseScenario(text, "x.yaml");
  EXPECT_EQ(test::MakeFarm(scenario).devices()[0].value, 80.0F) << "its site says so";
  scenario.devices.sites[0].value.reset();
  EXPECT_EQ(test::MakeFarm(scenario).devices()[0].value, 44.0F) << "in the row of 22 degrees";
  scenario.devices.sites.clear();
  scenario.devices.placement = DevicePlacement::kRandom;
  scenario.devices.count = 8;
  scenario.rocks.cells.clear();
  scenario.rocks.count = {0, 0};
  scenario.seas->device_value[12] = kUnknown;
  const Farm drawn = test::MakeFarm(scenario);
  scenario.seas->device_value.clear();
  const Farm plain = test::MakeFarm(scenario);
  for (std::size_t i = 0; i < 8; ++i) {
    const Device& device = drawn.devices()[i];
    EXPECT_EQ(device.cell, plain.devices()[i].cell) << "no draw is lost";
    const bool known = device.cell != Cell{2, 2} && device.cell != Cell{4, 4};
    const float expected =
        known ? 2.0F * (20.0F + static_cast<float>(device.cell.y)) : plain.devices()[i].value;
    EXPECT_EQ(device.value, expected);
  }
}

TEST(Seas, OfRulesAreTheSameAsNumbers) {
  const Scenario ruled = ParseScenario(WithRules("  risk: 'warmth > 22 ? -8 : 0'\n"), "x.yaml");
  const std::string text = ToYaml(ruled);
  EXPECT_EQ(text.find("warmth >"), std::string::npos);
  EXPECT_NE(text.find("risk_values"), std::string::npos);
  EXPECT_EQ(ParseScenario(text, "y.yaml").hash, ruled.hash);
}

TEST(Seas, ThatAreWrongAreRefused) {
  EXPECT_EQ(Refused(WithRules("  risk: 'warmth - 22'\n")),
            "seas.risk: got -2 at (0, 0), expected 0 or a number in [-20, -5]");
  EXPECT_EQ(Refused(WithRules("  device_value: '1 - warmth'\n")),
            "seas.device_value: got -19 at (0, 0), expected 0 or a number in [0, 10000]");
  EXPECT_EQ(Refused(WithRules("  risk: '2 * '\n")).substr(0, 52),
            "seas.risk: got '2 * ', expected an expression: Unexp");
  EXPECT_EQ(Refused(WithRules("  risk: '-8'\n  risk_values: [0]\n")),
            "seas.risk_values: is used only if 'risk' is not set");
  EXPECT_EQ(Refused(WithRules("  risk_values: [0, -8]\n")),
            "seas.risk_values: got 2 values, expected one per cell: 25");
  EXPECT_EQ(Refused(WithRules("  device_values: [0, 8]\n")),
            "seas.device_values: got 2 values, expected one per cell: 25");
  Scenario wrong = Warm();
  wrong.seas->risk.assign(25, 0.0F);
  wrong.seas->risk[7] = -3.0F;
  EXPECT_EQ(Refused(ToYaml(wrong)),
            "seas.risk_values: got -3 at (2, 1), expected 0 or a number in [-20, -5]");
  EXPECT_EQ(Refused(WithRules("  depth: 3\n")),
            "seas.depth: unknown key 'depth'; allowed: layers, risk, risk_values, device_value, "
            "device_values");
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = ToYaml(Warm());
    return Refused(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(changed("name: \"warmth\"", "name: \"Warm th\""),
            "seas.layers[0].name: got 'Warm th', expected a-z, 0-9 and _, starting with a letter");
  EXPECT_EQ(changed(".nan]", ".nan, 7]"),
            "seas.layers[0].values: got 26 values, expected one per cell: 25");
  EXPECT_EQ(changed(".nan]", "nothing]"),
            "seas.layers[0].values[24]: got 'nothing', expected a number or .nan");
  EXPECT_EQ(changed("units: \"degC\"", "file: sea.nc"),
            "seas.layers[0].values: is used only if 'file' is not set");
  Scenario twice = Warm();
  twice.seas->layers.push_back(twice.seas->layers[0]);
  EXPECT_EQ(Refused(ToYaml(twice)), "seas.layers[0].name: got 'warmth' twice, expected it once");
}

// 120,000 cells: more than the max number of islands, but less than the 200,000 values of a sea.
TEST(Seas, OfALargeFarmAreWrittenAndReadBack) {
  Scenario scenario = Warm();
  scenario.width = 400;
  scenario.height = 300;
  scenario.seas->layers[0].values.assign(120000, 20.5F);
  const Scenario read = ParseScenario(ToYaml(scenario), "x.yaml");
  EXPECT_EQ(read.seas->layers[0].values.size(), 120000U);
  scenario.seas->risk.assign(120000, -8.0F);
  EXPECT_EQ(Refused(ToYaml(scenario)), "seas: got 240000 values, expected at most 200000");
}

/// A file with a field that is 0 at 30 N and increases by 100 per degree to the north.
class SeaFiles : public testing::Test {
 protected:
  SeaFiles() : folder_(fs::temp_directory_path() / ("seas." + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    WriteSea((folder_ / "sea.nc").string(), "thetao", {29.0, 30.0, 31.0}, {121.0, 122.0, 123.0},
             {-100, -100, -100, 0, 0, 0, 100, 100, 100});
  }
  ~SeaFiles() override { fs::remove_all(folder_); }

  std::string Write(const std::string& file, const std::string& variable = "thetao",
                    bool placed = true) const {
    Scenario scenario = test::TinyScenario();
    if (placed) scenario.origin = GeoPoint{30.0, 122.0};
    const std::string path = (folder_ / "ranch.yaml").string();
    std::ofstream(path) << ToYaml(scenario)
                        << "seas:\n  layers:\n    - {name: warmth, file: " << file
                        << ", variable: " << variable << "}\n"
                        << "  device_value: 'warmth + 50'\n";
    return path;
  }
  std::string RefusedFile(const std::string& path) const {
    try {
      LoadScenario(path);
    } catch (const InputError& error) {
      const std::string line = error.what();
      return line.substr(line.find("seas.l"));
    }
    return "was taken";
  }

  const fs::path folder_;
};

TEST_F(SeaFiles, AreReadFromTheFolderOfTheScenario) {
  const Scenario scenario = LoadScenario(Write("sea.nc"));
  const SeaLayer& warmth = scenario.seas->layers[0];
  EXPECT_EQ(warmth.units, "degC");
  EXPECT_NEAR(warmth.values[0], 0.0F, 1e-4F);
  EXPECT_NEAR(warmth.values[24], 3.608F, 0.01F) << "four kilometres are 0.03608 degrees";
  EXPECT_NEAR(scenario.seas->device_value[24], 53.608F, 0.01F);
  EXPECT_EQ(ParseScenario(ToYaml(scenario), "elsewhere.yaml").hash, scenario.hash)
      << "its own text needs the file no more";
}

TEST_F(SeaFiles, ThatAreNotThereAreRefused) {
  EXPECT_EQ(RefusedFile(Write("none.nc")),
            "seas.layers[0].file: " + (folder_ / "none.nc").string() +
                ": cannot read as netCDF: No such file or directory");
  ASSERT_EQ(mkfifo((folder_ / "pipe.nc").c_str(), 0600), 0);
  for (const std::string& name : {std::string("pipe.nc"), std::string(".")}) {
    EXPECT_EQ(RefusedFile(Write(name)), "seas.layers[0].file: " + (folder_ / name).string() +
                                            ": cannot read: not a regular file");
  }
  EXPECT_EQ(RefusedFile(Write("sea.nc", "so")),
            "seas.layers[0].file: " + (folder_ / "sea.nc").string() +
                ": so: no such variable; available: lat, lon, thetao");
  EXPECT_EQ(RefusedFile(Write("sea.nc", "thetao", false)),
            "seas.layers[0].file: needs grid.origin, which is missing");
}

}  // namespace
}  // namespace aquafarm
