// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Archive: a compact text of recorded tracks, from which scenarios draw storms. docs/data.md
/// describes the format.
///
///   aquafarm-storms 1
///   # a comment
///   storm 2106 2 CMA | In-Fa
///   202107250600 30 122.2 TY 33 970 34=300,200,200,250 50=100,100,80,100
///
/// A line `storm` has the id, the averaging period of the winds [min], the agency and the name. The
/// next lines are the fixes of the storm. A fix has the time (UTC), latitude, longitude, grade,
/// wind [m/s], pressure [hPa], and the radii [km] of each ring that the source gives. "-" replaces
/// an unknown wind or pressure. A wind such as "<17" is an upper limit.

#include <string>
#include <vector>

#include "aquafarm/tracks/track.h"

namespace aquafarm {

/// Returns a track with the content and the precision of an archive: times in minutes; positions to
/// 0.001 degrees; winds, pressures and radii to 0.1; one averaging period for all fixes. Everything
/// that an archive does not store is left out, such as motion, estimated rings, forecasts and
/// landfalls.
StormTrack Archived(const StormTrack& track);

/// Writes tracks as the text of an archive. ParseStormFile reads these tracks as Archived returns
/// them, and computes their motion.
/// @param comment comment lines after the first line, each without "#"
std::string WriteArchive(const std::vector<StormTrack>& tracks,
                         const std::vector<std::string>& comment = {});

}  // namespace aquafarm
