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

/// Returns the edit distance (Levenshtein 1966): the smallest number of insertions, removals and
/// replacements of one byte that turn `a` into `b`.
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

/// Returns " (did you mean 'NAME'?)" with the name that has the smallest EditDistance from `text`;
/// the first of several such names. A name that differs from `text` only in separators counts as
/// distance 0: for INFA the suggestion is IN-FA, not LINFA. Returns "" if the smallest distance is
/// above 2 or above half of the length of `text`, or if `text` has more than 100 bytes.
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
