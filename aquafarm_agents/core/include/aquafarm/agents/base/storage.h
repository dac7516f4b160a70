// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace aquafarm::agents {

/// Thrown when a disk or folder refuses: full, unwritable, in use. what() is one line for people.
class StorageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes beside, syncs, renames: under `path` there is always a whole file, the old or the new.
/// @throws StorageError; `path` is then as it was and nothing is left beside it
void WriteFileAtomically(const std::string& path, std::string_view bytes);

/// @throws InputError when there is no such file or it cannot be read
std::string ReadFile(const std::string& path);

/// "runs/x/policy.ckpt: cannot be written: No space left on device" from errno.
std::string ErrnoText(const std::string& path, const std::string& what);

}  // namespace aquafarm::agents
