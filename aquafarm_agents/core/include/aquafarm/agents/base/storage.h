// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::agents {

/// Thrown when a disk or folder is full, not writable or in use. what() is one readable line.
class StorageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a temporary file next to `path`, syncs it and renames it, so that `path` always contains
/// either the complete old file or the complete new one.
/// @throws StorageError; `path` is then unchanged and the temporary file is removed
void WriteFileAtomically(const std::string& path, std::string_view bytes);

/// Writes the parts one after another, without joining them in memory.
void WriteFileAtomically(const std::string& path, const std::vector<std::string_view>& parts);

/// Removes what WriteFileAtomically leaves in a folder if its process is killed: files that end in
/// ".tmp". Only for folders that no other process writes to. Errors are ignored.
void RemoveTemporaryFiles(const std::string& folder);

/// Contents of a file. @throws InputError if it does not exist or cannot be read
std::string ReadFile(const std::string& path);

/// Error message from errno: "runs/x/policy.ckpt: cannot be written: No space left on device".
std::string ErrnoText(const std::string& path, const std::string& what);

}  // namespace aquafarm::agents
