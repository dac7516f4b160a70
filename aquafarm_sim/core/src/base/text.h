// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Formats and parses text, independent of the locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::internal {

/// Returns a short decimal text that Parse converts back to the same value, with a point as decimal
/// separator. For a value that is not finite, returns "nan", "inf" or "-inf", which Parse rejects.
std::string Format(float value);

std::string Format(double value);

std::string Format(std::int32_t value);

std::string Format(std::uint64_t value);

/// Parses a complete text as a number. Returns false and keeps `value` if the text is not a finite
/// number or does not fit the type. Blanks are not accepted; integers must not start with '+'.
bool Parse(const std::string& text, float& value);

bool Parse(const std::string& text, double& value);

bool Parse(const std::string& text, std::int32_t& value);

bool Parse(const std::string& text, std::uint64_t& value);

/// Joins names as "a, b, c".
std::string List(const std::vector<std::string>& names);

/// Returns a file's text without its leading UTF-8 byte order mark, if it has one.
std::string_view WithoutMark(std::string_view text);

/// Returns a text without leading and trailing blanks, tabs and carriage returns.
std::string_view Trim(std::string_view text);

/// Splits a text at blanks, tabs and carriage returns.
std::vector<std::string_view> SplitWords(std::string_view text);

/// Splits a text at commas and trims the fields. Replaces the content of `fields`. An empty text
/// has one empty field.
void SplitFields(std::string_view text, std::vector<std::string_view>& fields);

/// Returns the text in single quotes, for messages. Control characters below U+0020 become '?'. A
/// text of more than 40 bytes is cut after 40 bytes, with "…" at the end.
std::string Quoted(std::string_view text);

/// Returns a text with a-z replaced by A-Z; other characters are kept.
std::string Upper(std::string_view text);

/// Trims a text and parses it as a decimal number, with or without a sign; nullopt if it is not a
/// finite number. "inf" and "nan" are not accepted.
std::optional<double> ParseNumber(std::string_view text);

/// Parses a whole number of 32 bits, with or without a sign; nullopt if `text` is not one. Blanks
/// are not accepted.
std::optional<std::int32_t> ParseWhole(std::string_view text);

/// Returns the first non-blank line of a text, trimmed, and removes it and the lines before it.
/// Returns "" if there is no such line.
std::string_view TakeLine(std::string_view& text);

}  // namespace aquafarm::internal
