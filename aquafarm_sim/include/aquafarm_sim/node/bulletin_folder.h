// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aquafarm_sim {

/// A folder that receives bulletins as files.
class BulletinFolder {
 public:
  explicit BulletinFolder(std::string path) : path_(std::move(path)) {}

  /// Returns the paths of the files that are not marked, and of those whose state differs from the
  /// marked one (see Mark). The file with the earliest time of change is the first. Skips
  /// subfolders, hidden files and files that end in ".part", which may be incomplete. Also skips
  /// files whose time or size cannot be read.
  /// @throws InputError if the folder does not exist or cannot be read completely
  std::vector<std::string> New();
  /// Marks a file that the last New() returned, in the state (time of change and size) that New()
  /// found. Later calls of New() return this file only if its state differs from the marked one.
  void Mark(const std::string& path);

 private:
  using State = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // time of change, size
  std::string path_;
  std::map<std::string, State> found_;  // by path, at the last New()
  std::map<std::string, State> marked_;
};

}  // namespace aquafarm_sim
