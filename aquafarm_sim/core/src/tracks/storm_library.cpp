// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/tracks/storm_library.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "aquafarm/base/angle.h"
#include "aquafarm/tracks/archive.h"
#include "base/text.h"
#include "base/time.h"
#include "tracks/interpolate.h"

namespace aquafarm {
namespace {

using internal::kHour_s;

// Winds of the rings of every archived storm, independent of its source.
const std::vector<std::int32_t> kWinds_kt{64, 50, 34};

// Converts a track to a path whose steps are counted from 1970, so that they do not depend on the
// fixes that are kept.
StormPath PathOf(const StormTrack& track, const StormSite& site) {
  return ToPath(ToRings(track, RingReduction::kEqualArea, kWinds_kt), site.frame, site.cell_size_m,
                site.step_duration_s, 0);
}

// Returns false if a track certainly does not come within `within_km` of `middle`. This fast test
// avoids the projection of most tracks. It assumes that successive fixes are less than kMargin_km
// apart.
bool MayComeNear(const StormTrack& track, const GeoPoint& middle, double within_km) {
  constexpr double kMargin_km = 2000.0;
  constexpr double kKmPerDegree = 111.2;
  const double by_longitude = std::cos(middle.latitude * kRadiansPerDegree);
  return std::any_of(track.fixes.begin(), track.fixes.end(), [&](const StormFix& fix) {
    const double north = std::abs(fix.position.latitude - middle.latitude);
    const double turn = std::abs(fix.position.longitude - middle.longitude);
    const double east = std::min(turn, 360.0 - turn) * by_longitude;
    return std::max(north, east) * kKmPerDegree <= within_km + kMargin_km;
  });
}

// Returns the first uninterrupted part of a track on the farm's side of the globe, as ToPath
// requires; nullopt if it has fewer than two fixes.
std::optional<StormTrack> Near(const StormTrack& track, const StormSite& site) {
  const auto faces = [&site](const StormFix& fix) { return site.frame.Faces(fix.position); };
  const auto first = std::find_if(track.fixes.begin(), track.fixes.end(), faces);
  const auto last = std::find_if_not(first, track.fixes.end(), faces);
  if (last - first < 2) return std::nullopt;
  StormTrack near = track;
  near.fixes.assign(first, last);
  return near;
}

void Trim(const StormSite& site, double approach_s, std::vector<StormFix>& fixes) {
  const double first = approach_s - site.before_h * kHour_s;
  const double last = approach_s + site.after_h * kHour_s;
  std::size_t from = 0;
  while (from + 1 < fixes.size() && static_cast<double>(fixes[from + 1].time) <= first) ++from;
  std::size_t to = fixes.size();
  while (to > from + 1 && static_cast<double>(fixes[to - 2].time) >= last) --to;
  fixes = {fixes.begin() + static_cast<std::ptrdiff_t>(from),
           fixes.begin() + static_cast<std::ptrdiff_t>(to)};
}

// Returns whether the storm has a ring. A storm whose winds never reach 34 kt has none.
bool HasRing(const StormPath& path) {
  return std::any_of(path.points.begin(), path.points.end(), [](const StormPoint& point) {
    return *std::max_element(point.radius.begin(), point.radius.end()) > 0.0;
  });
}

}  // namespace

std::vector<StormTrack> SelectStorms(const std::vector<StormTrack>& tracks, const StormSite& site) {
  std::vector<StormTrack> selected;
  const GeoPoint middle = site.frame.ToGeo(site.x, site.y);
  for (const StormTrack& track : tracks) {
    if (!MayComeNear(track, middle, site.within_km)) continue;
    std::optional<StormTrack> near = Near(Archived(track), site);
    if (!near) continue;
    const PathApproach approach = ClosestApproach(PathOf(*near, site), site.x, site.y);
    if (approach.distance * site.cell_size_m > site.within_km * 1000.0) continue;
    Trim(site, approach.step * site.step_duration_s, near->fixes);
    if (near->fixes.size() >= 2 && HasRing(PathOf(*near, site)))
      selected.push_back(std::move(*near));
  }
  return selected;
}

ArchivedStorm PlaceAtSite(const StormTrack& track, const StormSite& site) {
  ArchivedStorm storm;
  storm.id = track.id;
  storm.name = track.name;
  storm.path = PathOf(track, site);
  const double approach = ClosestApproach(storm.path, site.x, site.y).step;
  const auto approach_s = static_cast<std::int64_t>(approach * site.step_duration_s);
  storm.year = internal::ParseWhole(internal::FormatTime(approach_s).substr(0, 4)).value_or(0);
  const double at = site.approach_h * kHour_s / site.step_duration_s;
  for (StormPoint& point : storm.path.points) point.step += at - approach;
  return storm;
}

}  // namespace aquafarm
