// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads warnings of a weather service (JSON with "warning") and anchorage forecasts of Zhoushan
/// (JSON with "anchors"). Each warning and each period of a forecast becomes a notice: a hazard at
/// a place for a period. docs/data.md lists the fields that are not read.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm {

/// A warning, or an anchorage forecast for a few hours.
struct Notice {
  std::string place;                 ///< anchorage, or the authority of a warning; UTF-8
  std::string what;                  ///< hazard as written, such as "大风"; empty for a forecast
  std::int32_t grade{};              ///< 1 blue … 4 red; 0 for white and for a forecast
  std::int64_t start{};              ///< UTC [s since 1970]
  std::int64_t end{};                ///< UTC, after start
  std::optional<double> wind_mps;    ///< mean wind
  std::optional<double> gust_mps;    ///< max gust
  std::optional<double> wave_max_m;  ///< upper end of the range of wave heights
  std::int32_t suitability{};        ///< worst of the anchorage's ratings, from 4 (suitable) to 1
                                     ///< (severe); 0 if not given
};

struct NoticeFile {
  std::vector<Notice> notices;        ///< in the order of the file
  std::vector<std::string> warnings;  ///< problems in the file, "file:line: …"
};

/// Reads a file of warnings or of anchorage forecasts. Cancelled warnings are left out.
/// @throws InputError "file:line: warning[0].endTime: got '…', expected a time"
NoticeFile LoadNotices(const std::string& path);

/// Reads notices from a text as LoadNotices does. `origin_name` replaces the file name in messages.
NoticeFile ParseNotices(const std::string& text, const std::string& origin_name);

/// Returns a description, such as "大风 of 上海中心气象台, grade 1, from … to …".
std::string Describe(const Notice& notice);

}  // namespace aquafarm
