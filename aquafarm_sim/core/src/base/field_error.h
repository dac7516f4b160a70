// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "aquafarm/base/check.h"

namespace aquafarm::internal {

/// Thrown for an invalid value at a key, such as "disasters[0].grade". The YAML reader adds the
/// file and the line to the message.
class FieldError : public InputError {
 public:
  FieldError(std::string field_path, const std::string& text)
      : InputError(field_path.empty() ? text : field_path + ": " + text),
        path(std::move(field_path)) {}
  const std::string path;
};

/// Returns "path.key", or `key` if the path is empty.
inline std::string Join(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}
/// Returns "path[index]".
inline std::string At(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

}  // namespace aquafarm::internal
