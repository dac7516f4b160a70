// SPDX-License-Identifier: BSD-3-Clause
#include "rescue/fine_track.h"

#include <utility>

namespace aquafarm::agents {
namespace {

double Between(double a, double b, double part) { return a + (b - a) * part; }

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
    if (later == nullptr) continue;
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

}  // namespace

StormTrack FineTrack(const StormTrack& track, std::int64_t from) {
  StormTrack fine = track;
  fine.fixes.clear();
  for (const StormFix& fix : track.fixes) {
    if (!fine.fixes.empty() && fix.time > from && IsKnown(fine.fixes.back(), fix)) {
      const StormFix before = fine.fixes.back();
      const std::int64_t gap = fix.time - before.time;
      const std::int64_t parts = (gap + kFineTrack_s - 1) / kFineTrack_s;
      for (std::int64_t part = 1; part < parts; ++part) {
        fine.fixes.push_back(Between(before, fix, before.time + gap * part / parts));
      }
    }
    fine.fixes.push_back(fix);
  }
  return fine;
}

}  // namespace aquafarm::agents
