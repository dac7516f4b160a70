// SPDX-License-Identifier: BSD-3-Clause
// Typhoon bulletins as JSON: a list of storms, each with its points, and forecasts with some of
// them. No document exists; the shape is that of some two thousand files. A second spelling of
// the keys (moveDir for move_dir, r7 for radius7) is as good as the first; so is that of Zhejiang's
// water office (tfid, movedirection, radii as 250|220|200|180).
#include <algorithm>
#include <array>

#include "base/field_error.h"
#include "base/text.h"
#include "base/time.h"
#include "input/json_object.h"
#include "storms/bulletin_rings.h"
#include "storms/formats/formats.h"
#include "storms/track_text.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kBeijing_s = 8 * 3600;  // times have no zone
constexpr std::int32_t kAveraging_min = 2;

// "强台风(STY)", "台风", "Super TY" …
StormGrade GradeOfText(const std::string& text) {
  // The longer words first: they hold the shorter ones.
  constexpr std::array<std::pair<std::string_view, StormGrade>, 14> kWords{{
      {"SUPER TY", StormGrade::kSuperTyphoon},
      {"SUPERTY", StormGrade::kSuperTyphoon},
      {"超强台风", StormGrade::kSuperTyphoon},
      {"STY", StormGrade::kSevereTyphoon},
      {"强台风", StormGrade::kSevereTyphoon},
      {"STS", StormGrade::kSevereTropicalStorm},
      {"强热带风暴", StormGrade::kSevereTropicalStorm},
      {"TD", StormGrade::kTropicalDepression},
      {"热带低压", StormGrade::kTropicalDepression},
      {"TS", StormGrade::kTropicalStorm},
      {"热带风暴", StormGrade::kTropicalStorm},
      {"TY", StormGrade::kTyphoon},
      {"台风", StormGrade::kTyphoon},
      {"", StormGrade::kUnknown},
  }};
  const std::string upper = Upper(text);
  return std::find_if(
             kWords.begin(), kWords.end(),
             [&upper](const auto& word) { return upper.find(word.first) != std::string::npos; })
      ->second;
}

// "250|220|200|180", or one number for all.
std::array<double, kQuadrantCount> ParseRadii(const JsonObject& point, JsonObject::Keys keys,
                                              HazardPlace& place) {
  std::array<double, kQuadrantCount> radius{};
  const Json* value = point.Find(keys);
  const std::string text = value != nullptr && value->is_string() ? value->get<std::string>() : "";
  if (text.find('|') == std::string::npos) {
    radius.fill(point.Number(keys, 0.0, kMostRadius_km).value_or(0.0));
    return radius;
  }
  std::string_view rest = text;
  bool fits = true;
  for (std::size_t q = 0; q < radius.size(); ++q) {
    const std::size_t bar = rest.find('|');
    const std::optional<double> number = ParseNumber(rest.substr(0, bar));
    fits = fits && number && *number >= 0.0 && *number <= kMostRadius_km &&
           (bar == std::string_view::npos) == (q + 1 == radius.size());
    if (!fits) break;
    radius[q] = *number;
    rest.remove_prefix(bar == std::string_view::npos ? rest.size() : bar + 1);
  }
  if (fits) return radius;
  place.RefuseValue(
      Join(point.path(), point.KeyOf(keys)),
      "got " + Quoted(text) + ", expected four numbers in [0, 3000] as " + "250|220|200|180");
}

void ReadRing(const JsonObject& point, std::int32_t wind_kt, JsonObject::Keys whole,
              JsonObject::Keys quadrants, HazardFix& fix, HazardPlace& place) {
  std::array<double, kQuadrantCount> radius = ParseRadii(point, whole, place);
  if (const Json* value = point.Find(quadrants)) {
    const auto each = ReadQuadrants(*value, Join(point.path(), point.KeyOf(quadrants)),
                                    {"ne", "se", "sw", "nw"}, wind_kt, radius, place);
    if (*std::max_element(each.begin(), each.end()) > 0.0) radius = each;
  }
  AddSaidRing(wind_kt, radius, fix);
}

HazardFix ReadPoint(const JsonObject& point, HazardPlace& place) {
  HazardFix fix;
  fix.time = point.NeedTime({"time"}, kBeijing_s);
  fix.position = point.NeedPosition({"lat"}, {"lng", "lon"});
  const double wind = point.Number({"speed"}, 0.0, 150.0).value_or(0.0);
  if (wind > 0.0) fix.wind_mps = wind;  // 0: of old storms, not known
  fix.averaging_min = kAveraging_min;
  const double pressure = point.Number({"pressure"}, 0.0, 1100.0).value_or(0.0);
  if (pressure > 0.0) fix.pressure_hpa = pressure;
  const std::string strong = point.Text({"strong"});
  fix.grade = GradeOfText(strong);
  if (fix.grade == StormGrade::kUnknown) {
    if (fix.wind_mps) fix.grade = GradeOfWind(*fix.wind_mps);
    if (!strong.empty()) point.Here().Warn("strong: " + Quoted(strong) + " is no grade known here");
  }
  ReadRing(point, 34, {"radius7", "r7"}, {"radius7_quad", "r7Quad", "radius7Quad"}, fix, place);
  ReadRing(point, 50, {"radius10", "r10"}, {"radius10_quad", "r10Quad", "radius10Quad"}, fix,
           place);
  ReadRing(point, 64, {"radius12", "r12"}, {"radius12_quad", "r12Quad", "radius12Quad"}, fix,
           place);
  fix.speed_kmh = point.Number({"move_speed", "moveSpeed", "movespeed"}, 0.0, 300.0);
  if (fix.speed_kmh == 0.0) fix.speed_kmh.reset();  // not said; a storm at rest is computed
  const JsonObject::Keys way{"move_dir", "moveDir", "movedirection"};
  const std::string direction = point.Text(way);
  fix.heading_deg = ParseDirection(direction);
  if (!fix.heading_deg && !direction.empty()) {
    point.Here().Warn(point.KeyOf(way) + ": " + Quoted(direction) + " is no direction known here");
  }
  return fix;
}

// Whether a forecast's point is after the observed one that it hangs on, which for some agencies is
// later than their own issue. @throws InputError when it is too far ahead for a forecast
bool IsAhead(std::int64_t time, std::int64_t observed, const std::string& path,
             HazardPlace& place) {
  constexpr std::int64_t kMostDays = 15;
  if (time - observed > kMostDays * 86400) {
    place.RefuseValue(path, "got " + FormatTime(time) + ", expected a forecast's within " +
                                std::to_string(kMostDays) + " days after " + FormatTime(observed));
  }
  if (time < observed) {
    place.WarnValue(path, "got " + FormatTime(time) + ", before " + FormatTime(observed) +
                              ", whose forecast it is; left out");
  }
  return time >= observed;
}

void ReadForecasts(const JsonObject& point, std::int64_t issued, HazardTrack& track,
                   HazardPlace& place) {
  const Json* forecasts = point.List({"forecast"});
  for (std::size_t i = 0; forecasts != nullptr && i < forecasts->size(); ++i) {
    const JsonObject one((*forecasts)[i], At(Join(point.path(), "forecast"), i), place);
    HazardForecast forecast;
    forecast.agency = one.Text({"sets", "tm"});
    forecast.issued = issued;
    const JsonObject::Keys keys{"points", "forecastpoints"};
    const Json* points = one.List(keys);
    for (std::size_t k = 0; points != nullptr && k < points->size(); ++k) {
      const JsonObject entry((*points)[k], At(Join(one.path(), one.KeyOf(keys)), k), place);
      HazardFix fix = ReadPoint(entry, place);
      if (IsAhead(fix.time, issued, Join(entry.path(), "time"), place)) {
        AppendFix(std::move(fix), forecast.fixes, entry.Here());
      }
    }
    if (!forecast.fixes.empty() && forecast.fixes.back().time > issued) {
      track.forecasts.push_back(std::move(forecast));
    } else {
      place.WarnValue(one.path(), "got no points after its issue, the forecast is left out");
    }
  }
}

void ReadLandfalls(const JsonObject& storm, HazardTrack& track, HazardPlace& place) {
  const Json* land = storm.List({"land"});
  for (std::size_t i = 0; land != nullptr && i < land->size(); ++i) {
    const Json& each = (*land)[i];
    const bool zhejiangs = each.contains("landtime");  // which names more than landfalls
    if (zhejiangs || IsBlank(each)) continue;
    const JsonObject entry(each, At(Join(storm.path(), "land"), i), place);
    track.landfalls.push_back({entry.NeedTime({"land_time", "landTime"}, kBeijing_s),
                               entry.NeedPosition({"lat"}, {"lng", "lon"}),
                               entry.Text({"position"})});
  }
  std::stable_sort(track.landfalls.begin(), track.landfalls.end(),
                   [](const Landfall& a, const Landfall& b) { return a.time < b.time; });
}

HazardTrack ReadStorm(const JsonObject& storm, HazardPlace& place) {
  HazardTrack track;
  track.id = storm.Text({"tfbh", "ident", "tfid"});
  if (track.id.empty()) storm.Here().Refuse("tfbh: got nothing, expected a storm's number");
  const auto named = [](const std::string& text) { return text == "-" ? std::string() : text; };
  track.name = named(storm.Text({"ename", "enname"}));
  track.local_name = named(storm.Text({"name"}));
  track.agency = "bulletin";
  const Json* points = storm.List({"points"});
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    const JsonObject point((*points)[i], At(Join(storm.path(), "points"), i), place);
    HazardFix fix = ReadPoint(point, place);
    const std::int64_t time = fix.time;
    AppendFix(std::move(fix), track.fixes, point.Here());
    ReadForecasts(point, time, track, place);
  }
  ReadLandfalls(storm, track, place);
  FinishTrack(track, storm.Here());
  return track;
}

}  // namespace

std::vector<HazardTrack> ReadBulletin(const std::string& text, HazardPlace& place) {
  const Json document = ParseJson(text, place);
  std::vector<HazardTrack> tracks;
  if (document.is_object()) {  // one storm without the list around it
    tracks.push_back(ReadStorm(JsonObject(document, "", place), place));
    return tracks;
  }
  if (!document.is_array() || document.empty()) {
    place.RefuseValue("bulletin", "got an empty list, expected a list of storms");
  }
  for (std::size_t i = 0; i < document.size(); ++i) {
    tracks.push_back(ReadStorm(JsonObject(document[i], At("", i), place), place));
  }
  return tracks;
}

}  // namespace aquafarm::internal
