// SPDX-License-Identifier: BSD-3-Clause
// Files without tracks are rejected with the position, the given and the expected value.
#include <gtest/gtest.h>

#include "storm_samples.h"

namespace aquafarm {
namespace {

struct WrongText {
  const char* name;
  const char* text;
  const char* words;
};
void PrintTo(const WrongText& wrong, std::ostream* out) { *out << wrong.name; }

#define CMA_HEAD "66666 2106   02 0011 2106 0 3 In-fa   20220410\n"
#define CMA_ONE "66666 2106   01 0011 2106 0 3 In-fa   20220410\n"
#define CMA_POINT "2021072500 4 297 1230  968      35\n"
#define JMA_HEAD "66666 2106  001 0011 2106 0 6                IN-FA              20220101\n"
#define ATCF_ROW "WP, 08, 2014070312,   , BEST,   0, 109N, 1440E,  30, 1000, TD\n"

const std::vector<WrongText> kWrongTexts{
    {"Empty", "", "x:1: got an empty file, expected tracks of storms"},
    {"EmptyList", " [] \n", "x:1: got an empty list, expected a list of storms"},
    {"OtherFormat", "P5\n10 10\n", "x:1: got a PGM picture, expected tracks of storms: a CMA"},
    {"OtherJson", "{\n  \"code\":  \"200\",\r\n \"daily\": []\n}\n",
     "x:1: got '{ \"code\": \"200\", \"daily\": [] }', expected tracks of storms: a CMA"},
    {"HeaderAlone", "66666\n2021\x01", "x:1: got '66666', expected tracks of storms: a CMA or J"},
    {"CmaTruncated", CMA_HEAD CMA_POINT,
     "x:2: got 1 points, expected the 2 points of the header on line 1"},
    {"CmaCountTooHigh", CMA_HEAD CMA_POINT "66666 2107   01 0012 2107 0 3 X   20220410\n",
     "x:3: got 1 points, expected the 2 points of the header on line 1"},
    {"CmaCountTooLow", CMA_HEAD CMA_POINT "2021072506 4 300 1222  970 33\n" CMA_POINT,
     "x:4: got '2021072500', expected a header, 66666 …"},
    {"CmaHeaderCut", "66666 2106 2\n" CMA_POINT, "x:1: got 3 words, expected a header"},
    {"CmaHeaderWithoutDate", "66666 2106   01 0011 2106 0 3 In-fa\n" CMA_POINT,
     "x:1: got 8 words, expected a header"},
    {"CmaHeaderDateCut", "66666 2106   01 0011 2106 0 3 In-fa   202204\n" CMA_POINT,
     "x:1: date: got '202204' at the end, expected YYYYMMDD: was it cut off?"},
    {"CmaPointCut", CMA_HEAD "2021072500 4 297 1230\n",
     "x:2: got 4 words, expected a point: time, grade, latitude"},
    {"CmaDay", CMA_ONE "2021023000 4 297 1230  968 35\n",
     "x:2: time: got '2021023000', expected an hour of UTC as YYYYMMDDHH"},
    {"CmaLatitude", CMA_ONE "2021072500 4 950 1230  968 35\n",
     "x:2: latitude in tenths of a degree: got '950', expected a whole number in [-900, 900]"},
    {"CmaLongitude", CMA_ONE "2021072500 4 297 4000  968 35\n",
     "longitude in tenths of a degree: got '4000', expected a whole number in [-1800, 3600]"},
    {"CmaBackwards", CMA_HEAD CMA_POINT "2021072418 4 300 1222  970 33\n",
     "x:3: time: got 2021-07-24T18:00:00Z, expected a time after that of the point"},
    {"JmaTruncated",
     "66666 2106  002 0011 2106 0 6                IN-FA              20220101\n"
     "21072500 002 2 297 1230  998     000\n",
     "x:2: got 1 points, expected the 2 points of the header on line 1"},
    {"JmaHeaderCut",
     "66666 2106  001 0011 2106 0 6                IN-FA              2022010\n"
     "21072500 002 2 297 1230  998     000\n",
     "x:1: got a header of 71 columns, expected 72 or more, which contain the date"},
    {"JmaCut", JMA_HEAD "21072500 002 2 297\n",
     "x:2: got a line of 18 columns, expected at least 36"},
    {"JmaHour", JMA_HEAD "21072524 002 2 297 1230  998     000\n",
     "x:2: time: got '2021072524', expected an hour of UTC"},
    {"AtcfFew", ATCF_ROW "WP, 08, 2014070318,   , BEST\n",
     "x:2: got 5 fields, expected at least 11 of an ATCF row"},
    {"AtcfForecast", "WP, 08, 2014070312, 03, JTWC,   0, 109N, 1440E,  30, 1000, TD\n",
     "x:1: technique: got 'JTWC', expected BEST: a b-deck"},
    {"AtcfLatitude", "WP, 08, 2014070312,   , BEST,   0, 950N, 1440E,  30, 1000, TD\n",
     "x:1: latitude: got '950', expected a whole number in [0, 900]"},
    {"AtcfSide", "WP, 08, 2014070312,   , BEST,   0, 109, 1440E,  30, 1000, TD\n",
     "x:1: latitude: got '109', expected tenths of a degree and N or S"},
    {"AtcfBackwards", ATCF_ROW "WP, 08, 2014070306,   , BEST,   0, 102N, 1451E,  30, 1000, TD\n",
     "x:2: time: got 2014-07-03T06:00:00Z, expected a time after that of the point before, "
     "2014-07-03T12:00:00Z"},
    {"IbtracsColumn", "SID,NAME,LAT\n", "x:1: got no column ISO_TIME, expected those of IBTrACS"},
    {"BulletinPoints", R"([{"tfbh": "1", "points": []}])",
     "x:1: [0].points: got none, expected at least one"},
    {"BulletinSpan", R"([{"tfbh": "1", "points": [
      {"time": "2019-07-25T14:00:00", "lat": 30, "lng": 1},
      {"time": "2021-07-25T14:00:00", "lat": 30, "lng": 1}]}])",
     "[0].points: got 731 days of one storm, expected at most 366"},
    {"BulletinLatitude",
     "[{\"tfbh\": \"1\", \"points\": [\n{\"time\": \"2021-07-25T14:00:00\",\n\"lat\": 95, "
     "\"lng\": 1}]}]",
     "x:3: [0].points[0].lat: got 95, expected a number in [-90, 90]"},
    {"BulletinNull",
     "[{\"tfbh\": \"1\", \"points\": [\n{\"time\": \"2021-07-25T14:00:00\", \"lat\": \"null\", "
     "\"lng\": 1}]}]",
     "x:2: [0].points[0].lat: got nothing, expected a number in [-90, 90]"},
    {"BulletinTime", R"([{"tfbh": "1", "points": [{"time": "2021-02-30T00:00:00"}]}])",
     "x:1: [0].points[0].time: got '2021-02-30T00:00:00', expected a time such as"},
    {"BulletinPointsMissing",
     "[\n{\"tfbh\": \"1\",\n\"points\": [\n{\"time\": \"2021-07-25T14:00:00\", "
     "\"lat\": 30, \"lng\": 1}]},\n{\"tfbh\": \"2\",\n\"name\": \"a\"}]",
     "x:5: [1].points: got none, expected at least one"},
    {"BulletinKeyTwice",
     "[{\"tfbh\": \"1\", \"points\": [],\n\"land\": [{\"points\": 1}],\n\"points\": []}]",
     "x:3: got the key 'points' twice in an object, expected it once"},
    {"BulletinTimeCut", R"([{"tfbh": "1", "points": [{"time": "2021-07-25T14:0"}]}])",
     "x:1: [0].points[0].time: got '2021-07-25T14:0', expected a time such as"},
    {"BulletinTimeCutLater", R"([{"tfbh": "1", "points": [{"time": "2021-07-25 14:00:0"}]}])",
     "x:1: [0].points[0].time: got '2021-07-25 14:00:0', expected a time such as"},
    {"BulletinShape", "[{\"tfbh\": \"1\",\n\"points\": [7]}]",
     "x:2: [0].points[0]: got 7, expected an object"},
    {"BulletinList", R"([{"tfbh": "1", "points": "none"}])",
     "x:1: [0].points: got 'none', expected a list"},
    {"JsonCut", "[{\"tfbh\": \"1\",\n\"points\": [{\"time\"", "x:2: invalid JSON: "},
    {"JsonNumber", "[{\"tfbh\": \"1\",\n\"points\": 1e999}]",
     "x:2: got '1e999', expected a number that a double can hold"},
    {"ServiceCode", R"({"code": "404", "track": []})", "x:1: code: got '404', expected '200'"},
    {"ServiceKeyMissing",
     "{\"code\": \"200\",\n\"track\": [\n{\"time\": \"2021-07-25T14:00+08:00\",\n\"lat\": "
     "\"30\"}]}",
     "x:3: track[0].lon: got nothing, expected a number in [-180, 360]"},
    {"ServiceEmpty", R"({"code": "200", "track": []})",
     "x:1: points: got none, expected at least one"},
};

class Refusals : public testing::TestWithParam<WrongText> {};

TEST_P(Refusals, SayWhereAndWhatWasExpected) {
  const std::string refusal = Refusal(GetParam().text);
  EXPECT_NE(refusal.find(GetParam().words), std::string::npos)
      << refusal << "\nexpected: " << GetParam().words;
  EXPECT_EQ(refusal.find('\n'), std::string::npos) << "one line";
}

INSTANTIATE_TEST_SUITE_P(All, Refusals, testing::ValuesIn(kWrongTexts),
                         [](const auto& test) { return test.param.name; });

TEST(Refusals, NameTheUnitsAndRowsOfIbtracs) {
  const std::string text = Sample("ibtracs.csv");
  EXPECT_EQ(Refusal(With(text, "kts", "m/s")), "x:2: WMO_WIND: got unit 'm/s', expected 'kts'");
  const std::string left_out = "; the point is left out\n";
  EXPECT_EQ(Warnings(With(text, "-9.30000", "-93")),
            "x:4: LAT: got '-93', expected a number in [-90, 90]" + left_out);
  EXPECT_EQ(
      Warnings(With(text, "2024-05-16 15:00:00", "2024-05-16 25:00:00")),
      "x:4: ISO_TIME: got '2024-05-16 25:00:00', expected UTC as YYYY-MM-DD HH:MM:SS" + left_out);
  EXPECT_EQ(
      Warnings(With(text, "2024-05-16 15:00:00", "2024-05-16 15:00:0")),
      "x:4: ISO_TIME: got '2024-05-16 15:00:0', expected UTC as YYYY-MM-DD HH:MM:SS" + left_out);
  EXPECT_EQ(Refusal(With(text, "IALY,", "")), "x:3: got 28 fields, expected the 29 of row 1");
}

TEST(Refusals, BoundTheDepthOfJson) {
  const auto nested = [](std::size_t depth) -> std::string {
    const std::string text = "[{\"tfbh\": \"]\\\"\",\n\"points\": " + std::string(depth, '[') +
                             std::string(depth, ']') + "}]";
    return Refusal(text);
  };
  EXPECT_EQ(nested(100'000),
            "x:2: got JSON nested more deeply than 64 levels, expected a bulletin or a chart");
  EXPECT_EQ(nested(62), "x:2: [0].points[0]: got a list, expected an object");
}

}  // namespace
}  // namespace aquafarm
