// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace aquafarm::internal {

void NeedRegularFile(const std::string& path) {
  std::error_code error;  // ignored: opening the file reports the error
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (error || std::filesystem::is_regular_file(status)) return;
  throw InputError(path + ": cannot read: not a regular file");
}

namespace {

// Returns the max size at which a file is read [bytes]. A file whose first non-blank character is {
// or [ counts as JSON, for which the max size is smaller.
std::streamoff SizeLimit(std::ifstream& file) {
  constexpr std::streamoff kMaxBytes = std::streamoff{512} << 20U;
  constexpr std::streamoff kMaxJsonBytes = std::streamoff{64} << 20U;
  file.seekg(0);
  char first = '\0';
  const bool any = static_cast<bool>(file >> std::ws >> first);
  file.clear();
  return any && (first == '{' || first == '[') ? kMaxJsonBytes : kMaxBytes;
}

}  // namespace

std::string ReadTextFile(const std::string& path) {
  NeedRegularFile(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  const std::streamoff limit = size < 0 ? 0 : SizeLimit(file);
  if (size > limit) {
    throw InputError(path + ": got " + std::to_string(size) + " bytes, expected at most " +
                     std::to_string(limit) +
                     " in this format; cut the file to the storms or the area that you need");
  }
  std::string text(static_cast<std::size_t>(std::max<std::streamoff>(size, 0)), '\0');
  file.seekg(0);
  if (size < 0 || !file.read(text.data(), static_cast<std::streamsize>(text.size()))) {
    throw InputError(path +
                     ": cannot read: " + (errno != 0 ? std::strerror(errno) : "ended early"));
  }
  return text;
}

void WriteFile(const std::string& path, std::string_view bytes) {
  const std::string temporary = path + ".part";
  errno = 0;
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error(file ? 0 : (errno != 0 ? errno : EIO), std::generic_category());
  if (file) std::filesystem::rename(temporary, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  throw WriteError(path + ": cannot be written: " + error.message());
}

}  // namespace aquafarm::internal
