// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The readers of tracks, one for each format. The parse context refuses and warns.

#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/storms/track.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

std::vector<HazardTrack> ReadCma(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadJma(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadAtcf(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadIbtracs(std::string_view text, HazardPlace& place);
std::vector<HazardTrack> ReadBulletin(const std::string& text, HazardPlace& place);
std::vector<HazardTrack> ReadWeatherService(const std::string& text, HazardPlace& place);

}  // namespace aquafarm::internal
