// SPDX-License-Identifier: BSD-3-Clause
#include "scenario/domains.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <locale>
#include <numeric>
#include <sstream>

namespace aquafarm::internal {
namespace {

constexpr std::int32_t kFirstYear = 1900;
constexpr std::int32_t kLastYear = 2200;

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

// A stream of the classic locale rounds correctly and knows no nan, inf or other decimal point;
// hexadecimal it knows.
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

bool IsWhole(const std::string& text, bool minus) {
  const std::size_t first = minus && !text.empty() && text[0] == '-' ? 1 : 0;
  return text.size() > first && text.size() < 22 &&
         text.find_first_not_of("0123456789", first) == std::string::npos;
}

// Days since 1970-01-01 of a date of the Gregorian calendar.
std::int64_t DaysFromCivil(int year, int month, int day) {
  const std::int64_t y = month <= 2 ? year - 1 : year;
  const std::int64_t era = y / 400;
  const std::int64_t year_of_era = y - era * 400;
  const std::int64_t day_of_year = (153 * (month > 2 ? month - 3 : month + 9) + 2) / 5 + day - 1;
  return era * 146097 + year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year -
         719468;
}

bool IsLeap(int year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

int DaysInMonth(int year, int month) {
  constexpr std::array<int, 12> kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && IsLeap(year) ? 1 : 0);
}

std::size_t EditDistance(const std::string& a, const std::string& b) {
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

bool IsUtf8WithoutControls(const std::string& text) {
  std::size_t following = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (following > 0) {
      if ((byte & 0xC0U) != 0x80U) return false;
      --following;
    } else if (byte >= 0x80U) {
      following = byte >= 0xF0U ? 3 : byte >= 0xE0U ? 2 : 1;
      if (byte < 0xC2U || byte > 0xF4U) return false;
    } else if ((byte < 0x20U && c != '\n') || byte == 0x7FU) {
      return false;
    }
  }
  return following == 0;
}

}  // namespace

std::string Format(float value) { return FormatReal(value); }
std::string Format(double value) { return FormatReal(value); }
std::string Format(std::int32_t value) { return std::to_string(value); }
std::string Format(std::uint64_t value) { return std::to_string(value); }

bool Parse(const std::string& text, float& value) { return ParseReal(text, value); }
bool Parse(const std::string& text, double& value) { return ParseReal(text, value); }

bool Parse(const std::string& text, std::int32_t& value) {
  if (!IsWhole(text, true) || text.size() > 11) return false;
  const long long parsed = std::stoll(text);
  if (parsed < std::numeric_limits<std::int32_t>::min() ||
      parsed > std::numeric_limits<std::int32_t>::max()) {
    return false;
  }
  value = static_cast<std::int32_t>(parsed);
  return true;
}

bool Parse(const std::string& text, std::uint64_t& value) {
  if (!IsWhole(text, false)) return false;
  std::uint64_t parsed = 0;
  for (const char c : text) {
    const auto digit = static_cast<std::uint64_t>(c - '0');
    if (parsed > (std::numeric_limits<std::uint64_t>::max() - digit) / 10) return false;
    parsed = parsed * 10 + digit;
  }
  value = parsed;
  return true;
}

std::string FormatTime(std::int64_t seconds) {
  std::int64_t days = seconds / 86400;
  std::int64_t rest = seconds % 86400;
  if (rest < 0) {
    rest += 86400;
    --days;
  }
  int year = static_cast<int>(1970 + days / 366);
  while (DaysFromCivil(year + 1, 1, 1) <= days) ++year;
  while (DaysFromCivil(year, 1, 1) > days) --year;
  int month = 12;
  while (DaysFromCivil(year, month, 1) > days) --month;
  const auto day = static_cast<int>(days - DaysFromCivil(year, month, 1) + 1);
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02d-%02dT%02d:%02d:%02dZ", year, month, day,
                static_cast<int>(rest / 3600), static_cast<int>(rest / 60 % 60),
                static_cast<int>(rest % 60));
  return text.data();
}

bool ParseTime(const std::string& text, std::int64_t& seconds) {
  const std::string form = "dddd-dd-ddTdd:dd:ddZ";
  if (text.size() != form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (form[i] == 'd' ? !digit : text[i] != form[i]) return false;
  }
  const auto part = [&text](std::size_t at, std::size_t n) {
    return std::stoi(text.substr(at, n));
  };
  const std::optional<std::int64_t> utc =
      UtcSeconds(part(0, 4), part(5, 2), part(8, 2), part(11, 2), part(14, 2), part(17, 2));
  if (utc) seconds = *utc;
  return utc.has_value();
}

std::optional<std::int64_t> UtcSeconds(int year, int month, int day, int hour, int minute,
                                       int second) {
  if (year < kFirstYear || year > kLastYear || month < 1 || month > 12) return std::nullopt;
  if (day < 1 || day > DaysInMonth(year, month)) return std::nullopt;
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59 || second < 0 || second > 59) {
    return std::nullopt;
  }
  return DaysFromCivil(year, month, day) * 86400 + hour * 3600 + minute * 60 + second;
}

std::optional<std::string> Nearest(const std::string& text, const std::vector<std::string>& names) {
  std::optional<std::string> best;
  std::size_t least = std::min<std::size_t>(3, text.size() / 2 + 1);
  if (text.size() > 100) return best;
  for (const std::string& name : names) {
    const std::size_t distance = EditDistance(text, name);
    if (distance >= least) continue;
    least = distance;
    best = name;
  }
  return best;
}

std::string List(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void Check(const std::string& path, std::int64_t seconds, UtcTime) {
  static const std::int64_t kFirst = DaysFromCivil(kFirstYear, 1, 1) * 86400;
  static const std::int64_t kEnd = DaysFromCivil(kLastYear + 1, 1, 1) * 86400;
  if (seconds >= kFirst && seconds < kEnd) return;
  throw FieldError(path, "got " + std::to_string(seconds) + " s since 1970, expected a year in [" +
                             Format(kFirstYear) + ", " + Format(kLastYear) + "]");
}

void Check(const std::string& path, float value, NumberOrNone) {
  if (std::isinf(value)) throw FieldError(path, "got infinity, expected a number or .nan");
}

void Check(const std::string& path, const std::string& value, const TextOf& domain) {
  if (value.size() < domain.min_bytes || value.size() > domain.max_bytes) {
    throw FieldError(path, "got a text of " + std::to_string(value.size()) + " bytes, expected [" +
                               std::to_string(domain.min_bytes) + ", " +
                               std::to_string(domain.max_bytes) + "]");
  }
  if (!IsUtf8WithoutControls(value)) {
    throw FieldError(path,
                     "got control characters or bytes that are no UTF-8, expected plain text");
  }
}

}  // namespace aquafarm::internal
