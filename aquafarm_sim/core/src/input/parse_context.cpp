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

constexpr std::size_t kMaxWarnings = 100;  // protects against files designed to fill the memory

template <typename T>
std::string NotInRange(std::string_view text, const char* name, T min, T max) {
  return std::string(name) + ": got " + Quoted(text) + ", expected a " +
         (std::is_integral_v<T> ? "whole number" : "number") + " in [" + Format(min) + ", " +
         Format(max) + "]";
}

}  // namespace

std::string ParseContext::Located(const std::string& value_path) const {
  // Each search parses the text again, so only a limited number of messages contain the line.
  constexpr std::size_t kMaxSearches = 200;
  constexpr std::size_t kMaxBytes = std::size_t{128} << 20U;
  if (!locate) return file_ + ":" + std::to_string(line) + ": ";
  ++searches_;
  const bool affordable = searches_ == 1 || searches_ * locate_bytes <= kMaxBytes;
  if (searches_ > kMaxSearches || !affordable) return file_ + ": ";
  return file_ + ":" + std::to_string(locate(value_path)) + ": ";
}
std::string ParseContext::At(const std::string& what) const {
  const bool known = line != 0 || !locate;
  return (known ? file_ + ":" + std::to_string(line) + ": " : Located(path)) + Join(path, what);
}
void ParseContext::Fail(const std::string& what) const { throw InputError(At(what)); }
std::string ParseContext::AtValue(const std::string& value_path, const std::string& what) const {
  return Located(value_path) + (value_path.empty() ? what : value_path + ": " + what);
}
void ParseContext::FailValue(const std::string& value_path, const std::string& what) const {
  throw InputError(AtValue(value_path, what));
}
void ParseContext::RefuseFix(const std::string& what) const { throw FixError(At(what)); }
void ParseContext::RefuseFixValue(const std::string& value_path, const std::string& what) const {
  throw FixError(AtValue(value_path, what));
}
void ParseContext::Warn(const std::string& what) {
  if (warnings_.size() < kMaxWarnings) warnings_.push_back(At(what));
}
void ParseContext::WarnValue(const std::string& value_path, const std::string& what) {
  if (warnings_.size() < kMaxWarnings) warnings_.push_back(AtValue(value_path, what));
}
bool ParseContext::IsRepeated(const std::string& kind) {
  const auto found = repeated_.find(kind);
  if (found == repeated_.end()) return false;
  Repeated& first = found->second;
  ++first.more;
  if (first.index < warnings_.size()) {
    warnings_[first.index] =
        first.text + " (and " + std::to_string(first.more) + " more of this kind in the file)";
  }
  return true;
}
void ParseContext::AddFirst(const std::string& kind, std::string text) {
  repeated_[kind] = {warnings_.size(), 0, text};
  if (warnings_.size() < kMaxWarnings) warnings_.push_back(std::move(text));
}
void ParseContext::WarnOnce(const std::string& kind, const std::string& what) {
  if (!IsRepeated(kind)) AddFirst(kind, At(what));
}
void ParseContext::WarnValueOnce(const std::string& kind, const std::string& value_path,
                                 const std::string& what) {
  if (!IsRepeated(kind)) AddFirst(kind, AtValue(value_path, what));
}
void ParseContext::LeaveOut(const FixError& error, LeftOut& left_out) {
  if (left_out.count++ == 0) left_out.first = error.what();
  WarnOnce("point", error, "; the point is left out");
}
void ParseContext::WarnOnce(const std::string& kind, const InputError& error,
                            const std::string& end) {
  if (!IsRepeated(kind)) AddFirst(kind, error.what() + end);
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
                       const ParseContext& place) {
  text = Trim(text);
  const std::optional<std::int32_t> value = ParseWhole(text);
  if (value && *value >= min && *value <= max) return *value;
  place.Fail(NotInRange(text, name, min, max));
}

double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const ParseContext& place) {
  const std::optional<double> value = ParseNumber(text);
  if (value && *value >= min && *value <= max) return *value;  // false for NaN
  place.Fail(NotInRange(text, name, min, max));
}

std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const ParseContext& place) {
  if (Trim(text).empty()) return std::nullopt;
  return ReadWhole(text, name, min, max, place);
}

std::optional<std::int32_t> TryWhole(std::string_view text, const char* name, std::int32_t min,
                                     std::int32_t max, ParseContext& place) {
  text = Trim(text);
  if (text.empty()) return std::nullopt;
  const std::optional<std::int32_t> value = ParseWhole(text);
  if (value && *value >= min && *value <= max) return value;
  place.WarnOnce(name, NotInRange(text, name, min, max) + kIgnored);
  return std::nullopt;
}

std::optional<double> TryNumber(std::string_view text, const char* name, double min, double max,
                                ParseContext& place) {
  if (Trim(text).empty()) return std::nullopt;
  const std::optional<double> value = ParseNumber(text);
  if (value && *value >= min && *value <= max) return value;  // false for NaN
  place.WarnOnce(name, NotInRange(text, name, min, max) + kIgnored);
  return std::nullopt;
}

std::int32_t ReadFixNumber(std::string_view text, const char* name, std::int32_t min,
                           std::int32_t max, const ParseContext& place) {
  const std::optional<std::int32_t> value = ParseWhole(Trim(text));
  if (value && *value >= min && *value <= max) return *value;
  place.RefuseFix(NotInRange(text, name, min, max));
}

std::int64_t ReadHour(std::string_view text, const ParseContext& place) {
  const std::optional<std::int64_t> time = ParseHour(text);
  if (time) return *time;
  place.RefuseFix("time: got " + Quoted(text) + ", expected an hour of UTC as YYYYMMDDHH");
}

}  // namespace aquafarm::internal
