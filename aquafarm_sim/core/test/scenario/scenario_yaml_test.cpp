// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/scenario/scenario_yaml.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "scenario/domains.h"
#include "tiny_farms.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

std::string MessageOf(const std::string& text) {
  try {
    ParseScenario(text, "ranch.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// Each file has one fault. Its first line contains the expected message without the file name.
class InvalidScenario : public testing::TestWithParam<fs::path> {};

TEST_P(InvalidScenario, IsRefusedInTheWordsOfItsFirstLine) {
  std::ifstream file(GetParam());
  std::string expected;
  std::getline(file, expected);
  ASSERT_GT(expected.size(), 2U);
  ASSERT_EQ(expected.substr(0, 2), "# ");
  try {
    LoadScenario(GetParam().string());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(GetParam().string() + expected.substr(2)), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
  }
}

TEST(RenamedKey, IsReadByItsOldNameWithOneLineThatGivesTheNewOne) {
  const std::string start = "name: x\nlayout: {ports: {count: 1}, devices: {count: 1}}\nview:\n";
  const fs::path path = fs::path(testing::TempDir()) / "old_names.yaml";
  std::ofstream(path) << start << "  waterways: true\n  courses: true\n";
  testing::internal::CaptureStderr();
  const Scenario scenario = LoadScenario(path.string());
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            path.string() +
                ":4: view.waterways is now called 'routes'; the old name still works\n" +
                path.string() +
                ":5: view.courses is now called 'lookahead_risk'; the old name still works\n");
  EXPECT_TRUE(scenario.view.routes && scenario.view.lookahead_risk);
  const std::string text = ToYaml(scenario);
  EXPECT_EQ(text.find("waterways"), std::string::npos);
  EXPECT_EQ(ParseScenario(text, "new.yaml").hash, scenario.hash);
}

std::vector<fs::path> InvalidFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(AQUAFARM_CORE_DIR "/test/invalid_scenarios")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

INSTANTIATE_TEST_SUITE_P(Files, InvalidScenario, testing::ValuesIn(InvalidFiles()),
                         [](const auto& test) { return test.param.stem().string(); });

TEST(Reader, RefusesFilesThatAreNoScenarios) {
  const std::string binary("name: x\nships: {count: \0 1}", 27);
  EXPECT_EQ(MessageOf(binary), "ranch.yaml:2: got byte 0, expected text (is this a binary file?)");
  const std::string huge = "name: x\ndescription: " + std::string(5 << 20, 'a');
  EXPECT_EQ(MessageOf(huge), "ranch.yaml: got more than 4194304 bytes, expected a scenario file");
  EXPECT_EQ(MessageOf("name: \"\xff\xfe\"\n").find("ranch.yaml:1: "), 0U);
  EXPECT_THROW(LoadScenario("/nonexistent/ranch.yaml"), InputError);
  EXPECT_THROW(LoadScenario("/tmp"), InputError);
  EXPECT_THROW(LoadScenario("/dev/zero"), InputError);
}

TEST(Reader, SurvivesDeepAndAliasedNesting) {
  EXPECT_NE(MessageOf("name: " + std::string(100000, '[')), "no error");
  EXPECT_NE(MessageOf("name: " + std::string(100000, '{')), "no error");
  EXPECT_NE(MessageOf("name: x\nships: &a {count: *a}\n"), "no error");
  std::string bomb = "name: x\na0: &a0 [1, 1]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before + ", " + before +
            "]\n";
  }
  EXPECT_NE(MessageOf(bomb + "disasters: *a59\n"), "no error");
}

TEST(Reader, BoundsListsBeforeItReadsThem) {
  std::string text = "name: x\ndisasters:\n";
  for (int i = 0; i < 65; ++i) text += "  - {kind: wave}\n";
  EXPECT_EQ(MessageOf(text), "ranch.yaml:2: disasters: got 65 entries, expected [0, 64]");
}

TEST(Reader, GivesThePapersFarmForANameAlone) {
  const Scenario scenario = ParseScenario("name: x\n", "ranch.yaml");
  EXPECT_EQ(scenario.width, 25);
  EXPECT_EQ(scenario.ports.count, 4);
  EXPECT_EQ(scenario.ships.capacity, 1);
  EXPECT_EQ(scenario.rocks.count.max, 40);
  EXPECT_TRUE(scenario.disasters.empty());
  EXPECT_EQ(scenario.step_limit, 5000);
}

TEST(Reader, ProjectsRealTracksOntoTheGrid) {
  const Scenario scenario = ParseScenario(R"(name: x
grid: {cell_size_m: 1000, origin: {latitude: 30, longitude: 122}}
time: {step_duration_s: 600, start: 2021-07-24T12:00:00Z}
disasters:
  - kind: typhoon
    risks: [-20, -5]
    track:
      - {time: 2021-07-24T11:00:00Z, latitude: 30, longitude: 122, radii_km: [40, 95.5], grade: 3}
      - {time: 2021-07-24T12:30:00Z, latitude: 30.1, longitude: 122, radii_km: [0, 90], grade: 2,
         pressure_hpa: 970, wind_mps: 33}
      - {time: 2021-07-25T12:00:00Z, latitude: 30, longitude: 122.1, radii_km: [0, 0], grade: 1,
         risks: [-10, -8]}
)",
                                          "ranch.yaml");
  const std::vector<Waypoint>& track = scenario.disasters[0].track;
  ASSERT_EQ(track.size(), 3U);
  EXPECT_FLOAT_EQ(track[0].step, -6.0F);
  EXPECT_FLOAT_EQ(track[1].step, 3.0F);
  EXPECT_FLOAT_EQ(track[2].step, 144.0F);
  EXPECT_EQ(track[0].x, 0.0F);
  EXPECT_EQ(track[0].y, 0.0F);
  // 0.1 degrees at 30 N on WGS 84 are 11.085 km north and 9.6486 km east.
  EXPECT_NEAR(track[1].y, 11.085, 0.001);
  EXPECT_NEAR(track[2].x, 9.6486, 0.001);
  EXPECT_FLOAT_EQ(track[0].radii[1], 95.5F);
  EXPECT_EQ(track[1].risks, (std::vector<float>{-20.0F, -5.0F})) << "the disaster's own";
  EXPECT_EQ(track[2].risks, (std::vector<float>{-10.0F, -8.0F}));
  EXPECT_EQ(track[1].wind_mps, 33.0F);
  EXPECT_EQ(track[2].wind_mps, std::nullopt);
  EXPECT_EQ(scenario.disasters[0].radii, track[0].radii);
  EXPECT_EQ(scenario.disasters[0].grade, 3);
}

TEST(Reader, KeepsWindsOfTracksAndForecastsWithoutEffect) {
  const std::string head =
      "name: x\ndisasters:\n  - kind: typhoon\n    risks: [-20, -5]\n    track:\n";
  const auto ranch = [&head](const std::string& wind) {
    return ParseScenario(head + "      - {step: 0, x: 0, y: 0, radii: [1, 2], grade: 3" + wind +
                             "}\n      - {step: 9, x: 9, y: 0, radii: [1, 2], grade: 3}\n" +
                             "    forecasts:\n      - step: 0\n        points:\n" +
                             "          - {step: 5, x: 4, y: 0" + wind + "}\n",
                         "ranch.yaml");
  };
  const Scenario windy = ranch(", wind_mps: 38.5");
  const Scenario back = ParseScenario(ToYaml(windy), "again");
  EXPECT_EQ(back.disasters[0].track[0].wind_mps, 38.5F);
  EXPECT_EQ(back.disasters[0].track[1].wind_mps, std::nullopt);
  EXPECT_EQ(back.disasters[0].forecasts[0].points[0].wind_mps, 38.5F);
  EXPECT_EQ(windy.hash, ranch("").hash) << "policies and bags of the scenario stay valid";
  EXPECT_EQ(windy.hash, back.hash);
  EXPECT_THROW(ranch(", wind_mps: 151"), InputError);
}

TEST(Reader, KeepsWindsOfRingsWithoutEffect) {
  const auto ranch = [](const std::string& winds) {
    return ParseScenario("name: x\ndisasters:\n  - kind: typhoon\n" + winds, "ranch.yaml");
  };
  const Scenario named = ranch("    ring_winds_kt: [64, 50, 34]\n");
  const Scenario back = ParseScenario(ToYaml(named), "again");
  EXPECT_EQ(back.disasters[0].ring_winds_kt, (std::vector<std::int32_t>{64, 50, 34}));
  EXPECT_EQ(named.hash, ranch("").hash) << "policies and bags of the scenario stay valid";
  EXPECT_EQ(ToYaml(ranch("")).find("ring_winds_kt"), std::string::npos);
}

TEST(Reader, KeepsTheNameOfAStormWithoutEffect) {
  const auto ranch = [](const std::string& name) {
    return ParseScenario("name: x\ndisasters:\n  - kind: typhoon\n" + name, "ranch.yaml");
  };
  const Scenario named = ranch("    name: 'In-Fa: \"2106\"'\n");
  EXPECT_EQ(ParseScenario(ToYaml(named), "again").disasters[0].name, "In-Fa: \"2106\"");
  EXPECT_EQ(named.hash, ranch("").hash) << "policies and bags of the scenario stay valid";
}

// A scenario that sets every key of a file to a value other than the default.
Scenario UnusualScenario() {
  Scenario s = test::CrowdedScenario(2);
  s.name = "odd \"name\" \\ 舟山";
  s.description = "two\nlines: with #, - and [";
  s.cell_size_m = 1.0 / 3.0;
  s.step_duration_s = 1e-3 + 1e-19;
  s.origin = GeoPoint{-30.123456789012345, 179.99999999999997};
  s.start_time = 951782399;  // 2000-02-28T23:59:59Z
  s.layout = LayoutMode::kFixed;
  s.layout_seed = std::numeric_limits<std::uint64_t>::max();
  s.rewards.pickup = 0.1F;
  s.rewards.sharing = RewardSharing::kTeam;
  s.damage.exposure_damage = std::nextafter(0.001F, 1.0F);
  s.energy = EnergySpec{0.1, {1.0 / 3.0, 0.5, 0.25, 0.1}, {0.7, 0.0, 0.3, 1e-9}};
  s.view = {ViewMode::kPartial, 7.7F, 3, 1.0e-30F, true, true};
  s.disasters[0].heading_deg = 359;
  s.disasters[0].start = {{-3.3F, 1.0e5F}};
  DisasterSpec tracked;
  tracked.kind = DisasterKind::kOilSpill;
  tracked.risks = {-15.5F, -5.0F};
  tracked.track = {{-7.25F, 1.1F, 2.2F, 4, {0.0F, 3.3F}, {-20.0F, -7.0F}},
                   {9.5F, -1.1F, -2.2F, 1, {1.0F, 1.0F}, {-6.0F, -6.0F}}};
  tracked.grade = 4;
  tracked.radii = tracked.track[0].radii;
  s.disasters.push_back(tracked);
  s.money = MoneySpec{"EUR", {1.01, 2.0, 3.99, 1.0e9}, 1200.5, 1.25, 0.25};
  s.hash = HashScenario(s);
  return s;
}

TEST(Writer, GivesTextThatReadsBackToTheSameBits) {
  const Scenario s = UnusualScenario();
  const std::string text = ToYaml(s);
  const Scenario back = ParseScenario(text, "again");
  EXPECT_EQ(ToYaml(back), text);
  EXPECT_EQ(back.hash, s.hash);
  EXPECT_EQ(back.name, s.name);
  EXPECT_EQ(back.description, s.description);
  EXPECT_EQ(back.cell_size_m, s.cell_size_m);
  EXPECT_EQ(back.step_duration_s, s.step_duration_s);
  EXPECT_EQ(back.origin->latitude, s.origin->latitude);
  EXPECT_EQ(back.origin->longitude, s.origin->longitude);
  EXPECT_EQ(back.start_time, s.start_time);
  EXPECT_EQ(back.layout_seed, s.layout_seed);
  EXPECT_EQ(back.damage.exposure_damage, s.damage.exposure_damage);
  EXPECT_EQ(back.money->currency, s.money->currency);
  EXPECT_EQ(back.money->device_values, s.money->device_values);
  EXPECT_EQ(back.money->ship_hour, s.money->ship_hour);
  EXPECT_EQ(back.money->kwh, s.money->kwh);
  EXPECT_EQ(back.money->at_sea_loss, s.money->at_sea_loss);
  EXPECT_EQ(back.energy->ships.per_km, s.energy->ships.per_km);
  EXPECT_EQ(back.energy->self_propelled.idle_per_step, s.energy->self_propelled.idle_per_step);
  EXPECT_EQ(back.view.bulletin_noise, s.view.bulletin_noise);
  EXPECT_EQ(back.view.shared_sight, s.view.shared_sight);
  EXPECT_EQ(back.view.routes, s.view.routes);
  EXPECT_EQ(back.view.lookahead_risk, s.view.lookahead_risk);
  EXPECT_EQ(back.disasters[0].heading_deg, s.disasters[0].heading_deg);
  EXPECT_EQ(back.disasters[0].start, s.disasters[0].start);
  EXPECT_EQ(back.disasters[1].heading_deg, std::nullopt);
  ASSERT_EQ(back.disasters[2].track.size(), 2U);
  EXPECT_EQ(back.disasters[2].track[1].x, -1.1F);
  EXPECT_EQ(back.disasters[2].track[1].risks, s.disasters[2].track[1].risks);
}

TEST(Writer, KeepsExplicitPlaces) {
  Scenario s = test::TinyScenario();
  s.devices.sites.push_back({{4, 4}, DeviceKind::kBreedingRelease, std::nullopt, true});
  s.devices.sites[1].insured_value = 12345.67;
  s.money.emplace();
  const Scenario back = ParseScenario(ToYaml(s), "again");
  ASSERT_EQ(back.devices.sites.size(), 2U);
  EXPECT_EQ(back.devices.sites[0].value, 80.0F);
  EXPECT_EQ(back.devices.sites[1].value, std::nullopt);
  EXPECT_TRUE(back.devices.sites[1].self_propelled);
  EXPECT_EQ(back.devices.sites[0].insured_value, std::nullopt);
  EXPECT_EQ(back.devices.sites[1].insured_value, 12345.67);
  EXPECT_EQ(back.rocks.cells, s.rocks.cells);
  EXPECT_EQ(back.ports.cells, s.ports.cells);
  EXPECT_EQ(back.islands[0].width, 2);
  EXPECT_EQ(back.SelfPropelledCount(), 1);
  EXPECT_EQ(back.AgentCount(), 2);
}

TEST(Tracks, TakeTheirRisksFromTheirGrade) {
  const Scenario scenario = ParseScenario(R"(
name: x
disasters:
  - kind: typhoon
    grade_risks: [[-8, -5], [-12, -5], [-16, -6], [-20, -7]]
    track:
      - {step: 0, x: 0, y: 0, radii: [1, 2], grade: 3}
      - {step: 5, x: 9, y: 0, radii: [1, 2], grade: 1}
      - {step: 9, x: 9, y: 9, radii: [1, 2], grade: 1, risks: [-19, -9]}
)",
                                          "graded");
  const DisasterSpec& disaster = scenario.disasters.at(0);
  EXPECT_EQ(disaster.risks, (std::vector<float>{-16.0F, -6.0F}));
  EXPECT_EQ(disaster.track[0].risks, (std::vector<float>{-16.0F, -6.0F}));
  EXPECT_EQ(disaster.track[1].risks, (std::vector<float>{-8.0F, -5.0F}));
  EXPECT_EQ(disaster.track[2].risks, (std::vector<float>{-19.0F, -9.0F}));
  EXPECT_EQ(ParseScenario(ToYaml(scenario), "again").hash, scenario.hash);
}

TEST(Documentation, NamesEveryKey) {
  std::ifstream file(AQUAFARM_CORE_DIR "/../../docs/scenario.md");
  if (!file) GTEST_SKIP() << "this copy of the core has no docs";
  const std::string docs((std::istreambuf_iterator<char>(file)), {});
  std::istringstream keys(ToYaml(UnusualScenario()) + ToYaml(test::TinyScenario()) +
                          "time:\nlatitude:\nlongitude:\nradii_km:\npressure_hpa:\nwind_mps:\n"
                          "grade_risks:\ngrade_factors:\nring_winds_kt:\nmonitoring_radius:\n");
  for (std::string line; std::getline(keys, line);) {
    const std::size_t first = line.find_first_not_of(" -");
    const std::string key = line.substr(first, line.find(':') - first);
    const bool named = docs.find(" " + key + ":") != std::string::npos ||
                       docs.find("\n" + key + ":") != std::string::npos;
    EXPECT_TRUE(named) << key;
  }
}

TEST(Writer, DoesNotMindALocaleWithADecimalComma) {
  const std::string text = ToYaml(UnusualScenario());
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    EXPECT_EQ(ToYaml(UnusualScenario()), text);
    EXPECT_EQ(ToYaml(ParseScenario(text, "again")), text);
  }
  std::setlocale(LC_ALL, "C");
}

TEST(Hash, IsTheSameForFilesThatMeanTheSame) {
  const Scenario plain = ParseScenario("name: x\nships: {count: 2}\n", "a");
  EXPECT_EQ(ParseScenario("# words\nships:\n  count: 2\nname: y\ndescription: z\n", "b").hash,
            plain.hash);
  EXPECT_EQ(ParseScenario("name: x\nships: {count: 2}\nrewards: {pickup: 20.0}\n", "c").hash,
            plain.hash);
  EXPECT_NE(ParseScenario("name: x\nships: {count: 1}\n", "d").hash, plain.hash);
  EXPECT_NE(ParseScenario("name: x\nships: {count: 2}\nrewards: {pickup: 20.1}\n", "e").hash,
            plain.hash);
  EXPECT_EQ(plain.hash, HashScenario(plain));
}

TEST(Numbers, AreWrittenShortAndReadBackExactly) {
  EXPECT_EQ(internal::Format(0.1F), "0.1");
  EXPECT_EQ(internal::Format(25.0F), "25");
  EXPECT_EQ(internal::Format(0.1), "0.1");
  std::uint64_t bits = 1;
  for (int i = 0; i < 20000; ++i) {
    Hasher hasher;
    hasher.Add(bits++);
    const auto word = static_cast<std::uint32_t>(hasher.value());
    float value;
    std::memcpy(&value, &word, sizeof(value));
    if (!std::isfinite(value)) continue;
    float back = 0.0F;
    // Streams reject subnormal numbers; no number of a scenario is that small.
    if (std::abs(value) < std::numeric_limits<float>::min()) continue;
    ASSERT_TRUE(internal::Parse(internal::Format(value), back)) << value;
    ASSERT_EQ(back, value) << internal::Format(value);
  }
}

TEST(Numbers, AreReadWholeOrNotAtAll) {
  for (const char* text : {"", " 1", "1 ", "1x", "--1", "+", "nan", "inf", "1e", "0x10", "1,5"}) {
    float real = 0.0F;
    std::int32_t whole = 0;
    EXPECT_FALSE(internal::Parse(text, real)) << text;
    EXPECT_FALSE(internal::Parse(text, whole)) << text;
  }
  std::int32_t whole = 0;
  EXPECT_FALSE(internal::Parse("2147483648", whole));
  EXPECT_TRUE(internal::Parse("-2147483648", whole));
  std::uint64_t large = 0;
  EXPECT_FALSE(internal::Parse("18446744073709551616", large));
  EXPECT_TRUE(internal::Parse("18446744073709551615", large));
  EXPECT_EQ(large, std::numeric_limits<std::uint64_t>::max());
}

TEST(Times, AreReadAndWrittenAsUtc) {
  std::int64_t seconds = 0;
  ASSERT_TRUE(internal::ParseTime("2021-07-24T12:00:00Z", seconds));
  EXPECT_EQ(seconds, 1627128000);
  for (const char* text : {"1900-01-01T00:00:00Z", "1969-12-31T23:59:59Z", "2000-02-29T00:00:00Z",
                           "2021-07-24T12:34:56Z", "2200-12-31T23:59:59Z"}) {
    ASSERT_TRUE(internal::ParseTime(text, seconds)) << text;
    EXPECT_EQ(internal::FormatTime(seconds), text);
  }
  EXPECT_FALSE(internal::ParseTime("2021-7-24T12:00:00Z", seconds));
  EXPECT_FALSE(internal::ParseTime("2021-07-24T24:00:00Z", seconds));
  EXPECT_FALSE(internal::ParseTime("1899-12-31T23:59:59Z", seconds));
}

TEST(Times, OfOptionsNeedAZoneAndMayLeaveOutSeconds) {
  for (const char* text : {"2021-07-24T12:00:00Z", "2021-07-24T12:00Z", "2021-07-24 12:00Z",
                           "2021-07-24T20:00+08:00", "2021-07-24T08:30:00-03:30"}) {
    EXPECT_EQ(ParseUtc("at", text), 1627128000) << text;
  }
  for (const char* text : {"", "noon", "2021-07-24T12:00", "2021-07-24T12:00:00", "2021-07-24",
                           "2021-07-24T25:00Z", "2021-07-24T12:00Zx"}) {
    EXPECT_THROW(ParseUtc("at", text), InputError) << text;
  }
}

}  // namespace
}  // namespace aquafarm
