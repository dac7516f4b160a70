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
#include "aquafarm/agents/evaluation/metrics_file.h"
#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/agents/training/run_folder.h"

namespace aquafarm::agents {

/// Limits of a training, and how often it saves and reports.
struct TrainerOptions {
  std::string algorithm;             ///< name stored in checkpoints
  std::uint64_t seed{1};             ///< seed of the episodes; below kEvaluationSeedBit
  std::uint64_t episodes{};          ///< limit; 0: no limit. At least one limit is required
  std::uint64_t steps{};             ///< limit in farm steps; 0: no limit
  double checkpoint_period_s{30.0};  ///< min time between two checkpoints; no effect on results
  double progress_period_s{1.0};     ///< min time between two reports of progress
  ProcessGroup* group{};  ///< ranks that train together; null if this process trains alone
};

/// Returns the spec of the farms of all ranks.
/// @param spec spec of the farms of this rank
/// @param group null if there is one rank
EnvironmentSpec WholeSpec(const EnvironmentSpec& spec, const ProcessGroup* group);

class PendingSteps;

/// Progress of a training.
struct TrainingProgress {
  std::uint64_t episodes{};
  std::uint64_t steps{};          ///< farm steps
  std::uint64_t episode_limit{};  ///< 0: no limit
  std::uint64_t step_limit{};     ///< 0: no limit
  float last_return{};            ///< NaN before the first episode has ended
  float mean_return{};            ///< of the last kWindow episodes; NaN before the first has ended
  float best_mean_return{};  ///< max mean of kWindow consecutive episodes; NaN if fewer have ended
  float success_rate{};      ///< of the last kWindow episodes; NaN before the first has ended
  LearnerStatus learner;
  double steps_per_second{};  ///< farm steps per second since the previous report
  double elapsed_s{};         ///< since the training started or resumed in this process
  double time_left_s{-1.0};   ///< -1 if unknown
  std::uint32_t restarts{};   ///< number of restarts of all farms, see ConsumeRestart
  inline static constexpr int kWindow = 50;
};

/// Reason for the end of a training.
enum class TrainingEnd : std::uint8_t {
  kDone,         ///< a limit is reached
  kInterrupted,  ///< `stop` was set
  /// The farms were lost. If this process trains alone: also after any InputError, for example if
  /// the farms returned with another scenario.
  kLost,
  kStorage,   ///< the run folder cannot be written
  kDiverged,  ///< learning failed (LearnerFailed)
  kRankLost,  ///< another rank was lost
  kBadInput   ///< with several ranks: an InputError, for example no valid ranch of a family
};

/// Trains a learner on an environment. Checks the limits, reports progress, and writes metrics and
/// checkpoints. The same options give bit-identical results, even if the training is stopped and
/// resumed, unless farms are lost.
class Trainer {
 public:
  /// @param environment, learner, folder must outlive the trainer
  /// @param folder receives metrics and checkpoints. If it is null, as on ranks other than 0, this
  ///   trainer writes no files
  /// @throws InputError if no limit is set, or if the seed is not below kEvaluationSeedBit
  Trainer(Environment& environment, Learner& learner, const TrainerOptions& options,
          RunFolder* folder = nullptr);
  ~Trainer();

  /// Resumes from a checkpoint of the same run. Must be called before Run.
  /// @param path file name of the checkpoint, for error messages
  /// @throws InputError if the checkpoint is damaged or belongs to another run
  /// @throws StorageError if the metrics file cannot be opened
  /// @throws EnvironmentLost if the farms cannot be reached
  void Resume(const Checkpoint& checkpoint, const std::string& path);

  using OnProgress = std::function<void(const TrainingProgress&)>;

  /// Trains until a limit is reached or `stop` is set, then saves a checkpoint. Failures of the
  /// farms, the disk, the learner or the ranks are not thrown: the returned value and message()
  /// report them. If this process trains alone, a checkpoint is saved even if the farms are lost.
  /// After a failure on a rank, this rank exchanges no more data, so its caller must close the
  /// group.
  /// @param stop may be set by a signal handler; null if the training cannot be stopped
  /// @param on_progress called at the start, about every progress_period_s, and at the end
  TrainingEnd Run(const std::atomic<bool>* stop = nullptr, const OnProgress& on_progress = {});

  TrainingProgress progress() const { return progress_; }
  /// Error message, one readable line; empty if there was no error.
  const std::string& message() const { return message_; }
  /// Returns and clears the latest notice, one readable line; empty if there is none.
  std::string TakeNotice() { return std::exchange(notice_, {}); }
  /// Returns the fraction of the run that is done, [0, 1].
  double Done() const;

 private:
  void Train(const std::atomic<bool>* stop, const OnProgress& on_progress);
  void Begin();
  void Count(const StepResults& results);
  void CountEpisode(const EpisodeSummary& result);
  void CountRestarts();
  void SaveWithoutFarms();
  void Report(const OnProgress& on_progress);
  void Summarise();
  void Save(bool with_environment);
  bool Synchronize(const std::atomic<bool>* stop);
  void CountPending(const std::vector<PendingSteps>& parts);
  bool CollectSections(Checkpoint& checkpoint) const;
  void Write(Checkpoint& checkpoint);
  bool IsDone() const;

  Environment& environment_;
  Learner& learner_;
  const TrainerOptions options_;
  RunFolder* const folder_;
  std::unique_ptr<MetricsFile> metrics_;

  const StepResults* results_{};  // the latest results; null before the start
  std::vector<std::uint8_t> actions_;
  TrainingProgress progress_;
  std::uint64_t next_episode_{};  // higher than the number of every started episode
  // Ring buffers of the last episodes.
  std::vector<float> returns_ = std::vector<float>(TrainingProgress::kWindow);
  std::vector<std::uint8_t> successes_ = std::vector<std::uint8_t>(TrainingProgress::kWindow);
  LearnerStatus status_;
  std::string message_;
  std::string notice_;

  std::uint32_t uncounted_restarts_{};

  const std::uint32_t sync_interval_;      // calls of Learner::Step between two synchronizations
  std::unique_ptr<PendingSteps> pending_;  // results since the last synchronization

  using Clock = std::chrono::steady_clock;
  static bool IsDue(Clock::time_point last, double period_s);
  Clock::time_point start_;
  Clock::time_point reported_;
  Clock::time_point saved_;
  bool is_saved_{};  ///< true if the newest checkpoint contains the current state
  std::uint64_t reported_steps_{};
  double done_at_start_{};
};

}  // namespace aquafarm::agents
