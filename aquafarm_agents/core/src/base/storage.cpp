// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/base/storage.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr char kTemporary[] = ".tmp";

// Syncs the folder of a renamed file. The rename must be on disk before the caller removes older
// files. Returns false on error.
bool SyncFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int handle =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool synced = fsync(handle) == 0 || errno == EINVAL;  // not every file system supports it
  close(handle);
  return synced;
}

bool WriteAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

std::string ErrnoText(const std::string& path, const std::string& what) {
  return path + ": " + what + ": " + std::strerror(errno);
}

void WriteFileAtomically(const std::string& path, std::string_view bytes) {
  WriteFileAtomically(path, std::vector<std::string_view>{bytes});
}

void WriteFileAtomically(const std::string& path, const std::vector<std::string_view>& parts) {
  const std::string temporary = path + kTemporary;
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw StorageError(ErrnoText(path, "cannot be written"));
  bool good = std::all_of(parts.begin(), parts.end(),
                          [file](std::string_view part) { return WriteAll(file, part); }) &&
              fsync(file) == 0;
  int error = errno;
  if (close(file) != 0 && good) {
    good = false;
    error = errno;
  }
  if (good && (std::rename(temporary.c_str(), path.c_str()) != 0 || !SyncFolderOf(path))) {
    good = false;
    error = errno;
  }
  if (good) return;
  unlink(temporary.c_str());
  errno = error;
  throw StorageError(ErrnoText(path, "cannot be written"));
}

void RemoveTemporaryFiles(const std::string& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == kTemporary) left.push_back(entry.path());
  }
  for (const std::filesystem::path& path : left) std::filesystem::remove(path, error);
}

std::string ReadFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path + ": is a folder, expected a file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(ErrnoText(path, "cannot be read"));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw InputError(ErrnoText(path, "cannot be read"));
  return text.str();
}

}  // namespace aquafarm::agents
