// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace aquafarm_agents {

/// A file and what changes when it is written again.
struct StampedFile {
  std::string path;
  std::string stamp;  ///< time of change and size; empty: there is no such file
};

StampedFile StampOf(const std::string& path);

/// Returns a file itself, or the files of a folder, the newest first. In a folder, hidden files and
/// files that end in ".part" are incomplete and skipped.
/// @throws InputError if there is neither, or the folder cannot be read
std::vector<StampedFile> NewestFiles(const std::string& path);

}  // namespace aquafarm_agents
