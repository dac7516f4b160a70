// SPDX-License-Identifier: BSD-3-Clause
// A weather service's answer to "where is this storm": {code, now, track}; every value is text.
// (QWeather's storm-track API: windRadius30, 50 and 64 are the winds of force 7, 10 and 12; its
// storm-forecast API has forecast in place of track and no radii.)
#include <algorithm>
#include <array>

#include "base/field_error.h"
#include "base/text.h"
#include "input/json_object.h"
#include "storms/bulletin_rings.h"
#include "storms/formats/formats.h"
#include "storms/track_text.h"

namespace aquafarm::internal {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kBeijing_s = 8 * 3600;  // where a time has no zone
constexpr std::int32_t kAveraging_min = 2;

StormGrade Grade(const JsonObject& point, const std::string& type,
                 const std::optional<double>& wind_mps) {
  for (int i = 1; i < kStormGradeCount; ++i) {
    if (Upper(type) == Upper(ToString(static_cast<StormGrade>(i)))) {
      return static_cast<StormGrade>(i);
    }
  }
  if (!type.empty()) point.Here().Warn("type: " + Quoted(type) + " is no grade known here");
  return wind_mps ? GradeOfWind(*wind_mps) : StormGrade::kUnknown;
}

HazardFix ReadPoint(const JsonObject& point, HazardPlace& place) {
  HazardFix fix;
  fix.time = point.NeedTime({"time", "pubTime", "fxTime"}, kBeijing_s);
  fix.position = point.NeedPosition({"lat"}, {"lon"});
  const double wind = point.Number({"windSpeed"}, 0.0, 150.0).value_or(0.0);
  if (wind > 0.0) fix.wind_mps = wind;
  fix.averaging_min = kAveraging_min;
  const double pressure = point.Number({"pressure"}, 0.0, 1100.0).value_or(0.0);
  if (pressure > 0.0) fix.pressure_hpa = pressure;
  fix.grade = Grade(point, point.Text({"type"}), fix.wind_mps);
  constexpr std::array<std::pair<const char*, std::int32_t>, 3> kRings{
      {{"windRadius30", 34}, {"windRadius50", 50}, {"windRadius64", 64}}};
  for (const auto& [key, wind_kt] : kRings) {
    std::array<double, kQuadrantCount> radius{};
    if (const Json* value = point.Find({key})) {
      radius =
          ReadQuadrants(*value, Join(point.path(), key),
                        {"neRadius", "seRadius", "swRadius", "nwRadius"}, wind_kt, radius, place);
    }
    AddSaidRing(wind_kt, radius, fix);
  }
  fix.speed_kmh = point.Number({"moveSpeed"}, 0.0, 300.0);
  if (fix.speed_kmh == 0.0) fix.speed_kmh.reset();  // not said; a storm at rest is computed
  fix.heading_deg = point.Number({"move360"}, 0.0, 360.0);
  if (fix.heading_deg == 360.0) fix.heading_deg = 0.0;
  const std::string direction = point.Text({"moveDir"});
  if (!fix.heading_deg) fix.heading_deg = ParseDirection(direction);
  if (!fix.heading_deg && !direction.empty()) {
    point.Here().Warn("moveDir: " + Quoted(direction) + " is no direction known here");
  }
  return fix;
}

// The list of points: the track, else the forecast. A track that says nothing is none.
const char* KeyOfPoints(const JsonObject& answer) {
  const Json* track = answer.List({"track"});
  return track == nullptr || track->empty() ? "forecast" : "track";
}

// Sections that an answer may have besides its points, and a forecast beside the track.
void WarnOfUnread(const Json& document, std::string_view points, HazardPlace& place) {
  constexpr std::array<std::string_view, 10> kKnown{
      "code", "updateTime", "fxLink", "isActive", "now", "track", "refer", "id", "stormid", "name"};
  for (const auto& [key, value] : document.items()) {
    const bool known =
        std::find(kKnown.begin(), kKnown.end(), key) != kKnown.end() || key == points;
    if (!known && !IsBlank(value)) place.WarnValue(key, "is not read");
  }
}

// A point of type DL marks a landfall and says nothing else.
bool IsLandfall(const JsonObject& point) { return point.Text({"type"}) == "DL"; }

}  // namespace

std::vector<HazardTrack> ReadWeatherService(const std::string& text, HazardPlace& place) {
  const Json document = ParseJson(text, place);
  const JsonObject answer(document, "", place);
  const std::string code = answer.Text({"code"});
  if (!code.empty() && code != "200") {
    answer.Here().Refuse("code: got " + Quoted(code) + ", expected '200'");
  }
  const char* key = KeyOfPoints(answer);
  WarnOfUnread(document, key, place);
  HazardTrack track;
  track.id = answer.Text({"id", "stormid"});
  if (track.id.empty()) track.id = "storm";
  track.name = answer.Text({"name"});
  track.agency = "weather service";
  const Json* points = answer.List({key});
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    const JsonObject point((*points)[i], At(key, i), place);
    if (IsLandfall(point)) {
      track.landfalls.push_back(
          {point.NeedTime({"time"}, kBeijing_s), point.NeedPosition({"lat"}, {"lon"}), ""});
      continue;
    }
    HazardFix fix = ReadPoint(point, place);
    AppendFix(std::move(fix), track.fixes, point.Here());
  }
  if (const Json* now = answer.Find({"now"})) {
    const JsonObject point(*now, "now", place);
    HazardFix fix = ReadPoint(point, place);
    if (track.fixes.empty() || fix.time > track.fixes.back().time) {
      AppendFix(std::move(fix), track.fixes, point.Here());
    }
  }
  FinishTrack(track, answer.Here());
  std::vector<HazardTrack> tracks;
  tracks.push_back(std::move(track));
  return tracks;
}

}  // namespace aquafarm::internal
