// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/episode_recorder.h"

#include <ros/console.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <charconv>
#include <exception>
#include <filesystem>
#include <utility>

#include "aquafarm/base/check.h"

namespace aquafarm_sim {
namespace {

/// Lowers the priority of the calling thread, so that the stepping threads take precedence.
/// SCHED_IDLE is not used, because other programs could starve the thread. Without privileges, a
/// thread cannot leave SCHED_IDLE, not even while the farms wait for it.
void StepBack() {
  // The struct of sched_setattr(2); the kernel header that defines it conflicts with sched.h.
  struct {
    std::uint32_t size{48};
    std::uint32_t policy{SCHED_OTHER};
    std::uint64_t flags{};
    std::int32_t nice{19};
    std::uint32_t priority{};
    // Since Linux 6.6 a thread keeps the processor for its time slice even if another thread wakes
    // up. Since 6.12 a thread can request a short time slice.
    std::uint64_t runtime_ns{100'000};  // time slice: the min that Linux accepts
    std::uint64_t deadline_ns{};
    std::uint64_t period_ns{};
  } attributes;
  static_assert(sizeof(attributes) == 48);
  if (syscall(SYS_sched_setattr, 0, &attributes, 0U) == 0) return;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), attributes.nice);  // fallback
}

std::string MakeFolder(std::string folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || access(folder.c_str(), W_OK) != 0) {
    throw aquafarm::InputError("~keep_dir: got '" + folder +
                               "', expected a folder that can be written");
  }
  return folder;
}

}  // namespace

Keep ParseKeep(const std::string& text) {
  using Which = Keep::Which;
  if (text == "none") return {Which::kNone, 0};
  if (text == "all") return {Which::kAll, 0};
  if (text == "best") return {Which::kBest, 0};
  if (text == "worst") return {Which::kWorst, 0};
  if (text == "failures") return {Which::kFailures, 0};
  const std::string every = "every:";
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  if (text.rfind(every, 0) == 0) {
    const auto read = std::from_chars(text.data() + every.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end && number > 0) return {Which::kEvery, number};
  }
  throw aquafarm::InputError("~keep: got '" + text +
                             "', expected none, all, every:N, best, worst or failures");
}

EpisodeRecorder::EpisodeRecorder(std::shared_ptr<const aquafarm::Scenario> scenario, Keep keep,
                                 std::string folder, BagFormat format, RecorderLimits limits)
    : keep_(keep),
      folder_(MakeFolder(std::move(folder))),
      writer_(std::move(scenario), std::move(format)),
      limits_(limits) {
  const int removed = RemoveAbandonedBags(folder_);
  ROS_INFO_COND(removed > 0, "%d partial bag(s) that a killed process left in %s are removed",
                removed, folder_.c_str());
  thread_ = std::thread([this] { Run(); });
}

EpisodeRecorder::~EpisodeRecorder() {
  {
    const aquafarm::MutexLock lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void EpisodeRecorder::OnStart(const aquafarm::Farm& farm, std::int32_t number,
                              const MessageContext& context) {
  const auto i = static_cast<std::size_t>(number);
  if (logs_.size() <= i) logs_.resize(i + 1);
  EpisodeLog log;
  log.farm = number;
  log.seed = farm.seed();
  log.episode = farm.episode();
  log.paced = context.paced && number == 0;  // the other farms only take joint steps
  log.rate_hz = context.rate_hz;
  log.first_step = farm.step();
  if (farm.step() != 0) log.changes.push_back({farm.step(), farm.Save()});
  logs_[i] = std::move(log);
}

void EpisodeRecorder::OnStep(const aquafarm::Farm& farm, std::int32_t number,
                             const std::uint8_t* actions) {
  EpisodeLog& log = logs_[static_cast<std::size_t>(number)];
  log.actions.insert(log.actions.end(), actions, actions + farm.ships().size());
  if (!farm.over()) return;
  log.record = farm.record();
  if (Wants(log)) Enqueue(std::move(log));
}

void EpisodeRecorder::OnIntervention(const aquafarm::Farm& farm, std::int32_t number) {
  auto& changes = logs_[static_cast<std::size_t>(number)].changes;
  if (changes.empty() || changes.back().step != farm.step()) changes.emplace_back();
  changes.back() = {farm.step(), farm.Save()};  // only the last change before a step counts
}

bool EpisodeRecorder::Wants(const EpisodeLog& log) {
  const float value = log.record.episode_return;
  switch (keep_.which) {
    case Keep::Which::kAll:
      return true;
    case Keep::Which::kEvery:
      return log.episode % keep_.every == 0;
    case Keep::Which::kFailures:
      return !log.record.Success();
    case Keep::Which::kBest:
    case Keep::Which::kWorst:
      if (extreme_ && !(keep_.which == Keep::Which::kBest ? value > *extreme_ : value < *extreme_))
        return false;
      extreme_ = value;
      return true;
    case Keep::Which::kNone:
      break;
  }
  return false;
}

void EpisodeRecorder::Enqueue(EpisodeLog log) {
  aquafarm::MutexLock lock(mutex_);
  if (!fault_.empty()) return;
  if (keep_.which == Keep::Which::kBest || keep_.which == Keep::Which::kWorst) {
    for (const EpisodeLog& overtaken : queue_) waiting_bytes_ -= overtaken.actions.size();
    queue_.clear();
  }
  const auto end = std::chrono::steady_clock::now() + limits_.wait;
  const auto is_full = [this]() AQUAFARM_REQUIRES(mutex_) {
    return waiting_bytes_ >= limits_.waiting_bytes && fault_.empty();
  };
  while (is_full() && lock.WaitUntil(changed_, end)) {
  }
  if (is_full()) {
    fault_ = std::to_string(waiting_bytes_) + " bytes of actions wait for the disk after " +
             std::to_string(limits_.wait.count()) + " ms, expected less than " +
             std::to_string(limits_.waiting_bytes) + "; use a faster disk or record fewer episodes";
    ROS_ERROR("episode recording stopped: %s", fault_.c_str());
  }
  if (!fault_.empty()) return;
  waiting_bytes_ += log.actions.size();
  queue_.push_back(std::move(log));
  changed_.notify_all();
}

void EpisodeRecorder::Run() {
  StepBack();
  aquafarm::MutexLock lock(mutex_);
  while (true) {
    while (!ending_ && queue_.empty()) lock.Wait(changed_);
    if (queue_.empty()) return;
    const EpisodeLog log = std::move(queue_.front());
    queue_.pop_front();
    lock.Unlock();
    std::string fault;
    bool written = false;
    try {
      Write(log);
      written = true;
    } catch (const ReplayError& error) {  // only this episode is lost
      ROS_ERROR("an episode was not recorded: %s", error.what());
    } catch (const std::exception& error) {
      fault = error.what();
      ROS_ERROR("episode recording stopped: %s", error.what());
    }
    lock.Lock();
    waiting_bytes_ -= log.actions.size();
    kept_ += written ? 1 : 0;
    if (!fault.empty()) {
      fault_ = fault;
      queue_.clear();
      waiting_bytes_ = 0;
    }
    changed_.notify_all();
  }
}

void EpisodeRecorder::Write(const EpisodeLog& log) {
  const std::string name = BagName(log);
  std::string path = folder_ + "/" + name;
  // A bag of this name exists if an earlier run, another farm or an episode before load_state had
  // the same episode number, seed and return.
  for (int i = 2; std::filesystem::exists(path); ++i) {
    path = folder_ + "/" + name.substr(0, name.size() - 4) + "_" + std::to_string(i) + ".bag";
  }
  writer_.Write(log, path);
  if (keep_.which != Keep::Which::kBest && keep_.which != Keep::Which::kWorst) return;
  std::error_code ignored;
  if (!extreme_path_.empty()) std::filesystem::remove(extreme_path_, ignored);
  extreme_path_ = path;
}

std::uint64_t EpisodeRecorder::kept() const {
  const aquafarm::MutexLock lock(mutex_);
  return kept_;
}

std::string EpisodeRecorder::fault() const {
  const aquafarm::MutexLock lock(mutex_);
  return fault_;
}

}  // namespace aquafarm_sim
