// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Reads and writes complete files.

#include <string>
#include <string_view>

#include "aquafarm/base/check.h"

namespace aquafarm::internal {

/// Rejects an existing path that is not a regular file: reading a pipe would block, and reading a
/// device may never end. Accepts a missing path, because opening the file reports the error.
/// @throws InputError "path: cannot read: not a regular file"
void NeedRegularFile(const std::string& path);

/// Reads a regular file completely.
/// @throws InputError if the file cannot be read or is too large. The limit is 64 MiB for JSON,
///   which takes several times its size in memory, and 512 MiB for other files. A file counts as
///   JSON if its first non-blank character is { or [. (The complete IBTrACS file has about 300
///   MiB.)
std::string ReadTextFile(const std::string& path);

/// Thrown if a file cannot be written.
class WriteError : public InputError {
 public:
  using InputError::InputError;
};

/// Writes a file. Writes to a temporary file first, so that `path` never contains an incomplete
/// file.
/// @throws WriteError "path: cannot be written: reason"
void WriteFile(const std::string& path, std::string_view bytes);

}  // namespace aquafarm::internal
