// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bulletin_folder.h"

#include <algorithm>
#include <system_error>

#include "aquafarm/check.h"

namespace aquafarm_sim {

std::vector<std::string> BulletinFolder::TakeNew() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::directory_iterator entries(path_, error);
  if (error) throw aquafarm::InputError(path_ + ": cannot read this folder: " + error.message());
  std::vector<std::pair<Mark, std::string>> found;
  std::map<std::string, Mark> seen;
  for (const fs::directory_entry& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (name[0] == '.' || entry.path().extension() == ".part") continue;
    const bool file = entry.is_regular_file(error) && !error;
    const auto changed = file ? entry.last_write_time(error) : fs::file_time_type();
    const std::uintmax_t size = file && !error ? entry.file_size(error) : 0;
    if (!file || error) continue;
    const Mark mark{changed, size};
    seen[name] = mark;
    const auto before = seen_.find(name);
    if (before == seen_.end() || before->second != mark) {
      found.emplace_back(mark, entry.path().string());
    }
  }
  seen_ = std::move(seen);  // forgets what is gone
  std::sort(found.begin(), found.end());
  std::vector<std::string> files;
  for (auto& one : found) files.push_back(std::move(one.second));
  return files;
}

}  // namespace aquafarm_sim
