// SPDX-License-Identifier: BSD-3-Clause
// Reads CMA best tracks, CHyyyyBST.txt: one header per storm, then its points. Lines are split at
// blanks instead of at fixed columns, because one header in the file of 2018 is shifted. Source:
// tcdata.typhoon.org.cn/zjljsjj.html
#include <algorithm>
#include <array>

#include "base/text.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

constexpr std::int32_t kAveraging_min = 2;

// Parses a header "66666 BBBB CCC DDDD EEEE F G name date". CCC is the number of points. DDDD
// is a serial number that is unique in its file. EEEE is the number of the storm, or two numbers
// such as "7127,7128". BBBB, F and G are not read.
BestTrackHeader ReadHeader(std::string_view line, ParseContext& place) {
  const std::vector<std::string_view> words = SplitWords(line);
  constexpr std::size_t kBeforeName = 7;
  const auto is_date = [](std::string_view word) {
    return word.size() == 8 && word.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const bool blank_name = words.size() == kBeforeName + 1 && is_date(words.back());
  if (words.size() < kBeforeName + 2 && !blank_name) {
    place.Fail("got " + std::to_string(words.size()) +
               " words, expected a header: 66666, numbers, points, serial, number, end, hours, "
               "name, date");
  }
  BestTrackHeader header;
  header.points = ReadWhole(words[2], "number of points", 1, kMaxFixes, place);
  const std::string_view number = words[4];
  const std::int32_t serial = ReadWhole(words[3], "serial number", 0, 9999, place);
  header.track.id = number == "0000" ? "CMA" + std::to_string(serial) : std::string(number);
  header.track.agency = "CMA";
  const std::string_view date = words.back();
  if (!is_date(date)) {
    place.Fail("date: got " + Quoted(date) + " at the end, expected YYYYMMDD: was it cut off?");
  }
  for (std::size_t i = kBeforeName; i + 1 < words.size(); ++i) {
    header.track.name += (i > kBeforeName ? " " : "") + std::string(words[i]);
  }
  if (header.track.name == "(nameless)") header.track.name.clear();
  if (blank_name) {
    place.WarnOnce("name", "name: got nothing, expected a name or (nameless); the storm is " +
                               header.track.id + " and has no name");
  }
  return header;
}

// Parses a point "YYYYMMDDHH I LAT LONG PRES WND [OWD]".
StormFix ReadPoint(std::string_view line, ParseContext& place) {
  const std::vector<std::string_view> words = SplitWords(line);
  if (words.size() != 6 && words.size() != 7) {
    place.Fail("got " + std::to_string(words.size()) +
               " words, expected a point: time, grade, latitude, longitude, pressure, wind");
  }
  StormFix fix;
  fix.time = ReadHour(words[0], place);
  fix.position = {ReadLatitudeTenths(words[2], place), ReadLongitudeTenths(words[3], place)};
  constexpr std::int32_t kNoGrade = -1;
  std::int32_t grade = TryWhole(words[1], "grade", 0, 9, place).value_or(kNoGrade);
  if (grade == 7 || grade == 8) {
    place.WarnOnce("grade", "grade: got " + std::to_string(grade) +
                                ", expected one of 0 to 6 or 9" + kIgnored);
    grade = kNoGrade;
  }
  fix.pressure_hpa =
      CheckedPressure(TryWhole(words[4], "pressure", 0, 1100, place), "pressure", place);
  fix.averaging_min = kAveraging_min;
  const std::int32_t wind = TryWhole(words[5], "wind", 0, 150, place).value_or(0);
  constexpr std::int32_t kBelowTen = 9;
  if (wind == kBelowTen) fix.wind_below_mps = 10.0;
  if (wind > 0 && wind != kBelowTen) fix.wind_mps = wind;
  if (words.size() == 7) {
    const auto second = TryWhole(words[6], "second wind", 0, 150, place);
    if (second.value_or(0) > 0) fix.second_wind_mps = second;
  }
  constexpr std::int32_t kExtratropical = 9;
  fix.extratropical = grade == kExtratropical;
  if (grade != kNoGrade && !fix.extratropical) {
    fix.grade = static_cast<StormGrade>(grade);
  } else if (fix.wind_mps) {
    fix.grade = GradeOfWind(*fix.wind_mps);
  }
  return fix;
}

}  // namespace

namespace {

// Warns about points that may be cut off. Numbers are right-aligned in fixed columns, so a point
// that is shorter than others with as many fields has lost digits of its last number.
void WarnOfShortPoints(std::string_view text, ParseContext& place) {
  constexpr std::size_t kMaxWords = 7;
  const auto each = [&](auto&& act) {
    LineReader lines(text, place);
    std::string_view line;
    while (lines.Next(line)) {
      const std::size_t words = SplitWords(line).size();
      const std::string_view end = line.substr(0, line.find_last_not_of(" \t\r") + 1);
      if (words > 0 && words <= kMaxWords && Trim(line).substr(0, 5) != "66666") {
        act(words, end.size());
      }
    }
  };
  std::array<std::size_t, kMaxWords + 1> longest{};
  each([&](std::size_t words, std::size_t size) {
    longest[words] = std::max(longest[words], size);
  });
  each([&](std::size_t words, std::size_t size) {
    if (size == longest[words]) return;
    place.Warn("got a point of " + std::to_string(size) + " columns, but other points have " +
               std::to_string(longest[words]) + ": was the line cut off?");
  });
}

}  // namespace

std::vector<StormTrack> ReadCma(std::string_view text, ParseContext& place) {
  std::vector<StormTrack> tracks = ReadBestTracks(text, place, ReadHeader, ReadPoint);
  WarnOfShortPoints(text, place);
  return tracks;
}

}  // namespace aquafarm::internal
