// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/fine_rings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/wind_radii.h"
#include "tracks/interpolate.h"

namespace aquafarm {
namespace {

using internal::Between;
using internal::kHour_s;
using Quadrants = std::array<double, kQuadrantCount>;

bool Blows(const WindRing& ring) {
  return *std::max_element(ring.radius_km.begin(), ring.radius_km.end()) > 0.0;
}

StormFix Between(const StormFix& from, const StormFix& to, std::int64_t time) {
  const double part =
      static_cast<double>(time - from.time) / static_cast<double>(to.time - from.time);
  StormFix fix;
  fix.time = time;
  double east = to.position.longitude - from.position.longitude;
  if (east > 180.0) east -= 360.0;
  if (east < -180.0) east += 360.0;
  const double longitude = from.position.longitude + part * east;
  fix.position = {Between(from.position.latitude, to.position.latitude, part),
                  longitude > 180.0     ? longitude - 360.0
                  : longitude <= -180.0 ? longitude + 360.0
                                        : longitude};
  fix.wind_mps = Between(*from.wind_mps, *to.wind_mps, part);
  fix.averaging_min = from.averaging_min;
  fix.grade = GradeOfWind(*fix.wind_mps);
  fix.forecast = to.forecast;
  fix.interpolated = true;
  for (WindRing ring : from.rings) {
    const WindRing* later = to.Ring(ring.wind_kt);
    if (later == nullptr || Blows(ring) != Blows(*later)) continue;
    for (std::size_t q = 0; q < ring.radius_km.size(); ++q) {
      ring.radius_km[q] = Between(ring.radius_km[q], later->radius_km[q], part);
    }
    ring.estimated = ring.estimated || later->estimated;
    AddRing(ring, fix.rings);
  }
  return fix;
}

bool IsKnown(const StormFix& from, const StormFix& to) {
  return from.wind_mps && to.wind_mps && from.averaging_min == to.averaging_min;
}

// Returns times that divide the interval between two points into equal parts of at most
// kFineTrack_s.
std::vector<std::int64_t> TimesBetween(std::int64_t from, std::int64_t to) {
  const std::int64_t parts = (to - from + kFineTrack_s - 1) / kFineTrack_s;
  std::vector<std::int64_t> times;
  for (std::int64_t part = 1; part < parts; ++part) {
    times.push_back(from + (to - from) * part / parts);
  }
  return times;
}

// Returns the wind, or the lower limit of the grade if the wind is unknown; 0 if both are unknown.
double WindOf(const StormWaypoint& at) { return at.wind_mps.value_or(LowestWindOf(at.grade)); }

// Returns the estimated radius of a ring [km]; 0 if the storm does not reach the ring's wind.
double MedianOf(const StormRings& storm, const StormWaypoint& at, std::size_t ring) {
  return EstimateRadius(storm.wind_kt[ring], WindOf(at), at.position.latitude, at.averaging_min)
      .median_km;
}

// Returns the radii of a ring by quadrant; they are equal for a circle.
Quadrants EdgeOf(const StormWaypoint& at, std::size_t ring) {
  if (!at.quadrants_km.empty()) return at.quadrants_km[ring];
  Quadrants edge{};
  edge.fill(at.radii_km[ring]);
  return edge;
}

void SetEdge(const Quadrants& edge, std::size_t ring, StormWaypoint& at) {
  if (!at.quadrants_km.empty()) at.quadrants_km[ring] = edge;
  at.radii_km[ring] = *std::max_element(edge.begin(), edge.end());
}

// Returns the ratio of a ring's radius (root mean square of its quadrants) to its estimated radius;
// 0 if one of them is 0.
double SizeOf(const StormRings& storm, const StormWaypoint& at, std::size_t ring) {
  const double median_km = MedianOf(storm, at, ring);
  if (at.radii_km[ring] <= 0.0 || median_km <= 0.0) return 0.0;
  double squares = 0.0;
  for (const double radius_km : EdgeOf(at, ring)) squares += radius_km * radius_km;
  return std::sqrt(squares / kQuadrantCount) / median_km;
}

// Returns whether the radii of a ring are reported at a fix, or derived from reported ones.
bool IsReported(const StormFix& fix, const StormWaypoint& at, std::int32_t wind_kt) {
  const WindRing* ring = fix.Ring(wind_kt);
  if (ring == nullptr && wind_kt == 34 && at.is_reported) ring = fix.Ring(30);
  return ring != nullptr && !ring->estimated;
}

// Sets each estimated ring of a point to its estimate times a factor. The factor is ratio^kept,
// where `ratio` is the ring's SizeOf at the last report. If SizeOf is 0, for example because the
// storm did not reach the wind of the ring at the report, the factor is at.size. Resize first sets
// at.size to the factor of the outermost ring. Reported rings do not change. An estimated ring is
// never smaller than a reported ring of a stronger wind, and never larger than the ring outside it.
void Resize(const StormWaypoint& report, double kept, const StormFix& fix, StormRings& storm,
            StormWaypoint& at) {
  const std::size_t rings = storm.wind_kt.size();
  const bool has_own = IsReported(fix, at, storm.wind_kt.back());
  const double outermost = SizeOf(storm, has_own ? at : report, rings - 1);
  at.size = outermost > 0.0 ? std::pow(outermost, has_own ? 1.0 : kept) : 1.0;
  // For each ring, the largest reported radii of this ring and of the rings inside it.
  std::vector<Quadrants> reported(rings, Quadrants{});
  for (std::size_t ring = 0; ring < rings; ++ring) {
    if (ring > 0) reported[ring] = reported[ring - 1];
    if (!IsReported(fix, at, storm.wind_kt[ring])) continue;
    const Quadrants edge = EdgeOf(at, ring);
    for (std::size_t q = 0; q < kQuadrantCount; ++q) {
      reported[ring][q] = std::max(reported[ring][q], edge[q]);
    }
  }
  Quadrants outer{};
  outer.fill(std::numeric_limits<double>::infinity());
  for (std::size_t ring = rings; ring-- > 0;) {
    const double own = SizeOf(storm, report, ring);
    const double radius_km =
        MedianOf(storm, at, ring) * (own > 0.0 ? std::pow(own, kept) : at.size);
    if (IsReported(fix, at, storm.wind_kt[ring])) {
      outer = EdgeOf(at, ring);
    } else {
      for (std::size_t q = 0; q < kQuadrantCount; ++q) {
        outer[q] = std::min(outer[q], std::max(radius_km, reported[ring][q]));
      }
    }
    SetEdge(outer, ring, at);
  }
}

// Returns a point between two others with the larger radii of both.
StormWaypoint Larger(const StormRings& storm, const StormWaypoint& from, const StormWaypoint& to,
                     std::int64_t time) {
  StormWaypoint held = *storm.At(time);  // for the position
  held.grade = std::max(from.grade, to.grade);
  held.estimated = true;
  held.is_reported = false;
  held.pressure_hpa.reset();
  held.wind_mps.reset();
  held.averaging_min = to.averaging_min;
  held.size = std::max(from.size, to.size);
  held.keeps_radii.assign(held.radii_km.size(), true);
  for (std::size_t ring = 0; ring < held.radii_km.size(); ++ring) {
    Quadrants edge = EdgeOf(from, ring);
    const Quadrants later = EdgeOf(to, ring);
    for (std::size_t q = 0; q < edge.size(); ++q) edge[q] = std::max(edge[q], later[q]);
    SetEdge(edge, ring, held);
  }
  return held;
}

// Adds points to the intervals of more than kFineTrack_s that FineTrack did not divide, unless the
// rings at one end are unknown. Returns the number of divided intervals.
std::int32_t HoldLarger(std::int64_t from, StormRings& storm) {
  std::vector<StormWaypoint> all;
  std::int32_t held = 0;
  for (const StormWaypoint& to : storm.waypoints) {
    const bool is_long = !all.empty() && to.time > from && to.time - all.back().time > kFineTrack_s;
    if (is_long && !all.back().silent && !to.silent) {
      const StormWaypoint before = all.back();
      for (const std::int64_t time : TimesBetween(before.time, to.time)) {
        all.push_back(Larger(storm, before, to, time));
      }
      ++held;
    }
    all.push_back(to);
  }
  storm.waypoints = std::move(all);
  return held;
}

}  // namespace

StormTrack FineTrack(const StormTrack& track, std::int64_t from) {
  StormTrack fine = track;
  fine.fixes.clear();
  for (const StormFix& fix : track.fixes) {
    if (!fine.fixes.empty() && fix.time > from && IsKnown(fine.fixes.back(), fix)) {
      const StormFix before = fine.fixes.back();
      for (const std::int64_t time : TimesBetween(before.time, fix.time)) {
        fine.fixes.push_back(Between(before, fix, time));
      }
    }
    fine.fixes.push_back(fix);
  }
  return fine;
}

std::optional<std::int64_t> CarrySize(const StormTrack& track, double memory_h, StormRings& storm) {
  AQUAFARM_CHECK_EQ(track.fixes.size(), storm.waypoints.size());
  const StormWaypoint* report = nullptr;
  for (std::size_t i = 0; i < storm.waypoints.size(); ++i) {
    StormWaypoint& at = storm.waypoints[i];
    if (at.forecast) continue;
    for (const std::int32_t wind_kt : storm.wind_kt) {
      at.keeps_radii.push_back(IsReported(track.fixes[i], at, wind_kt));
    }
    if (at.is_reported) report = &at;
  }
  if (report == nullptr) return std::nullopt;
  const StormWaypoint last = *report;
  const auto sigma = [&storm](const StormWaypoint& at) {
    return SizeSigma(storm.wind_kt.back(), WindOf(at), at.position.latitude, at.averaging_min);
  };
  for (std::size_t i = 0; i < storm.waypoints.size(); ++i) {
    StormWaypoint& at = storm.waypoints[i];
    if (!at.estimated || WindOf(at) <= 0.0 || at.time <= last.time) continue;
    const double since_h = static_cast<double>(at.time - last.time) / kHour_s;
    const double kept = std::exp(-since_h / memory_h) * sigma(at) / sigma(last);
    Resize(last, kept, track.fixes[i], storm, at);
  }
  return last.time;
}

FineRings ToFineRings(const StormTrack& track, RingReduction reduction, std::int64_t from,
                      const std::vector<std::int32_t>& winds_kt, double memory_h) {
  const StormRings own = ToRings(track, reduction, winds_kt);
  const StormTrack fine = FineTrack(track, from);
  StormRings storm = ToRings(fine, reduction, own.wind_kt);
  CarrySize(fine, memory_h, storm);
  const std::int32_t held = HoldLarger(from, storm);
  storm.estimated = own.estimated;
  storm.silent = own.silent;
  return {std::move(storm), held};
}

}  // namespace aquafarm
