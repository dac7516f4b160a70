// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Where a training keeps everything:
///
///   lock           held while a process trains here
///   scenario.yaml  canonical text of the farm
///   run.json       algorithm, options, seed, limits, version, scenario hash, arguments
///   metrics.csv    a line an episode
///   checkpoints/   the last two, named by their steps
///   policy.ckpt    what was learnt, at the end
///   evaluation.*   the greedy evaluation at the end

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

class RunFolder {
 public:
  /// Opens or makes the folder, tries whether it can be written, and locks it.
  /// @param resume false: a folder that holds a run already is refused
  /// @throws StorageError when it cannot be written or another process trains here;
  ///         InputError when it holds a run and `resume` is false, or none and it is true
  RunFolder(std::string path, bool resume);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string metrics_path() const { return path_ + "/metrics.csv"; }
  std::string policy_path() const { return path_ + "/policy.ckpt"; }

  /// @throws StorageError
  void Write(const std::string& name, const std::string& bytes) const;

  /// Writes checkpoints/step_<steps>.ckpt and removes all but the last two.
  /// @throws StorageError; those before stay
  void SaveCheckpoint(const Checkpoint& checkpoint) const;
  /// Paths of all checkpoints, the newest first.
  std::vector<std::string> Checkpoints() const;
  /// Path of the newest checkpoint, if there is one.
  std::optional<std::string> NewestCheckpoint() const { return NewestCheckpoint(path_); }
  static std::optional<std::string> NewestCheckpoint(const std::string& run_folder);

 private:
  void Lock();

  std::string path_;
  int lock_{-1};
};

/// A folder for a run that was given none: runs/<date>-<time>.
std::string NewRunFolder();

}  // namespace aquafarm::agents
