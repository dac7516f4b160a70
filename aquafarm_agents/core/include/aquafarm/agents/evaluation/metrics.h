// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/learning/learner.h"

namespace aquafarm::agents {

/// CSV column names of an EpisodeResult.
inline constexpr const char* kEpisodeColumns =
    "farm,seed,episode,steps,return,delivered,devices,delivered_health,crashes,collisions,"
    "steps_in_disaster,reason,success";

/// Columns that files of version 0.1.0 lack, at the end of each line.
inline constexpr const char* kAddedEpisodeColumns = "energy_kwh,distance_km";

/// Appends an episode in the order of kEpisodeColumns. Numbers parse back to the same bits.
void AppendEpisode(const EpisodeResult& result, std::string& text);
/// Appends the columns kAddedEpisodeColumns.
void AppendAdded(const EpisodeResult& result, std::string& text);

/// metrics.csv: one line per episode, `number,total_steps,<kEpisodeColumns>,exploration,
/// learning_rate,loss,<kAddedEpisodeColumns>`. A file of version 0.1.0 continues without the last
/// ones. It contains no wall time, so that a resumed run writes the same bytes.
class MetricsFile {
 public:
  /// Creates the file, or truncates an existing one. @throws StorageError
  explicit MetricsFile(std::string path);
  /// Truncates the file to `size` bytes and continues there.
  /// @throws InputError if it is shorter; StorageError
  MetricsFile(std::string path, std::uint64_t size);
  ~MetricsFile();
  MetricsFile(const MetricsFile&) = delete;
  MetricsFile& operator=(const MetricsFile&) = delete;

  void Append(std::uint64_t number, std::uint64_t total_steps, const EpisodeResult& result,
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
  bool has_added_{true};  // the columns kAddedEpisodeColumns
  std::uint64_t flushed_{};
  std::string buffer_;
};

}  // namespace aquafarm::agents
