// SPDX-License-Identifier: BSD-3-Clause
// Reads ATCF b-decks: comma-separated rows padded with blanks. A fix has one to three rows, one for
// each wind whose radii are given. Trailing fields of a row may be missing. Source:
// science.nrlmry.navy.mil, abrdeck.html
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/text.h"
#include "grid/longitude.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

constexpr std::int32_t kAveraging_min = 1;
enum Field : std::size_t {
  kBasin,
  kCyclone,
  kTime,
  kMinute,
  kTechnique,
  kHours,
  kLatitude,
  kLongitude,
  kWind,
  kPressure,
  kType,
  kRadiusWind,
  kRadiusCode,
  kRadius1,
  kRadius4 = kRadius1 + 3,
  kMaxWindRadius = 19,
  kDirection = 25,
  kSpeed,
  kName,
};

using Fields = std::vector<std::string_view>;

std::string_view At(const Fields& fields, Field field) {
  return field < fields.size() ? fields[field] : std::string_view();
}

// Parses an angle such as "123N" or "1423E", in tenths of a degree, and returns degrees.
double ReadAngle(std::string_view text, char positive, char negative, std::int32_t max,
                 const char* name, const ParseContext& place) {
  const char side = text.empty() ? ' ' : text.back();
  if (side != positive && side != negative) {
    place.RefuseFix(std::string(name) + ": got " + Quoted(text) +
                    ", expected tenths of a degree and " + positive + " or " + negative);
  }
  const double tenths = ReadFixNumber(text.substr(0, text.size() - 1), name, 0, max, place);
  return (side == positive ? tenths : -tenths) / 10.0;
}

// Returns the radii by quadrant for a radius code; nullopt if the code is unknown. AAA is a circle.
// Codes such as NEQ name the first quadrant, and the other quadrants follow clockwise. Codes such
// as NES name a semicircle; the second radius applies to the other half. The radii are first
// assigned to eighths of the circle. A quadrant then gets the root mean square of its two eighths,
// which preserves the area.
std::optional<std::array<double, kQuadrantCount>> Quadrants(std::string_view code,
                                                            const std::array<double, 4>& radius) {
  constexpr std::array<std::string_view, 8> kTowards{"NN", "NE", "EE", "SE",
                                                     "SS", "SW", "WW", "NW"};
  std::array<double, kQuadrantCount> quadrants{};
  if (code == "AAA") {
    quadrants.fill(radius[0]);
    return quadrants;
  }
  const char kind = code.size() == 3 ? code[2] : ' ';
  const auto towards = std::find(kTowards.begin(), kTowards.end(), code.substr(0, 2));
  const bool quadrant = kind == 'Q';
  if (towards == kTowards.end() || (!quadrant && kind != 'S')) {
    return std::nullopt;
  }
  std::array<double, 8> eighths{};  // clockwise from the one between north and north-east
  const std::size_t width = quadrant ? 2 : 4;
  const auto middle = static_cast<std::size_t>(towards - kTowards.begin());
  for (std::size_t i = 0; i < eighths.size(); ++i) {
    eighths[(middle + 8 - width / 2 + i) % 8] = radius[i / width];
  }
  for (std::size_t q = 0; q < quadrants.size(); ++q) {
    quadrants[q] = std::sqrt(
        (eighths[2 * q] * eighths[2 * q] + eighths[2 * q + 1] * eighths[2 * q + 1]) / 2.0);
  }
  return quadrants;
}

void ReadRing(const Fields& fields, StormFix& fix, ParseContext& place) {
  const std::int32_t wind_kt =
      TryWhole(At(fields, kRadiusWind), "wind of the radii", 0, 100, place).value_or(0);
  const std::string_view code = At(fields, kRadiusCode);
  if (wind_kt == 0 || code.empty()) return;
  const std::size_t given = code == "AAA" ? 1 : code.back() == 'S' ? 2 : 4;
  std::array<double, 4> radius{};
  for (std::size_t i = 0; i < given; ++i) {
    const std::string_view field = At(fields, static_cast<Field>(kRadius1 + i));
    if (field.empty()) ReadWhole(field, "radius", 0, 1500, place);  // rejects a truncated row
    const auto value = TryWhole(field, "radius", 0, 1500, place);
    if (!value) return;
    radius[i] = kKmPerNauticalMile * *value;
  }
  const auto quadrants = Quadrants(code, radius);
  if (!quadrants) {
    place.WarnOnce("radius code",
                   "radius code: got " + Quoted(code) +
                       ", expected AAA, a quadrant such as NEQ or a semicircle such as NES; "
                       "the radii are ignored");
    return;
  }
  if (AddRing({wind_kt, *quadrants, false}, fix.rings)) return;
  place.Warn("the radii of " + std::to_string(wind_kt) + " kt occur twice; the second ones are " +
             "left out");
}

StormFix ReadFix(const Fields& fields, ParseContext& place) {
  StormFix fix;
  fix.time = ReadHour(At(fields, kTime), place);
  const std::string_view minute = At(fields, kMinute);
  if (!minute.empty()) fix.time += 60 * ReadFixNumber(minute, "minutes", 0, 59, place);
  fix.position.latitude = ReadAngle(At(fields, kLatitude), 'N', 'S', 900, "latitude", place);
  fix.position.longitude =
      NormalLongitude(ReadAngle(At(fields, kLongitude), 'E', 'W', 1800, "longitude", place));
  const auto above_zero = [&](Field field, const char* name, std::int32_t max) {
    const std::int32_t value = TryWhole(At(fields, field), name, -999, max, place).value_or(0);
    return value > 0 ? std::optional<double>(value) : std::nullopt;
  };
  if (const auto wind_kt = above_zero(kWind, "wind", 250)) fix.wind_mps = *wind_kt * kMpsPerKnot;
  fix.averaging_min = kAveraging_min;
  fix.pressure_hpa = CheckedPressure(above_zero(kPressure, "pressure", 1100), "pressure", place);
  if (const auto radius = above_zero(kMaxWindRadius, "radius of the greatest wind", 999)) {
    fix.max_wind_radius_km = *radius * kKmPerNauticalMile;
  }
  const std::string_view type = At(fields, kType);
  fix.extratropical = type == "EX" || type == "ET" || type == "PT";
  if (fix.wind_mps) fix.grade = GradeOfWind(*fix.wind_mps);
  // Best tracks set direction and speed to 0; the motion is then computed.
  if (const auto speed_kt = above_zero(kSpeed, "speed", 200)) {
    const auto direction = TryWhole(At(fields, kDirection), "direction", 0, 360, place);
    if (direction) {
      fix.speed_kmh = *speed_kt * kKmPerNauticalMile;
      fix.heading_deg = *direction % 360;
    }
  }
  return fix;
}

// Returns whether a row belongs to the fix of the previous row. The rows of one fix differ only in
// their radii.
bool IsSame(const StormFix& fix, const StormFix& known) {
  return fix.time == known.time && fix.position.latitude == known.position.latitude &&
         fix.position.longitude == known.position.longitude && fix.wind_mps == known.wind_mps &&
         fix.pressure_hpa == known.pressure_hpa;
}

// Number of fields of a row that ends with the comma after the last radius, and of one that ends
// with the comma after the radius of the max wind.
constexpr std::size_t kThroughRadii = kRadius4 + 2;
constexpr std::size_t kThroughMaxWind = kMaxWindRadius + 2;

// Line and number of fields of a row that may be too short.
using NarrowRow = std::pair<std::int32_t, std::size_t>;

// Detects truncated rows. If other rows of the deck are longer, a row that ends before the last
// radius causes an error, and a row that ends before the radius of the max wind causes a warning.
// @param widest number of fields of the longest row of the deck
void CheckNarrowRows(const std::vector<NarrowRow>& narrow, std::size_t widest,
                     ParseContext& place) {
  for (const auto& [number, size] : narrow) {
    place.line = number;
    if (size < kThroughRadii && widest >= kThroughRadii) {
      place.Fail("got " + std::to_string(size) + " fields, expected at least " +
                 std::to_string(kThroughRadii) +
                 ", up to the comma after the radii, as in other rows");
    }
    if (widest < kThroughMaxWind) continue;
    place.Warn("got " + std::to_string(size) + " fields, but other rows have up to " +
               std::to_string(widest) + ": was the row cut off?");
  }
}

}  // namespace

std::vector<StormTrack> ReadAtcf(std::string_view text, ParseContext& place) {
  std::vector<StormTrack> tracks;
  LineReader lines(text, place);
  Fields fields;
  std::string_view line;
  std::string current;
  std::size_t widest = 0;
  std::vector<NarrowRow> narrow;
  LeftOut left_out;
  while (lines.Next(line)) {
    if (Trim(line).empty()) continue;
    SplitFields(line, fields);
    widest = std::max(widest, fields.size());
    // Some valid rows end with the comma after the radii.
    const bool ends_in_radii = fields.size() == kThroughRadii && fields.back().empty();
    if (fields.size() < kThroughMaxWind && !ends_in_radii) {
      narrow.emplace_back(place.line, fields.size());
    }
    if (fields.size() <= kType) {
      place.Fail("got " + std::to_string(fields.size()) + " fields, expected at least " +
                 std::to_string(kType + 1) + " of an ATCF row, from basin to type");
    }
    if (fields[kTechnique] != "BEST") {
      place.Fail("technique: got " + Quoted(fields[kTechnique]) + ", expected BEST: a b-deck");
    }
    ReadWholeOrBlank(fields[kHours], "TAU of a best track", 0, 0, place);
    const std::string storm = std::string(fields[kBasin]) + std::string(fields[kCyclone]);
    if (storm != current) {
      current = storm;
      if (!tracks.empty()) FinishTrack(tracks.back(), left_out, place);
      left_out = {};
      StormTrack track;
      track.id = storm + std::string(fields[kTime].substr(0, 4));
      track.agency = "ATCF";
      track.line = place.line;
      tracks.push_back(std::move(track));
    }
    StormTrack& track = tracks.back();
    if (!At(fields, kName).empty()) track.name = At(fields, kName);
    const auto read = [&] {
      StormFix fix = ReadFix(fields, place);
      if (track.fixes.empty() || !IsSame(fix, track.fixes.back())) {
        AppendFix(std::move(fix), track.fixes, place);
      }
      ReadRing(fields, track.fixes.back(), place);
    };
    TryFix(read, left_out, place);
  }
  if (!tracks.empty()) FinishTrack(tracks.back(), left_out, place);
  CheckNarrowRows(narrow, widest, place);
  return tracks;
}

}  // namespace aquafarm::internal
