// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where a reader of text stands: its lines with their numbers, strict numbers and times, and the
/// place that a refusal or a warning names.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::internal {

/// Where a reader stands: it refuses and warns in the name of a file and a line.
class HazardPlace {
 public:
  HazardPlace(const std::string& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  std::int32_t line{};  ///< 0: `locate` finds it when it is asked for
  std::string path;     ///< of a value in JSON, said before what is wrong
  std::function<std::int32_t(const std::string& path)> locate;

  /// @throws InputError "file:line: what", with a path "file:line: path.what"
  [[noreturn]] void Refuse(const std::string& what) const;
  /// @throws InputError "file:line: value_path: what", with the line of that value
  [[noreturn]] void RefuseValue(const std::string& value_path, const std::string& what) const;
  void Warn(const std::string& what);
  void WarnValue(const std::string& value_path, const std::string& what);

 private:
  std::string At(const std::string& what) const;
  std::string AtValue(const std::string& value_path, const std::string& what) const;
  const std::string& file_;
  std::vector<std::string>& warnings_;
};

/// The lines of a text, one by one, without CR and LF.
class LineReader {
 public:
  LineReader(std::string_view text, HazardPlace& place) : rest_(text), place_(place) {
    place.line = 0;
  }
  /// False at the end of the text. Puts place.line on the line it gives.
  bool Next(std::string_view& line);

 private:
  std::string_view rest_;
  HazardPlace& place_;
};

/// A whole number in [min, max]. @throws InputError "name: got 'x', expected a whole number in …"
std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const HazardPlace& place);
/// A decimal number in [min, max].
double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const HazardPlace& place);
/// As ReadWhole, none for a blank text.
std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const HazardPlace& place);

/// UTC seconds of YYYYMMDDHH. @throws InputError for a date that is not
std::int64_t ReadHour(std::string_view text, const HazardPlace& place);

}  // namespace aquafarm::internal
