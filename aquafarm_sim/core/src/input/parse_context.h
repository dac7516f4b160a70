// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Context of a text parser: lines with their numbers, strict parsing of numbers and times, and the
/// position for errors and warnings.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm::internal {

/// Thrown when the time or the position of a point is invalid: the reader leaves out that point and
/// keeps the storm.
class FixError : public InputError {
 public:
  using InputError::InputError;
};

/// The points of one storm that were left out.
struct LeftOut {
  std::size_t count{};
  std::string first;  ///< message about the first of them
};

/// Position of a parser. Reports errors and warnings with the file and the line.
class ParseContext {
 public:
  ParseContext(const std::string& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  std::int32_t line{};  ///< 0: `locate` determines it on demand
  std::string path;     ///< path of a value in JSON, reported before the error
  std::function<std::int32_t(const std::string& path)> locate;
  std::size_t locate_bytes{};  ///< length of the text that `locate` reads

  /// @throws InputError "file:line: what", with a path "file:line: path.what"
  [[noreturn]] void Fail(const std::string& what) const;
  /// @throws InputError "file:line: value_path: what", with the line of that value
  [[noreturn]] void FailValue(const std::string& value_path, const std::string& what) const;
  /// @throws FixError with the message of Fail
  [[noreturn]] void RefuseFix(const std::string& what) const;
  /// @throws FixError with the message of FailValue
  [[noreturn]] void RefuseFixValue(const std::string& value_path, const std::string& what) const;
  void Warn(const std::string& what);
  void WarnValue(const std::string& value_path, const std::string& what);
  /// Adds one warning per `kind`: the first with its line, then the number of later ones.
  void WarnOnce(const std::string& kind, const std::string& what);
  void WarnValueOnce(const std::string& kind, const std::string& value_path,
                     const std::string& what);
  /// As WarnOnce, with the message of an error; `end` states the consequence.
  void WarnOnce(const std::string& kind, const InputError& error, const std::string& end);
  /// Counts a point that is left out and warns about the first one.
  void LeaveOut(const FixError& error, LeftOut& left_out);

 private:
  struct Repeated {
    std::size_t index{};  // index of the warning
    std::size_t more{};   // number of warnings of its kind after the first
    std::string text;
  };
  // Returns true for the second and later ones of a kind, which are counted.
  bool IsRepeated(const std::string& kind);
  void AddFirst(const std::string& kind, std::string text);
  // Returns "file:line: ", with the line of a value in JSON.
  std::string Located(const std::string& value_path) const;
  std::string At(const std::string& what) const;
  std::string AtValue(const std::string& value_path, const std::string& what) const;
  const std::string& file_;
  std::vector<std::string>& warnings_;
  std::map<std::string, Repeated> repeated_;
  mutable std::size_t searches_{};
};

/// Reads one point with `read()`. @returns false if its time or position is invalid: it is left out
template <typename Read>
bool TryFix(Read read, LeftOut& left_out, ParseContext& place) {
  try {
    read();
    return true;
  } catch (const FixError& error) {
    place.LeaveOut(error, left_out);
    return false;
  }
}

/// Iterates over the lines of a text, without CR and LF.
class LineReader {
 public:
  LineReader(std::string_view text, ParseContext& place) : rest_(text), place_(place) {
    place.line = 0;
  }
  /// Reads the next line and sets place.line to its number; returns false at the end of the text.
  bool Next(std::string_view& line);

 private:
  std::string_view rest_;
  ParseContext& place_;
};

/// Parses a whole number in [min, max].
/// @throws InputError "name: got 'x', expected a whole number in …"
std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const ParseContext& place);
/// Parses a decimal number in [min, max]. @throws InputError
double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const ParseContext& place);
/// Parses as ReadWhole does; returns nullopt for a blank text.
std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const ParseContext& place);

/// As ReadWholeOrBlank; an invalid value is ignored with one warning per name and file.
std::optional<std::int32_t> TryWhole(std::string_view text, const char* name, std::int32_t min,
                                     std::int32_t max, ParseContext& place);
/// As TryWhole, for a decimal number.
std::optional<double> TryNumber(std::string_view text, const char* name, double min, double max,
                                ParseContext& place);
/// Ending of the warning about an ignored value.
inline constexpr const char* kIgnored = "; the value is ignored";

/// Parses a whole number of a time or a position. @throws FixError
std::int32_t ReadFixNumber(std::string_view text, const char* name, std::int32_t min,
                           std::int32_t max, const ParseContext& place);

/// Returns UTC seconds of YYYYMMDDHH. @throws FixError for a date that does not exist
std::int64_t ReadHour(std::string_view text, const ParseContext& place);

}  // namespace aquafarm::internal
