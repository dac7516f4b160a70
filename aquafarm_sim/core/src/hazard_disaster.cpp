// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/hazard_disaster.h"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "aquafarm/check.h"
#include "field_domain.h"
#include "hazard_text.h"
#include "name_of.h"

namespace aquafarm {
namespace {

double Circle(const WindRing& ring, RingReduction reduction) {
  if (reduction == RingReduction::kLargest) {
    return *std::max_element(ring.radius_km.begin(), ring.radius_km.end());
  }
  double squares = 0.0;
  for (const double radius : ring.radius_km) squares += radius * radius;
  return std::sqrt(squares / kQuadrantCount);
}

bool Speaks(const HazardTrack& track, std::int32_t wind_kt) {
  return std::any_of(track.fixes.begin(), track.fixes.end(),
                     [wind_kt](const HazardFix& fix) { return fix.Ring(wind_kt) != nullptr; });
}

std::vector<std::int32_t> WindsOf(const HazardTrack& track) {
  if (Speaks(track, 30) && !Speaks(track, 34)) return {50, 30};
  return {64, 50, 34};
}

double DistanceKm(GeoPoint a, GeoPoint b) {
  double distance_m = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(a.latitude, a.longitude, b.latitude, b.longitude,
                                           distance_m);
  return distance_m / 1000.0;
}

double Between(double a, double b, double part) { return a + (b - a) * part; }

GeoPoint Between(GeoPoint a, GeoPoint b, double part) {
  double step = b.longitude - a.longitude;
  if (step > 180.0) step -= 360.0;
  if (step < -180.0) step += 360.0;
  return {Between(a.latitude, b.latitude, part),
          internal::NormalLongitude(a.longitude + step * part)};
}

// The waypoints on the ranch's side of the globe, from the first to the last.
std::vector<StormWaypoint> Facing(const StormRings& storm, const GeoFrame& frame) {
  const auto faces = [&frame](const StormWaypoint& at) { return frame.Faces(at.position); };
  const auto& all = storm.waypoints;
  const auto first = std::find_if(all.begin(), all.end(), faces);
  const auto last = std::find_if(all.rbegin(), all.rend(), faces).base();
  if (first == all.end()) {
    throw InputError(
        "storm: got a track on the far side of the globe, expected one that comes "
        "within 60 degrees of the ranch");
  }
  if (!std::all_of(first, last, faces)) {
    throw InputError(
        "storm: got a track that leaves the ranch's side of the globe and comes back, "
        "expected one within 60 degrees of the ranch");
  }
  return {first, last};
}

}  // namespace

std::int32_t StepsToCover(double span_s, double step_duration_s) {
  const double steps = std::ceil(span_s / step_duration_s);
  if (steps <= 1.0e7) return std::max(1, static_cast<std::int32_t>(std::max(steps, 1.0)));
  throw InputError("duration: got " + internal::Format(steps) +
                   " steps, expected at most 10000000; the storm is too long for such steps");
}

std::string_view ToString(RingReduction value) {
  return internal::NameOf(
      value, std::array<std::string_view, kRingReductionCount>{"equal_area", "largest"});
}

StormRings ToRings(const HazardTrack& track, RingReduction reduction) {
  StormRings storm;
  storm.wind_kt = WindsOf(track);
  for (HazardFix fix : track.fixes) {
    StormWaypoint waypoint{fix.time, fix.position,     fix.grade,   {},
                           false,    fix.pressure_hpa, fix.wind_mps};
    double outer = 0.0;
    bool silent = true;
    for (auto wind = storm.wind_kt.rbegin(); wind != storm.wind_kt.rend(); ++wind) {
      waypoint.estimated = EstimateRing(fix, *wind) || waypoint.estimated;
      const WindRing* ring = fix.Ring(*wind);
      silent = silent && ring == nullptr;
      const double radius = ring == nullptr ? 0.0 : Circle(*ring, reduction);
      outer = waypoint.radii_km.empty() ? radius : std::min(radius, outer);
      waypoint.radii_km.push_back(outer);
    }
    std::reverse(waypoint.radii_km.begin(), waypoint.radii_km.end());
    storm.estimated += waypoint.estimated ? 1 : 0;
    storm.silent += silent ? 1 : 0;
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
  for (std::size_t k = 0; k < now.radii_km.size(); ++k) {
    now.radii_km[k] = Between(from.radii_km[k], next->radii_km[k], part);
  }
  return now;
}

std::int32_t BorrowRings(const HazardTrack& from, HazardTrack& track) {
  constexpr std::int64_t kLongestGap_s = 6 * 3600;
  std::int32_t given = 0;
  for (HazardFix& fix : track.fixes) {
    const auto next = std::lower_bound(
        from.fixes.begin(), from.fixes.end(), fix.time,
        [](const HazardFix& other, std::int64_t time) { return other.time < time; });
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
      internal::AddRing(ring, fix.rings);
    }
    given += fix.rings.empty() ? 0 : 1;
  }
  return given;
}

const RiskTable& DefaultRiskTable() {
  static const RiskTable kTable{{{-14.0F, -8.0F, -5.0F},
                                 {-16.0F, -9.0F, -5.0F},
                                 {-20.0F, -10.0F, -5.0F},
                                 {-20.0F, -12.0F, -6.0F}}};
  return kTable;
}

DisasterSpec ToDisaster(const StormRings& storm, const RiskTable& risks, const GeoFrame& frame,
                        double cell_size_m, double step_duration_s, std::int64_t start_time) {
  AQUAFARM_CHECK_GE(storm.waypoints.size(), 1U);
  DisasterSpec disaster;
  disaster.kind = DisasterKind::kTyphoon;
  for (const StormWaypoint& from : Facing(storm, frame)) {
    const std::array<double, 2> place = frame.ToGrid(from.position);
    Waypoint waypoint;
    waypoint.step =
        static_cast<float>(static_cast<double>(from.time - start_time) / step_duration_s);
    waypoint.x = static_cast<float>(place[0]);
    waypoint.y = static_cast<float>(place[1]);
    waypoint.grade = DisasterGrade(from.grade);
    for (const double radius_km : from.radii_km) {
      waypoint.radii.push_back(static_cast<float>(radius_km * 1000.0 / cell_size_m));
    }
    const std::vector<float>& row = risks[static_cast<std::size_t>(waypoint.grade - 1)];
    AQUAFARM_CHECK_GE(row.size(), from.radii_km.size());
    waypoint.risks.assign(row.end() - static_cast<std::ptrdiff_t>(from.radii_km.size()), row.end());
    disaster.track.push_back(std::move(waypoint));
  }
  const Waypoint& first = disaster.track.front();
  disaster.grade = first.grade;
  disaster.radii = first.radii;
  disaster.risks = first.risks;
  disaster.duration = StepsToCover(static_cast<double>(disaster.track.back().step), 1.0);
  return disaster;
}

HazardTrack WithForecast(const HazardTrack& track) {
  HazardTrack whole = track;
  AQUAFARM_CHECK_GE(track.fixes.size(), 1U);
  const HazardFix& now = track.fixes.back();
  const HazardForecast* newest = nullptr;
  for (const HazardForecast& forecast : track.forecasts) {
    if (forecast.fixes.back().time <= now.time) continue;
    if (newest == nullptr || forecast.issued > newest->issued) newest = &forecast;
  }
  if (newest != nullptr) {
    std::copy_if(newest->fixes.begin(), newest->fixes.end(), std::back_inserter(whole.fixes),
                 [&now](const HazardFix& fix) { return fix.time > now.time; });
    return whole;
  }
  if (!now.heading_deg || !now.speed_kmh) return whole;
  constexpr std::int64_t kAhead_s = 24 * 3600;
  HazardFix later = now;
  later.time += kAhead_s;
  GeographicLib::Geodesic::WGS84().Direct(now.position.latitude, now.position.longitude,
                                          *now.heading_deg,
                                          *now.speed_kmh * static_cast<double>(kAhead_s) / 3.6,
                                          later.position.latitude, later.position.longitude);
  whole.fixes.push_back(std::move(later));
  return whole;
}

DisasterSpec ToDisaster(const HazardTrack& bulletin, const Scenario& scenario,
                        std::int32_t step_now) {
  if (!scenario.origin || !scenario.start_time) {
    throw InputError("bulletin: needs a ranch with grid.origin and time.start");
  }
  const StormRings storm = ToRings(WithForecast(bulletin), RingReduction::kEqualArea);
  DisasterSpec disaster =
      ToDisaster(storm, DefaultRiskTable(), GeoFrame(*scenario.origin, scenario.cell_size_m),
                 scenario.cell_size_m, scenario.step_duration_s, *scenario.start_time);
  const double left = std::ceil(static_cast<double>(disaster.track.back().step)) - step_now;
  if (left <= 0.0) {
    throw InputError("bulletin: is over: got a last position before step " +
                     std::to_string(step_now) + ", expected one of a storm that goes on");
  }
  disaster.duration = StepsToCover(left, 1.0);
  return disaster;
}

Passage PassOver(const StormRings& storm, GeoPoint place, double margin_km) {
  constexpr std::int64_t kStep_s = 600;
  Passage passage;
  passage.nearest_km = 1.0e9;
  if (storm.waypoints.empty()) return passage;
  for (std::int64_t time = storm.waypoints.front().time; time <= storm.waypoints.back().time;
       time += kStep_s) {
    const StormWaypoint now = *storm.At(time);
    const double distance = DistanceKm(now.position, place);
    if (distance < passage.nearest_km) {
      passage.nearest_km = distance;
      passage.nearest_time = time;
    }
    for (std::size_t k = 0; k < now.radii_km.size(); ++k) {
      if (now.radii_km[k] <= 0.0 || distance > now.radii_km[k] + margin_km) continue;
      passage.worst_wind_kt = std::max(passage.worst_wind_kt, storm.wind_kt[k]);
      if (passage.first == 0) passage.first = time;
      passage.last = time;
      passage.widest_h += static_cast<double>(kStep_s) / 3600.0;
      break;
    }
  }
  return passage;
}

}  // namespace aquafarm
