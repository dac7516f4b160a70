// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Suggests a valid name for a mistyped one. Header-only, so that programs that do not link the
/// core can use it.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace aquafarm {

/// Returns the smallest number of characters to insert, remove or replace that turns `a` into `b`
/// (Levenshtein 1966).
inline std::size_t EditDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

/// Returns a name without its hyphens, underscores and blanks.
inline std::string WithoutSeparators(std::string name) {
  const auto is_separator = [](char c) { return c == '-' || c == '_' || c == ' '; };
  name.erase(std::remove_if(name.begin(), name.end(), is_separator), name.end());
  return name;
}

/// Returns " (did you mean 'NAME'?)" with the name that needs the fewest edits. Of several such
/// names it returns the first. Returns "" if every name needs more than two edits, or more edits
/// than half of the length of `text`. Also returns "" if `text` has more than 100 bytes.
/// A difference only in separators counts as no edit: for INFA the suggestion is IN-FA, not LINFA.
inline std::string DidYouMean(const std::string& text, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 100;
  std::size_t limit = std::min<std::size_t>(3, text.size() / 2 + 1);
  std::string words;
  if (text.size() > kLongest) return words;
  for (const std::string& name : names) {
    const bool is_same = WithoutSeparators(text) == WithoutSeparators(name);
    const std::size_t distance = is_same ? 0 : EditDistance(text, name);
    if (name.empty() || distance >= limit) continue;
    limit = distance;
    words = " (did you mean '" + name + "'?)";
  }
  return words;
}

}  // namespace aquafarm
