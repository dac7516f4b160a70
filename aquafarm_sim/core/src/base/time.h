// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Converts between text and UTC seconds since 1970.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aquafarm::internal {

/// First and last year that the parsers below accept.
inline constexpr std::int32_t kFirstYear = 1900;
inline constexpr std::int32_t kLastYear = 2200;

/// Formats UTC seconds since 1970 as YYYY-MM-DDTHH:MM:SSZ.
std::string FormatTime(std::int64_t seconds);

/// Parses YYYY-MM-DDTHH:MM:SSZ to UTC seconds since 1970. Returns false and keeps `seconds` if the
/// text has another form or is not a valid time.
bool ParseTime(const std::string& text, std::int64_t& seconds);

/// Returns the UTC seconds since 1970 of a date and time. Returns nullopt if they do not exist or
/// the year is not in [kFirstYear, kLastYear].
std::optional<std::int64_t> UtcSeconds(int year, int month, int day, int hour, int minute,
                                       int second);

/// Parses "YYYY-MM-DD HH:MM[:SS]" with an optional zone to UTC seconds since 1970; nullopt if
/// `text` is not such a time. Accepts '/' for '-', T for the blank, and one digit for month, day
/// and hour. The zone follows without a blank: Z, ±HH:MM, ±H:MM or ±HHMM, with at most 14 hours.
/// @param zone_s UTC offset of a text without a zone [s], positive east of Greenwich
std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s);

/// Parses YYYYMMDDHH to UTC seconds since 1970; nullopt if `text` is not such an hour.
std::optional<std::int64_t> ParseHour(std::string_view text);

}  // namespace aquafarm::internal
