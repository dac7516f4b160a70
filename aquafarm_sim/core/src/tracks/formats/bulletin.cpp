// SPDX-License-Identifier: BSD-3-Clause
// Reads typhoon bulletins (JSON): one storm or a list of storms, each with its points. Some points
// have forecasts. There is no specification; the structure was derived from about two thousand
// files. Alternative spellings of the keys are accepted (moveDir for move_dir, r7 for radius7). The
// format of Zhejiang's water office is accepted, too (tfid, movedirection, radii as
// 250|220|200|180).
#include <algorithm>
#include <array>

#include "base/field_error.h"
#include "base/text.h"
#include "base/time.h"
#include "input/json_object.h"
#include "tracks/bulletin_rings.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kBeijing_s = 8 * 3600;  // times do not contain a zone
constexpr std::int32_t kAveraging_min = 2;

// Returns the grade that a text such as "强台风(STY)", "台风" or "Super TY" contains; kUnknown if
// there is none.
StormGrade GradeOfText(const std::string& text) {
  // Longer words come first, because they contain the shorter ones.
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

// Parses "250|220|200|180", or one number for all quadrants. Returns zeros if there is no value,
// and nullopt with a warning for any other value.
std::optional<std::array<double, kQuadrantCount>> ParseRadii(const JsonObject& point,
                                                             JsonObject::Keys keys,
                                                             ParseContext& place) {
  std::array<double, kQuadrantCount> radius{};
  const Json* value = point.Find(keys);
  const std::string text = value != nullptr && value->is_string() ? value->get<std::string>() : "";
  if (text.find('|') == std::string::npos) {
    const std::optional<double> all = point.TryNumber(keys, 0.0, kMaxRadius_km);
    if (!all && value != nullptr) return std::nullopt;
    radius.fill(all.value_or(0.0));
    return radius;
  }
  std::string_view rest = text;
  bool fits = true;
  for (std::size_t q = 0; q < radius.size(); ++q) {
    const std::size_t bar = rest.find('|');
    const std::optional<double> number = ParseNumber(rest.substr(0, bar));
    fits = fits && number && *number >= 0.0 && *number <= kMaxRadius_km &&
           (bar == std::string_view::npos) == (q + 1 == radius.size());
    if (!fits) break;
    radius[q] = *number;
    rest.remove_prefix(bar == std::string_view::npos ? rest.size() : bar + 1);
  }
  if (fits) return radius;
  place.WarnValueOnce(point.KeyOf(keys), Join(point.path(), point.KeyOf(keys)),
                      "got " + Quoted(text) +
                          ", expected four numbers in [0, 3000] such as 250|220|200|180" +
                          kIgnored);
  return std::nullopt;
}

void ReadRing(const JsonObject& point, std::int32_t wind_kt, JsonObject::Keys whole,
              JsonObject::Keys quadrants, StormFix& fix, ParseContext& place) {
  const auto given = ParseRadii(point, whole, place);
  std::array<double, kQuadrantCount> radius = given.value_or(std::array<double, kQuadrantCount>{});
  bool valid = given.has_value();
  const Json* value = point.Find(quadrants);
  if (value != nullptr && value->is_object()) {
    const auto each = ReadQuadrants(*value, Join(point.path(), point.KeyOf(quadrants)),
                                    {"ne", "se", "sw", "nw"}, wind_kt, radius, place);
    if (*std::max_element(each.begin(), each.end()) > 0.0) {
      radius = each;
      valid = true;
    }
  } else if (value != nullptr) {
    place.WarnValueOnce(
        point.KeyOf(quadrants), Join(point.path(), point.KeyOf(quadrants)),
        std::string("got no object, expected radii such as {\"ne\": 250, …}") + kIgnored);
  }
  if (valid) AddSaidRing(wind_kt, radius, fix);  // without a ring, ToRings estimates the radius
}

StormFix ReadPoint(const JsonObject& point, ParseContext& place) {
  StormFix fix;
  fix.time = point.NeedTime({"time"}, kBeijing_s);
  fix.position = point.NeedPosition({"lat"}, {"lng", "lon"});
  const double wind = point.TryNumber({"speed"}, 0.0, 150.0).value_or(0.0);
  if (wind > 0.0) fix.wind_mps = wind;  // 0 means unknown in bulletins of old storms
  fix.averaging_min = kAveraging_min;
  fix.pressure_hpa = CheckedPressure(point.TryNumber({"pressure"}, 0.0, 1100.0),
                                     Join(point.path(), "pressure"), place);
  const std::string strong = point.TryText({"strong"});
  fix.grade = GradeOfText(strong);
  if (fix.grade == StormGrade::kUnknown) {
    if (fix.wind_mps) fix.grade = GradeOfWind(*fix.wind_mps);
    if (!strong.empty()) {
      place.WarnValueOnce("strong", Join(point.path(), "strong"),
                          Quoted(strong) + " is not a known grade");
    }
  }
  ReadRing(point, 34, {"radius7", "r7"}, {"radius7_quad", "r7Quad", "radius7Quad"}, fix, place);
  ReadRing(point, 50, {"radius10", "r10"}, {"radius10_quad", "r10Quad", "radius10Quad"}, fix,
           place);
  ReadRing(point, 64, {"radius12", "r12"}, {"radius12_quad", "r12Quad", "radius12Quad"}, fix,
           place);
  fix.speed_kmh = point.TryNumber({"move_speed", "moveSpeed", "movespeed"}, 0.0, 300.0);
  if (fix.speed_kmh == 0.0)
    fix.speed_kmh.reset();  // 0 means not given; the motion is then computed
  const JsonObject::Keys way{"move_dir", "moveDir", "movedirection"};
  const std::string direction = point.TryText(way);
  fix.heading_deg = ParseDirection(direction);
  if (!fix.heading_deg && !direction.empty()) {
    place.WarnValueOnce(point.KeyOf(way), Join(point.path(), point.KeyOf(way)),
                        Quoted(direction) + " is not a known direction");
  }
  return fix;
}

// Returns true if a forecast point is at or after the time of the observed point that contains the
// forecast. Else warns and returns false. Some forecasts were issued before that observed point.
// @throws FixError if the forecast point is more than 15 days later
bool IsAhead(std::int64_t time, std::int64_t observed, const std::string& path,
             ParseContext& place) {
  constexpr std::int64_t kMaxDays = 15;
  if (time - observed > kMaxDays * 86400) {
    place.RefuseFixValue(path,
                         "got " + FormatTime(time) + ", expected the time of a forecast, within " +
                             std::to_string(kMaxDays) + " days after " + FormatTime(observed));
  }
  if (time < observed) {
    place.WarnValueOnce("forecast before", path,
                        "got " + FormatTime(time) + ", expected at least " + FormatTime(observed) +
                            ", the time of issue; the point is left out");
  }
  return time >= observed;
}

void ReadForecasts(const JsonObject& point, std::int64_t issued, StormTrack& track,
                   ParseContext& place) {
  const Json* forecasts = point.TryList({"forecast"});
  for (std::size_t i = 0; forecasts != nullptr && i < forecasts->size(); ++i) {
    const JsonObject one((*forecasts)[i], At(Join(point.path(), "forecast"), i), place);
    StormForecast forecast;
    forecast.agency = one.TryText({"sets", "tm"});
    forecast.issued = issued;
    const JsonObject::Keys keys{"points", "forecastpoints"};
    const Json* points = one.TryList(keys);
    LeftOut unused;
    for (std::size_t k = 0; points != nullptr && k < points->size(); ++k) {
      const JsonObject entry((*points)[k], At(Join(one.path(), one.KeyOf(keys)), k), place);
      const auto read = [&] {
        StormFix fix = ReadPoint(entry, place);
        if (IsAhead(fix.time, issued, Join(entry.path(), "time"), place)) {
          AppendFix(std::move(fix), forecast.fixes, entry.Here());
        }
      };
      TryFix(read, unused, place);
    }
    if (!forecast.fixes.empty() && forecast.fixes.back().time > issued) {
      track.forecasts.push_back(std::move(forecast));
    } else {
      place.WarnValueOnce("no forecast", one.path(),
                          "got no points after its issue; the forecast is left out");
    }
  }
}

void ReadLandfalls(const JsonObject& storm, StormTrack& track, ParseContext& place) {
  const Json* land = storm.TryList({"land"});
  for (std::size_t i = 0; land != nullptr && i < land->size(); ++i) {
    const Json& each = (*land)[i];
    const bool zhejiangs = each.contains("landtime");  // may be another event than a landfall
    if (zhejiangs || IsBlank(each)) continue;
    try {
      const JsonObject entry(each, At(Join(storm.path(), "land"), i), place);
      track.landfalls.push_back({entry.NeedTime({"land_time", "landTime", "time"}, kBeijing_s),
                                 entry.NeedPosition({"lat"}, {"lng", "lon"}),
                                 entry.TryText({"position", "landaddress"})});
    } catch (const InputError& error) {
      place.WarnOnce("land", error, "; the landfall is left out");
    }
  }
  std::stable_sort(track.landfalls.begin(), track.landfalls.end(),
                   [](const Landfall& a, const Landfall& b) { return a.time < b.time; });
}

StormTrack ReadStorm(const JsonObject& storm, ParseContext& place) {
  StormTrack track;
  track.id = storm.Text({"tfbh", "ident", "tfid"});
  if (track.id.empty()) storm.Here().Fail("tfbh: got nothing, expected a storm's number");
  const auto named = [](const std::string& text) { return text == "-" ? std::string() : text; };
  track.name = named(storm.TryText({"ename", "enname"}));
  track.local_name = named(storm.TryText({"name"}));
  track.agency = "bulletin";
  const Json* points = storm.List({"points"});
  LeftOut left_out;
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    const JsonObject point((*points)[i], At(Join(storm.path(), "points"), i), place);
    const auto read = [&] {
      StormFix fix = ReadPoint(point, place);
      const std::int64_t time = fix.time;
      AppendFix(std::move(fix), track.fixes, point.Here());
      ReadForecasts(point, time, track, place);
    };
    TryFix(read, left_out, place);
  }
  ReadLandfalls(storm, track, place);
  FinishTrack(track, left_out, storm.Here());
  return track;
}

}  // namespace

std::vector<StormTrack> ReadBulletin(std::string_view text, ParseContext& place) {
  const Json document = ParseJson(std::string(text), place);
  std::vector<StormTrack> tracks;
  if (document.is_object()) {  // one storm without an enclosing list
    tracks.push_back(ReadStorm(JsonObject(document, "", place), place));
    return tracks;
  }
  if (!document.is_array() || document.empty()) {
    place.FailValue(
        "bulletin",
        "got no list of storms or an empty one, expected a list with at least one storm");
  }
  for (std::size_t i = 0; i < document.size(); ++i) {
    tracks.push_back(ReadStorm(JsonObject(document[i], At("", i), place), place));
  }
  return tracks;
}

}  // namespace aquafarm::internal
