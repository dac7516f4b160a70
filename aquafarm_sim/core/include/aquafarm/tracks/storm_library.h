// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Recorded storms near a farm. Episodes draw their storms from them.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// A farm, and the limits in space and time of the storms that are selected for it.
struct StormSite {
  GeoFrame frame;
  double cell_size_m{};
  double step_duration_s{};
  double x{};  ///< middle of the farm [cells]
  double y{};
  double within_km{};   ///< max distance of the closest approach to the middle
  double approach_h{};  ///< time from step 0 to the closest approach [hours]
  double before_h{};    ///< part of a track to keep before the closest approach [hours]
  double after_h{};     ///< part of a track to keep after the closest approach [hours]
};

/// A recorded storm on a farm. The rings of its path are circles of 64, 50 and 34 kt. The storm is
/// closest to the middle of the farm StormSite::approach_h hours after step 0 of the path.
struct ArchivedStorm {
  std::string id;
  std::string name;
  std::int32_t year{};  ///< year of the closest approach, UTC
  StormPath path;
};

/// Storms for training and for evaluation; no storm is in both.
struct StormLibrary {
  std::vector<ArchivedStorm> training;
  std::vector<ArchivedStorm> evaluation;
};

/// Selects the tracks whose closest approach to the middle of a site is within site.within_km, and
/// rounds them as in an archive. Keeps the fewest fixes of each track that cover the period from
/// `before_h` hours before the closest approach until `after_h` hours after it, as far as the track
/// covers this period. Leaves out a track if fewer than two fixes are kept, or if its rings have
/// radius 0 at all kept fixes. Applied to its own result, the function returns it unchanged.
std::vector<StormTrack> SelectStorms(const std::vector<StormTrack>& tracks, const StormSite& site);

/// Converts a track of SelectStorms to a storm on the farm of the site.
ArchivedStorm PlaceAtSite(const StormTrack& track, const StormSite& site);

}  // namespace aquafarm
