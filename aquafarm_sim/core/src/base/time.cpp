// SPDX-License-Identifier: BSD-3-Clause
#include "base/time.h"

#include <array>
#include <cstdio>

#include "base/text.h"

namespace aquafarm::internal {
namespace {

// Returns the number of days from 1970-01-01 to a date of the Gregorian calendar, for years from 1.
// Source: Hinnant, https://howardhinnant.github.io/date_algorithms.html (days_from_civil).
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

// Removes up to `max` leading digits from a text and returns their value; nullopt if there are
// fewer than `min` digits.
std::optional<int> TakeDigits(std::string_view& text, std::size_t max, std::size_t min = 1) {
  std::size_t count = 0;
  int value = 0;
  while (count < max && count < text.size() && text[count] >= '0' && text[count] <= '9') {
    value = value * 10 + (text[count++] - '0');
  }
  text.remove_prefix(count);
  if (count < min) return std::nullopt;
  return value;
}

// Removes the first character if `any_of` contains it, and returns whether it did.
bool Take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text[0]) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

// Parses a zone such as "Z", "+08:00" or "+0800" to seconds east of Greenwich. Returns `fallback`
// if the text is empty and nullopt if it is not a zone.
std::optional<std::int64_t> TakeZone(std::string_view text, std::int64_t fallback) {
  if (text.empty()) return fallback;
  if (text == "Z") return 0;
  const bool west = text[0] == '-';
  if (!Take(text, "+-")) return std::nullopt;
  const std::optional<int> hours = TakeDigits(text, 2);
  Take(text, ":");
  const std::optional<int> minutes = TakeDigits(text, 2, 2);
  if (!hours || !minutes || *hours > 14 || *minutes > 59 || !text.empty()) return std::nullopt;
  const std::int64_t zone_s = *hours * 3600 + *minutes * 60;
  return west ? -zone_s : zone_s;
}

}  // namespace

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

std::optional<std::int64_t> ParseDateTime(std::string_view text, std::int64_t zone_s) {
  text = Trim(text);
  std::array<int, 6> part{};
  constexpr std::array<std::string_view, 5> kAfter{"-/", "-/", "T ", ":", ":"};
  for (std::size_t i = 0; i < part.size(); ++i) {
    const std::optional<int> digits = TakeDigits(text, i == 0 ? 4 : 2, i < 4 ? 1 : 2);
    if (!digits) return std::nullopt;
    part[i] = *digits;
    if (i < kAfter.size() && !Take(text, kAfter[i])) {
      if (i < 4) return std::nullopt;
      break;  // the text has no seconds
    }
  }
  const std::optional<std::int64_t> local =
      UtcSeconds(part[0], part[1], part[2], part[3], part[4], part[5]);
  const std::optional<std::int64_t> zone = TakeZone(text, zone_s);
  if (!local || !zone) return std::nullopt;
  return *local - *zone;
}

std::optional<std::int64_t> ParseHour(std::string_view text) {
  const bool digits = text.find_first_not_of("0123456789") == std::string_view::npos;
  if (text.size() != 10 || !digits) return std::nullopt;
  const int year = *TakeDigits(text, 4);
  const int month = *TakeDigits(text, 2);
  const int day = *TakeDigits(text, 2);
  return UtcSeconds(year, month, day, *TakeDigits(text, 2), 0, 0);
}

}  // namespace aquafarm::internal
