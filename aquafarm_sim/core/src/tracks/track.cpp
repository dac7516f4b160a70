// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/track.h"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>

#include "base/name_of.h"

namespace aquafarm {
namespace {

// Lower limit of each grade from TD on [m/s], GB/T 19201-2006.
constexpr std::array<double, kStormGradeCount - 1> kLowestWind_mps{10.8, 17.2, 24.5,
                                                                   32.7, 41.5, 51.0};

// Sets the missing heading [0, 360) and speed of `fix` to those from one fix to a later one.
void SetMotion(const StormFix& from, const StormFix& to, StormFix& fix) {
  double distance_m = 0.0;
  double azimuth_deg = 0.0;
  double unused = 0.0;
  GeographicLib::Geodesic::WGS84().Inverse(from.position.latitude, from.position.longitude,
                                           to.position.latitude, to.position.longitude, distance_m,
                                           azimuth_deg, unused);
  const double hours = static_cast<double>(to.time - from.time) / 3600.0;
  const double speed_kmh = distance_m / 1000.0 / hours;
  if (!fix.speed_kmh) fix.speed_kmh = speed_kmh;
  if (!fix.heading_deg && speed_kmh > 0.0) {
    fix.heading_deg = azimuth_deg < 0.0 ? azimuth_deg + 360.0 : azimuth_deg;
  }
  fix.motion_computed = true;
}

}  // namespace

std::string_view ToString(StormGrade value) {
  return internal::NameOf(value, std::array<std::string_view, kStormGradeCount>{
                                     "unknown", "TD", "TS", "STS", "TY", "STY", "SuperTY"});
}

StormGrade GradeOfWind(double wind_mps) {
  const auto reached = std::upper_bound(kLowestWind_mps.begin(), kLowestWind_mps.end(), wind_mps);
  return static_cast<StormGrade>(reached - kLowestWind_mps.begin());
}

double LowestWindOf(StormGrade grade) {
  if (grade == StormGrade::kUnknown) return 0.0;
  return kLowestWind_mps[static_cast<std::size_t>(grade) - 1];
}

const WindRing* StormFix::Ring(std::int32_t wind_kt) const {
  for (const WindRing& ring : rings) {
    if (ring.wind_kt == wind_kt) return &ring;
  }
  return nullptr;
}

std::int32_t DisasterGrade(StormGrade grade) {
  switch (grade) {
    case StormGrade::kSevereTropicalStorm:
      return 2;
    case StormGrade::kTyphoon:
      return 3;
    case StormGrade::kSevereTyphoon:
    case StormGrade::kSuperTyphoon:
      return 4;
    default:
      return 1;
  }
}

void ComputeMotion(std::vector<StormFix>& fixes) {
  for (std::size_t i = 0; i < fixes.size() && fixes.size() > 1; ++i) {
    if (fixes[i].heading_deg && fixes[i].speed_kmh) continue;
    const std::size_t from = std::min(i, fixes.size() - 2);
    SetMotion(fixes[from], fixes[from + 1], fixes[i]);
  }
}

bool AddRing(WindRing ring, std::vector<WindRing>& rings) {
  const auto at =
      std::lower_bound(rings.begin(), rings.end(), ring,
                       [](const WindRing& a, const WindRing& b) { return a.wind_kt < b.wind_kt; });
  if (at != rings.end() && at->wind_kt == ring.wind_kt) return false;
  rings.insert(at, ring);
  return true;
}

}  // namespace aquafarm
