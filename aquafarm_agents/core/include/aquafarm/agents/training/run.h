// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/agents/training/trainer.h"

namespace aquafarm::agents {

/// Credit assignment in scenarios with a team reward: each agent learns from its individual reward
/// (`own`), or all agents learn from the sum of the rewards (`shared`). Reported returns are always
/// the team's.
inline constexpr std::array<const char*, 2> kCredits{"own", "shared"};

/// Arguments of a training run.
struct RunOptions {
  std::string algorithm{"q_learning"};  ///< name of an algorithm, or kAutoAlgorithm
  std::string exploration;              ///< see ParseExploration; empty: default of the algorithm
  std::string options;                  ///< key=value …; see OptionReader
  std::string init;           ///< policy whose weights the learner starts with; may be empty
  std::string credit{"own"};  ///< one of kCredits
  std::uint64_t seed{1};      ///< below 2^63
  std::uint64_t episodes{};   ///< limit; 0: no limit
  /// Limit in farm steps; 0: no limit. If `episodes` and `steps` are both 0, a resumed run keeps
  /// the limits in its run.json, and a new run gets the limit of DefaultSteps.
  std::uint64_t steps{};
  std::string run_dir;  ///< run folder (run_folder.h)
  bool resume{};        ///< true: resumes the run in run_dir
  double checkpoint_period_s{30.0};
  double progress_period_s{1.0};
  std::int32_t evaluation_episodes{1000};  ///< of the greedy policy at the end; 0: no evaluation
  std::int32_t random_episodes{100};       ///< of RANDOM, for comparison; 0: no comparison
  std::vector<std::string> arguments;      ///< command line, for run.json
};

/// Phase of a training run, as reported to observers.
enum class RunPhase : std::uint8_t { kStarting, kTraining, kEvaluating, kEnded };

/// Status of a training run, as reported to observers.
struct RunStatus {
  RunPhase phase{};
  std::string algorithm;  ///< kAutoAlgorithm is replaced as soon as an algorithm is selected
  TrainingProgress progress;
  Evaluation evaluation;  ///< of the greedy policy; valid if has_evaluation is true
  bool has_evaluation{};
  std::string message;       ///< one readable line; may be empty
  const Learner* learner{};  ///< set in phase kTraining; valid only during the call of the observer
};

/// Result of a training run.
struct RunReport {
  ExitCode code{};
  RunStatus status;         ///< the last status
  Evaluation random;        ///< of the policy RANDOM; without episodes if it was not evaluated
  std::int32_t farms{};     ///< number of farms of all ranks; 0 if no environment was made
  std::string summary;      ///< a few readable lines; on ranks other than 0 only an error, or empty
  std::string policy_path;  ///< empty if no policy was written
  std::int32_t ranks{1};    ///< number of ranks
  double exchange_fraction{};  ///< share of the training time spent on exchanges between ranks
};

/// Checks the options before the run starts. @throws InputError if an option is wrong
void CheckRunOptions(const RunOptions& options);

/// Makes the environment with the observation types that the algorithm requires.
using MakeEnvironment = std::function<std::unique_ptr<Environment>(std::uint8_t observation_types)>;

/// A training whose farms are divided among the ranks of a process group.
struct RankedRun {
  ProcessGroup& group;
  MakeEnvironment make_share;  ///< makes the environment with the farms of this rank
};

/// Default number of shards (groups of farms, see PpoOptions::shards) of a training with several
/// ranks, or with the option --ranks 1. If there are more than 8 ranks, the default is the number
/// of ranks.
inline constexpr int kDefaultShards = 8;

/// Trains, saves the policy, and evaluates it and the policy RANDOM. Errors are returned in the
/// report. Without an evaluation of the policy, RANDOM is not evaluated either.
/// @param make_environment makes the environment with all farms
/// @param on_status called with each new status; may be empty
/// @param stop ends the run early if set, for example by a signal handler; may be null
/// @param ranked null if this process trains alone; only rank 0 writes the run folder and evaluates
RunReport Train(const RunOptions& options, const MakeEnvironment& make_environment,
                const std::function<void(const RunStatus&)>& on_status,
                const std::atomic<bool>* stop, const RankedRun* ranked = nullptr);

/// Returns whether several ranks can train an algorithm.
/// @param algorithm a name of Algorithms(), or kAutoAlgorithm, which several ranks cannot train
bool CanUseRanks(const std::string& algorithm);

/// Checks that several ranks can train an algorithm.
/// @param source name of the variable or option with the number of ranks, such as WORLD_SIZE
/// @throws InputError if they cannot. The message lists the algorithms that several ranks can train
void CheckRanks(const std::string& algorithm, int ranks, const std::string& source);

}  // namespace aquafarm::agents
