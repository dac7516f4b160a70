// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// JSON as found in bulletins, notices, weather-service tracks and coasts. The text may start with
/// a byte order mark or be inside a Markdown fence. It may be the value of a JavaScript variable
/// (`let x = …;`), with comments before it. A number may be written as a string. A value is
/// missing if its key is absent, or if the value is null, a blank string or "null".

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "aquafarm/grid/geo_frame.h"
#include "base/text.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

/// Returns whether a text starts with `let`, `var` or `const` and a blank, and contains '='.
bool IsAssignment(std::string_view text);

/// Replaces the byte order mark, the Markdown fence and the JavaScript around a JSON text by
/// blanks. Line numbers stay the same.
std::string CleanJson(const std::string& text);

/// Parses JSON.
/// @throws InputError "file:line: invalid JSON: …"; also for a key that occurs twice in an object,
///   more than 64 nested levels, or a number that a double cannot hold
nlohmann::json ParseJson(const std::string& text, ParseContext& place);

/// Returns whether a value is missing, or is an object whose values are all missing.
bool IsBlank(const nlohmann::json& value);

/// Returns the line of the value at a path such as "[0].points[3].lat". For an object or a list, it
/// is the line of the opening bracket; for other values, the line on which the value ends. If the
/// path does not exist, it is the line of the nearest existing parent.
std::int32_t LineOfJson(const std::string& text, const std::string& path);

/// A JSON object with its path. Each look-up accepts several spellings of a key and uses the first
/// spelling that has a value.
class JsonObject {
 public:
  /// @throws InputError if `value` is not an object
  JsonObject(const nlohmann::json& value, std::string path, ParseContext& place);

  using Keys = std::initializer_list<const char*>;
  /// Returns the value, or nullptr if it is missing.
  const nlohmann::json* Find(Keys keys) const;
  /// Returns the spelling of a key that this object uses: the first one with a value. If all values
  /// are missing, returns the first spelling that the object contains, else the first of `keys`.
  std::string KeyOf(Keys keys) const;
  /// Returns a number; nullopt if it is missing.
  /// @throws InputError if it is not a number in [min, max]
  std::optional<double> Number(Keys keys, double min, double max) const;
  /// Returns a number. @throws InputError if it is missing or not a number in [min, max]
  double NeedNumber(Keys keys, double min, double max) const;
  /// Does the same as Number, but ignores an invalid value, with one warning per key and file.
  std::optional<double> TryNumber(Keys keys, double min, double max) const;
  /// Returns a string, or a number as text; "" if it is missing.
  /// @throws InputError for a value of another type
  std::string Text(Keys keys) const;
  /// Does the same as Text, but ignores a value of another type, with one warning per key and file.
  std::string TryText(Keys keys) const;
  /// Returns UTC seconds since 1970.
  /// @param zone_s offset that applies to a text without a zone [s], positive east of Greenwich
  /// @throws FixError if the time is missing or invalid
  std::int64_t NeedTime(Keys keys, std::int64_t zone_s) const;
  /// Returns a position, with a longitude in (-180, 180].
  /// @throws FixError if the latitude is missing or not in [-90, 90], or the longitude is missing
  ///   or not in [-180, 360]
  GeoPoint NeedPosition(Keys latitude, Keys longitude) const;
  /// Returns a list, or nullptr if it is missing. @throws InputError if it is not a list
  const nlohmann::json* List(Keys keys) const;
  /// Does the same as List, but ignores a value of another type, with one warning per key and file.
  const nlohmann::json* TryList(Keys keys) const;
  /// Sets the position of the parse context to this object and returns the context, so that the
  /// caller can report an error or a warning.
  ParseContext& Here() const;
  const std::string& path() const { return path_; }

 private:
  template <typename Read>
  auto Try(Keys keys, Read read) const -> decltype(read());
  [[noreturn]] void Fail(Keys keys, const nlohmann::json* got, const std::string& expected) const;
  const nlohmann::json& value_;
  std::string path_;
  ParseContext& place_;
};

}  // namespace aquafarm::internal
