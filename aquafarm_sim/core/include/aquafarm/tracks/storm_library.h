// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Recorded storms near a farm, from which episodes draw one.

#include <cstdint>
#include <string>
#include <vector>

#include "aquafarm/tracks/storm_path.h"
#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// A farm, and the part of a storm that matters to it.
struct StormSite {
  GeoFrame frame;
  double cell_size_m{};
  double step_duration_s{};
  double x{};  ///< middle of the farm [cells]
  double y{};
  double within_km{};   ///< max distance of the closest approach to the middle
  double approach_h{};  ///< from step 0 to the closest approach [hours]
  double before_h{};    ///< kept before the closest approach [hours]
  double after_h{};     ///< kept after it [hours]
};

/// A recorded storm on a farm. Its path has the rings of 64, 50 and 34 kt as circles, and its
/// closest approach to the middle of the farm at approach_h.
struct ArchivedStorm {
  std::string id;
  std::string name;
  std::int32_t year{};  ///< of its closest approach, UTC
  StormPath path;
};

/// Storms for training and for evaluation; no storm is in both.
struct StormLibrary {
  std::vector<ArchivedStorm> training;
  std::vector<ArchivedStorm> evaluation;
};

/// Returns the tracks that come within reach of a site, rounded as in an archive, each with the
/// fixes of the time that matters and one more on both sides. Tracks that it returned are returned
/// unchanged.
std::vector<StormTrack> SelectStorms(const std::vector<StormTrack>& tracks, const StormSite& site);

/// Places a track of SelectStorms at its site.
ArchivedStorm PlaceAtSite(const StormTrack& track, const StormSite& site);

}  // namespace aquafarm
