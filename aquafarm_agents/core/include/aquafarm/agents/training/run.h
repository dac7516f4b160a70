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
/// (`own`), or all agents learn from the sum (`shared`). Reported returns are always the team's.
inline constexpr std::array<const char*, 2> kCredits{"own", "shared"};

/// Arguments of a training run, with farms in this process or behind ROS services.
struct RunOptions {
  std::string algorithm{"q_learning"};  ///< or kAutoAlgorithm
  std::string exploration;              ///< empty: default of the algorithm
  std::string options;                  ///< key=value …; see OptionReader
  std::string init;                     ///< policy whose weights a learner begins with, or empty
  std::string credit{"own"};            ///< own or shared; see kCredits
  std::uint64_t seed{1};
  std::uint64_t episodes{};  ///< 0 with steps 0: DefaultSteps
  std::uint64_t steps{};
  std::string run_dir;
  bool resume{};
  double checkpoint_period_s{30.0};
  double progress_period_s{1.0};
  std::int32_t evaluation_episodes{1000};  ///< greedy, at the end; 0 disables them
  std::int32_t random_episodes{100};       ///< of RANDOM, for comparison; 0 disables them
  std::vector<std::string> arguments;      ///< as given; for run.json
};

/// Phase of a training run, as reported to observers.
enum class RunPhase : std::uint8_t { kStarting, kTraining, kEvaluating, kEnded };

struct RunStatus {
  RunPhase phase{};
  std::string algorithm;  ///< the selected algorithm once auto has chosen
  TrainingProgress progress;
  Evaluation evaluation;  ///< of the learner; valid if phase is kEnded and has_evaluation is true
  bool has_evaluation{};
  std::string message;       ///< one readable line; empty if there is no message
  const Learner* learner{};  ///< set during training; valid only during the call
};

/// What a training run ends with.
struct RunReport {
  ExitCode code{};
  RunStatus status;
  Evaluation random;
  std::int32_t farms{};     ///< number of farms; 0 if no environment was made
  std::string summary;      ///< a few readable lines; of a rank other than 0 only its failure
  std::string policy_path;  ///< empty if no policy was written
  std::int32_t ranks{1};
  double exchange_fraction{};  ///< of the training time, in exchanges between ranks [0, 1]
};

/// Validates the options before the run starts. @throws InputError
void CheckRunOptions(const RunOptions& options);

/// Makes the environment with the observation types that the algorithm requires.
using MakeEnvironment = std::function<std::unique_ptr<Environment>(std::uint8_t observation_types)>;

/// A training whose farms are divided among the ranks of a process group.
struct RankedRun {
  ProcessGroup& group;
  MakeEnvironment make_share;  ///< makes the environment with the farms of this rank
};

/// Default number of shards of a training with several ranks.
inline constexpr int kDefaultShards = 8;

/// Trains, saves the policy and evaluates it against RANDOM. Never throws; errors are returned in
/// the report.
/// @param make_environment with all farms
/// @param ranked null if this process trains alone. Rank 0 alone writes the run folder, reports
///        progress and evaluates.
RunReport Train(const RunOptions& options, const MakeEnvironment& make_environment,
                const std::function<void(const RunStatus&)>& on_status,
                const std::atomic<bool>* stop, const RankedRun* ranked = nullptr);

/// Checks that the algorithm can be trained by several ranks.
/// @param source of the number of ranks, such as WORLD_SIZE
/// @throws InputError with the algorithms that can
void CheckRanks(const std::string& algorithm, int ranks, const std::string& source);

/// Progress line: "steps 812,000 / 3,000,000  episodes 1,240  return 81.2  …  left 1.2 s".
std::string DescribeProgress(const TrainingProgress& progress);

}  // namespace aquafarm::agents
