// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKeptCheckpoints = 2;

// Returns the file name of a checkpoint. The names sort in the order of the steps.
std::string CheckpointName(std::uint64_t steps) {
  char name[40];
  std::snprintf(name, sizeof(name), "step_%015llu.ckpt", static_cast<unsigned long long>(steps));
  return name;
}

std::vector<std::string> CheckpointsIn(const std::string& run_folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run_folder + "/checkpoints", error)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("step_", 0) == 0 && entry.path().extension() == ".ckpt") {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

RunFolder::RunFolder(std::string path, bool resume) : path_(std::move(path)) {
  if (path_.empty()) throw InputError("run_dir: got nothing, expected a folder");
  std::error_code error;
  if (resume && !fs::exists(path_, error)) throw InputError(path_ + ": contains no run to resume");
  fs::create_directories(path_ + "/checkpoints", error);
  if (error) throw StorageError(path_ + ": cannot be created: " + error.message());
  Lock();
  try {
    const bool holds_run = fs::exists(path_ + "/run.json", error) || !CheckpointsIn(path_).empty();
    if (!resume && holds_run) {
      throw InputError(path_ + ": already contains a run; resume it or choose another folder");
    }
    if (resume && !holds_run) throw InputError(path_ + ": contains no run to resume");
    RemoveTemporaryFiles(path_);
    RemoveTemporaryFiles(path_ + "/checkpoints");
    const std::string probe = path_ + "/checkpoints/probe.tmp";
    WriteFileAtomically(probe, std::string(4096, '\0'));
    unlink(probe.c_str());
  } catch (...) {
    close(lock_);
    throw;
  }
}

void RunFolder::Lock() {
  const std::string name = path_ + "/lock";
  lock_ = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) throw StorageError(ErrnoText(path_, "cannot be written"));
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const bool in_use = errno == EWOULDBLOCK;
    const std::string text = ErrnoText(name, "cannot be locked");
    close(lock_);
    if (!in_use) throw StorageError(text);
    std::string owner;
    std::ifstream(name) >> owner;
    throw StorageError(path_ + ": is in use by another training (process " + owner + ")");
  }
  const std::string owner = std::to_string(getpid()) + "\n";
  if (ftruncate(lock_, 0) != 0 ||
      write(lock_, owner.data(), owner.size()) != static_cast<ssize_t>(owner.size())) {
    const std::string text = ErrnoText(path_, "cannot be written");
    close(lock_);
    throw StorageError(text);
  }
}

RunFolder::~RunFolder() { close(lock_); }

void RunFolder::Write(const std::string& name, const std::string& bytes) const {
  WriteFileAtomically(path_ + "/" + name, bytes);
}

void RunFolder::SaveCheckpoint(const Checkpoint& checkpoint) const {
  WriteCheckpoint(path_ + "/checkpoints/" + CheckpointName(checkpoint.steps), checkpoint);
  const std::vector<std::string> paths = CheckpointsIn(path_);
  for (std::size_t i = 0; i + kKeptCheckpoints < paths.size(); ++i) unlink(paths[i].c_str());
}

std::string RunFolder::ReadNewestCheckpoint(Checkpoint& checkpoint, std::string& damage) const {
  for (const std::string& path : Checkpoints()) {
    try {
      checkpoint = ReadCheckpoint(path);
      return path;
    } catch (const InputError& error) {
      if (damage.empty()) damage = error.what();
    }
  }
  if (!damage.empty()) throw InputError(damage);
  return "";
}

std::vector<std::string> RunFolder::Checkpoints() const {
  std::vector<std::string> paths = CheckpointsIn(path_);
  std::reverse(paths.begin(), paths.end());
  return paths;
}

std::optional<std::string> RunFolder::NewestCheckpoint(const std::string& run_folder) {
  const std::vector<std::string> paths = CheckpointsIn(run_folder);
  if (paths.empty()) return std::nullopt;
  return paths.back();
}

std::string NewRunFolder() {
  char name[40];
  const std::time_t now = std::time(nullptr);
  std::strftime(name, sizeof(name), "runs/%Y%m%d-%H%M%S", std::localtime(&now));
  return name;
}

}  // namespace aquafarm::agents
