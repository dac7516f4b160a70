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

/// Tenths of a degree in [-900, 900]. @throws FixError
double ReadLatitudeTenths(std::string_view text, const ParseContext& place);

/// Tenths of a degree in [-1800, 3600], brought to (-180, 180]. @throws FixError
double ReadLongitudeTenths(std::string_view text, const ParseContext& place);

/// The pressure of a storm; 0 and less mean unknown. Values below 800 hPa are ignored with a
/// warning.
std::optional<double> CheckedPressure(std::optional<double> pressure_hpa,
                                      const std::string& value_path, ParseContext& place);

/// Appends a fix. One with the time of the last is left out with a warning.
/// @throws InputError for too many fixes
void AppendFix(StormFix fix, std::vector<StormFix>& fixes, ParseContext& place);

/// Ends a track: leaves out points that break the order of time, warns of jumps, and computes
/// motion that the source does not give.
/// @throws InputError without points, when more points were left out than kept, or when they span
///   more than 366 days
void FinishTrack(StormTrack& track, LeftOut left_out, ParseContext& place);

/// "NE", "ENE", "西北", … as a compass bearing; none: no direction.
std::optional<double> ParseDirection(std::string_view text);

/// What the header of a storm says in the best tracks of CMA and JMA.
struct BestTrackHeader {
  StormTrack track;
  std::int32_t points{};  ///< lines that follow
};

/// Storms of a header, 66666 …, and as many points as it promises, each on a line of its own.
std::vector<StormTrack> ReadBestTracks(std::string_view text, ParseContext& place,
                                       BestTrackHeader (*read_header)(std::string_view line,
                                                                      ParseContext& place),
                                       StormFix (*read_point)(std::string_view line,
                                                              ParseContext& place));

}  // namespace aquafarm::internal
