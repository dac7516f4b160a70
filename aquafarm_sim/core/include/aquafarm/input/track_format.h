// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aquafarm {

enum class HazardFormat : std::uint8_t {
  kCma,             ///< CMA best track, CHyyyyBST.txt
  kJma,             ///< JMA / RSMC Tokyo best track, bst_*.txt
  kAtcf,            ///< ATCF b-deck, bWPnnyyyy.dat
  kIbtracs,         ///< IBTrACS v04 CSV
  kBulletin,        ///< typhoon bulletin, also Zhejiang's (tfbh or tfid, points with radius7…)
  kWeatherService,  ///< storm-track answer of a weather service (track with windRadius30 …)
};
inline constexpr int kHazardFormatCount = 6;
std::string_view ToString(HazardFormat value);

/// The format of a text by its content; none: it is no file of tracks. CMA and JMA files start
/// with the same word and are told apart by the first point.
std::optional<HazardFormat> DetectHazardFormat(const std::string& text);

}  // namespace aquafarm
