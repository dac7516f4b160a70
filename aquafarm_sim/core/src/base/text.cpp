// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <type_traits>

namespace aquafarm::internal {
namespace {

template <typename T>
std::string FormatReal(T value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  for (int digits = std::numeric_limits<T>::digits10;; ++digits) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << value;
    T back{};
    if (digits >= std::numeric_limits<T>::max_digits10 || (Parse(out.str(), back) && back == value))
      return out.str();
  }
}

// A stream with the classic locale rounds correctly and rejects nan, inf and other decimal
// separators. It also accepts hexadecimal numbers, so they are excluded first.
template <typename T>
bool ParseReal(const std::string& text, T& value) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return false;
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  T parsed{};
  if (!(in >> parsed) || in.peek() != std::istringstream::traits_type::eof()) return false;
  value = parsed;
  return std::isfinite(parsed);
}

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// Parses a complete text. `value` is unchanged if the text is not a number of type T.
template <typename T>
bool ParseAll(std::string_view text, T& value) {
  T parsed{};
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, parsed);
  if (result.ec != std::errc() || result.ptr != end) return false;
  value = parsed;
  return true;
}

// Parses a complete text like ParseAll. Also accepts a leading '+'. Rejects "inf" and "nan".
// Returns nullopt if the text is not a number of type T.
template <typename T>
std::optional<T> ParseSigned(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  if (!ParseAll(text, value)) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

}  // namespace

std::string Format(float value) { return FormatReal(value); }

std::string Format(double value) { return FormatReal(value); }

std::string Format(std::int32_t value) { return std::to_string(value); }

std::string Format(std::uint64_t value) { return std::to_string(value); }

bool Parse(const std::string& text, float& value) { return ParseReal(text, value); }

bool Parse(const std::string& text, double& value) { return ParseReal(text, value); }

bool Parse(const std::string& text, std::int32_t& value) { return ParseAll(text, value); }

bool Parse(const std::string& text, std::uint64_t& value) { return ParseAll(text, value); }

std::string List(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string_view WithoutMark(std::string_view text) {
  return text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0);
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> SplitWords(std::string_view text) {
  std::vector<std::string_view> words;
  for (;;) {
    text = Trim(text);
    if (text.empty()) return words;
    const std::size_t end =
        static_cast<std::size_t>(std::find_if(text.begin(), text.end(), IsBlank) - text.begin());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

void SplitFields(std::string_view text, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t end = text.find(',');
    fields.push_back(Trim(text.substr(0, end)));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kMax = 40;
  std::string quoted = "'";
  for (const char c : text.substr(0, kMax)) {
    quoted += static_cast<unsigned char>(c) < 0x20U ? '?' : c;
  }
  return quoted + (text.size() > kMax ? "…'" : "'");
}

std::string Upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return upper;
}

std::optional<double> ParseNumber(std::string_view text) { return ParseSigned<double>(Trim(text)); }

std::optional<std::int32_t> ParseWhole(std::string_view text) {
  return ParseSigned<std::int32_t>(text);
}

std::string_view TakeLine(std::string_view& text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = Trim(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty()) return line;
  }
  return {};
}

}  // namespace aquafarm::internal
