// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/storm_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "aquafarm/base/check.h"
#include "aquafarm/tracks/wind_radii.h"

namespace aquafarm {
namespace {

// Returns the waypoints within 60 degrees of the frame's origin.
// @throws InputError if there are no such waypoints, or if they are not consecutive
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

StormPoint ToPoint(const StormWaypoint& from, const StormPath& path, const GeoFrame& frame,
                   double cell_size_m, std::int64_t start_time) {
  StormPoint point;
  const std::array<double, 2> place = frame.ToGrid(from.position);
  point.step = static_cast<double>(from.time - start_time) / path.step_duration_s;
  point.x = place[0];
  point.y = place[1];
  point.latitude = from.position.latitude;
  point.wind_mps = from.wind_mps.value_or(LowestWindOf(from.grade));
  point.averaging_min = from.averaging_min;
  point.grade = from.grade;
  std::copy(from.keeps_radii.begin(), from.keeps_radii.end(), point.keeps_radii.begin());
  point.size = from.size;
  for (std::size_t k = 0; k < path.rings; ++k) {
    point.radius[k] = from.radii_km[k] * 1000.0 / cell_size_m;
    point.median_km[k] =
        EstimateRadius(path.wind_kt[k], point.wind_mps, point.latitude, point.averaging_min)
            .median_km;
    for (std::size_t q = 0; path.by_quadrant && q < kQuadrantCount; ++q) {
      point.quadrants[k][q] = from.quadrants_km[k][q] * 1000.0 / cell_size_m;
    }
  }
  return point;
}

// Sets the direction of motion at each point to the direction from the previous to the next point.
void SetDirections(std::vector<StormPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const StormPoint& from = points[i == 0 ? 0 : i - 1];
    const StormPoint& to = points[std::min(i + 1, points.size() - 1)];
    const double east = to.x - from.x;
    const double north = to.y - from.y;
    const double length = std::sqrt(east * east + north * north);
    if (length <= 0.0) continue;
    points[i].east = east / length;
    points[i].north = north / length;
  }
}

}  // namespace

StormPath ToPath(const StormRings& storm, const GeoFrame& frame, double cell_size_m,
                 double step_duration_s, std::int64_t start_time) {
  AQUAFARM_CHECK_GE(storm.waypoints.size(), 1U);
  AQUAFARM_CHECK_LE(storm.wind_kt.size(), kMaxStormRings);
  StormPath path;
  path.rings = storm.wind_kt.size();
  std::copy(storm.wind_kt.begin(), storm.wind_kt.end(), path.wind_kt.begin());
  path.by_quadrant = !storm.waypoints.front().quadrants_km.empty();
  path.cell_size_km = cell_size_m / 1000.0;
  path.step_duration_s = step_duration_s;
  for (const StormWaypoint& from : Facing(storm, frame)) {
    path.points.push_back(ToPoint(from, path, frame, cell_size_m, start_time));
  }
  SetDirections(path.points);
  return path;
}

PathApproach ClosestApproach(const StormPath& path, double x, double y, double along,
                             double across) {
  AQUAFARM_CHECK_GE(path.points.size(), 1U);
  PathApproach best{0.0, std::numeric_limits<double>::infinity()};
  StormPoint a;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    StormPoint b = path.points[i];
    b.x += along * b.east + across * b.north;
    b.y += along * b.north - across * b.east;
    if (i == 0) a = b;
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double squared = dx * dx + dy * dy;
    const double onto = (x - a.x) * dx + (y - a.y) * dy;
    const double part = squared > 0.0 ? std::clamp(onto / squared, 0.0, 1.0) : 0.0;
    const double east = a.x + part * dx - x;
    const double north = a.y + part * dy - y;
    const double distance = std::sqrt(east * east + north * north);
    if (distance < best.distance) best = {a.step + part * (b.step - a.step), distance};
    a = b;
  }
  return best;
}

}  // namespace aquafarm
