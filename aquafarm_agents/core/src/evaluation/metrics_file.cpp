// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/metrics_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <type_traits>
#include <utility>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 16U;
constexpr const char* kFreeSpace = "; free disk space or correct the permissions, then resume";
constexpr const char* kRestore = "; restore the file, or train in another folder";

template <typename T>
void Put(T value, std::string& text) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  text.append(digits, static_cast<std::size_t>(end - digits));
}

void Put(EndReason reason, std::string& text) { text += ToString(reason); }

// Returns the leading columns, which are the same in files of all versions.
std::string FirstColumns() {
  return "number,total_steps," + EpisodeColumns() + ",exploration,learning_rate,loss";
}

}  // namespace

std::string EpisodeColumns() {
  std::string names = "farm,";
  VisitEpisodeFields([&names](const EpisodeField& field) {
    if (!field.is_added) names += std::string(field.column) + ',';
  });
  return names + "success";
}

std::string AddedColumns() {
  std::string names;
  VisitEpisodeFields([&names](const EpisodeField& field) {
    if (field.is_added) names += std::string(",") + field.column;
  });
  return names;
}

void AppendEpisode(const EpisodeSummary& result, std::string& text) {
  Put(result.farm, text);
  VisitEpisodeFields(
      [&text](const EpisodeField& field, auto value) {
        if (field.is_added) return;
        text += ',';
        Put(value, text);
      },
      result);
  text += result.Success() ? ",1" : ",0";
}

void AppendAdded(const EpisodeSummary& result, std::string& text, std::size_t count) {
  VisitEpisodeFields(
      [&text, &count](const EpisodeField& field, auto value) {
        if (!field.is_added || count == 0) return;
        --count;
        text += ',';
        Put(value, text);
      },
      result);
}

namespace {

// Returns how many of AddedColumns a file has after FirstColumns. @throws InputError if the file
// has other columns
std::size_t CountAdded(const std::string& path) {
  std::ifstream file(path);
  if (!file) return 0;  // the constructor reports the error when it opens the file
  std::string columns;
  std::getline(file, columns);
  const std::string first = FirstColumns();
  const std::string all = first + AddedColumns() + ',';
  const bool has_first = columns.compare(0, first.size(), first) == 0;
  if (!has_first || all.compare(0, columns.size() + 1, columns + ',') != 0) {
    throw InputError(path + ":1: got the columns '" + columns + "', expected '" + first +
                     "', alone or followed by leading columns of '" + AddedColumns() +
                     "'; resume with the version that began this run, or train in another folder");
  }
  return static_cast<std::size_t>(
      std::count(columns.begin() + static_cast<std::ptrdiff_t>(first.size()), columns.end(), ','));
}

}  // namespace

MetricsFile::MetricsFile(std::string path) : path_(std::move(path)) {
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) {
    throw StorageError(ErrnoText(path_, "cannot be written") +
                       "; free disk space or correct the permissions");
  }
  buffer_ = FirstColumns() + AddedColumns() + "\n";
  buffer_.reserve(2 * kFlushBytes);
}

MetricsFile::MetricsFile(std::string path, std::uint64_t size)
    : path_(std::move(path)), added_columns_(CountAdded(path_)) {
  file_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) throw StorageError(ErrnoText(path_, "cannot be continued") + kRestore);
  struct stat status {};
  const bool known = fstat(file_, &status) == 0;
  const bool shorter = known && static_cast<std::uint64_t>(status.st_size) < size;
  if (!known || shorter || ftruncate(file_, static_cast<off_t>(size)) != 0 ||
      lseek(file_, 0, SEEK_END) < 0) {
    const std::string text = ErrnoText(path_, "cannot be continued") + kRestore;
    close(file_);
    if (!shorter) throw StorageError(text);
    throw InputError(path_ + ": got " + std::to_string(status.st_size) +
                     " bytes, expected at least the " + std::to_string(size) +
                     " that the checkpoint records" + kRestore);
  }
  flushed_ = size;
  buffer_.reserve(2 * kFlushBytes);
}

MetricsFile::~MetricsFile() {
  if (file_ >= 0) close(file_);
}

void MetricsFile::Append(std::uint64_t number, std::uint64_t total_steps,
                         const EpisodeSummary& result, const LearnerStatus& status) {
  Put(number, buffer_);
  buffer_ += ',';
  Put(total_steps, buffer_);
  buffer_ += ',';
  AppendEpisode(result, buffer_);
  buffer_ += ',';
  Put(status.exploration, buffer_);
  buffer_ += ',';
  Put(status.learning_rate, buffer_);
  buffer_ += ',';
  Put(status.loss, buffer_);
  AppendAdded(result, buffer_, added_columns_);
  buffer_ += '\n';
  if (buffer_.size() >= kFlushBytes) Flush();
}

void MetricsFile::Flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = write(file_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const std::string text = ErrnoText(path_, "cannot be written") + kFreeSpace;
      flushed_ += done;
      buffer_.erase(0, done);
      throw StorageError(text);
    }
    done += static_cast<std::size_t>(written);
  }
  flushed_ += buffer_.size();
  buffer_.clear();
}

void MetricsFile::Sync() {
  Flush();
  if (fsync(file_) != 0) throw StorageError(ErrnoText(path_, "cannot be synced") + kFreeSpace);
}

}  // namespace aquafarm::agents
