// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Points between the points of a storm track. A storm's radii are not linear in time: they depend
/// on its wind by a root, and a wind of 34 kt that begins or ends has a radius of about 160 km at
/// once. Linear radii between the points of a bulletin, 12 to 24 hours apart, are too small.

#include <cstdint>

#include "aquafarm/tracks/track.h"

namespace aquafarm::agents {

/// Max time between two points of a track with a known wind [s].
inline constexpr std::int64_t kFineTrack_s = 3 * 3600;

/// Returns the track with points at most kFineTrack_s apart. Position and wind of a new point are
/// linear between its neighbours. It has the rings that both of them have, linear as well; its
/// other rings are left to be estimated from its wind. No points are added next to a point without
/// a known wind, or before `from`.
/// @param from UTC [s since 1970]
StormTrack FineTrack(const StormTrack& track, std::int64_t from);

}  // namespace aquafarm::agents
