// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Conversion of numbers and lists to and from text.

#include <string>
#include <vector>

namespace aquafarm::agents {

/// Parses the complete text as a number.
/// @param what prefix of error messages
/// @throws InputError "gamma: got 'x', expected a number"
double ParseNumber(const std::string& text, const std::string& what);

/// Shortest decimal text that parses back to the same number.
std::string FormatNumber(double value);

/// Time for readers: "3.4 s", "2 min 05 s", "1 h 02 min".
std::string FormatDuration(double seconds);

bool EndsWith(const std::string& text, const std::string& end);

/// Names separated by commas: "a, b, c".
std::string Join(const std::vector<std::string>& names);

}  // namespace aquafarm::agents
