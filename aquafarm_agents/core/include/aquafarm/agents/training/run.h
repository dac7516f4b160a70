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
#include "aquafarm/agents/training/trainer.h"

namespace aquafarm::agents {

/// What agents learn from where a scenario shares the reward: `own`, each from its own part, or
/// `shared`, all from the sum. Returns are the team's in any case.
inline constexpr std::array<const char*, 2> kCredits{"own", "shared"};

/// A training from its first argument to its summary, wherever the farms are.
struct RunOptions {
  std::string algorithm{"q_learning"};  ///< or kAutoAlgorithm
  std::string exploration;              ///< empty: the algorithm's own
  std::string options;                  ///< key=value …; see OptionReader
  std::string credit{"own"};            ///< own or shared; see kCredits
  std::uint64_t seed{1};
  std::uint64_t episodes{};  ///< 0 with steps 0: DefaultSteps
  std::uint64_t steps{};
  std::string run_dir;
  bool resume{};
  double checkpoint_period_s{30.0};
  double progress_period_s{1.0};
  std::int32_t evaluation_episodes{1000};  ///< greedy, at the end; 0: none
  std::int32_t random_episodes{100};       ///< of RANDOM beside it; 0: none
  std::vector<std::string> arguments;      ///< as given; for run.json
};

/// What those who watch are told.
enum class RunPhase : std::uint8_t { kStarting, kTraining, kEvaluating, kEnded };

struct RunStatus {
  RunPhase phase{};
  std::string algorithm;  ///< once auto has chosen, what it chose
  TrainingProgress progress;
  Evaluation evaluation;  ///< of the learner; meaningful once phase is kEnded and has_evaluation
  bool has_evaluation{};
  std::string message;       ///< one line for people; empty: nothing to say
  const Learner* learner{};  ///< while it trains; only for the time of the call
};

struct RunReport {
  ExitCode code{};
  RunStatus status;
  Evaluation random;
  std::int32_t farms{};     ///< stepped together; 0: none were reached
  std::string summary;      ///< a few lines for people
  std::string policy_path;  ///< empty: none was written
};

/// Refuses options that cannot work, before anything is started.
/// @throws InputError
void CheckRunOptions(const RunOptions& options);

/// Makes the environment for the encodings that the algorithm reads.
using MakeEnvironment = std::function<std::unique_ptr<Environment>(std::uint8_t encodings)>;

/// Trains, saves the policy, evaluates it against RANDOM. Throws nothing; the report says it all.
RunReport Train(const RunOptions& options, const MakeEnvironment& make_environment,
                const std::function<void(const RunStatus&)>& on_status,
                const std::atomic<bool>* stop);

/// "steps 812,000 / 3,000,000  episodes 1,240  return 81.2  success 0.62  … left 1.2 s"
std::string DescribeProgress(const TrainingProgress& progress);

}  // namespace aquafarm::agents
