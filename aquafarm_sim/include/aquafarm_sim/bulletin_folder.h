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

  /// Files that are new or changed since the last look, the oldest first. Hidden files and those
  /// that end in ".part" are still being written. Files that cannot be looked at are passed over.
  /// @throws InputError when there is no such folder
  std::vector<std::string> TakeNew();

 private:
  using Mark = std::pair<std::filesystem::file_time_type, std::uintmax_t>;  // changed, size
  std::string path_;
  std::map<std::string, Mark> seen_;
};

}  // namespace aquafarm_sim
