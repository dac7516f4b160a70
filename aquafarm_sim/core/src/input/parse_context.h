// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Context of a text parser: lines with their numbers, strict parsing of numbers and times, and the
/// position for errors and warnings.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::internal {

/// Position of a parser. Reports errors and warnings with the file and the line.
class HazardPlace {
 public:
  HazardPlace(const std::string& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  std::int32_t line{};  ///< 0: `locate` determines it on demand
  std::string path;     ///< path of a value in JSON, reported before the error
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

/// Iterates over the lines of a text, without CR and LF.
class LineReader {
 public:
  LineReader(std::string_view text, HazardPlace& place) : rest_(text), place_(place) {
    place.line = 0;
  }
  /// Reads the next line and sets place.line to its number; returns false at the end of the text.
  bool Next(std::string_view& line);

 private:
  std::string_view rest_;
  HazardPlace& place_;
};

/// Parses a whole number in [min, max].
/// @throws InputError "name: got 'x', expected a whole number in …"
std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const HazardPlace& place);
/// Parses a decimal number in [min, max]. @throws InputError
double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const HazardPlace& place);
/// Parses as ReadWhole does; returns nullopt for a blank text.
std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const HazardPlace& place);

/// Parses YYYYMMDDHH to UTC seconds. @throws InputError for an invalid date
std::int64_t ReadHour(std::string_view text, const HazardPlace& place);

}  // namespace aquafarm::internal
