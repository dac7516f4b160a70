// SPDX-License-Identifier: BSD-3-Clause
// Reads IBTrACS v04 CSV: names in row 1, units in row 2, then one row per fix. Columns are found by
// name. A missing value is a blank. Source: IBTrACS v04 column documentation.
#include <array>
#include <map>

#include "base/text.h"
#include "base/time.h"
#include "grid/longitude.h"
#include "tracks/formats/formats.h"
#include "tracks/track_text.h"

namespace aquafarm::internal {
namespace {

using Fields = std::vector<std::string_view>;

// Returns the averaging period [min] of WMO_WIND, the wind of the agency in WMO_AGENCY; 0 if no
// agency is given. IBTrACS does not convert winds to a common period. Source: IBTrACS technical
// details, table of agencies.
std::int32_t AveragingOf(std::string_view agency) {
  if (agency == "newdelhi") return 3;
  if (agency.substr(0, 7) == "hurdat_" || agency == "atcf" || agency == "cphc") return 1;
  return agency.empty() ? 0 : 10;
}

class Columns {
 public:
  Columns(const Fields& names, const ParseContext& place) : count_(names.size()) {
    for (std::size_t i = 0; i < names.size(); ++i) at_.emplace(std::string(names[i]), i);
    for (const char* needed :
         {"SID", "NAME", "ISO_TIME", "NATURE", "LAT", "LON", "WMO_WIND", "WMO_PRES", "WMO_AGENCY",
          "TRACK_TYPE", "IFLAG", "USA_WIND", "USA_PRES", "USA_RMW", "STORM_SPEED", "STORM_DIR"}) {
      if (at_.count(needed) == 0) {
        place.Fail(std::string("got no column ") + needed + ", expected those of IBTrACS v04");
      }
    }
  }
  std::size_t count() const { return count_; }
  std::string_view Get(const Fields& fields, const std::string& name) const {
    const auto found = at_.find(name);
    return found == at_.end() ? std::string_view() : fields[found->second];
  }

 private:
  std::map<std::string, std::size_t> at_;
  std::size_t count_;
};

std::optional<double> Number(std::string_view text, const char* name, double max,
                             ParseContext& place) {
  return TryNumber(text, name, 0.0, max, place);
}

double Degrees(std::string_view text, const char* name, double min, double max,
               const ParseContext& place) {
  const std::optional<double> value = ParseNumber(text);
  if (value && *value >= min && *value <= max) return *value;  // false for NaN
  place.RefuseFix(std::string(name) + ": got " + Quoted(text) + ", expected a number in [" +
                  Format(min) + ", " + Format(max) + "]");
}

// Reads the rings. The four quadrants of a ring come from the first agency that gives a radius for
// the wind of the ring.
void ReadRings(const Columns& columns, const Fields& fields, StormFix& fix, ParseContext& place) {
  constexpr std::array<const char*, kQuadrantCount> kQuadrants{"NE", "SE", "SW", "NW"};
  for (const std::int32_t wind_kt : {34, 50, 64}) {
    for (const char* agency : {"USA", "BOM", "REUNION"}) {
      const std::string stem = std::string(agency) + "_R" + std::to_string(wind_kt) + "_";
      WindRing ring;
      ring.wind_kt = wind_kt;
      bool any = false;
      for (std::size_t q = 0; q < kQuadrants.size(); ++q) {
        const auto radius =
            Number(columns.Get(fields, stem + kQuadrants[q]), "radius", 1500.0, place);
        any = any || radius;
        ring.radius_km[q] = radius.value_or(0.0) * kKmPerNauticalMile;
      }
      if (any && AddRing(ring, fix.rings)) break;
    }
  }
}

// Reads wind, grade, pressure and radius of the max wind. WMO_WIND and WMO_PRES are the values of
// the responsible agency. USA_WIND and USA_PRES replace them if they are blank, as in provisional
// tracks, or invalid.
void ReadStrength(const Columns& columns, const Fields& fields, StormFix& fix,
                  ParseContext& place) {
  auto wind_kt = Number(columns.Get(fields, "WMO_WIND"), "WMO_WIND", 250.0, place);
  fix.averaging_min = wind_kt ? AveragingOf(columns.Get(fields, "WMO_AGENCY")) : 0;
  if (!wind_kt) {
    wind_kt = Number(columns.Get(fields, "USA_WIND"), "USA_WIND", 250.0, place);
    if (wind_kt) fix.averaging_min = 1;
  }
  if (wind_kt) {
    fix.wind_mps = *wind_kt * kMpsPerKnot;
    fix.grade = GradeOfWind(*fix.wind_mps);
  }
  for (const char* key : {"WMO_PRES", "USA_PRES"}) {
    const std::string_view pressure = columns.Get(fields, key);
    if (fix.pressure_hpa || pressure.empty()) continue;
    fix.pressure_hpa = TryNumber(pressure, key, kMinPressure_hpa, 1100.0, place);
  }
  const auto radius = Number(columns.Get(fields, "USA_RMW"), "USA_RMW", 999.0, place);
  if (radius) fix.max_wind_radius_km = *radius * kKmPerNauticalMile;
}

StormFix ReadFix(const Columns& columns, const Fields& fields, ParseContext& place) {
  StormFix fix;
  const std::string_view time = columns.Get(fields, "ISO_TIME");
  const std::optional<std::int64_t> utc = ParseDateTime(time, 0);
  if (!utc) {
    place.RefuseFix("ISO_TIME: got " + Quoted(time) + ", expected UTC as YYYY-MM-DD HH:MM:SS");
  }
  fix.time = *utc;
  fix.position.latitude = Degrees(columns.Get(fields, "LAT"), "LAT", -90.0, 90.0, place);
  fix.position.longitude =
      NormalLongitude(Degrees(columns.Get(fields, "LON"), "LON", -180.0, 360.0, place));
  ReadStrength(columns, fields, fix, place);
  ReadRings(columns, fields, fix, place);
  fix.extratropical = columns.Get(fields, "NATURE") == "ET";
  const std::string_view flags = columns.Get(fields, "IFLAG");
  fix.interpolated = !flags.empty() && flags.find('O') == std::string_view::npos;
  const auto speed_kt = Number(columns.Get(fields, "STORM_SPEED"), "STORM_SPEED", 200.0, place);
  const auto direction = Number(columns.Get(fields, "STORM_DIR"), "STORM_DIR", 360.0, place);
  if (speed_kt) fix.speed_kmh = *speed_kt * kKmPerNauticalMile;
  if (direction) fix.heading_deg = *direction < 360.0 ? *direction : 0.0;
  return fix;
}

}  // namespace

std::vector<StormTrack> ReadIbtracs(std::string_view text, ParseContext& place) {
  std::vector<StormTrack> tracks;
  LineReader lines(text, place);
  Fields fields;
  std::string_view line;
  lines.Next(line);
  SplitFields(line, fields);
  const Columns columns(fields, place);
  std::map<std::string, bool> seen;
  LeftOut left_out;
  while (lines.Next(line)) {
    if (Trim(line).empty()) continue;
    SplitFields(line, fields);
    if (fields.size() != columns.count()) {
      place.Fail("got " + std::to_string(fields.size()) + " fields, expected the " +
                 std::to_string(columns.count()) + " of row 1");
    }
    const std::string_view id = columns.Get(fields, "SID");
    if (place.line == 2 && id.empty()) {  // the row of units
      const std::string_view unit = columns.Get(fields, "WMO_WIND");
      if (unit != "kts") place.Fail("WMO_WIND: got unit " + Quoted(unit) + ", expected 'kts'");
      continue;
    }
    if (id.empty()) place.Fail("SID: got nothing, expected a storm's identifier");
    if (tracks.empty() || tracks.back().id != id) {
      if (!seen.emplace(id, true).second) {
        place.Fail("SID: got " + Quoted(id) + " again, expected all rows of a storm in one block");
      }
      if (!tracks.empty()) FinishTrack(tracks.back(), left_out, place);
      left_out = {};
      StormTrack track;
      track.id = id;
      track.name = columns.Get(fields, "NAME");
      if (track.name == "NOT_NAMED" || track.name == "UNNAMED") track.name.clear();
      track.agency = columns.Get(fields, "TRACK_TYPE");
      track.agency = "IBTrACS " + track.agency;
      track.line = place.line;
      tracks.push_back(std::move(track));
    }
    TryFix([&] { AppendFix(ReadFix(columns, fields, place), tracks.back().fixes, place); },
           left_out, place);
  }
  if (tracks.empty()) place.Fail("got no storm, expected rows of fixes");
  FinishTrack(tracks.back(), left_out, place);
  return tracks;
}

}  // namespace aquafarm::internal
