// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/place_storm.h"

#include <algorithm>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/wind_radii.h"

namespace aquafarm {
namespace {

constexpr double kMinGap_steps = 0.25;  // min time between displaced waypoints

struct PlacedWind {
  double mps{};
  bool changed{};
};

PlacedWind WindOf(const StormPoint& point, const StormErrors& error) {
  const bool changed =
      point.wind_mps > 0.0 && (error.wind_factor != 1.0 || error.wind_add_mps != 0.0);
  if (!changed) return {point.wind_mps, false};
  return {std::max(0.0, point.wind_mps * error.wind_factor + error.wind_add_mps), true};
}

// The placed radius of a ring is its radius at the point times `factor`, plus `added`.
struct PlacedRing {
  double factor{1.0};
  double added{};  // radius of a ring that the point does not have [cells]
};

class RingScale {
 public:
  RingScale(const StormPath& path, const StormPoint& point, PlacedWind wind, double size)
      : path_(path), point_(point), wind_(wind), size_(size) {}

  PlacedRing Ring(std::size_t k) const {
    if (!wind_.changed || (point_.keeps_radii[k] && point_.radius[k] > 0.0)) return {size_, 0.0};
    const double median_km = MedianOf(k);
    if (point_.radius[k] > 0.0 && point_.median_km[k] > 0.0) {
      return {size_ * median_km / point_.median_km[k], 0.0};
    }
    const bool newly_reached = point_.median_km[k] <= 0.0 && median_km > 0.0;
    if (!newly_reached) return {median_km > 0.0 ? size_ : 0.0, 0.0};
    return {0.0, size_ * median_km * AnomalyOutside(k) / path_.cell_size_km};
  }

 private:
  double MedianOf(std::size_t k) const {
    return EstimateRadius(path_.wind_kt[k], wind_.mps, point_.latitude, point_.averaging_min)
        .median_km;
  }
  // Returns the ratio of recorded to estimated radius for the next weaker wind that has both radii.
  // Without such a wind, returns StormPoint::size.
  double AnomalyOutside(std::size_t k) const {
    for (std::size_t outer = k + 1; outer < path_.rings; ++outer) {
      if (point_.median_km[outer] <= 0.0 || point_.radius[outer] <= 0.0) continue;
      return point_.radius[outer] * path_.cell_size_km / point_.median_km[outer];
    }
    return point_.size;
  }

  const StormPath& path_;
  const StormPoint& point_;
  PlacedWind wind_;
  double size_;
};

void SetRadii(const StormPath& path, const StormPoint& point, const RingScale& scale,
              Waypoint& waypoint) {
  waypoint.radii.resize(path.rings);
  waypoint.quadrants.resize(path.by_quadrant ? path.rings : 0);
  QuadrantRadii outside;
  outside.fill(1.0e6F);
  for (std::size_t k = path.rings; k-- > 0;) {  // no ring extends beyond a ring of a weaker wind
    const PlacedRing ring = scale.Ring(k);
    QuadrantRadii placed{};
    for (std::size_t q = 0; q < placed.size(); ++q) {
      const double own = path.by_quadrant ? point.quadrants[k][q] : point.radius[k];
      placed[q] = std::min(static_cast<float>(own * ring.factor + ring.added), outside[q]);
    }
    outside = placed;
    waypoint.radii[k] = *std::max_element(placed.begin(), placed.end());
    if (path.by_quadrant) waypoint.quadrants[k] = placed;
  }
}

void SetRisks(const GradeRisks& risks, std::size_t rings, Waypoint& waypoint) {
  const std::vector<float>& row = risks[static_cast<std::size_t>(waypoint.grade - 1)];
  waypoint.risks.resize(rings);
  for (std::size_t k = 0; k < rings; ++k) {
    const std::size_t weaker = rings - 1 - k;  // rings outside this one
    waypoint.risks[k] = weaker < row.size() ? row[row.size() - 1 - weaker] : row.front();
  }
}

}  // namespace

void StormPlacer::Place(const StormPath& path, const std::vector<StormErrors>& errors,
                        const GradeRisks& risks, std::vector<Waypoint>& waypoints) {
  AQUAFARM_CHECK_EQ(risks.size(), 4U);
  if (errors.size() > 1) AQUAFARM_CHECK_EQ(errors.size(), path.points.size());
  waypoints.reserve(path.points.size());
  while (waypoints.size() > path.points.size()) {
    spare_.push_back(std::move(waypoints.back()));
    waypoints.pop_back();
  }
  while (waypoints.size() < path.points.size()) {
    waypoints.push_back(spare_.empty() ? Waypoint{} : std::move(spare_.back()));
    if (!spare_.empty()) spare_.pop_back();
  }
  static const StormErrors kNone;
  double last = 0.0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const StormPoint& point = path.points[i];
    const StormErrors& error = errors.empty() ? kNone : errors[errors.size() == 1 ? 0 : i];
    Waypoint& waypoint = waypoints[i];
    const double along = error.along_km / path.cell_size_km;
    const double across = error.across_km / path.cell_size_km;
    double step = point.step + error.shift_s / path.step_duration_s;
    if (i > 0 && errors.size() > 1) step = std::max(step, last + kMinGap_steps);
    last = step;
    waypoint.step = static_cast<float>(step);
    waypoint.x = static_cast<float>(point.x + along * point.east + across * point.north);
    waypoint.y = static_cast<float>(point.y + along * point.north - across * point.east);
    const PlacedWind wind = WindOf(point, error);
    waypoint.grade = DisasterGrade(wind.changed ? GradeOfWind(wind.mps) : point.grade);
    SetRadii(path, point, {path, point, wind, error.size_factor}, waypoint);
    SetRisks(risks, path.rings, waypoint);
  }
}

std::vector<Waypoint> StormPlacer::Place(const StormPath& path,
                                         const std::vector<StormErrors>& errors,
                                         const GradeRisks& risks) {
  std::vector<Waypoint> waypoints;
  Place(path, errors, risks, waypoints);
  return waypoints;
}

}  // namespace aquafarm
