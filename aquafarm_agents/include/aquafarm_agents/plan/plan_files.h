// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace aquafarm_agents {

/// A file with a stamp that changes when the file is written.
struct StampedFile {
  std::string path;
  std::string stamp;  ///< time of the last change, and size; empty: not an existing regular file
};

/// Returns a file with its current stamp.
StampedFile StampOf(const std::string& path);

/// Returns the file at `path`, or the files of the folder at `path`, the newest first. Subfolders
/// are skipped. Hidden files and files that end in ".part" are skipped in a folder, because they
/// may be incomplete.
/// @throws InputError if `path` is neither a regular file nor a readable folder
std::vector<StampedFile> NewestFiles(const std::string& path);

}  // namespace aquafarm_agents
