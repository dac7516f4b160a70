// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/archive.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "base/time.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm {
namespace {

using internal::Format;
using internal::ParseContext;

constexpr const char* kFirstLine = "aquafarm-storms 1";
constexpr std::int32_t kMaxAveraging_min = 60;
constexpr double kMaxRadius_km = 3000.0;

double Rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

std::optional<double> Rounded(const std::optional<double>& value) {
  if (!value) return value;
  return Rounded(*value, 10.0);
}

// Returns a time as YYYYMMDDHHMM.
std::string TimeText(std::int64_t time) {
  std::string text = internal::FormatTime(time).substr(0, 16);
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](char c) { return c == '-' || c == 'T' || c == ':'; }),
             text.end());
  return text;
}

std::string NumberText(const std::optional<double>& value) { return value ? Format(*value) : "-"; }

std::string FixText(const StormFix& fix) {
  std::string text =
      TimeText(fix.time) + " " + Format(fix.position.latitude) + " " +
      Format(fix.position.longitude) + " " + std::string(ToString(fix.grade)) + " " +
      (fix.wind_below_mps ? "<" + Format(*fix.wind_below_mps) : NumberText(fix.wind_mps)) + " " +
      NumberText(fix.pressure_hpa);
  for (const WindRing& ring : fix.rings) {
    text += " " + std::to_string(ring.wind_kt) + "=";
    for (std::size_t q = 0; q < ring.radius_km.size(); ++q) {
      text += (q == 0 ? "" : ",") + Format(ring.radius_km[q]);
    }
  }
  return text + "\n";
}

std::optional<double> ReadOptional(std::string_view word, const char* name, double min, double max,
                                   const ParseContext& place) {
  if (word == "-") return std::nullopt;
  return internal::ReadNumber(word, name, min, max, place);
}

StormGrade ReadGrade(std::string_view word, const ParseContext& place) {
  std::vector<std::string> names;
  for (int i = 0; i < kStormGradeCount; ++i) {
    const auto grade = static_cast<StormGrade>(i);
    if (word == ToString(grade)) return grade;
    names.emplace_back(ToString(grade));
  }
  place.Fail("grade: got " + internal::Quoted(word) + ", expected one of " + internal::List(names));
}

// Parses a ring such as "34=300,200,200,250".
WindRing ReadRing(std::string_view word, const ParseContext& place) {
  WindRing ring;
  const std::size_t equals = word.find('=');
  std::vector<std::string_view> radii;
  if (equals != std::string_view::npos) internal::SplitFields(word.substr(equals + 1), radii);
  if (radii.size() != ring.radius_km.size()) {
    place.Fail("ring: got " + internal::Quoted(word) + ", expected WIND=NE,SE,SW,NW");
  }
  ring.wind_kt = internal::ReadWhole(word.substr(0, equals), "wind of a ring", 1, 200, place);
  for (std::size_t q = 0; q < radii.size(); ++q) {
    ring.radius_km[q] = internal::ReadNumber(radii[q], "radius", 0.0, kMaxRadius_km, place);
  }
  return ring;
}

StormFix ReadFix(const std::vector<std::string_view>& words, ParseContext& place) {
  constexpr std::size_t kBeforeRings = 6;
  if (words.size() < kBeforeRings) {
    place.Fail("got " + std::to_string(words.size()) +
               " words, expected a fix: time, latitude, longitude, grade, wind, pressure");
  }
  StormFix fix;
  const std::string when(words[0]);
  const std::optional<std::int64_t> time =
      when.size() == 12 ? internal::ParseDateTime(when.substr(0, 4) + "-" + when.substr(4, 2) +
                                                      "-" + when.substr(6, 2) + "T" +
                                                      when.substr(8, 2) + ":" + when.substr(10, 2),
                                                  0)
                        : std::nullopt;
  if (!time) place.Fail("time: got " + internal::Quoted(when) + ", expected YYYYMMDDHHMM");
  fix.time = *time;
  fix.position = {internal::ReadNumber(words[1], "latitude", -90.0, 90.0, place),
                  internal::ReadNumber(words[2], "longitude", -180.0, 180.0, place)};
  fix.grade = ReadGrade(words[3], place);
  const bool below = words[4].substr(0, 1) == "<";
  const auto wind = ReadOptional(words[4].substr(below ? 1 : 0), "wind", 0.0, 150.0, place);
  (below ? fix.wind_below_mps : fix.wind_mps) = wind;
  fix.pressure_hpa = ReadOptional(words[5], "pressure", internal::kMinPressure_hpa, 1100.0, place);
  for (std::size_t i = kBeforeRings; i < words.size(); ++i) {
    AddRing(ReadRing(words[i], place), fix.rings);
  }
  return fix;
}

// Parses a line "storm ID AVERAGING_MIN AGENCY | NAME".
StormTrack ReadHeader(std::string_view line, std::int32_t& averaging_min, ParseContext& place) {
  const std::size_t bar = line.find('|');
  const std::vector<std::string_view> words = internal::SplitWords(line.substr(0, bar));
  if (bar == std::string_view::npos || words.size() < 4) {
    place.Fail("got " + internal::Quoted(line) +
               ", expected: storm ID AVERAGING_MIN AGENCY | NAME");
  }
  StormTrack track;
  track.id = words[1];
  averaging_min = internal::ReadWhole(words[2], "averaging period", 0, kMaxAveraging_min, place);
  for (std::size_t i = 3; i < words.size(); ++i) {
    track.agency += (i > 3 ? " " : "") + std::string(words[i]);
  }
  track.name = internal::Trim(line.substr(bar + 1));
  track.line = place.line;
  return track;
}

// Replaces characters that end a line, because the heading of a storm is one line.
std::string WithoutLineEnds(std::string text) {
  const auto ends_line = [](char c) { return c == '\n' || c == '\r'; };
  std::replace_if(text.begin(), text.end(), ends_line, ' ');
  return text;
}

// Replaces blanks, because they separate the words of a heading.
std::string OneWord(std::string text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  std::replace_if(text.begin(), text.end(), is_blank, '_');
  return text;
}

}  // namespace

StormTrack Archived(const StormTrack& track) {
  StormTrack archived;
  archived.id = OneWord(track.id);
  archived.name = WithoutLineEnds(track.name);
  archived.agency = track.agency.empty() ? "unknown" : WithoutLineEnds(track.agency);
  for (const StormFix& from : track.fixes) {
    StormFix fix;
    fix.time = from.time - ((from.time % 60) + 60) % 60;
    fix.position = {Rounded(from.position.latitude, 1000.0),
                    Rounded(from.position.longitude, 1000.0)};
    fix.grade = from.grade;
    fix.wind_mps = Rounded(from.wind_mps);
    fix.wind_below_mps = Rounded(from.wind_below_mps);
    if (fix.wind_below_mps) fix.wind_mps.reset();
    fix.averaging_min = track.fixes.front().averaging_min;
    fix.pressure_hpa = Rounded(from.pressure_hpa);
    for (WindRing ring : from.rings) {
      if (ring.estimated) continue;
      for (double& radius : ring.radius_km) radius = Rounded(radius, 10.0);
      fix.rings.push_back(ring);
    }
    archived.fixes.push_back(std::move(fix));
  }
  return archived;
}

std::string WriteArchive(const std::vector<StormTrack>& tracks,
                         const std::vector<std::string>& comment) {
  std::string text = std::string(kFirstLine) + "\n";
  for (const std::string& line : comment) text += "# " + line + "\n";
  for (const StormTrack& track : tracks) {
    const StormTrack archived = Archived(track);
    const std::int32_t averaging_min =
        archived.fixes.empty() ? 0 : archived.fixes.front().averaging_min;
    text += "storm " + archived.id + " " + std::to_string(averaging_min) + " " + archived.agency +
            " |" + (archived.name.empty() ? "" : " ") + archived.name + "\n";
    for (const StormFix& fix : archived.fixes) text += FixText(fix);
  }
  return text;
}

namespace internal {

std::vector<StormTrack> ReadArchive(std::string_view text, ParseContext& place) {
  std::vector<StormTrack> tracks;
  LineReader lines(text, place);
  std::string_view line;
  LeftOut left_out;
  std::int32_t averaging_min = 0;
  const auto finish = [&] {
    if (!tracks.empty()) FinishTrack(tracks.back(), left_out, place);
    left_out = {};
  };
  while (lines.Next(line)) {
    line = Trim(line);
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string_view> words = SplitWords(line);
    if (words[0] == "aquafarm-storms") {
      if (line != kFirstLine) {
        place.Fail("got " + Quoted(line) + ", expected " + kFirstLine +
                   "; this version reads no other");
      }
      continue;
    }
    if (words[0] == "storm") {
      finish();
      tracks.push_back(ReadHeader(line, averaging_min, place));
      continue;
    }
    if (tracks.empty()) place.Fail("got " + Quoted(words[0]) + ", expected a line: storm …");
    StormFix fix = ReadFix(words, place);
    fix.averaging_min = averaging_min;
    AppendFix(std::move(fix), tracks.back().fixes, place);
  }
  finish();
  if (tracks.empty()) place.Fail("got no storm, expected at least one");
  return tracks;
}

}  // namespace internal
}  // namespace aquafarm
