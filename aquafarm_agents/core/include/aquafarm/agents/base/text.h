// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Conversion between numbers and text, and other functions on text.

#include <string>
#include <vector>

namespace aquafarm::agents {

/// Parses `text` as a finite number.
/// @param what prefix of error messages
/// @throws InputError "gamma: got 'x', expected a number" if `text` is not a finite number
double ParseNumber(const std::string& text, const std::string& what);

/// Returns the shortest decimal text that parses back to the same number.
std::string FormatNumber(double value);

/// Returns a duration as text for people: "3.4 s", "2 min 05 s", "1 h 02 min".
std::string FormatDuration(double seconds);

/// Returns whether `text` ends with `end`.
bool EndsWith(const std::string& text, const std::string& end);

/// Returns the names separated by commas: "a, b, c".
std::string Join(const std::vector<std::string>& names);

}  // namespace aquafarm::agents
