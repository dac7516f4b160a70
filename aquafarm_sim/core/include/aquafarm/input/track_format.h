// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aquafarm {

/// The formats of storm tracks that aquafarm reads.
enum class TrackFormat : std::uint8_t {
  kCma,             ///< CMA best track, CHyyyyBST.txt
  kJma,             ///< JMA / RSMC Tokyo best track, bst_*.txt
  kAtcf,            ///< ATCF b-deck, bWPnnyyyy.dat
  kIbtracs,         ///< IBTrACS v04 CSV
  kBulletin,        ///< JSON bulletin, such as that of Zhejiang (key tfbh or tfid)
  kWeatherService,  ///< JSON storm track of a weather service (key track or windRadius30)
  kArchive,         ///< archive of aquafarm (tracks/archive.h)
};
inline constexpr int kTrackFormatCount = 7;
/// Returns the name of the format in messages, such as "JMA best track".
std::string_view ToString(TrackFormat value);

/// Detects the format of a text from its content; nullopt if it is not a file of tracks. CMA and
/// JMA files start with the same word, so the second line decides between them.
std::optional<TrackFormat> DetectTrackFormat(const std::string& text);

}  // namespace aquafarm
