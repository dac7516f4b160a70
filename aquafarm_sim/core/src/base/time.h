// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Times as UTC seconds since 1970, and as text.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aquafarm::internal {

/// The years that a time may lie in.
inline constexpr std::int32_t kFirstYear = 1900;
inline constexpr std::int32_t kLastYear = 2200;

/// YYYY-MM-DDTHH:MM:SSZ
std::string FormatTime(std::int64_t seconds);

bool ParseTime(const std::string& text, std::int64_t& seconds);

/// UTC seconds since 1970 of a date and time; none: there is no such day or hour.
std::optional<std::int64_t> UtcSeconds(int year, int month, int day, int hour, int minute,
                                       int second);

/// UTC seconds of "YYYY-MM-DD HH:MM[:SS]" with T or a blank, '-' or '/', one or two digits of
/// month, day and hour, and Z or ±HH:MM or, without a zone, `zone_s` east of Greenwich; none: it is
/// no such time.
std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s);

/// UTC seconds of YYYYMMDDHH; nullopt if `text` is not such an hour.
std::optional<std::int64_t> ParseHour(std::string_view text);

}  // namespace aquafarm::internal
