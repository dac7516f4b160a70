// SPDX-License-Identifier: BSD-3-Clause
#include "tracks/track_text.h"

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "base/time.h"
#include "grid/longitude.h"

namespace aquafarm::internal {
namespace {

// The directions in bulletins. A Chinese name of three characters contains one direction twice. It
// stands for the bearing midway between this direction and the diagonal of its two directions:
// 北西北 and 北北西 both mean NNW, between N and NW. The recorded motion of storms agrees with this
// reading.
constexpr std::pair<std::string_view, double> kDirections[]{
    {"N", 0.0},          {"NNE", 22.5},       {"NE", 45.0},        {"ENE", 67.5},
    {"E", 90.0},         {"ESE", 112.5},      {"SE", 135.0},       {"SSE", 157.5},
    {"S", 180.0},        {"SSW", 202.5},      {"SW", 225.0},       {"WSW", 247.5},
    {"W", 270.0},        {"WNW", 292.5},      {"NW", 315.0},       {"NNW", 337.5},
    {"北", 0.0},         {"偏北", 0.0},       {"北东北", 22.5},    {"北北东", 22.5},
    {"东北北", 22.5},    {"东北偏北", 22.5},  {"北东", 45.0},      {"东北", 45.0},
    {"东东北", 67.5},    {"东北东", 67.5},    {"东北偏东", 67.5},  {"东", 90.0},
    {"偏东", 90.0},      {"东东南", 112.5},   {"东南东", 112.5},   {"东南", 135.0},
    {"南东", 135.0},     {"南东南", 157.5},   {"南南东", 157.5},   {"南", 180.0},
    {"偏南", 180.0},     {"南西南", 202.5},   {"南南西", 202.5},   {"西南", 225.0},
    {"南西", 225.0},     {"西西南", 247.5},   {"西南西", 247.5},   {"西", 270.0},
    {"偏西", 270.0},     {"西西北", 292.5},   {"西北西", 292.5},   {"西北偏西", 292.5},
    {"西北", 315.0},     {"北西", 315.0},     {"北西北", 337.5},   {"北北西", 337.5},
    {"西北北", 337.5},   {"西北偏北", 337.5}, {"东南偏东", 112.5}, {"东南偏南", 157.5},
    {"西南偏南", 202.5}, {"西南偏西", 247.5},
};

}  // namespace

double ReadLatitudeTenths(std::string_view text, const ParseContext& place) {
  return ReadFixNumber(text, "latitude in tenths of a degree", -900, 900, place) / 10.0;
}

double ReadLongitudeTenths(std::string_view text, const ParseContext& place) {
  return NormalLongitude(
      ReadFixNumber(text, "longitude in tenths of a degree", -1800, 3600, place) / 10.0);
}

void AppendFix(StormFix fix, std::vector<StormFix>& fixes, ParseContext& place) {
  fix.line = place.line;
  if (fixes.size() >= kMaxFixes) {
    place.Fail("got more than " + std::to_string(kMaxFixes) + " points of one storm");
  }
  if (!fixes.empty() && fix.time == fixes.back().time) {
    place.WarnOnce("twice",
                   "time: " + FormatTime(fix.time) + " occurs twice; the second is dropped");
    return;
  }
  fixes.push_back(std::move(fix));
}

std::optional<double> CheckedPressure(std::optional<double> pressure_hpa,
                                      const std::string& value_path, ParseContext& place) {
  if (!pressure_hpa || *pressure_hpa <= 0.0) return std::nullopt;
  if (*pressure_hpa >= kMinPressure_hpa) return pressure_hpa;
  const std::string what = "got " + Format(*pressure_hpa) +
                           " hPa, expected [800, 1100], or 0 where it is not known" + kIgnored;
  if (place.locate) {
    place.WarnValueOnce("pressure", value_path, what);
  } else {
    place.WarnOnce("pressure", value_path + ": " + what);
  }
  return std::nullopt;
}

std::vector<StormTrack> ReadBestTracks(std::string_view text, ParseContext& place,
                                       BestTrackHeader (*read_header)(std::string_view line,
                                                                      ParseContext& place),
                                       StormFix (*read_point)(std::string_view line,
                                                              ParseContext& place)) {
  std::vector<StormTrack> tracks;
  LineReader lines(text, place);
  std::string_view line;
  const auto is_header = [](std::string_view of) { return Trim(of).substr(0, 5) == "66666"; };
  while (lines.Next(line)) {
    if (Trim(line).empty()) continue;
    if (!is_header(line)) {
      place.Fail("got " + Quoted(SplitWords(line)[0]) +
                 ", expected a header, 66666 …, because the storm before has all its points");
    }
    BestTrackHeader header = read_header(line, place);
    header.track.line = place.line;
    const std::string promised = std::to_string(header.points) + " points of the header on line " +
                                 std::to_string(place.line);
    LeftOut left_out;
    for (std::int32_t i = 0; i < header.points; ++i) {
      if (!lines.Next(line) || is_header(line) || Trim(line).empty()) {
        place.Fail("got " + std::to_string(i) + " points, expected the " + promised);
      }
      TryFix([&] { AppendFix(read_point(line, place), header.track.fixes, place); }, left_out,
             place);
    }
    FinishTrack(header.track, left_out, place);
    tracks.push_back(std::move(header.track));
  }
  return tracks;
}

std::optional<double> ParseDirection(std::string_view text) {
  text = Trim(text);
  const std::size_t blank = text.find(' ');  // "ENE 2"
  const std::string word = Upper(text.substr(0, blank));
  for (const auto& [name, bearing_deg] : kDirections) {
    if (name == word) return bearing_deg;
  }
  return std::nullopt;
}

}  // namespace aquafarm::internal
