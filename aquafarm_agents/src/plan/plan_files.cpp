// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/plan/plan_files.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "aquafarm/base/check.h"

namespace aquafarm_agents {
namespace {

namespace fs = std::filesystem;

fs::file_time_type ChangeOf(const fs::path& path) {
  std::error_code gone;
  return fs::last_write_time(path, gone);
}

}  // namespace

StampedFile StampOf(const std::string& path) {
  std::error_code gone;
  const auto size = fs::file_size(path, gone);
  if (gone || !fs::is_regular_file(path, gone)) return {path, ""};
  return {path,
          std::to_string(ChangeOf(path).time_since_epoch().count()) + ":" + std::to_string(size)};
}

std::vector<StampedFile> NewestFiles(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return {StampOf(path)};
  fs::directory_iterator entry(path, error);
  const auto check = [&] {
    if (!error) return;
    throw aquafarm::InputError(path + ": got " + error.message() +
                               ", expected a bulletin or a folder of bulletins");
  };
  check();
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  for (; entry != fs::directory_iterator(); entry.increment(error), check()) {
    const std::string name = entry->path().filename().string();
    if (name[0] == '.' || entry->path().extension() == ".part") continue;
    std::error_code gone;
    if (!entry->is_regular_file(gone) || gone) continue;
    found.emplace_back(ChangeOf(entry->path()), entry->path().string());
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<StampedFile> files;
  for (const auto& [time, file] : found) {
    files.push_back(StampOf(file));
    if (files.back().stamp.empty()) files.pop_back();
  }
  return files;
}

}  // namespace aquafarm_agents
