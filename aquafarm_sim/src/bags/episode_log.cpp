// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/episode_log.h"

#include <aquafarm_msgs/SavedState.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/chunked_bag.h"
#include "aquafarm_sim/convert/conversions.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_sim {
namespace {

using aquafarm::Farm;

constexpr std::int32_t kRiskPeriod = 10;  // steps
constexpr std::int32_t kMoment_ns = 1000;

constexpr const char* kPrefix = "episode_";
// rosbag record names its partial bags ".active" and holds no lock on them. This name must differ.
constexpr const char* kPartial = ".partial";

/// Holds a lock on a file. The kernel releases the lock if the process is killed.
class FileLock {
 public:
  FileLock(const std::string& path, int open_flags)
      : file_(open(path.c_str(), open_flags | O_CLOEXEC, 0666)),
        is_held_(file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) == 0) {}
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock() {
    if (file_ >= 0) close(file_);
  }
  bool is_held() const { return is_held_; }
  /// Returns whether the file is open, and another process holds the lock.
  bool is_held_by_another() const { return file_ >= 0 && !is_held_; }

 private:
  const int file_;
  const bool is_held_;
};

bool IsPartialBag(const std::filesystem::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  const std::string end = std::string(".bag") + kPartial;
  std::error_code error;
  return entry.is_regular_file(error) && !entry.is_symlink(error) && name.rfind(kPrefix, 0) == 0 &&
         name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

/// Creates and writes the messages of one episode during its simulation.
class Messages {
 public:
  Messages(ChunkedBag& bag, const EpisodeLog& log, const BagFormat& format)
      : bag_(bag), format_(format) {
    context_.map_frame = format.map_frame;
    context_.paced = log.paced;
    context_.rate_hz = log.rate_hz > 0.0 ? log.rate_hz : format.rate_hz;
  }

  void Start(const Farm& farm, const aquafarm::Encoder& encoder, const std::string& yaml) {
    SetTime(0);
    aquafarm_msgs::FarmSpec spec;
    ToMsg(farm, encoder, format_.farms, yaml, context_, spec);
    Write(names::kSpec, spec);
    Write(names::kChart, ChartToMsg(farm, context_));
  }

  void Change(const Farm& farm, const std::string& data) {
    SetTime(farm.step());
    aquafarm_msgs::SavedState saved;
    saved.header.stamp = context_.stamp;
    saved.header.frame_id = context_.map_frame;
    saved.seed = farm.seed();
    saved.episode = farm.episode();
    saved.step = static_cast<std::uint64_t>(farm.step());
    saved.data.assign(data.begin(), data.end());
    Write(names::kSavedState, saved);
  }

  void State(const Farm& farm) {
    SetTime(farm.step());
    ToMsg(farm, context_, state_);
    Write(names::kState, state_);
    if (farm.step() % kRiskPeriod != 0 && !farm.over()) return;
    RiskToMsg(farm.disasters(), farm.scenario(), context_, risk_);
    Write(names::kRisk, risk_);
  }

  void End(const EpisodeLog& log, const Farm& farm) {
    Write(names::kEpisode, ToMsg(log.record, farm.SettleAccounts(), log.farm, context_));
  }

 private:
  // A bag cannot contain time 0, so step 0 has the time 1 / rate_hz.
  void SetTime(std::int32_t step) {
    const ros::Time stamp(static_cast<double>(step + 1) / context_.rate_hz);
    if (stamp != context_.stamp) order_ = 0;
    context_.stamp = stamp;
  }

  // Readers receive messages of equal time in any order, so the messages of a step are kMoment_ns
  // apart.
  template <typename Message>
  void Write(const char* name, const Message& message) {
    bag_.Write(format_.ns + name, context_.stamp + ros::Duration(0, kMoment_ns * order_++),
               message);
  }

  ChunkedBag& bag_;
  const BagFormat& format_;
  MessageContext context_;
  std::int32_t order_{};  // index of the next message among those of this stamp
  aquafarm_msgs::FarmState state_;
  nav_msgs::OccupancyGrid risk_;
};

void Play(Farm& farm, const EpisodeLog& log, Messages& messages) {
  auto change = log.changes.begin();
  const auto take_changes = [&] {
    for (; change != log.changes.end() && change->step == farm.step(); ++change) {
      farm.Load(change->state);
      messages.Change(farm, change->state);
      messages.State(farm);
    }
  };
  if (log.first_step == 0) {
    messages.State(farm);
  } else {
    farm.Load(log.changes.front().state);  // sets the farm's step to that of the first change
  }
  take_changes();
  const std::size_t agents = farm.ships().size();
  for (std::size_t i = 0; i + agents <= log.actions.size() && !farm.over(); i += agents) {
    farm.Step(log.actions.data() + i);
    messages.State(farm);
    take_changes();
  }
  if (farm.record().steps != log.record.steps ||
      farm.record().episode_return != log.record.episode_return ||
      farm.record().reason != log.record.reason) {
    throw ReplayError("episode " + std::to_string(log.episode) +
                      ": its actions, when repeated, do not give the same result");
  }
}

}  // namespace

std::string BagName(const EpisodeLog& log) {
  char name[120];
  std::snprintf(name, sizeof(name), "%s%08llu_seed_%llu_return_%+.1f.bag", kPrefix,
                static_cast<unsigned long long>(log.episode),
                static_cast<unsigned long long>(log.seed),
                static_cast<double>(log.record.episode_return));
  return name;
}

int RemoveAbandonedBags(const std::string& folder) {
  int removed = 0;
  std::error_code error;
  std::vector<std::filesystem::path> found;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (IsPartialBag(*entry)) found.push_back(entry->path());
  }
  for (const auto& path : found) {
    if (!FileLock(path.string(), O_RDONLY).is_held()) continue;
    removed += std::filesystem::remove(path, error) ? 1 : 0;
  }
  return removed;
}

EpisodeBagWriter::EpisodeBagWriter(std::shared_ptr<const aquafarm::Scenario> scenario,
                                   BagFormat format)
    : format_(std::move(format)),
      farm_(std::move(scenario)),
      encoder_(farm_.scenario()),
      yaml_(aquafarm::ToYaml(farm_.scenario())) {}

void EpisodeBagWriter::Write(const EpisodeLog& log, const std::string& path) {
  const std::string active = path + kPartial;
  std::error_code error;
  const FileLock lock(active, O_RDWR | O_CREAT);  // if it is not opened, ChunkedBag reports why
  if (lock.is_held_by_another()) {
    throw std::runtime_error(active + ": another process writes this file; keep the episodes of " +
                             "each process in a folder of its own");
  }
  try {
    ChunkedBag bag(active);
    Messages messages(bag, log, format_);
    farm_.Reset(log.seed, log.episode);
    messages.Start(farm_, encoder_, yaml_);
    Play(farm_, log, messages);
    messages.End(log, farm_);
    bag.Close();
  } catch (const std::system_error& fault) {
    std::filesystem::remove(active, error);
    throw std::runtime_error(active + ": cannot be written: " + fault.code().message());
  } catch (...) {
    std::filesystem::remove(active, error);
    throw;
  }
  std::filesystem::rename(active, path, error);
  if (!error) return;
  const std::string why = error.message();
  std::filesystem::remove(active, error);
  throw std::runtime_error(path + ": cannot be written: " + why);
}

}  // namespace aquafarm_sim
