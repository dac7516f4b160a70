// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/storms/track.h"

#include <GeographicLib/Geodesic.hpp>
#include <algorithm>
#include <cmath>

#include "aquafarm/base/angle.h"
#include "base/name_of.h"

namespace aquafarm {
namespace {

// Lower limit of each grade from TD on [m/s], GB/T 19201-2006.
constexpr std::array<double, kStormGradeCount - 1> kLowestWind_mps{10.8, 17.2, 24.5,
                                                                   32.7, 41.5, 51.0};

// Bearing [0, 360) and speed from one fix to a later one.
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

// Holland's gradient wind around one fix [m/s], radii in metres.
class HollandProfile {
 public:
  explicit HollandProfile(const StormFix& fix) {
    constexpr double kAmbient_hpa = 1010.0;
    constexpr double kAirDensity = 1.15;  // kg/m3
    constexpr double kEarthRotation = 7.292e-5;
    const double latitude = std::abs(fix.position.latitude);
    const double wind = *fix.wind_mps;
    max_wind_radius_ = 1000.0 * fix.max_wind_radius_km.value_or(
                                    46.4 * std::exp(-0.0155 * wind + 0.0169 * latitude));
    coriolis_ = 2.0 * kEarthRotation * std::sin(latitude * kPi / 180.0);
    cyclostrophic_squared_ = wind * wind + wind * coriolis_ * max_wind_radius_;
    const double drop_pa = 100.0 * (kAmbient_hpa - fix.pressure_hpa.value_or(kAmbient_hpa));
    if (drop_pa > 0.0) {
      shape_ = std::clamp(std::exp(1.0) * kAirDensity * wind * wind / drop_pa, 1.0, 2.5);
    }
  }

  double max_wind_radius() const { return max_wind_radius_; }

  double Wind(double radius) const {
    const double a = std::pow(max_wind_radius_ / radius, shape_);
    const double turning = coriolis_ * radius / 2.0;
    return std::sqrt(cyclostrophic_squared_ * a * std::exp(1.0 - a) + turning * turning) - turning;
  }

 private:
  double max_wind_radius_{};
  double coriolis_{};
  double cyclostrophic_squared_{};
  double shape_{1.3};
};

// Returns the largest radius with this wind, by bisection: outside Rmax the wind only decreases.
double RadiusOf(double wind_mps, const HollandProfile& profile) {
  double inner = profile.max_wind_radius();
  double outer = std::max(2.0e6, 2.0 * inner);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inner + outer);
    (profile.Wind(middle) >= wind_mps ? inner : outer) = middle;
  }
  return inner;
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

bool EstimateRing(StormFix& fix, std::int32_t wind_kt) {
  if (fix.Ring(wind_kt) != nullptr || !fix.wind_mps || *fix.wind_mps <= 0.0) return false;
  const double wind_mps = wind_kt * kMpsPerKnot;
  WindRing ring;
  ring.wind_kt = wind_kt;
  ring.radius_km.fill(*fix.wind_mps >= wind_mps ? RadiusOf(wind_mps, HollandProfile(fix)) / 1000.0
                                                : 0.0);
  ring.estimated = true;
  return AddRing(ring, fix.rings);
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
