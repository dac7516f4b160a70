// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The readers of tracks, one for each format. They add warnings to the parse context, and throw
/// InputError for an invalid file.

#include <array>
#include <string_view>
#include <vector>

#include "aquafarm/input/track_format.h"
#include "aquafarm/tracks/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

std::vector<StormTrack> ReadCma(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadJma(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadAtcf(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadIbtracs(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadArchive(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadBulletin(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadWeatherService(std::string_view text, ParseContext& place);

/// The reader of a format.
struct TrackReader {
  TrackFormat format;
  bool is_json;  ///< whether `read` requires the result of CleanJson
  std::vector<StormTrack> (*read)(std::string_view text, ParseContext& place);
};

inline constexpr std::array<TrackReader, kTrackFormatCount> kTrackReaders{{
    {TrackFormat::kCma, false, ReadCma},
    {TrackFormat::kJma, false, ReadJma},
    {TrackFormat::kAtcf, false, ReadAtcf},
    {TrackFormat::kIbtracs, false, ReadIbtracs},
    {TrackFormat::kBulletin, true, ReadBulletin},
    {TrackFormat::kWeatherService, true, ReadWeatherService},
    {TrackFormat::kArchive, false, ReadArchive},
}};

}  // namespace aquafarm::internal
