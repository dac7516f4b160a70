// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the readers of tracks share: fixes, rings, directions and best tracks of lines.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/storms/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

/// Most fixes of one storm: a year of hourly ones.
inline constexpr std::size_t kMaxFixes = 10000;

/// No storm's was ever below 870.
inline constexpr double kLeastPressure_hpa = 800.0;

/// Tenths of a degree, at most 90 either way. @throws InputError
double ReadLatitudeTenths(std::string_view text, const HazardPlace& place);

/// Tenths of a degree up to 3600, brought to (-180, 180]. @throws InputError
double ReadLongitudeTenths(std::string_view text, const HazardPlace& place);

/// Adds a fix after the ones there. A time that is there already is left out with a warning.
/// @throws InputError for a time before the last, or too many fixes
void AppendFix(HazardFix fix, std::vector<HazardFix>& fixes, HazardPlace& place);

/// Ends a track: checks that it has fixes, computes what motion the source does not give.
void FinishTrack(HazardTrack& track, const HazardPlace& place);

/// "NE", "ENE", "西北", … as a compass bearing; none: no direction.
std::optional<double> ParseDirection(std::string_view text);

/// What the header of a storm says in the best tracks of CMA and JMA.
struct BestTrackHeader {
  HazardTrack track;
  std::int32_t points{};  ///< lines that follow
};

/// Storms of a header, 66666 …, and as many points as it promises, each on a line of its own.
std::vector<HazardTrack> ReadBestTracks(std::string_view text, HazardPlace& place,
                                        BestTrackHeader (*read_header)(std::string_view line,
                                                                       const HazardPlace& place),
                                        HazardFix (*read_point)(std::string_view line,
                                                                const HazardPlace& place));

}  // namespace aquafarm::internal
