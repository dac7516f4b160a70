// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/storm_rings.h"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/wind_radii.h"
#include "base/name_of.h"
#include "base/time.h"
#include "grid/longitude.h"
#include "tracks/interpolate.h"

namespace aquafarm {
namespace {

using internal::Between;
using Quadrants = std::array<double, 4>;

double Largest(const Quadrants& quadrants) {
  return *std::max_element(quadrants.begin(), quadrants.end());
}

// Returns the radii of a ring by quadrant. Without kQuadrants, they are replaced by the radius of a
// circle (RingReduction).
Quadrants Reduced(const WindRing& ring, RingReduction reduction) {
  Quadrants quadrants = ring.radius_km;
  if (reduction == RingReduction::kQuadrants) return quadrants;
  double squares = 0.0;
  for (const double radius : quadrants) squares += radius * radius;
  quadrants.fill(reduction == RingReduction::kLargest ? Largest(quadrants)
                                                      : std::sqrt(squares / kQuadrantCount));
  return quadrants;
}

bool Speaks(const StormTrack& track, std::int32_t wind_kt) {
  return std::any_of(track.fixes.begin(), track.fixes.end(),
                     [wind_kt](const StormFix& fix) { return fix.Ring(wind_kt) != nullptr; });
}

std::vector<std::int32_t> WindsOf(const StormTrack& track) {
  if (Speaks(track, 30) && !Speaks(track, 34)) return {50, 30};
  return {64, 50, 34};
}

// Adds a ring of 34 kt, marked as estimated, to a fix with a ring of 30 kt but without one of 34
// kt. Both radii are assumed to differ from their medians by the same factor.
void DeriveGale(StormFix& fix) {
  const WindRing* wider = fix.Ring(30);
  if (wider == nullptr || fix.Ring(34) != nullptr || !fix.wind_mps) return;
  const auto median_km = [&fix](std::int32_t wind_kt) {
    return EstimateRadius(wind_kt, *fix.wind_mps, fix.position.latitude, fix.averaging_min)
        .median_km;
  };
  if (median_km(30) <= 0.0) return;
  WindRing gale{34, wider->radius_km, true};
  for (double& radius : gale.radius_km) radius *= median_km(34) / median_km(30);
  AddRing(gale, fix.rings);
}

// Distance of a place from a storm, and the quadrant of the storm that contains the place.
struct Offset {
  double distance_km{};
  std::size_t quadrant{};
};

Offset From(GeoPoint storm, GeoPoint place) {
  double distance_m = 0.0;
  double bearing_deg = 0.0;  // in [-180, 180]
  double unused = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(storm.latitude, storm.longitude, place.latitude,
                                           place.longitude, distance_m, bearing_deg, unused);
  const double turned = bearing_deg < 0.0 ? bearing_deg + 360.0 : bearing_deg;
  return {distance_m / 1000.0, static_cast<std::size_t>(turned / 90.0) % 4};
}

GeoPoint Between(GeoPoint a, GeoPoint b, double part) {
  double step = b.longitude - a.longitude;
  if (step > 180.0) step -= 360.0;
  if (step < -180.0) step += 360.0;
  return {Between(a.latitude, b.latitude, part),
          internal::NormalLongitude(a.longitude + step * part)};
}

}  // namespace

std::string_view ToString(RingReduction value) {
  return internal::NameOf(value, std::array<std::string_view, kRingReductionCount>{
                                     "equal_area", "largest", "quadrants"});
}

StormRings ToRings(const StormTrack& track, RingReduction reduction,
                   const std::vector<std::int32_t>& winds_kt) {
  StormRings storm;
  storm.name = track.name;
  storm.wind_kt = winds_kt.empty() ? WindsOf(track) : winds_kt;
  for (StormFix fix : track.fixes) {
    StormWaypoint waypoint;
    waypoint.time = fix.time;
    waypoint.position = fix.position;
    waypoint.grade = fix.grade;
    waypoint.pressure_hpa = fix.pressure_hpa;
    waypoint.wind_mps = fix.wind_mps;
    waypoint.averaging_min = fix.averaging_min;
    waypoint.forecast = fix.forecast;
    // If the wind is unknown and the grade is at least TS, uses the lower limit of the grade.
    if (!fix.wind_mps && fix.grade >= StormGrade::kTropicalStorm) {
      fix.wind_mps = LowestWindOf(fix.grade);
    }
    const bool weak = fix.wind_below_mps || fix.grade == StormGrade::kTropicalDepression;
    if (storm.wind_kt.back() == 34) DeriveGale(fix);
    Quadrants outer{};
    waypoint.silent = !weak;
    for (auto wind = storm.wind_kt.rbegin(); wind != storm.wind_kt.rend(); ++wind) {
      const bool is_estimated = EstimateRing(fix, *wind);
      waypoint.estimated = is_estimated || waypoint.estimated;
      const WindRing* ring = fix.Ring(*wind);
      if (wind == storm.wind_kt.rbegin()) {
        waypoint.is_reported = !is_estimated && ring != nullptr && Largest(ring->radius_km) > 0.0;
      }
      waypoint.silent = waypoint.silent && ring == nullptr;
      waypoint.estimated = waypoint.estimated || (ring != nullptr && ring->estimated);
      Quadrants radii = ring == nullptr ? Quadrants{} : Reduced(*ring, reduction);
      for (std::size_t q = 0; q < radii.size() && !waypoint.radii_km.empty(); ++q) {
        radii[q] = std::min(radii[q], outer[q]);
      }
      outer = radii;
      waypoint.radii_km.push_back(Largest(radii));
      waypoint.quadrants_km.push_back(radii);
    }
    std::reverse(waypoint.radii_km.begin(), waypoint.radii_km.end());
    std::reverse(waypoint.quadrants_km.begin(), waypoint.quadrants_km.end());
    if (reduction != RingReduction::kQuadrants) waypoint.quadrants_km.clear();
    storm.estimated += waypoint.estimated ? 1 : 0;
    storm.silent += waypoint.silent ? 1 : 0;
    storm.waypoints.push_back(std::move(waypoint));
  }
  return storm;
}

std::optional<StormWaypoint> StormRings::At(std::int64_t time) const {
  if (waypoints.empty() || time < waypoints.front().time || time > waypoints.back().time) {
    return std::nullopt;
  }
  auto next = std::upper_bound(waypoints.begin(), waypoints.end(), time,
                               [](std::int64_t t, const StormWaypoint& w) { return t < w.time; });
  if (next == waypoints.end()) return waypoints.back();
  const StormWaypoint& from = *(next - 1);
  const double part =
      static_cast<double>(time - from.time) / static_cast<double>(next->time - from.time);
  StormWaypoint now = from;
  now.time = time;
  now.position = Between(from.position, next->position, part);
  now.forecast = from.forecast || (part > 0.0 && next->forecast);
  now.silent = from.silent || (part > 0.0 && next->silent);
  for (std::size_t k = 0; k < now.radii_km.size(); ++k) {
    now.radii_km[k] = Between(from.radii_km[k], next->radii_km[k], part);
    if (now.quadrants_km.empty()) continue;
    for (std::size_t q = 0; q < 4; ++q) {
      now.quadrants_km[k][q] = Between(from.quadrants_km[k][q], next->quadrants_km[k][q], part);
    }
    now.radii_km[k] = Largest(now.quadrants_km[k]);
  }
  return now;
}

std::int32_t BorrowRings(const StormTrack& from, StormTrack& track) {
  constexpr std::int64_t kLongestGap_s = 6 * 3600;
  std::int32_t given = 0;
  for (StormFix& fix : track.fixes) {
    const auto next = std::lower_bound(
        from.fixes.begin(), from.fixes.end(), fix.time,
        [](const StormFix& other, std::int64_t time) { return other.time < time; });
    if (!fix.rings.empty() || next == from.fixes.end()) continue;
    const auto last = next->time == fix.time || next == from.fixes.begin() ? next : next - 1;
    if (last->time > fix.time || next->time - last->time > kLongestGap_s) continue;
    const auto span = static_cast<double>(next->time - last->time);
    const double part = span > 0.0 ? static_cast<double>(fix.time - last->time) / span : 0.0;
    for (WindRing ring : last->rings) {
      const WindRing* later = next->Ring(ring.wind_kt);
      if (later == nullptr) continue;
      for (std::size_t q = 0; q < ring.radius_km.size(); ++q) {
        ring.radius_km[q] = Between(ring.radius_km[q], later->radius_km[q], part);
      }
      ring.estimated = ring.estimated || later->estimated;
      AddRing(ring, fix.rings);
    }
    given += fix.rings.empty() ? 0 : 1;
  }
  return given;
}

const StormForecast* NewestForecast(const StormTrack& track) {
  AQUAFARM_CHECK_GE(track.fixes.size(), 1U);
  constexpr std::int64_t kStale_s = 24 * 3600;
  const StormFix& now = track.fixes.back();
  const StormForecast* newest = nullptr;
  for (const StormForecast& forecast : track.forecasts) {
    if (forecast.fixes.back().time <= now.time || forecast.issued + kStale_s < now.time) continue;
    if (newest == nullptr || forecast.issued > newest->issued) newest = &forecast;
  }
  return newest;
}

StormTrack WithForecast(const StormTrack& track, NoForecast fallback) {
  StormTrack whole = track;
  const StormForecast* const newest = NewestForecast(track);
  const StormFix& now = track.fixes.back();
  if (newest != nullptr) {
    for (StormFix fix : newest->fixes) {
      if (fix.time <= now.time) continue;
      const StormFix& before = whole.fixes.back();
      if (!fix.wind_mps && fix.rings.empty()) {
        fix.wind_mps = before.wind_mps;
        fix.rings = before.rings;
        for (WindRing& ring : fix.rings) ring.estimated = true;
        if (fix.grade == StormGrade::kUnknown) fix.grade = before.grade;
      }
      fix.forecast = true;
      whole.fixes.push_back(std::move(fix));
    }
    return whole;
  }
  if (fallback == NoForecast::kEnd) return whole;
  constexpr std::int64_t kAhead_s = 24 * 3600;
  StormFix later = now;
  later.time += kAhead_s;
  later.forecast = true;
  if (now.heading_deg && now.speed_kmh) {
    GeographicLib::Geodesic::WGS84().Direct(now.position.latitude, now.position.longitude,
                                            *now.heading_deg,
                                            *now.speed_kmh * static_cast<double>(kAhead_s) / 3.6,
                                            later.position.latitude, later.position.longitude);
  }
  whole.fixes.push_back(std::move(later));
  return whole;
}

StormKnowledge KnowledgeOf(const StormTrack& recorded, const StormTrack& whole) {
  StormKnowledge knowledge;
  for (const StormFix& fix : recorded.fixes) {
    if (!fix.forecast) knowledge.recorded_until = fix.time;
  }
  knowledge.known_until = whole.fixes.back().time;
  if (const StormForecast* newest = NewestForecast(recorded)) {
    knowledge.issued = newest->issued;
    knowledge.agency = newest->agency;
  }
  return knowledge;
}

std::string Describe(const StormKnowledge& knowledge) {
  using internal::FormatTime;
  const std::string recorded = FormatTime(knowledge.recorded_until);
  const std::string until = FormatTime(knowledge.known_until);
  if (knowledge.recorded_until == 0) return "not recorded, forecast or assumed until " + until;
  if (knowledge.known_until == knowledge.recorded_until) return "known until " + recorded + " only";
  if (knowledge.issued == 0) {
    return "known until " + recorded +
           " only; no forecast: it is assumed to keep its motion, wind and rings until " + until;
  }
  return "recorded until " + recorded + ", then forecast until " + until + " (issued " +
         FormatTime(knowledge.issued) + (knowledge.agency.empty() ? "" : " by ") +
         knowledge.agency + ")";
}

Passage ClosestApproach(const StormRings& storm, GeoPoint place, double margin_km) {
  constexpr std::int64_t kStep_s = 600;
  Passage passage;
  passage.nearest_km = 1.0e9;
  if (storm.waypoints.empty()) return passage;
  const std::int64_t start = storm.waypoints.front().time;
  const std::int64_t end = storm.waypoints.back().time;
  for (std::int64_t step = 0; step * kStep_s < end - start + kStep_s; ++step) {
    const std::int64_t time = std::min(start + step * kStep_s, end);
    const StormWaypoint now = *storm.At(time);
    const auto [distance, quadrant] = From(now.position, place);
    if (distance < passage.nearest_km) {
      passage.nearest_km = distance;
      passage.nearest_time = time;
      passage.nearest_forecast = now.forecast;
    }
    if (now.silent && distance <= kLargestGale_km + margin_km) {
      if (passage.unknown[0] == 0) passage.unknown[0] = time;
      passage.unknown[1] = time;
    }
    for (std::size_t k = 0; k < now.radii_km.size(); ++k) {
      const double radius_km =
          now.quadrants_km.empty() ? now.radii_km[k] : now.quadrants_km[k][quadrant];
      if (radius_km <= 0.0 || distance > radius_km + margin_km) continue;
      passage.over_at_start = passage.over_at_start || time == start;
      passage.over_at_end = time == end;
      passage.worst_wind_kt = std::max(passage.worst_wind_kt, storm.wind_kt[k]);
      if (passage.first == 0) passage.first = passage.last = time;
      const std::int64_t since_last_s = time - passage.last;
      if (since_last_s <= kStep_s) passage.widest_h += static_cast<double>(since_last_s) / 3600.0;
      passage.last = time;
      break;
    }
  }
  passage.nearest_at_end = passage.nearest_time == end;
  return passage;
}

}  // namespace aquafarm
