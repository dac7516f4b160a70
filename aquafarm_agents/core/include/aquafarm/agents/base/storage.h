// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace aquafarm::agents {

/// Thrown if a file or folder cannot be written, for example because the disk is full, or if a run
/// folder is in use by another process. what() is one readable line.
class StorageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a temporary file next to `path`, syncs it and renames it, so that `path` always contains
/// either the complete old file or the complete new one.
/// @throws StorageError if the file cannot be written. The temporary file is then removed. `path`
///   has the new contents if only the sync of its folder failed, else the old contents
void WriteFileAtomically(const std::string& path, std::string_view bytes);

/// Writes the concatenation of `parts` in the same way. The parts are not joined in memory.
void WriteFileAtomically(const std::string& path, const std::vector<std::string_view>& parts);

/// Removes all files of `folder` that end in ".tmp". WriteFileAtomically leaves such a file if its
/// process is killed. No other process may write to the folder. Errors are ignored.
void RemoveTemporaryFiles(const std::string& folder);

/// Returns the contents of a file. @throws InputError if it does not exist or cannot be read
std::string ReadFile(const std::string& path);

/// Returns an error message that consists of `path`, `what` and the text of errno, for example
/// "runs/x/policy.ckpt: cannot be written: No space left on device".
std::string ErrnoText(const std::string& path, const std::string& what);

}  // namespace aquafarm::agents
