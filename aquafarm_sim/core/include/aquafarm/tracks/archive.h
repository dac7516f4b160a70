// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Compact text of recorded tracks, the `archive` of a scenario's storms. docs/data.md describes
/// it.
///
///   aquafarm-storms 1
///   # a comment
///   storm 2106 2 CMA | In-Fa
///   202107250600 30 122.2 TY 33 970 34=300,200,200,250 50=100,100,80,100
///
/// A fix has time (UTC), latitude, longitude, grade, wind [m/s] and pressure [hPa], "-" where the
/// source gives none, and the radii [km] of each ring that the source gives.

#include <string>
#include <vector>

#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Rounds what an archive stores to the digits that it stores: positions to 0.001 degrees, winds,
/// pressures and radii to 0.1. Drops what it does not store: motion, forecasts, landfalls.
StormTrack Archived(const StormTrack& track);

/// Writes tracks as the text of an archive. ParseStormFile returns them as Archived does.
/// @param comment lines at the beginning, each without "#"
std::string WriteArchive(const std::vector<StormTrack>& tracks,
                         const std::vector<std::string>& comment = {});

}  // namespace aquafarm
