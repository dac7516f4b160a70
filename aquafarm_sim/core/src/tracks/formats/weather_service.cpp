// SPDX-License-Identifier: BSD-3-Clause
// Reads the response of a weather service to a storm query (JSON): {code, now, track}. Numbers are
// written as strings. In QWeather's storm-track API, windRadius30, windRadius50 and windRadius64
// are the radii of the winds of force 7, 10 and 12. Its storm-forecast API has `forecast` instead
// of `track`, and no radii.
#include <algorithm>
#include <array>

#include "base/field_error.h"
#include "base/text.h"
#include "input/json_object.h"
#include "tracks/bulletin_rings.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kBeijing_s = 8 * 3600;  // for times without a zone
constexpr std::int32_t kAveraging_min = 2;

StormGrade Grade(const JsonObject& point, const std::string& type,
                 const std::optional<double>& wind_mps) {
  for (int i = 1; i < kStormGradeCount; ++i) {
    if (Upper(type) == Upper(ToString(static_cast<StormGrade>(i)))) {
      return static_cast<StormGrade>(i);
    }
  }
  if (!type.empty()) {
    point.Here().WarnOnce("type", "type: " + Quoted(type) + " is not a known grade");
  }
  return wind_mps ? GradeOfWind(*wind_mps) : StormGrade::kUnknown;
}

StormFix ReadPoint(const JsonObject& point, ParseContext& place) {
  StormFix fix;
  fix.time = point.NeedTime({"time", "pubTime", "fxTime"}, kBeijing_s);
  fix.position = point.NeedPosition({"lat"}, {"lon"});
  const double wind = point.TryNumber({"windSpeed"}, 0.0, 150.0).value_or(0.0);
  if (wind > 0.0) fix.wind_mps = wind;
  fix.averaging_min = kAveraging_min;
  fix.pressure_hpa = CheckedPressure(point.TryNumber({"pressure"}, 0.0, 1100.0),
                                     Join(point.path(), "pressure"), place);
  fix.grade = Grade(point, point.TryText({"type"}), fix.wind_mps);
  constexpr std::array<std::pair<const char*, std::int32_t>, 3> kRings{
      {{"windRadius30", 34}, {"windRadius50", 50}, {"windRadius64", 64}}};
  for (const auto& [key, wind_kt] : kRings) {
    std::array<double, kQuadrantCount> radius{};
    const Json* value = point.Find({key});
    if (value != nullptr && !value->is_object()) {
      place.WarnValueOnce(
          key, Join(point.path(), key),
          std::string("got no object, expected radii such as {\"neRadius\": …}") + kIgnored);
      continue;
    }
    if (value != nullptr) {
      radius =
          ReadQuadrants(*value, Join(point.path(), key),
                        {"neRadius", "seRadius", "swRadius", "nwRadius"}, wind_kt, radius, place);
    }
    AddSaidRing(wind_kt, radius, fix);
  }
  fix.speed_kmh = point.TryNumber({"moveSpeed"}, 0.0, 300.0);
  if (fix.speed_kmh == 0.0)
    fix.speed_kmh.reset();  // 0 means not given; the motion is then computed
  fix.heading_deg = point.TryNumber({"move360"}, 0.0, 360.0);
  if (fix.heading_deg == 360.0) fix.heading_deg = 0.0;
  const std::string direction = point.TryText({"moveDir"});
  if (!fix.heading_deg) fix.heading_deg = ParseDirection(direction);
  if (!fix.heading_deg && !direction.empty()) {
    point.Here().WarnOnce("moveDir", "moveDir: " + Quoted(direction) + " is not a known direction");
  }
  return fix;
}

// Returns the key of the list of points: "track", or "forecast" if `track` is missing or empty.
const char* KeyOfPoints(const JsonObject& answer) {
  const Json* track = answer.List({"track"});
  return track == nullptr || track->empty() ? "forecast" : "track";
}

// Warns about unknown keys that have a value.
void WarnOfUnread(const Json& document, ParseContext& place) {
  constexpr std::array<std::string_view, 11> kKnown{"code", "updateTime", "fxLink",  "isActive",
                                                    "now",  "track",      "refer",   "id",
                                                    "name", "stormid",    "forecast"};
  for (const auto& [key, value] : document.items()) {
    const bool known = std::find(kKnown.begin(), kKnown.end(), key) != kKnown.end();
    if (!known && !IsBlank(value)) place.WarnValue(key, "is not read");
  }
}

// Returns whether a point only marks a landfall (type DL).
bool IsLandfall(const JsonObject& point) { return point.TryText({"type"}) == "DL"; }

// Reads the forecast of a response that also has `track` or `now`. The forecast counts as issued at
// the time of the last fix.
void ReadForecast(const JsonObject& answer, StormTrack& track, ParseContext& place) {
  const Json* points = answer.TryList({"forecast"});
  if (points == nullptr || points->empty() || track.fixes.empty()) return;
  StormForecast forecast;
  forecast.issued = track.fixes.back().time;
  LeftOut unused;
  for (std::size_t i = 0; i < points->size(); ++i) {
    const JsonObject point((*points)[i], At("forecast", i), place);
    const auto read = [&] {
      StormFix fix = ReadPoint(point, place);
      if (fix.time > forecast.issued) AppendFix(std::move(fix), forecast.fixes, point.Here());
    };
    if (!IsLandfall(point)) TryFix(read, unused, place);
  }
  if (!forecast.fixes.empty()) track.forecasts.push_back(std::move(forecast));
}

void ReadLandfall(const JsonObject& point, StormTrack& track, ParseContext& place) {
  try {
    track.landfalls.push_back(
        {point.NeedTime({"time"}, kBeijing_s), point.NeedPosition({"lat"}, {"lon"}), ""});
  } catch (const FixError& error) {
    place.WarnOnce("land", error, "; the landfall is left out");
  }
}

}  // namespace

std::vector<StormTrack> ReadWeatherService(std::string_view text, ParseContext& place) {
  const Json document = ParseJson(std::string(text), place);
  const JsonObject answer(document, "", place);
  const std::string code = answer.Text({"code"});
  if (!code.empty() && code != "200") {
    answer.Here().Fail("code: got " + Quoted(code) + ", expected '200'");
  }
  const char* key = KeyOfPoints(answer);
  WarnOfUnread(document, place);
  const Json* now = answer.Find({"now"});
  const bool alone = std::string_view(key) == "forecast" && now == nullptr;
  StormTrack track;
  track.id = answer.Text({"id", "stormid"});
  if (track.id.empty()) track.id = kUnknownStormId;
  track.name = answer.TryText({"name"});
  track.agency = "weather service";
  const Json* points = std::string_view(key) == "track" || alone ? answer.List({key}) : nullptr;
  LeftOut left_out;
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    const JsonObject point((*points)[i], At(key, i), place);
    if (IsLandfall(point)) {
      ReadLandfall(point, track, place);
    } else {
      TryFix([&] { AppendFix(ReadPoint(point, place), track.fixes, point.Here()); }, left_out,
             place);
    }
  }
  if (now != nullptr) {
    const JsonObject point(*now, "now", place);
    const auto read = [&] {
      StormFix fix = ReadPoint(point, place);
      if (track.fixes.empty() || fix.time > track.fixes.back().time) {
        AppendFix(std::move(fix), track.fixes, point.Here());
      }
    };
    TryFix(read, left_out, place);
  }
  if (!alone) ReadForecast(answer, track, place);
  for (StormFix& fix : track.fixes) fix.forecast = alone;
  FinishTrack(track, left_out, answer.Here());
  std::vector<StormTrack> tracks;
  tracks.push_back(std::move(track));
  return tracks;
}

}  // namespace aquafarm::internal
