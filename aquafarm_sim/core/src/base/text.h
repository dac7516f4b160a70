// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Formatting and parsing of text, independent of the locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::internal {

/// Returns the shortest decimal text that parses back to the same bits. The decimal separator is a
/// point in every locale.
std::string Format(float value);

std::string Format(double value);

std::string Format(std::int32_t value);

std::string Format(std::uint64_t value);

/// Parses a complete text as a number; returns false if it is not a number or does not fit the
/// type.
bool Parse(const std::string& text, float& value);

bool Parse(const std::string& text, double& value);

bool Parse(const std::string& text, std::int32_t& value);

bool Parse(const std::string& text, std::uint64_t& value);

/// Joins names as "a, b, c".
std::string List(const std::vector<std::string>& names);

/// Returns a file's text without a leading byte order mark.
std::string_view WithoutMark(std::string_view text);

std::string_view Trim(std::string_view text);

std::vector<std::string_view> SplitWords(std::string_view text);

/// Splits a text at commas and trims the fields.
void SplitFields(std::string_view text, std::vector<std::string_view>& fields);

/// Returns "'text'", truncated if long and without control characters.
std::string Quoted(std::string_view text);

std::string Upper(std::string_view text);

/// Parses a decimal number; nullopt if `text` is not one.
std::optional<double> ParseNumber(std::string_view text);

/// Parses a whole number, with or without '+'; nullopt if `text` is not one.
std::optional<std::int32_t> ParseWhole(std::string_view text);

/// Removes the first non-blank line from a text and returns it trimmed; empty at the end of the
/// text.
std::string_view TakeLine(std::string_view& text);

}  // namespace aquafarm::internal
