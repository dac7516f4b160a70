// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Folder with the files that a training writes:
///
///   lock                 file that a process locks while it trains here; contains its process id
///   scenario.yaml        canonical text of the scenario
///   run.json             algorithm, options, seed, limits, version, scenario hash, arguments, …
///   metrics.csv          one line per episode
///   checkpoints/         the last two checkpoints, named by their steps
///   policy.ckpt          the learned policy, written at the end
///   evaluation.*         evaluation of the greedy policy at the end
///   evaluation_random.*  evaluation of the policy RANDOM at the end

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents {

class RunFolder {
 public:
  /// Opens or creates the folder, locks it and checks that it is writable. Removes temporary files
  /// that a killed process has left in it.
  /// @param resume true to resume the run in the folder, false to start a new run
  /// @throws StorageError if the folder is not writable or another process trains in it
  /// @throws InputError if `path` is empty, if the folder contains a run and `resume` is false, or
  ///   if it contains no run and `resume` is true
  RunFolder(std::string path, bool resume);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string metrics_path() const { return path_ + "/metrics.csv"; }
  std::string policy_path() const { return path_ + "/policy.ckpt"; }

  /// Writes a file of the folder atomically. @throws StorageError
  void Write(const std::string& name, const std::string& bytes) const;

  /// Writes checkpoints/step_<steps>.ckpt and removes all but the last two checkpoints.
  /// @throws StorageError if the checkpoint cannot be written; the older ones are then kept
  void SaveCheckpoint(const Checkpoint& checkpoint) const;
  /// Paths of all checkpoints, newest first.
  std::vector<std::string> Checkpoints() const;
  /// Reads the newest valid checkpoint. Returns its path; empty if there is no checkpoint.
  /// @param damage is set to an error message if the newest checkpoint is damaged
  /// @throws InputError with that message if all checkpoints are damaged
  std::string ReadNewestCheckpoint(Checkpoint& checkpoint, std::string& damage) const;
  /// Path of the newest checkpoint, damaged or not; nullopt if there is none.
  std::optional<std::string> NewestCheckpoint() const { return NewestCheckpoint(path_); }
  static std::optional<std::string> NewestCheckpoint(const std::string& run_folder);

 private:
  void Lock();

  std::string path_;
  int lock_{-1};
};

/// Returns the default folder of a run: runs/<date>-<time>, in local time.
std::string NewRunFolder();

}  // namespace aquafarm::agents
