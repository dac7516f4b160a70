// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Functions that the readers of tracks share.

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

/// Parses a latitude in tenths of a degree, in [-900, 900]. @returns degrees @throws FixError
double ReadLatitudeTenths(std::string_view text, const ParseContext& place);

/// Parses a longitude in tenths of a degree, in [-1800, 3600].
/// @returns degrees in (-180, 180] @throws FixError
double ReadLongitudeTenths(std::string_view text, const ParseContext& place);

/// Returns the pressure of a storm; nullopt if it is 0 or less, which means unknown. Also returns
/// nullopt, with a warning, for other values below 800 hPa.
/// @param value_path path of the value, for messages
std::optional<double> CheckedPressure(std::optional<double> pressure_hpa,
                                      const std::string& value_path, ParseContext& place);

/// Appends a fix. If its time equals that of the last fix, the fix is left out with a warning.
/// @throws InputError if there are more than kMaxFixes fixes
void AppendFix(StormFix fix, std::vector<StormFix>& fixes, ParseContext& place);

/// Completes a track, whose points are its fixes, and its forecasts. Leaves out points that break
/// the order of time. Leaves out points of the track that are more than 30 days from the others, if
/// they are fewer than half. Warns about jumps, and computes motions that the source does not give.
/// Leaves out forecasts without a point after their time of issue, or in which at least half of the
/// points break the order of time.
/// @param left_out points that the reader has left out
/// @throws InputError if there are no points, if the reader has left out more points than it has
///   kept, if at least half of the points break the order of time, or if the points span 367 days
///   or more
void FinishTrack(StormTrack& track, LeftOut left_out, ParseContext& place);

/// Converts a direction such as "NE", "ENE" or "西北" to a compass bearing [degrees]; nullopt if
/// the text is not a direction.
std::optional<double> ParseDirection(std::string_view text);

/// Header of a storm in the best tracks of CMA and JMA.
struct BestTrackHeader {
  StormTrack track;
  std::int32_t points{};  ///< number of points, one per line
};

/// Reads best tracks. Each storm consists of a header line, which starts with 66666 and contains
/// the number of points, and of one line per point.
/// @throws InputError if the lines do not follow this structure
std::vector<StormTrack> ReadBestTracks(std::string_view text, ParseContext& place,
                                       BestTrackHeader (*read_header)(std::string_view line,
                                                                      ParseContext& place),
                                       StormFix (*read_point)(std::string_view line,
                                                              ParseContext& place));

}  // namespace aquafarm::internal
