// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>

namespace aquafarm {

/// Returns the folder of the real data files: AQUAFARM_SHARED_DATA, else shared/data next to the
/// project. Tests that need missing files are skipped.
inline std::filesystem::path SharedData() {
  namespace fs = std::filesystem;
  if (const char* path = std::getenv("AQUAFARM_SHARED_DATA")) return path;
  // Resolves links, because a workspace can contain a link to the project.
  const fs::path core = fs::weakly_canonical(AQUAFARM_CORE_DIR);
  return core.parent_path().parent_path().parent_path() / "shared" / "data";
}

}  // namespace aquafarm
