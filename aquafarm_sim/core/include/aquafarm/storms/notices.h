// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads what is announced for a place and a time rather than for a storm: a weather service's
/// warnings (JSON with "warning") and the anchorage forecasts of Zhoushan (JSON with "anchors").
/// Both become notices; docs/data.md says what of them is lost.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aquafarm {

/// A warning, or what is forecast for some hours.
struct Notice {
  std::string place;                 ///< the anchorage, or who warns; UTF-8
  std::string what;                  ///< as written, such as "大风"; empty: a forecast
  std::int32_t grade{};              ///< 1 blue … 4 red; 0: no warning
  std::int64_t start{};              ///< UTC [s since 1970]
  std::int64_t end{};                ///< UTC, after start
  std::optional<double> wind_mps;    ///< mean
  std::optional<double> gust_mps;    ///< greatest
  std::optional<double> wave_max_m;  ///< upper end of the range of wave heights
  std::int32_t suitability{};  ///< of the anchorage: 4 suitable … 1 severe, the worst of the
                               ///< source's four ratings; 0: not said
};

struct NoticeFile {
  std::vector<Notice> notices;        ///< in the order of the file
  std::vector<std::string> warnings;  ///< repairs made: "file:line: what was done"
};

/// Reads either of the two.
/// @throws InputError "file:line: warning[0].endTime: got '…', expected a time"
NoticeFile LoadNotices(const std::string& path);

/// The same for text; `origin_name` stands for the file in messages.
NoticeFile ParseNotices(const std::string& text, const std::string& origin_name);

/// "大风 of 上海中心气象台, grade 1, from … to …", for people.
std::string Describe(const Notice& notice);

}  // namespace aquafarm
