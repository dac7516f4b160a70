// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Returns the names of the CSV columns of an EpisodeSummary that every file contains, separated by
/// commas.
std::string EpisodeColumns();
/// Returns the names of the CSV columns of an EpisodeSummary that older files may lack, each after
/// a comma. They follow the other columns of a file.
std::string AddedColumns();

/// Appends the values of EpisodeColumns. Numbers parse back to the same bits.
void AppendEpisode(const EpisodeSummary& result, std::string& text);
/// Appends the first `count` values of AddedColumns (by default all), each after a comma.
void AppendAdded(const EpisodeSummary& result, std::string& text, std::size_t count = SIZE_MAX);

/// Writes metrics.csv: a line of column names, then one line per episode, `number,total_steps,
/// <EpisodeColumns>,exploration,learning_rate,loss<AddedColumns>`. New lines of an older file have
/// only the columns of that file. The file contains no wall time, so that an interrupted and
/// resumed run writes the same bytes as an uninterrupted one.
class MetricsFile {
 public:
  /// Creates the file, or truncates an existing one. @throws StorageError
  explicit MetricsFile(std::string path);
  /// Truncates an existing file to `size` bytes and continues there.
  /// @throws InputError if the file is shorter than `size` or has other columns
  /// @throws StorageError if the file cannot be opened or truncated
  MetricsFile(std::string path, std::uint64_t size);
  /// Closes the file. Buffered lines are lost; call Flush before.
  ~MetricsFile();
  MetricsFile(const MetricsFile&) = delete;
  MetricsFile& operator=(const MetricsFile&) = delete;

  /// Appends an episode to the buffer. Flushes the buffer if it contains at least 64 KiB.
  /// @param number number of the episode in the training, from 1
  /// @param total_steps farm steps of the training so far
  /// @throws StorageError
  void Append(std::uint64_t number, std::uint64_t total_steps, const EpisodeSummary& result,
              const LearnerStatus& status);
  /// Writes all buffered lines to the operating system. @throws StorageError
  void Flush();
  /// Flushes, then syncs the file to the disk. @throws StorageError
  void Sync();
  /// Returns the size of the file [bytes], including lines that are not flushed yet.
  std::uint64_t size() const { return flushed_ + buffer_.size(); }

 private:
  std::string path_;
  int file_{-1};
  std::size_t added_columns_{SIZE_MAX};  // number of AddedColumns in the file; SIZE_MAX: all
  std::uint64_t flushed_{};
  std::string buffer_;
};

}  // namespace aquafarm::agents
