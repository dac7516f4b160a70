// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Numbers and words as text, the same in every locale.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::internal {

/// The shortest decimal text that reads back to the same bits, with a point whatever the locale.
std::string Format(float value);

std::string Format(double value);

std::string Format(std::int32_t value);

std::string Format(std::uint64_t value);

/// Readers of whole texts; false when the text is anything else or does not fit the type.
bool Parse(const std::string& text, float& value);

bool Parse(const std::string& text, double& value);

bool Parse(const std::string& text, std::int32_t& value);

bool Parse(const std::string& text, std::uint64_t& value);

/// The nearest of some names to a mistyped one, or none.
std::optional<std::string> Nearest(const std::string& text, const std::vector<std::string>& names);

/// "a, b, c"
std::string List(const std::vector<std::string>& names);

/// A file's text without the byte order mark that may stand before it.
std::string_view WithoutMark(std::string_view text);

std::string_view Trim(std::string_view text);

std::vector<std::string_view> SplitWords(std::string_view text);

/// Fields between commas, blanks around them taken off.
void SplitFields(std::string_view text, std::vector<std::string_view>& fields);

/// As "'text'", cut when long and without control characters.
std::string Quoted(std::string_view text);

std::string Upper(std::string_view text);

/// A decimal number; none: it is none.
std::optional<double> ParseNumber(std::string_view text);

/// Parses a whole number, with or without '+'; nullopt if `text` is not one.
std::optional<std::int32_t> ParseWhole(std::string_view text);

/// Takes the first line that is not blank off a text and returns it, trimmed; empty at the end of
/// the text.
std::string_view TakeLine(std::string_view& text);

}  // namespace aquafarm::internal
