// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Context of a text parser: the current line, strict parsing of numbers and times, and messages
/// with the position of errors and warnings.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm::internal {

/// Thrown if the time or the position of a track point, a landfall or a notice is invalid. Readers
/// of tracks leave out such a point. They reject the file if they leave out more points of a storm
/// than they keep.
class FixError : public InputError {
 public:
  using InputError::InputError;
};

/// Counts the points of one storm that were left out.
struct LeftOut {
  std::size_t count{};
  std::string first;  ///< error message of the first point left out
};

/// Position of a parser. Reports errors and warnings with the file and the line. Keeps at most 100
/// warnings and drops later ones.
class ParseContext {
 public:
  ParseContext(const std::string& file, std::vector<std::string>& warnings)
      : file_(file), warnings_(warnings) {}

  std::int32_t line{};  ///< current line, from 1; 0: messages call `locate`
  /// Path of the current JSON value, for messages; empty if the text is not JSON.
  std::string path;
  /// Function that returns the line of the JSON value at a path; not set if the text is not JSON.
  std::function<std::int32_t(const std::string& path)> locate;
  std::size_t locate_bytes{};  ///< length of the text that `locate` searches

  /// @throws InputError "file:line: what", or "file:line: path.what" if `path` is set
  [[noreturn]] void Fail(const std::string& what) const;
  /// @throws InputError "file:line: value_path: what", with the line of that value
  [[noreturn]] void FailValue(const std::string& value_path, const std::string& what) const;
  /// @throws FixError with the message of Fail
  [[noreturn]] void RefuseFix(const std::string& what) const;
  /// @throws FixError with the message of FailValue
  [[noreturn]] void RefuseFixValue(const std::string& value_path, const std::string& what) const;
  /// Adds a warning with the message of Fail.
  void Warn(const std::string& what);
  /// Adds a warning with the message of FailValue.
  void WarnValue(const std::string& value_path, const std::string& what);
  /// Adds a warning for the first call with a `kind`. Later calls with this kind only update a
  /// count in the text of that warning.
  void WarnOnce(const std::string& kind, const std::string& what);
  /// Does the same as WarnOnce, with the message of FailValue.
  void WarnValueOnce(const std::string& kind, const std::string& value_path,
                     const std::string& what);
  /// Does the same as WarnOnce, with the message of an error followed by `end`, the consequence of
  /// the error.
  void WarnOnce(const std::string& kind, const InputError& error, const std::string& end);
  /// Counts a point that is left out, and calls WarnOnce for the kind "point".
  void LeaveOut(const FixError& error, LeftOut& left_out);

 private:
  struct Repeated {
    std::size_t index{};  // index of the warning
    std::size_t more{};   // number of later calls with its kind
    std::string text;     // text of the warning without the number `more`
  };
  // Returns whether the kind has a warning. If so, counts the call in the text of that warning.
  bool IsRepeated(const std::string& kind);
  // Adds the first warning of a kind.
  void AddFirst(const std::string& kind, std::string text);
  // Returns "file:line: ". If `locate` is set, the line is that of a JSON value. After too many
  // searches, returns "file: ".
  std::string Located(const std::string& value_path) const;
  std::string At(const std::string& what) const;
  std::string AtValue(const std::string& value_path, const std::string& what) const;
  const std::string& file_;
  std::vector<std::string>& warnings_;
  std::map<std::string, Repeated> repeated_;
  mutable std::size_t searches_{};
};

/// Calls `read` to read one point. Returns false if the point is left out because its time or
/// position is invalid (FixError).
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

/// Iterates over the lines of a text, without CR and LF. Sets place.line to the number of the line.
class LineReader {
 public:
  LineReader(std::string_view text, ParseContext& place) : rest_(text), place_(place) {
    place.line = 0;
  }
  /// Reads the next line and increments place.line. Returns false at the end of the text.
  bool Next(std::string_view& line);

 private:
  std::string_view rest_;
  ParseContext& place_;
};

/// Parses a whole number in [min, max]. Blanks around it are ignored.
/// @throws InputError "file:line: name: got 'x', expected a whole number in …"
std::int32_t ReadWhole(std::string_view text, const char* name, std::int32_t min, std::int32_t max,
                       const ParseContext& place);
/// Does the same as ReadWhole, for a decimal number.
double ReadNumber(std::string_view text, const char* name, double min, double max,
                  const ParseContext& place);
/// Does the same as ReadWhole, but returns nullopt for a blank text.
std::optional<std::int32_t> ReadWholeOrBlank(std::string_view text, const char* name,
                                             std::int32_t min, std::int32_t max,
                                             const ParseContext& place);

/// Does the same as ReadWholeOrBlank, but ignores an invalid value, with one warning per name and
/// file.
std::optional<std::int32_t> TryWhole(std::string_view text, const char* name, std::int32_t min,
                                     std::int32_t max, ParseContext& place);
/// Does the same as TryWhole, for a decimal number.
std::optional<double> TryNumber(std::string_view text, const char* name, double min, double max,
                                ParseContext& place);
/// End of the warning about an ignored value.
inline constexpr const char* kIgnored = "; the value is ignored";

/// Does the same as ReadWhole, for a part of a time or a position.
/// @throws FixError instead of InputError
std::int32_t ReadFixNumber(std::string_view text, const char* name, std::int32_t min,
                           std::int32_t max, const ParseContext& place);

/// Parses YYYYMMDDHH to UTC seconds since 1970. @throws FixError if the text is not such an hour
std::int64_t ReadHour(std::string_view text, const ParseContext& place);

}  // namespace aquafarm::internal
