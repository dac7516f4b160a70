// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/agents/evaluation/metrics.h"
#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/agents/training/run_folder.h"

namespace aquafarm::agents {

struct TrainerOptions {
  std::string algorithm;             ///< name, for checkpoints
  std::uint64_t seed{1};             ///< of episodes; below kEvaluationSeedBit
  std::uint64_t episodes{};          ///< 0: no such limit
  std::uint64_t steps{};             ///< farm steps; 0: no such limit. One of the two is needed
  double checkpoint_period_s{30.0};  ///< changes no result
  double progress_period_s{1.0};
};

/// How a training is getting on.
struct TrainingProgress {
  std::uint64_t episodes{};
  std::uint64_t steps{};          ///< farm steps
  std::uint64_t episode_limit{};  ///< 0: none
  std::uint64_t step_limit{};     ///< 0: none
  float last_return{};            ///< NaN: no episode has ended
  float mean_return{};            ///< of the last kWindow episodes; NaN: none
  float best_mean_return{};       ///< best mean over a full window; NaN: none yet
  float success_rate{};           ///< of the last kWindow episodes; NaN: none
  LearnerStatus learner;
  double steps_per_second{};
  double elapsed_s{};        ///< in this process
  double time_left_s{-1.0};  ///< -1: not known
  std::uint32_t restarts{};  ///< times that lost farms came back fresh
  inline static constexpr int kWindow = 50;
};

/// Why a training came to its end.
enum class TrainingEnd : std::uint8_t { kDone, kInterrupted, kLost, kStorage, kDiverged };

/// Lets a learner train on an environment: limits, progress, metrics, checkpoints, interruption.
/// The same options give the same bits however often it was stopped and resumed.
class Trainer {
 public:
  /// @param folder for metrics and checkpoints; null: none are kept
  /// @throws InputError when no limit is given
  Trainer(Environment& environment, Learner& learner, const TrainerOptions& options,
          RunFolder* folder = nullptr);
  ~Trainer();

  /// Goes on from a checkpoint of the same run. Before Run.
  /// @param path stands first in messages
  /// @throws InputError when it does not fit, with what differs
  void Resume(const Checkpoint& checkpoint, const std::string& path);

  using OnProgress = std::function<void(const TrainingProgress&)>;

  /// Trains until a limit is reached or `stop` is set, and saves. Never throws what the farms or
  /// the disk do: see the end and message().
  /// @param stop may be set by a signal handler; null: never
  TrainingEnd Run(const std::atomic<bool>* stop = nullptr, const OnProgress& on_progress = {});

  TrainingProgress progress() const { return progress_; }
  /// What went wrong, one line for people; empty: nothing.
  const std::string& message() const { return message_; }
  /// What there is to tell since the last call, one line for people; empty: nothing.
  std::string TakeNotice() { return std::exchange(notice_, {}); }
  /// Share of the run that is done, [0, 1].
  double Done() const;

 private:
  void Train(const std::atomic<bool>* stop, const OnProgress& on_progress);
  void Begin();
  void Count(const Results& results);
  void CountEpisode(const EpisodeResult& result);
  void Report(const OnProgress& on_progress);
  void Summarise();
  void Save(bool with_environment);
  bool IsDone() const;

  Environment& environment_;
  Learner& learner_;
  const TrainerOptions options_;
  RunFolder* const folder_;
  std::unique_ptr<MetricsFile> metrics_;

  const Results* results_{};  // that stand; null: not begun
  std::vector<std::uint8_t> actions_;
  TrainingProgress progress_;
  std::uint64_t next_episode_{};  // beyond all that have begun
  std::vector<float> returns_ = std::vector<float>(TrainingProgress::kWindow);  // ring
  std::vector<std::uint8_t> successes_ = std::vector<std::uint8_t>(TrainingProgress::kWindow);
  LearnerStatus status_;
  std::string message_;
  std::string notice_;

  using Clock = std::chrono::steady_clock;
  Clock::time_point start_;
  Clock::time_point reported_;
  Clock::time_point saved_;
  std::uint64_t reported_steps_{};
  double done_at_start_{};
};

}  // namespace aquafarm::agents
