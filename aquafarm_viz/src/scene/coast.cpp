// SPDX-License-Identifier: BSD-3-Clause
#include "scene/coast.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

#include "aquafarm/grid/geo_frame.h"
#include "scene/graticule.h"

namespace aquafarm_viz {
namespace {

// For each ring: the number of its corners, then the longitude and the latitude of each corner
// [0.01 degrees].
constexpr std::int16_t kCoast[] = {
#include "../../data/coast.csv"
};

constexpr double kUnit_deg = 0.01;

cv::Rect2d BoxOf(const std::vector<cv::Point2d>& corners) {
  const auto by_x = std::minmax_element(corners.begin(), corners.end(),
                                        [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto by_y = std::minmax_element(corners.begin(), corners.end(),
                                        [](const auto& a, const auto& b) { return a.y < b.y; });
  return {cv::Point2d(by_x.first->x, by_y.first->y), cv::Point2d(by_x.second->x, by_y.second->y)};
}

}  // namespace

std::vector<CoastRing> CoastAround(const aquafarm_msgs::FarmSpec& spec) {
  std::vector<CoastRing> coast;
  if (!HasGraticule(spec)) return coast;
  const aquafarm::GeoFrame frame({spec.origin_latitude_deg, spec.origin_longitude_deg},
                                 spec.cell_size_m);
  for (const std::int16_t* at = std::begin(kCoast); at < std::end(kCoast);) {
    const std::int16_t* const end = at + 1 + 2 * std::ptrdiff_t{*at};
    CoastRing ring;
    for (++at; at < end; at += 2) {
      const aquafarm::GeoPoint point{kUnit_deg * at[1], kUnit_deg * at[0]};
      if (!frame.Faces(point)) continue;
      const auto [x, y] = frame.ToGrid(point);
      ring.corners.emplace_back(x, y);
    }
    if (ring.corners.size() < 3) continue;
    ring.box = BoxOf(ring.corners);
    coast.push_back(std::move(ring));
  }
  return coast;
}

}  // namespace aquafarm_viz
