// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Conversion between text and UTC seconds since 1970.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aquafarm::internal {

/// First and last valid year of a time.
inline constexpr std::int32_t kFirstYear = 1900;
inline constexpr std::int32_t kLastYear = 2200;

/// Formats a time as YYYY-MM-DDTHH:MM:SSZ.
std::string FormatTime(std::int64_t seconds);

bool ParseTime(const std::string& text, std::int64_t& seconds);

/// Returns the UTC seconds since 1970 of a date and time; nullopt if they are invalid.
std::optional<std::int64_t> UtcSeconds(int year, int month, int day, int hour, int minute,
                                       int second);

/// Parses "YYYY-MM-DD HH:MM[:SS]" to UTC seconds; nullopt if `text` is not such a time. Accepts T
/// or a blank, '-' or '/', and one or two digits for month, day and hour. The zone is Z or ±HH:MM;
/// without one it is `zone_s` [s] east of Greenwich.
std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s);

/// Parses YYYYMMDDHH to UTC seconds; nullopt if `text` is not such an hour.
std::optional<std::int64_t> ParseHour(std::string_view text);

}  // namespace aquafarm::internal
