// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// JSON as bulletins write it: with a byte-order mark or a Markdown fence around it, or as the
/// value of a variable of JavaScript (`let x = …;`, behind comments), numbers as numbers or as
/// text, and nothing said as null, "", "null" or no key at all.

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "aquafarm/grid/geo_frame.h"
#include "base/text.h"
#include "input/parse_context.h"

namespace aquafarm::internal {

/// Whether a text starts as `let x = …`, `var x = …` or `const x = …`.
bool IsAssignment(std::string_view text);

/// A JSON text without byte-order mark, Markdown fence and JavaScript; lines stay where they are.
std::string CleanJson(const std::string& text);

/// @throws InputError "file:line: got no valid JSON: …", also for a key that an object has twice
nlohmann::json ParseJson(const std::string& text, HazardPlace& place);

/// Whether JSON says nothing: null, blank or "null" as text, or an object of nothing else.
bool IsBlank(const nlohmann::json& value);

/// The line on which the value of a path such as "[0].points[3].lat" ends, or a list or an object
/// begins; where there is no such value, that of the nearest parent there is.
std::int32_t LineOfJson(const std::string& text, const std::string& path);

/// A JSON object with its path, and the first of several spellings of a key.
class JsonObject {
 public:
  /// @throws InputError when it is no object
  JsonObject(const nlohmann::json& value, std::string path, HazardPlace& place);

  using Keys = std::initializer_list<const char*>;
  /// The value; null where nothing is said.
  const nlohmann::json* Find(Keys keys) const;
  /// The spelling that is used here: of the value, else of a key without one, else the first.
  std::string KeyOf(Keys keys) const;
  /// @throws InputError when it is no number in [min, max]
  std::optional<double> Number(Keys keys, double min, double max) const;
  double NeedNumber(Keys keys, double min, double max) const;
  /// Text, or a number as such, or "" when nothing is said. @throws InputError
  std::string Text(Keys keys) const;
  /// UTC; `zone_s` where the text has no zone. @throws InputError
  std::int64_t NeedTime(Keys keys, std::int64_t zone_s) const;
  GeoPoint NeedPosition(Keys latitude, Keys longitude) const;
  /// A list, or null. @throws InputError when it is something else
  const nlohmann::json* List(Keys keys) const;
  /// Puts the place on this object, for a refusal or a warning.
  HazardPlace& Here() const;
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void Refuse(Keys keys, const nlohmann::json* got, const std::string& expected) const;
  const nlohmann::json& value_;
  std::string path_;
  HazardPlace& place_;
};

}  // namespace aquafarm::internal
