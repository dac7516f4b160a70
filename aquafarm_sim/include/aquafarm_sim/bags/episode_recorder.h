// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Keeps episodes as bags while the ranch runs, every step of them, without slowing it: the ranch
/// leaves actions on a tape, a thread of its own plays the kept tapes again and writes them.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "aquafarm_sim/bags/episode_log.h"
#include "aquafarm_sim/server/farm_server.h"

namespace aquafarm_sim {

/// Which episodes are kept.
struct Keep {
  enum class Which : std::uint8_t { kNone, kAll, kEvery, kBest, kWorst, kFailures };
  Which which{};
  std::uint64_t every{};  ///< kEvery: episodes whose number it divides
};

/// Reads "none", "all", "every:10", "best", "worst" or "failures".
/// @throws InputError "~keep: got 'some', expected none, all, every:N, best, worst or failures"
Keep ParseKeep(const std::string& text);

/// How far the writing may fall behind.
struct RecorderLimits {
  // Steps are written at some 300,000 a second: this is a second's work.
  std::size_t waiting_bytes{300'000};      ///< of actions left to write; then the farms wait
  std::chrono::milliseconds wait{10'000};  ///< that they wait at most; then nothing more is kept
};

class EpisodeRecorder final : public RanchRecorder {
 public:
  /// @throws InputError when the folder cannot be made
  EpisodeRecorder(std::shared_ptr<const aquafarm::Scenario> scenario, Keep keep, std::string folder,
                  BagFormat format, RecorderLimits limits = {});
  /// Writes what is left first.
  ~EpisodeRecorder() override;

  void OnStart(const aquafarm::Farm& farm, std::int32_t number,
               const MessageContext& context) override;
  /// Waits while more is left to write than the limits say, but no longer than they say.
  void OnStep(const aquafarm::Farm& farm, std::int32_t number,
              const std::uint8_t* actions) override;
  void OnIntervention(const aquafarm::Farm& farm, std::int32_t number) override;

  std::uint64_t kept() const;  ///< bags written so far
  std::string fault() const;   ///< why nothing is kept any more; empty: all is well

 private:
  bool Wants(const EpisodeTape& tape);
  void Enqueue(EpisodeTape tape);
  void Run();
  void Write(const EpisodeTape& tape);

  const Keep keep_;
  const std::string folder_;
  EpisodeBagWriter writer_;  // only the writing thread touches it
  const RecorderLimits limits_;
  std::vector<EpisodeTape> tapes_;  // by farm; only the ranch's thread touches them
  std::optional<float> extreme_;    // best or worst return so far
  std::string extreme_path_;        // its bag; only the writing thread touches it

  mutable std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  std::deque<EpisodeTape> queue_;
  std::size_t waiting_bytes_{};  // of the actions queued and being written
  std::uint64_t kept_{};
  std::string fault_;
  bool ending_{};
  std::thread thread_;
};

}  // namespace aquafarm_sim
