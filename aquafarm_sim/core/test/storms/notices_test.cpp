// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/notices.h"

#include <gtest/gtest.h>

#include <fstream>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "shared_data.h"

namespace aquafarm {
namespace {

namespace fs = std::filesystem;

std::string Sample(const char* name) {
  const std::string path = std::string(AQUAFARM_CORE_DIR "/test/data/") + name;
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::int64_t Utc(const char* text) { return ParseUtc("test", text); }

TEST(Warnings, HaveTheirColourAndTheirHours) {
  const NoticeFile file = ParseNotices(Sample("warning.json"), "x.json");
  ASSERT_EQ(file.notices.size(), 1U) << "the other one is cancelled";
  const Notice& gale = file.notices[0];
  EXPECT_EQ(gale.place, "舟山市气象台");
  EXPECT_EQ(gale.grade, 2);
  EXPECT_EQ(gale.start, Utc("2026-05-04T02:30:00Z"));
  EXPECT_EQ(gale.end, Utc("2026-05-05T02:30:00Z"));
  EXPECT_EQ(Describe(gale),
            "大风 of 舟山市气象台, grade 2, from 2026-05-04T02:30:00Z to 2026-05-05T02:30:00Z");
}

TEST(Warnings, MayBeNone) {
  EXPECT_TRUE(ParseNotices(R"({"code": "200", "warning": []})", "x.json").notices.empty());
}

TEST(Anchorages, HaveWindsWavesAndTheWorstRating) {
  const NoticeFile file = ParseNotices(Sample("anchorage.json"), "x.json");
  ASSERT_EQ(file.notices.size(), 2U);
  EXPECT_EQ(file.notices[0].start, Utc("2026-04-30T00:00:00Z"));
  EXPECT_EQ(file.notices[0].wave_max_m, 0.5);
  EXPECT_EQ(file.notices[0].suitability, 4);
  const Notice& night = file.notices[1];
  EXPECT_EQ(night.place, "东锚地");
  EXPECT_EQ(night.start, Utc("2026-04-30T15:00:00Z"));
  EXPECT_EQ(night.end, Utc("2026-04-30T18:00:00Z")) << "the first of May at two in the morning";
  EXPECT_EQ(night.wind_mps, 16.0);
  EXPECT_EQ(night.gust_mps, 21.8);
  EXPECT_EQ(night.wave_max_m, 3.0);
  EXPECT_EQ(night.suitability, 1);
}

TEST(Anchorages, WithoutForecastsAreSaid) {
  const auto said = [](const std::string& anchors) {
    const NoticeFile file = ParseNotices(
        "{\"publishCode\": \"2026043011\",\n\"anchors\": {" + anchors + "}}", "x.json");
    EXPECT_TRUE(file.notices.empty());
    return file.warnings;
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(said(""), Words{"x.json:2: anchors: got none, expected anchorages by name"});
  for (const std::string none : {R"("Time": "2026043011")", R"("PreciseForecast": [])",
                                 R"("PreciseForecast": null)", R"("preciseForecast": [{}])"}) {
    EXPECT_EQ(said("\n\"东锚地\": {" + none + "}"),
              Words{"x.json:3: anchors.东锚地: got no PreciseForecast; the anchorage is left out"})
        << none;
  }
}

// Returns the start of the first notice of the sample, after replacing its time of publication and
// its periods.
std::int64_t StartOf(const std::string& published, const std::string& period) {
  std::string text = Sample("anchorage.json");
  text.replace(text.find("2026043011"), 10, published);
  for (const std::string sample : {"30日08时-11时", "30日23时-01日02时"}) {
    text.replace(text.find(sample), sample.size(), period);
  }
  return ParseNotices(text, "x.json").notices[0].start;
}

TEST(Anchorages, TakeTheMonthInWhichTheDayIsNearestToThePublication) {
  EXPECT_EQ(StartOf("2026050102", "30日23时-01日02时"), Utc("2026-04-30T15:00:00Z"));
  EXPECT_EQ(StartOf("2026050102", "01日02时-05时"), Utc("2026-04-30T18:00:00Z"));
  EXPECT_EQ(StartOf("2026050102", "03日08时-11时"), Utc("2026-05-03T00:00:00Z"));
  EXPECT_EQ(StartOf("2027010100", "31日23时-01日02时"), Utc("2026-12-31T15:00:00Z"));
  EXPECT_EQ(StartOf("2026123120", "01日08时-11时"), Utc("2027-01-01T00:00:00Z"));
  EXPECT_EQ(StartOf("2026123120", "31日20时-23时"), Utc("2026-12-31T12:00:00Z"));
  EXPECT_EQ(StartOf("2026022820", "01日08时-11时"), Utc("2026-03-01T00:00:00Z"));
}

std::string Refused(const char* sample, const std::string& from, const std::string& to) {
  std::string text = Sample(sample);
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  try {
    ParseNotices(text, "x.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "was read";
}

TEST(Notices, ThatAreWrongAreRefusedWithTheirLine) {
  EXPECT_EQ(
      Refused("warning.json", "Yellow", "Pink"),
      "x.json:5: warning[0].severityColor: got 'Pink', expected White, Blue, Yellow, Orange or "
      "Red");
  EXPECT_EQ(Refused("warning.json", "2026-05-05T10:30", "2026-05-32T10:30"),
            "x.json:4: warning[0].endTime: got '2026-05-32T10:30+08:00', expected a time such as "
            "2021-07-25T14:00:00");
  EXPECT_EQ(Refused("warning.json", "2026-05-05T10:30", "2026-05-04T10:30"),
            "x.json:4: warning[0].endTime: got an end that is not after the start");
  EXPECT_EQ(Refused("warning.json", "\"200\"", "\"401\""),
            "x.json:1: code: got '401', expected '200'");
  EXPECT_EQ(Refused("anchorage.json", "2026043011", "20260430"),
            "x.json:1: publishCode: got '20260430', expected YYYYMMDDHH");
  EXPECT_EQ(Refused("anchorage.json", "30日08时-11时", "32日08时-11时"),
            "x.json:3: anchors.东锚地.PreciseForecast[0].Time: got '32日08时-11时', expected a "
            "period such as "
            "'04日08时-11时'");
  EXPECT_EQ(
      Refused("anchorage.json", "<0.5m", "calm"),
      "x.json:3: anchors.东锚地.PreciseForecast[0].WindWave: got 'calm', expected a range such as "
      "'0.5-1.0m'");
  EXPECT_EQ(
      Refused("anchorage.json", "4 4 4 4", "4 4 7 4"),
      "x.json:3: anchors.东锚地.PreciseForecast[0].Riskrating: got '4 4 7 4', expected numbers "
      "from 1 to 4");
  EXPECT_EQ(
      Refused("anchorage.json", "5.6", "560"),
      "x.json:3: anchors.东锚地.PreciseForecast[0].WindSpeed: got 560, expected a number in [0, "
      "150]");
  const std::string expected = ", expected a weather service's warnings or anchorage forecasts";
  EXPECT_EQ(Refused("cma.txt", "", ""),
            "x.json:1: got tracks of storms (CMA best track)" + expected);
  EXPECT_EQ(Refused("coast.json", "", ""), "x.json:1: got GeoJSON" + expected);
  EXPECT_EQ(Refused("warning.json", "\"warning\"", "\"warnings\""),
            "x.json:1: got neither \"warning\" nor \"anchors\"" + expected);
  EXPECT_EQ(Refused("warning.json", "\"warning\"", "\"alerts\""),
            "x.json:2: alerts: got the newer interface's alerts, which are not read" + expected);
}

TEST(Notices, NextToAnchoragesAreReportedAsUnread) {
  std::string text = Sample("anchorage.json");
  text.insert(text.find('{') + 1, "\"warning\": [{}],");
  EXPECT_EQ(ParseNotices(text, "x.json").warnings,
            std::vector<std::string>{"x.json:1: warning: is ignored in a file with anchors"});
}

TEST(Notices, MayHaveKeysThatOtherFilesHave) {
  for (const char* sample : {"warning.json", "anchorage.json"}) {
    std::string text = Sample(sample);
    text.insert(text.find('{') + 1,
                R"("type": "x", "coordinates": [122.1, 30.1], "features": [], "track": null,)");
    EXPECT_FALSE(ParseNotices(text, "x.json").notices.empty()) << sample;
  }
}

TEST(RealNotices, AreRead) {
  const fs::path folder = SharedData() / "bulletins";
  if (!fs::exists(folder)) GTEST_SKIP() << "no bulletins at " << folder;
  const NoticeFile shanghai = LoadNotices((folder / "qweather_getWarningNow-zh.json").string());
  ASSERT_EQ(shanghai.notices.size(), 1U);
  EXPECT_EQ(shanghai.notices[0].grade, 1);
  EXPECT_EQ(shanghai.notices[0].what, "大风");
  const NoticeFile zhoushan = LoadNotices((folder / "zs121_anchorage_2026050411.json").string());
  ASSERT_EQ(zhoushan.notices.size(), 96U) << "24 periods of 4 anchorages";
  EXPECT_EQ(zhoushan.notices[0].end - zhoushan.notices[0].start, 3 * 3600);
  std::int32_t lowest = 4;
  for (const Notice& notice : zhoushan.notices) {
    lowest = std::min(lowest, notice.suitability);
    EXPECT_LE(*notice.wind_mps, *notice.gust_mps);
  }
  EXPECT_EQ(lowest, 2);
}

}  // namespace
}  // namespace aquafarm
