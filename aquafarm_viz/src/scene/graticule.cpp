// SPDX-License-Identifier: BSD-3-Clause
#include "scene/graticule.h"

#include <cmath>
#include <opencv2/core.hpp>

namespace aquafarm_viz {
namespace {

using aquafarm_msgs::FarmSpec;

// @param start_deg  latitude of the southern edge, or longitude of the western edge, of the farm
// @param length  length of the axis [cells]
std::vector<ArcTick> Ticks(double start_deg, double cells_per_deg, int length, double min_cells) {
  int step = 1;
  for (const int minutes : {1, 2, 5, 10, 15, 30, 60, 120, 300, 600}) {
    step = minutes;
    if (cells_per_deg * minutes / 60.0 >= min_cells) break;
  }
  std::vector<ArcTick> ticks;
  const auto first = static_cast<int>(std::ceil(start_deg * 60.0 / step));
  for (int tick = first;; ++tick) {
    const double at = (tick * step / 60.0 - start_deg) * cells_per_deg;
    if (at > length) return ticks;
    ticks.push_back({tick * step, at});
  }
}

// The following two functions return the length of a degree of latitude, and of a degree of
// longitude, on the ellipsoid of WGS 84 [m]. They use the first two terms of a series. `latitude`
// is in radians.
double LatitudeMetres(double latitude) { return 111132.95 - 559.85 * std::cos(2.0 * latitude); }

double LongitudeMetres(double latitude) {
  return 111412.88 * std::cos(latitude) - 93.5 * std::cos(3.0 * latitude);
}

}  // namespace

bool HasGraticule(const FarmSpec& spec) {
  return spec.has_origin && std::abs(spec.origin_latitude_deg) < 85.0;
}

std::vector<ArcTick> LongitudeTicks(const FarmSpec& spec, double min_cells) {
  const double cells = LongitudeMetres(spec.origin_latitude_deg * CV_PI / 180.0) / spec.cell_size_m;
  return Ticks(spec.origin_longitude_deg - 0.5 / cells, cells, spec.width, min_cells);
}

std::vector<ArcTick> LatitudeTicks(const FarmSpec& spec, double min_cells) {
  const double cells = LatitudeMetres(spec.origin_latitude_deg * CV_PI / 180.0) / spec.cell_size_m;
  return Ticks(spec.origin_latitude_deg - 0.5 / cells, cells, spec.height, min_cells);
}

int CellTickStep(double min_cells) {
  for (int power = 1;; power *= 10) {
    for (const int factor : {1, 2, 5}) {
      if (factor * power >= min_cells) return factor * power;
    }
  }
}

}  // namespace aquafarm_viz
