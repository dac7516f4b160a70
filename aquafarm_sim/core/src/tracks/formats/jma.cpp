// SPDX-License-Identifier: BSD-3-Clause
// Reads best tracks of the JMA (RSMC Tokyo), which have fixed columns. Source: jma.go.jp,
// e_format_bst.html
#include <cmath>

#include "aquafarm/base/angle.h"
#include "base/text.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

constexpr std::int32_t kAveraging_min = 10;
constexpr std::int32_t kUnknownGrade = 7;  // "just entering the region": the wind decides
// Numbers of columns after which a line may end. Other lines are padded to 80 columns.
constexpr std::size_t kThroughHeader = 72;
constexpr std::size_t kThroughWind = 36;
constexpr std::size_t kThroughRadii = 62;
constexpr std::size_t kThroughMark = 72;

std::string_view Columns(std::string_view line, std::size_t first, std::size_t end) {
  if (first >= line.size()) return {};
  return line.substr(first, end - first);
}

// Returns the radii by quadrant of a wind area of the JMA. The area is a circle whose centre may
// differ from the storm's: the longest radius points to one side, the shortest to the other. The
// radius of a quadrant is the distance from the storm to the edge of this circle, in the direction
// of the quadrant's middle.
std::array<double, kQuadrantCount> Quadrants(std::int32_t direction, double longest,
                                             double shortest) {
  std::array<double, kQuadrantCount> radius{};
  constexpr std::int32_t kSymmetric = 9;
  const double towards = direction == kSymmetric ? 0.0 : direction * 45.0;  // 1 NE … 8 N
  const double middle = (longest + shortest) / 2.0;
  const double aside = (longest - shortest) / 2.0;
  for (std::size_t q = 0; q < radius.size(); ++q) {
    const double angle = (45.0 + 90.0 * static_cast<double>(q) - towards) * kRadiansPerDegree;
    const double across = aside * std::sin(angle);
    radius[q] = aside * std::cos(angle) + std::sqrt(middle * middle - across * across);
  }
  return radius;
}

// Reads a ring that begins at column `at`. Blank columns mean that the ring is not given; zeros
// mean that no such wind blows. A line that ends within the ring is truncated and causes an error.
void ReadRing(std::string_view line, std::size_t at, std::int32_t wind_kt, StormFix& fix,
              ParseContext& place) {
  const std::string_view direction = Columns(line, at, at + 1);
  const std::string_view longest = Columns(line, at + 1, at + 5);
  if (Trim(direction).empty() && Trim(longest).empty()) return;
  constexpr std::size_t kWidth = 10;
  if (line.size() < at + kWidth) {
    place.Fail("got a line of " + std::to_string(line.size()) + " columns, expected " +
               std::to_string(at + kWidth) + " or more where there are radii of " +
               std::to_string(wind_kt) + " kt");
  }
  const auto code = TryWhole(direction, "direction of the longest radius", 0, 9, place);
  const auto far = TryWhole(longest, "longest radius", 0, 2000, place);
  const auto near = TryWhole(Columns(line, at + 6, at + 10), "shortest radius", 0, 2000, place);
  if (!code || !far || !near) return;
  const std::string of_wind = " of " + std::to_string(wind_kt) + " kt; the radii are ignored";
  if (*code == 0 && *far > 0) {
    place.WarnOnce(
        "radii", "direction of the longest radius: got 0, expected 1 to 9 with a radius" + of_wind);
  } else if (*near > *far) {
    place.WarnOnce("radii", "shortest radius: got " + std::to_string(*near) +
                                ", expected at most the longest radius, " + std::to_string(*far) +
                                "," + of_wind);
  } else {
    AddRing(
        {wind_kt, Quadrants(*code, *far * kKmPerNauticalMile, *near * kKmPerNauticalMile), false},
        fix.rings);
  }
}

BestTrackHeader ReadHeader(std::string_view line, ParseContext& place) {
  if (line.size() < kThroughHeader) {
    place.Fail("got a header of " + std::to_string(line.size()) + " columns, expected " +
               std::to_string(kThroughHeader) + " or more, which contain the date");
  }
  BestTrackHeader header;
  header.points = ReadWhole(Columns(line, 12, 15), "number of points", 1, 999, place);
  const std::string_view number = Trim(Columns(line, 6, 10));
  ReadWhole(number, "number", 0, 9999, place);
  const std::string_view again = Trim(Columns(line, 21, 25));
  if (!again.empty() && again != number) {
    place.WarnOnce("number", "number: got " + Quoted(number) + " and " + Quoted(again) +
                                 ", expected the same twice; " + Quoted(number) + " is used");
  }
  header.track.id = number;
  header.track.name = Trim(Columns(line, 30, 50));
  header.track.agency = "JMA";
  return header;
}

StormGrade Grade(std::int32_t code, const std::optional<double>& wind_mps) {
  switch (code) {
    case 2:
      return StormGrade::kTropicalDepression;
    case 3:
      return StormGrade::kTropicalStorm;
    case 4:
      return StormGrade::kSevereTropicalStorm;
    default:  // TY of the JMA includes STY and SuperTY; 6, 7 and 9 give no grade
      if (wind_mps) return GradeOfWind(*wind_mps);
      return code == 5 ? StormGrade::kTyphoon : StormGrade::kUnknown;
  }
}

StormFix ReadPoint(std::string_view line, ParseContext& place) {
  if (Columns(line, 9, 12) != "002") {
    place.Fail("got " + Quoted(line) + ", expected a point: yymmddhh 002 …");
  }
  if (line.size() < kThroughWind) {
    place.Fail("got a line of " + std::to_string(line.size()) + " columns, expected at least " +
               std::to_string(kThroughWind) + ", which contain the wind");
  }
  const std::string_view hour = Columns(line, 0, 8);
  StormFix fix;
  // The years have two digits. The file starts in 1951, so smaller numbers mean years from 2000 on.
  fix.time = ReadHour((hour < "51" ? "20" : "19") + std::string(hour), place);
  std::int32_t code = TryWhole(Columns(line, 13, 14), "grade", 2, 9, place).value_or(kUnknownGrade);
  if (code == 8) {
    place.WarnOnce("grade", std::string("grade: got 8, expected one of 2 to 7 or 9") + kIgnored);
    code = kUnknownGrade;
  }
  fix.position = {ReadLatitudeTenths(Columns(line, 15, 18), place),
                  ReadLongitudeTenths(Columns(line, 19, 23), place)};
  fix.pressure_hpa = CheckedPressure(TryWhole(Columns(line, 24, 28), "pressure", 0, 1100, place),
                                     "pressure", place);
  const std::int32_t wind_kt = TryWhole(Columns(line, 33, 36), "wind", 0, 250, place).value_or(0);
  if (wind_kt > 0) fix.wind_mps = wind_kt * kMpsPerKnot;
  fix.averaging_min = kAveraging_min;
  fix.extratropical = code == 6;
  fix.grade = Grade(code, fix.wind_mps);
  ReadRing(line, 41, 50, fix, place);
  constexpr std::size_t kWeaker = 52;
  if (!fix.rings.empty() && Trim(Columns(line, kWeaker, kWeaker + 1)).empty()) {
    place.Fail("got radii of 50 kt alone, expected those of 30 kt as well");
  }
  ReadRing(line, kWeaker, 30, fix, place);
  // Since 1977 a point with the grade of a storm has the columns of the radii, even if they are
  // blank.
  constexpr std::int64_t k1977 = 220924800;
  const bool is_storm = code >= 3 && code <= 5;
  if (is_storm && fix.time >= k1977 && line.size() < kThroughRadii) {
    place.Fail("got a line of " + std::to_string(line.size()) + " columns, expected at least " +
               std::to_string(kThroughRadii) + ", which contain the radii of a storm");
  }
  fix.landfall = Columns(line, 71, 72) == "#";
  return fix;
}

// Warns about points that may be cut off. Points after a padded header are padded, too. If a header
// has no columns after its date, its points end after the wind, the radii or the landfall mark.
void WarnOfShortPoints(std::string_view text, ParseContext& place) {
  LineReader lines(text, place);
  std::string_view line;
  std::size_t header = 0;
  while (lines.Next(line)) {
    if (line.substr(0, 5) == "66666") header = line.size();
    const bool filled = header > kThroughHeader;
    const bool ends = line.size() == kThroughWind || line.size() == kThroughRadii;
    if (Trim(line).empty() || line.size() >= kThroughMark || (ends && !filled)) continue;
    place.Warn("got a point of " + std::to_string(line.size()) + " columns under a header of " +
               std::to_string(header) + ": was the line cut off?");
  }
}

}  // namespace

std::vector<StormTrack> ReadJma(std::string_view text, ParseContext& place) {
  std::vector<StormTrack> tracks = ReadBestTracks(text, place, ReadHeader, ReadPoint);
  WarnOfShortPoints(text, place);
  return tracks;
}

}  // namespace aquafarm::internal
