// SPDX-License-Identifier: BSD-3-Clause
#include "input/parse_context.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "aquafarm/base/check.h"
#include "scenario/domains.h"

namespace aquafarm::internal {
namespace {

constexpr std::size_t kMostWarnings = 100;  // of a file made to fill memory

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

[[noreturn]] void RefuseNumber(std::string_view text, const char* name, const char* kind,
                               const std::string& min, const std::string& max,
                               const HazardPlace& place) {
  place.Refuse(std::string(name) + ": got " + Quoted(text) + ", expected a " + kind + " in [" +
               min + ", " + max + "]");
}

template <typename T>
bool ParseAll(std::string_view text, T& value) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

// Takes up to `most` digits off a text; none when there are less than `least`.
std::optional<int> TakeDigits(std::string_view& text, std::size_t most, std::size_t least = 1) {
  std::size_t count = 0;
  int value = 0;
  while (count < most && count < text.size() && text[count] >= '0' && text[count] <= '9') {
    value = value * 10 + (text[count++] - '0');
  }
  text.remove_prefix(count);
  if (count < least) return std::nullopt;
  return value;
}

bool Take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

// Seconds of a zone as "Z", "+08:00", "+0800"; `otherwise` where there is none.
std::optional<std::int64_t> TakeZone(std::string_view text, std::int64_t otherwise) {
  if (text.empty()) return otherwise;
  if (text == "Z") return 0;
  const bool west = text[0] == '-';
  if (!Take(text, "+-")) return std::nullopt;
  const std::optional<int> hours = TakeDigits(text, 2);
  Take(text, ":");
  const std::optional<int> minutes = TakeDigits(text, 2, 2);
  if (!hours || !minutes || *hours > 14 || *minutes > 59 || !text.empty()) return std::nullopt;
  const std::int64_t zone_s = *hours * 3600 + *minutes * 60;
  return west ? -zone_s : zone_s;
}

// The directions that bulletins use. Of three characters the first two or the last two name the
// half that the third leans to (北西北 as 北北西); what was measured between fixes agrees.
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

std::string HazardPlace::At(const std::string& what) const {
  const std::int32_t where = line == 0 && locate ? locate(path) : line;
  return file_ + ":" + std::to_string(where) + ": " + Join(path, what);
}
void HazardPlace::Refuse(const std::string& what) const { throw InputError(At(what)); }
std::string HazardPlace::AtValue(const std::string& value_path, const std::string& what) const {
  const std::int32_t where = locate ? locate(value_path) : line;
  return file_ + ":" + std::to_string(where) + ": " +
         (value_path.empty() ? what : value_path + ": " + what);
}
void HazardPlace::RefuseValue(const std::string& value_path, const std::string& what) const {
  throw InputError(AtValue(value_path, what));
}
void HazardPlace::Warn(const std::string& what) {
  if (warnings_.size() < kMostWarnings) warnings_.push_back(At(what));
}
void HazardPlace::WarnValue(const std::string& value_path, const std::string& what) {
  if (warnings_.size() < kMostWarnings) warnings_.push_back(AtValue(value_path, what));
}

bool LineReader::Next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++place_.line;
  return true;
}

void NeedRegularFile(const std::string& path) {
  std::error_code error;  // that it is not there is said by who reads it
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (error || std::filesystem::is_regular_file(status)) return;
  throw InputError(path + ": cannot read: is no regular file");
}

std::string ReadTextFile(const std::string& path) {
  constexpr std::streamoff kMostBytes = std::streamoff{512} << 20U;
  NeedRegularFile(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size > kMostBytes) {
    throw InputError(path + ": got " + std::to_string(size) + " bytes, expected at most " +
                     std::to_string(kMostBytes));
  }
  std::string text(static_cast<std::size_t>(std::max<std::streamoff>(size, 0)), '\0');
  file.seekg(0);
  if (size < 0 || !file.read(text.data(), static_cast<std::streamsize>(text.size()))) {
    throw InputError(path +
                     ": cannot read: " + (errno != 0 ? std::strerror(errno) : "ended early"));
  }
  return text;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> SplitWords(std::string_view text) {
  std::vector<std::string_view> words;
  for (;;) {
    text = Trim(text);
    if (text.empty()) return words;
    const std::size_t end =
        static_cast<std::size_t>(std::find_if(text.begin(), text.end(), IsBlank) - text.begin());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

void SplitFields(std::string_view text, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t end = text.find(',');
    fields.push_back(Trim(text.substr(0, end)));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string quoted = "'";
  for (const char c : text.substr(0, kMost)) {
    quoted += static_cast<unsigned char>(c) < 0x20U ? '?' : c;
  }
  return quoted + (text.size() > kMost ? "…'" : "'");
}

std::string_view WithoutMark(std::string_view text) {
  return text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
}

std::string Upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return upper;
}

std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const HazardPlace& place) {
  text = Trim(text);
  std::int32_t value = 0;
  if (ParseAll(text, value) && value >= min && value <= max) return value;
  RefuseNumber(text, name, "whole number", Format(min), Format(max), place);
}

std::optional<double> ParseNumber(std::string_view text) {
  double value = 0.0;
  if (!ParseAll(Trim(text), value)) return std::nullopt;
  return value;
}

double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const HazardPlace& place) {
  const std::optional<double> value = ParseNumber(text);
  if (value && *value >= min && *value <= max) return *value;  // false for nan
  RefuseNumber(text, name, "number", Format(min), Format(max), place);
}

std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const HazardPlace& place) {
  if (Trim(text).empty()) return std::nullopt;
  return ReadWhole(text, name, min, max, place);
}

std::int64_t ReadHour(std::string_view text, const HazardPlace& place) {
  const std::string_view whole = text;
  if (text.size() == 10 && text.find_first_not_of("0123456789") == std::string_view::npos) {
    const int year = *TakeDigits(text, 4);
    const int month = *TakeDigits(text, 2);
    const int day = *TakeDigits(text, 2);
    const std::optional<std::int64_t> time =
        UtcSeconds(year, month, day, *TakeDigits(text, 2), 0, 0);
    if (time) return *time;
  }
  place.Refuse("time: got " + Quoted(whole) + ", expected an hour of UTC as YYYYMMDDHH");
}

std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s) {
  text = Trim(text);
  std::array<int, 6> part{};
  constexpr std::array<std::string_view, 5> kAfter{"-/", "-/", "T ", ":", ":"};
  for (std::size_t i = 0; i < part.size(); ++i) {
    const std::optional<int> digits = TakeDigits(text, i == 0 ? 4 : 2, i < 4 ? 1 : 2);
    if (!digits) return std::nullopt;
    part[i] = *digits;
    if (i < kAfter.size() && !Take(text, kAfter[i])) {
      if (i < 4) return std::nullopt;
      break;  // no seconds
    }
  }
  const std::optional<std::int64_t> local =
      UtcSeconds(part[0], part[1], part[2], part[3], part[4], part[5]);
  const std::optional<std::int64_t> zone = TakeZone(text, zone_s);
  if (!local || !zone) return std::nullopt;
  return *local - *zone;
}

double NormalLongitude(double longitude) {
  if (longitude > 180.0) return longitude - 360.0;
  return longitude <= -180.0 ? longitude + 360.0 : longitude;
}

double ReadLatitudeTenths(std::string_view text, const HazardPlace& place) {
  return ReadWhole(text, "latitude in tenths of a degree", -900, 900, place) / 10.0;
}

double ReadLongitudeTenths(std::string_view text, const HazardPlace& place) {
  return NormalLongitude(ReadWhole(text, "longitude in tenths of a degree", -1800, 3600, place) /
                         10.0);
}

void AppendFix(HazardFix fix, std::vector<HazardFix>& fixes, HazardPlace& place) {
  fix.line = place.line;
  if (fixes.size() >= kMaxFixes) {
    place.Refuse("got more than " + std::to_string(kMaxFixes) + " points of one storm");
  }
  if (fix.pressure_hpa && *fix.pressure_hpa < kLeastPressure_hpa) {
    place.Refuse("pressure: got " + Format(*fix.pressure_hpa) +
                 " hPa, expected [800, 1100], or 0 where it is not known");
  }
  if (!fixes.empty() && fix.time == fixes.back().time) {
    place.Warn("time: " + FormatTime(fix.time) + " is there twice, the second is left out");
    return;
  }
  if (!fixes.empty() && fix.time < fixes.back().time) {
    place.Refuse("time: got " + FormatTime(fix.time) + ", expected one after " +
                 FormatTime(fixes.back().time) + " of the point before");
  }
  fixes.push_back(std::move(fix));
}

void FinishTrack(HazardTrack& track, const HazardPlace& place) {
  if (track.fixes.empty()) place.Refuse("points: got none, expected at least one");
  constexpr std::int64_t kDay_s = 86400;
  const std::int64_t days = (track.fixes.back().time - track.fixes.front().time) / kDay_s;
  if (days > 366) {
    place.Refuse("points: got " + std::to_string(days) +
                 " days of one storm, expected at most 366");
  }
  ComputeMotion(track.fixes);
  for (HazardForecast& forecast : track.forecasts) ComputeMotion(forecast.fixes);
}

std::vector<HazardTrack> ReadBestTracks(std::string_view text, HazardPlace& place,
                                        BestTrackHeader (*read_header)(std::string_view line,
                                                                       const HazardPlace& place),
                                        HazardFix (*read_point)(std::string_view line,
                                                                const HazardPlace& place)) {
  std::vector<HazardTrack> tracks;
  LineReader lines(text, place);
  std::string_view line;
  const auto is_header = [](std::string_view of) { return Trim(of).substr(0, 5) == "66666"; };
  while (lines.Next(line)) {
    if (Trim(line).empty()) continue;
    if (!is_header(line)) {
      place.Refuse("got " + Quoted(SplitWords(line)[0]) +
                   ", expected a header, 66666 …, as the storm before has all its points");
    }
    BestTrackHeader header = read_header(line, place);
    header.track.line = place.line;
    const std::string promised = std::to_string(header.points) + " points of the header on line " +
                                 std::to_string(place.line);
    for (std::int32_t i = 0; i < header.points; ++i) {
      if (!lines.Next(line) || is_header(line) || Trim(line).empty()) {
        place.Refuse("got " + std::to_string(i) + " points, expected the " + promised);
      }
      AppendFix(read_point(line, place), header.track.fixes, place);
    }
    FinishTrack(header.track, place);
    tracks.push_back(std::move(header.track));
  }
  return tracks;
}

bool AddRing(WindRing ring, std::vector<WindRing>& rings) {
  const auto at =
      std::lower_bound(rings.begin(), rings.end(), ring,
                       [](const WindRing& a, const WindRing& b) { return a.wind_kt < b.wind_kt; });
  if (at != rings.end() && at->wind_kt == ring.wind_kt) return false;
  rings.insert(at, ring);
  return true;
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
