// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// JSON as found in bulletins. The text may have a byte-order mark or a Markdown fence, or be the
/// value of a JavaScript variable (`let x = …;`, after comments). Numbers may be numbers or text. A
/// missing value may be null, "", "null" or an absent key.

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "aquafarm/grid/geo_frame.h"
#include "base/text.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

/// Returns whether a text starts with `let x = …`, `var x = …` or `const x = …`.
bool IsAssignment(std::string_view text);

/// Removes byte-order mark, Markdown fence and JavaScript from a JSON text. Line numbers stay the
/// same.
std::string CleanJson(const std::string& text);

/// Parses JSON. @throws InputError "file:line: invalid JSON: …", also for a duplicate key in
/// an object
nlohmann::json ParseJson(const std::string& text, ParseContext& place);

/// Returns whether a value is missing: null, a blank text, the text "null", or an object that
/// contains only such values.
bool IsBlank(const nlohmann::json& value);

/// Returns the line on which the value of a path such as "[0].points[3].lat" ends, or on which it
/// begins if it is a list or an object. Returns the line of the nearest existing parent if there is
/// no such value.
std::int32_t LineOfJson(const std::string& text, const std::string& path);

/// A JSON object with its path. Each look-up accepts several spellings of a key and uses the first
/// one that has a value.
class JsonObject {
 public:
  /// @throws InputError if `value` is not an object
  JsonObject(const nlohmann::json& value, std::string path, ParseContext& place);

  using Keys = std::initializer_list<const char*>;
  /// Returns the value, or nullptr if it is missing.
  const nlohmann::json* Find(Keys keys) const;
  /// Returns the spelling used in this object: the key with a value, else a key without a value,
  /// else the first spelling.
  std::string KeyOf(Keys keys) const;
  /// Returns a number; nullopt if it is missing. @throws InputError if it is not in [min, max]
  std::optional<double> Number(Keys keys, double min, double max) const;
  double NeedNumber(Keys keys, double min, double max) const;
  /// As Number; an invalid value is ignored with one warning per key and file.
  std::optional<double> TryNumber(Keys keys, double min, double max) const;
  /// Returns a text, or a number as text; "" if it is missing. @throws InputError
  std::string Text(Keys keys) const;
  /// As Text; anything else is ignored with one warning per key and file.
  std::string TryText(Keys keys) const;
  /// Returns UTC seconds; `zone_s` applies if the text has no zone. @throws FixError
  std::int64_t NeedTime(Keys keys, std::int64_t zone_s) const;
  /// @throws FixError
  GeoPoint NeedPosition(Keys latitude, Keys longitude) const;
  /// Returns a list, or nullptr if it is missing. @throws InputError if it is not a list
  const nlohmann::json* List(Keys keys) const;
  /// As List; anything else is ignored with one warning per key and file.
  const nlohmann::json* TryList(Keys keys) const;
  /// Sets the parse position to this object, for an error or a warning, and returns it.
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
