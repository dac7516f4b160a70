// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace aquafarm_agents {

/// A file with a stamp that changes when the file is written.
struct StampedFile {
  std::string path;
  std::string stamp;  ///< time of the last change, and size; empty: there is no such file
};

/// Returns a file with its current stamp.
StampedFile StampOf(const std::string& path);

/// Returns the file at `path`, or the files of the folder at `path`, the newest first. In a folder,
/// hidden files and files that end in ".part" are incomplete and skipped.
/// @throws InputError if `path` does not exist, or the folder cannot be read
std::vector<StampedFile> NewestFiles(const std::string& path);

}  // namespace aquafarm_agents
