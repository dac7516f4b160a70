// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Numbers and lists as text.

#include <string>
#include <vector>

namespace aquafarm::agents {

/// Reads a whole text as a number. @throws InputError "discount: got 'x', expected a number"
double ParseNumber(const std::string& text, const std::string& what);

/// The shortest decimal text that reads back to the same number.
std::string FormatNumber(double value);

/// "a, b, c"
std::string Join(const std::vector<std::string>& names);

}  // namespace aquafarm::agents
