// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/wind_radii.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "aquafarm/base/check.h"
#include "aquafarm/base/deterministic_math.h"

namespace aquafarm {
namespace {

// Coefficients of one wind. docs/data.md states how each was determined.
struct Relation {
  std::int32_t wind_kt{};
  double cma{};  // coefficient a, one value per authority
  double jma{};
  double jtwc{};
  double by_wind{};                   // b
  double by_latitude{};               // c [1/degree]
  std::array<double, 3> log_sigma{};  // for storms below 48 kt, below 64 kt, and from 64 kt
};

constexpr std::array<Relation, 4> kRelations{{
    {30, 5.29, 5.293, 4.76, 0.494, 0.010, {0.45, 0.41, 0.35}},
    {34, 5.09, 5.089, 4.552, 0.494, 0.010, {0.45, 0.41, 0.35}},
    {50, 4.01, 4.178, 3.80, 0.952, 0.019, {0.43, 0.43, 0.34}},
    {64, 3.51, 3.95, 3.21, 0.952, 0.019, {0.43, 0.43, 0.34}},
}};

const Relation& RelationOf(std::int32_t wind_kt) {
  const auto found =
      std::find_if(kRelations.begin(), kRelations.end(),
                   [wind_kt](const Relation& one) { return one.wind_kt == wind_kt; });
  AQUAFARM_CHECK_LT(found - kRelations.begin(), static_cast<std::ptrdiff_t>(kRelations.size()));
  return *found;
}

}  // namespace

RadiusEstimate EstimateRadius(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                              std::int32_t averaging_min) {
  constexpr double kReaches = 0.98;
  constexpr std::int32_t kJmaAveraging_min = 10;
  constexpr std::int32_t kJtwcAveraging_min = 1;
  const Relation& relation = RelationOf(wind_kt);
  // Rounded to 0.01 kt, because the square root is steep at V = w: the rounding error of a wind
  // that a message stores in single precision would change the radius visibly.
  const double storm_kt = std::round(storm_wind_mps / kMpsPerKnot * 100.0) / 100.0;
  const double ratio = storm_kt / wind_kt;
  if (!(ratio >= kReaches)) return {};
  const double a = averaging_min == kJmaAveraging_min    ? relation.jma
                   : averaging_min == kJtwcAveraging_min ? relation.jtwc
                                                         : relation.cma;
  const std::size_t strength = storm_kt < 48.0 ? 0 : storm_kt < 64.0 ? 1 : 2;
  return {Exp(a + relation.by_wind * std::sqrt(std::max(ratio - 1.0, 0.0)) +
              relation.by_latitude * (std::abs(latitude) - 25.0)),
          relation.log_sigma[strength]};
}

double SizeSigma(std::int32_t wind_kt, double storm_wind_mps, double latitude,
                 std::int32_t averaging_min) {
  // The bound comes first: std::max(bound, NaN) is the bound, std::max(NaN, bound) is NaN.
  const double at_least_mps = std::max(wind_kt * kMpsPerKnot, storm_wind_mps);
  const double sigma = EstimateRadius(wind_kt, at_least_mps, latitude, averaging_min).log_sigma;
  AQUAFARM_CHECK_LT(0.0, sigma);  // callers divide by it, and a ring with radius NaN has no risk
  return sigma;
}

bool EstimateRing(StormFix& fix, std::int32_t wind_kt) {
  if (fix.Ring(wind_kt) != nullptr || !fix.wind_mps || *fix.wind_mps <= 0.0) return false;
  WindRing ring;
  ring.wind_kt = wind_kt;
  ring.radius_km.fill(
      EstimateRadius(wind_kt, *fix.wind_mps, fix.position.latitude, fix.averaging_min).median_km);
  ring.estimated = true;
  return AddRing(ring, fix.rings);
}

}  // namespace aquafarm
