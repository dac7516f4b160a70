// SPDX-License-Identifier: BSD-3-Clause
#include "input/parse_context.h"

#include <charconv>
#include <utility>

#include "aquafarm/base/check.h"
#include "base/field_error.h"
#include "base/text.h"
#include "base/time.h"

namespace aquafarm::internal {
namespace {

constexpr std::size_t kMostWarnings = 100;  // protects against files designed to fill the memory

[[noreturn]] void RefuseNumber(std::string_view text, const char* name, const char* kind,
                               const std::string& min, const std::string& max,
                               const HazardPlace& place) {
  place.Refuse(std::string(name) + ": got " + Quoted(text) + ", expected a " + kind + " in [" +
               min + ", " + max + "]");
}

}  // namespace

std::string HazardPlace::At(const std::string& what) const {
  const std::int32_t where = line == 0 && locate ? locate(path) : line;
  return file_ + ":" + std::to_string(where) + ": " + Join(path, what);
}
void HazardPlace::Refuse(const std::string& what) const { throw InputError(At(what)); }
std::string HazardPlace::AtValue(const std::string& value_path, const std::string& what) const {
  const std::int32_t where = locate ? locate(value_path) : line;
  return file_ + ":" + std::to_string(where) + ": " +
         (value_path.empty() ? what : value_path + ": " + what);
}
void HazardPlace::RefuseValue(const std::string& value_path, const std::string& what) const {
  throw InputError(AtValue(value_path, what));
}
void HazardPlace::Warn(const std::string& what) {
  if (warnings_.size() < kMostWarnings) warnings_.push_back(At(what));
}
void HazardPlace::WarnValue(const std::string& value_path, const std::string& what) {
  if (warnings_.size() < kMostWarnings) warnings_.push_back(AtValue(value_path, what));
}

bool LineReader::Next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++place_.line;
  return true;
}

std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const HazardPlace& place) {
  text = Trim(text);
  const std::optional<std::int32_t> value = ParseWhole(text);
  if (value && *value >= min && *value <= max) return *value;
  RefuseNumber(text, name, "whole number", Format(min), Format(max), place);
}

double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const HazardPlace& place) {
  const std::optional<double> value = ParseNumber(text);
  if (value && *value >= min && *value <= max) return *value;  // false for NaN
  RefuseNumber(text, name, "number", Format(min), Format(max), place);
}

std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const HazardPlace& place) {
  if (Trim(text).empty()) return std::nullopt;
  return ReadWhole(text, name, min, max, place);
}

std::int64_t ReadHour(std::string_view text, const HazardPlace& place) {
  const std::optional<std::int64_t> time = ParseHour(text);
  if (time) return *time;
  place.Refuse("time: got " + Quoted(text) + ", expected an hour of UTC as YYYYMMDDHH");
}

}  // namespace aquafarm::internal
