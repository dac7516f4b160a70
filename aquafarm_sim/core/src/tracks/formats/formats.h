// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The readers of tracks, one for each format. They report errors and warnings to the parse
/// context.

#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/tracks/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

std::vector<StormTrack> ReadCma(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadJma(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadAtcf(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadIbtracs(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadArchive(std::string_view text, ParseContext& place);
std::vector<StormTrack> ReadBulletin(const std::string& text, ParseContext& place);
std::vector<StormTrack> ReadWeatherService(const std::string& text, ParseContext& place);

}  // namespace aquafarm::internal
