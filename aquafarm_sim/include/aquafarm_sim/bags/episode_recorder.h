// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Writes ended episodes as bags while the farms run. Each step only appends its actions to a log.
/// A separate thread simulates the kept logs again and writes the bags.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "aquafarm/base/mutex.h"
#include "aquafarm_sim/bags/episode_log.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

/// Selects the episodes to keep. kBest keeps one bag: that of the episode with the highest return
/// so far. kWorst keeps that of the episode with the lowest return. kFailures keeps episodes in
/// which at least one device was not delivered.
struct Keep {
  enum class Which : std::uint8_t { kNone, kAll, kEvery, kBest, kWorst, kFailures };
  Which which{};
  std::uint64_t every{};  ///< kEvery: keeps the episodes whose index is a multiple of `every`
};

/// Parses "none", "all", "every:10", "best", "worst" or "failures".
/// @throws InputError "~keep: got 'some', expected none, all, every:N, best, worst or failures"
Keep ParseKeep(const std::string& text);

/// Limits of the backlog of unwritten episodes.
struct RecorderLimits {
  /// The farms wait while the size of the unwritten actions is at least this [bytes]. With one
  /// agent the default is the work of about one second: the thread writes about 300,000 steps per
  /// second.
  std::size_t waiting_bytes{300'000};
  std::chrono::milliseconds wait{10'000};  ///< max wait of the farms; recording stops after it
};

/// Records the episodes of all farms of a FarmServer.
class EpisodeRecorder final : public FarmRecorder {
 public:
  /// Removes partial bags that killed processes left in the folder.
  /// @throws InputError if the folder cannot be created or written
  EpisodeRecorder(std::shared_ptr<const aquafarm::Scenario> scenario, Keep keep, std::string folder,
                  BagFormat format, RecorderLimits limits = {});
  /// Writes the queued episodes, then stops the thread.
  ~EpisodeRecorder() override;

  void OnStart(const aquafarm::Farm& farm, std::int32_t number,
               const MessageContext& context) override;
  /// Appends a step. After the last step of a kept episode, waits while the backlog has at least
  /// limits.waiting_bytes. If this takes longer than limits.wait, recording stops.
  void OnStep(const aquafarm::Farm& farm, std::int32_t number,
              const std::uint8_t* actions) override;
  void OnIntervention(const aquafarm::Farm& farm, std::int32_t number) override;

  std::uint64_t kept() const;  ///< number of bags written so far, including replaced ones
  std::string fault() const;   ///< reason why recording stopped; empty if it did not stop

 private:
  bool Wants(const EpisodeLog& log);
  void Enqueue(EpisodeLog log);
  void Run();
  void Write(const EpisodeLog& log);

  const Keep keep_;
  const std::string folder_;
  EpisodeBagWriter writer_;  // used only by the writing thread
  const RecorderLimits limits_;
  std::vector<EpisodeLog> logs_;  // by farm; used only in callbacks, under the FarmServer's mutex
  std::optional<float> extreme_;  // kBest, kWorst: best or worst return so far; used like logs_
  std::string extreme_path_;      // kBest, kWorst: newest bag; used only by the writing thread

  mutable aquafarm::Mutex mutex_;
  std::condition_variable changed_;
  std::deque<EpisodeLog> queue_ AQUAFARM_GUARDED_BY(mutex_);
  // Size of the actions that are queued or being written.
  std::size_t waiting_bytes_ AQUAFARM_GUARDED_BY(mutex_){};
  std::uint64_t kept_ AQUAFARM_GUARDED_BY(mutex_){};
  std::string fault_ AQUAFARM_GUARDED_BY(mutex_);
  bool ending_ AQUAFARM_GUARDED_BY(mutex_){};
  std::thread thread_;
};

}  // namespace aquafarm_sim
