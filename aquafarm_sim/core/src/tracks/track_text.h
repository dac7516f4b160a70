// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Shared by the readers of tracks: fixes, rings, directions and line-based best tracks.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/tracks/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

/// Max number of fixes of one storm: more than a year of hourly fixes.
inline constexpr std::size_t kMaxFixes = 10000;

/// Lower limit of a plausible pressure; the lowest on record is 870 hPa.
inline constexpr double kMinPressure_hpa = 800.0;

/// Parses tenths of a degree in [-900, 900]. @throws FixError
double ReadLatitudeTenths(std::string_view text, const ParseContext& place);

/// Parses tenths of a degree in [-1800, 3600], normalized to (-180, 180]. @throws FixError
double ReadLongitudeTenths(std::string_view text, const ParseContext& place);

/// Returns the pressure of a storm; nullopt for 0 or less, which mean unknown. Values below 800 hPa
/// are ignored with a warning.
std::optional<double> CheckedPressure(std::optional<double> pressure_hpa,
                                      const std::string& value_path, ParseContext& place);

/// Appends a fix. A fix with the time of the last one is left out with a warning.
/// @throws InputError for too many fixes
void AppendFix(StormFix fix, std::vector<StormFix>& fixes, ParseContext& place);

/// Completes a track: leaves out points that break the order of time, warns about jumps, and
/// computes the motion if the source does not give it.
/// @throws InputError if there are no points, if more points were left out than kept, or if they
///   span more than 366 days
void FinishTrack(StormTrack& track, LeftOut left_out, ParseContext& place);

/// Returns "NE", "ENE", "西北", … as a compass bearing; nullopt if it is not a direction.
std::optional<double> ParseDirection(std::string_view text);

/// Header of a storm in the best tracks of CMA and JMA.
struct BestTrackHeader {
  StormTrack track;
  std::int32_t points{};  ///< number of lines that follow
};

/// Reads storms that consist of a header, 66666 …, and the number of points given there, one per
/// line.
std::vector<StormTrack> ReadBestTracks(std::string_view text, ParseContext& place,
                                       BestTrackHeader (*read_header)(std::string_view line,
                                                                      ParseContext& place),
                                       StormFix (*read_point)(std::string_view line,
                                                              ParseContext& place));

}  // namespace aquafarm::internal
