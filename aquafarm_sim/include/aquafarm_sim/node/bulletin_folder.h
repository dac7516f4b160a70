// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace aquafarm_sim {

/// A folder that bulletins are put into.
class BulletinFolder {
 public:
  explicit BulletinFolder(std::string path) : path_(std::move(path)) {}

  /// Files that are new or changed since they were marked, the oldest first. Hidden files and those
  /// that end in ".part" are still being written. Files that cannot be looked at are passed over.
  /// @throws InputError when there is no such folder, or it cannot be read to its end
  std::vector<std::string> New();
  /// Marks a file of the last New(): it is given again only when it changes after that look.
  void Mark(const std::string& path);

 private:
  using State = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // changed, size
  std::string path_;
  std::map<std::string, State> found_;  // by path, at the last look
  std::map<std::string, State> marked_;
};

}  // namespace aquafarm_sim
