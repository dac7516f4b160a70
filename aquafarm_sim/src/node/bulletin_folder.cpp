// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/node/bulletin_folder.h"

#include <algorithm>
#include <system_error>

#include "aquafarm/base/check.h"

namespace aquafarm_sim {

std::vector<std::string> BulletinFolder::New() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::directory_iterator entry(path_, error);
  const auto check = [&] {
    if (error) throw aquafarm::InputError(path_ + ": cannot read this folder: " + error.message());
  };
  check();
  std::map<std::string, State> found;
  for (; entry != fs::directory_iterator(); entry.increment(error), check()) {
    const std::string name = entry->path().filename().string();
    if (name[0] == '.' || entry->path().extension() == ".part") continue;
    std::error_code unseen;
    if (!entry->is_regular_file(unseen) || unseen) continue;
    const auto changed = entry->last_write_time(unseen);
    if (unseen) continue;
    const std::uintmax_t size = entry->file_size(unseen);
    if (!unseen) found[entry->path().string()] = {changed, size};
  }
  found_ = std::move(found);
  std::vector<std::pair<State, std::string>> fresh;
  std::map<std::string, State> marked;  // without deleted files
  for (const auto& [path, state] : found_) {
    const auto before = marked_.find(path);
    if (before != marked_.end()) marked.insert(*before);
    if (before == marked_.end() || before->second != state) fresh.emplace_back(state, path);
  }
  marked_ = std::move(marked);
  std::sort(fresh.begin(), fresh.end());
  std::vector<std::string> files;
  files.reserve(fresh.size());
  for (auto& one : fresh) files.push_back(std::move(one.second));
  return files;
}

void BulletinFolder::Mark(const std::string& path) {
  const auto found = found_.find(path);
  if (found != found_.end()) marked_[path] = found->second;
}

}  // namespace aquafarm_sim
