// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/metrics.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <utility>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kFlushBytes = std::size_t{1} << 16U;

template <typename T>
void Put(T value, std::string& text) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  text.append(digits, static_cast<std::size_t>(end - digits));
}

// Returns whether the first line of a file names the added columns.
bool HasAdded(int file) {
  std::string line(1024, '\0');
  const ssize_t got = pread(file, line.data(), line.size(), 0);
  line.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return line.substr(0, line.find('\n')).find(kAddedEpisodeColumns) != std::string::npos;
}

}  // namespace

void AppendEpisode(const EpisodeResult& result, std::string& text) {
  const auto put = [&text](auto value) {
    Put(value, text);
    text += ',';
  };
  put(result.farm);
  put(result.seed);
  put(result.episode);
  put(result.steps);
  put(result.episode_return);
  put(result.delivered);
  put(result.devices);
  put(result.delivered_health);
  put(result.crashes);
  put(result.collisions);
  put(result.steps_in_disaster);
  text += ToString(result.reason);
  text += result.Success() ? ",1" : ",0";
}

void AppendAdded(const EpisodeResult& result, std::string& text) {
  Put(result.energy, text);
  text += ',';
  Put(result.distance, text);
}

MetricsFile::MetricsFile(std::string path) : path_(std::move(path)) {
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ < 0) throw StorageError(ErrnoText(path_, "cannot be written"));
  buffer_ = std::string("number,total_steps,") + kEpisodeColumns +
            ",exploration,learning_rate,loss," + kAddedEpisodeColumns + "\n";
  buffer_.reserve(2 * kFlushBytes);
}

MetricsFile::MetricsFile(std::string path, std::uint64_t size) : path_(std::move(path)) {
  file_ = open(path_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) throw StorageError(ErrnoText(path_, "cannot be continued"));
  struct stat status {};
  const bool known = fstat(file_, &status) == 0;
  const bool shorter = known && static_cast<std::uint64_t>(status.st_size) < size;
  if (!known || shorter || ftruncate(file_, static_cast<off_t>(size)) != 0 ||
      lseek(file_, 0, SEEK_END) < 0) {
    const std::string text = ErrnoText(path_, "cannot be continued");
    close(file_);
    if (!shorter) throw StorageError(text);
    throw InputError(path_ + ": got " + std::to_string(status.st_size) +
                     " bytes, expected at least the " + std::to_string(size) +
                     " that the checkpoint records");
  }
  has_added_ = HasAdded(file_);
  flushed_ = size;
  buffer_.reserve(2 * kFlushBytes);
}

MetricsFile::~MetricsFile() {
  if (file_ >= 0) close(file_);
}

void MetricsFile::Append(std::uint64_t number, std::uint64_t total_steps,
                         const EpisodeResult& result, const LearnerStatus& status) {
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
  if (has_added_) {
    buffer_ += ',';
    AppendAdded(result, buffer_);
  }
  buffer_ += '\n';
  if (buffer_.size() >= kFlushBytes) Flush();
}

void MetricsFile::Flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = write(file_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const std::string text = ErrnoText(path_, "cannot be written");
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
  if (fsync(file_) != 0) throw StorageError(ErrnoText(path_, "cannot be synced"));
}

}  // namespace aquafarm::agents
