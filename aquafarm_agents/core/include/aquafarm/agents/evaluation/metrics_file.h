// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// Returns the CSV column names of an EpisodeSummary that files of version 0.1.0 have, with commas
/// between them.
std::string EpisodeColumns();
/// Returns the column names that were added later, each after a comma. They end each line.
std::string AddedColumns();

/// Appends an episode in the order of EpisodeColumns. Numbers parse back to the same bits.
void AppendEpisode(const EpisodeSummary& result, std::string& text);
/// Appends the first `count` values of AddedColumns, each after a comma; by default all.
void AppendAdded(const EpisodeSummary& result, std::string& text, std::size_t count = SIZE_MAX);

/// metrics.csv: one line per episode, `number,total_steps,<EpisodeColumns>,exploration,
/// learning_rate,loss<AddedColumns>`. A file of an earlier version continues with the columns that
/// it has. It contains no wall time, so that a resumed run writes the same bytes.
class MetricsFile {
 public:
  /// Creates the file, or truncates an existing one. @throws StorageError
  explicit MetricsFile(std::string path);
  /// Truncates the file to `size` bytes and continues there.
  /// @throws InputError if it is shorter or has other columns; StorageError
  MetricsFile(std::string path, std::uint64_t size);
  ~MetricsFile();
  MetricsFile(const MetricsFile&) = delete;
  MetricsFile& operator=(const MetricsFile&) = delete;

  void Append(std::uint64_t number, std::uint64_t total_steps, const EpisodeSummary& result,
              const LearnerStatus& status);
  /// Writes all buffered lines to the operating system. @throws StorageError
  void Flush();
  /// Flushes and syncs to the disk. @throws StorageError
  void Sync();
  /// Size in bytes, including lines that are not flushed yet.
  std::uint64_t size() const { return flushed_ + buffer_.size(); }

 private:
  std::string path_;
  int file_{-1};
  std::size_t added_columns_{SIZE_MAX};  // max number of AddedColumns
  std::uint64_t flushed_{};
  std::string buffer_;
};

}  // namespace aquafarm::agents
