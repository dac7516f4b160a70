// SPDX-License-Identifier: BSD-3-Clause
// Trains an agent in this process, without ROS.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "app.h"
#include "aquafarm/agents/environment/family_environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/ranks/process_group.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/progress_text.h"
#include "aquafarm/agents/training/run.h"
#include "aquafarm/scenario/limits.h"
#include "local_ranks.h"

namespace aquafarm::agents {
namespace {

std::string ListAlgorithms() {
  std::size_t widest = 0;
  for (const Algorithm& one : Algorithms()) {
    widest = std::max(widest, std::string_view(one.name).size());
  }
  std::string text = "algorithms:";
  for (const Algorithm& one : Algorithms()) {
    std::string name = one.name;
    name.resize(widest, ' ');
    text += "\n  " + name + "  " + one.summary;
  }
  return text;
}

std::int32_t DefaultFarms(const std::string& algorithm) {
  return algorithm == kAutoAlgorithm ? kDefaultFarms : FindAlgorithm(algorithm).default_farms;
}

void Print(const RunStatus& status) {
  if (!status.message.empty() && status.phase != RunPhase::kEnded) {
    std::printf("%s\n", status.message.c_str());
  }
  if (status.phase == RunPhase::kTraining) {
    std::printf("%s\n", DescribeProgress(status.progress).c_str());
  }
  std::fflush(stdout);
}

struct Arguments {
  RunOptions options;
  ScenarioChoice scenario;
  std::vector<std::string> settings;
  EnvironmentOptions environment;
  int ranks{};  // processes to start; 0: none
  GroupTimes times;
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  RunOptions& options = arguments.options;
  app.add_option("scenario", arguments.scenario.name,
                 "scenario file, or the name of a shipped one");
  app.add_option("-a,--algorithm", options.algorithm, "learner by name, or auto");
  app.add_option("-e,--episodes", options.episodes, "max number of episodes; 0: no limit");
  app.add_option(
      "-n,--steps", options.steps,
      "max number of steps, summed over all farms; 0: no limit if --episodes is set, else the "
      "algorithm's default, but at least eight steps per state of a large table");
  app.add_option("-s,--seed", options.seed, "seed of episodes and exploration");
  app.add_option("-f,--farms", arguments.environment.farms,
                 "number of parallel farms; 0: the algorithm's default, 256 for ppo and mappo, 16 "
                 "for others")
      ->check(CLI::Range(0, kMaxFarms));
  app.add_option("-t,--threads", arguments.environment.threads,
                 "number of threads that step the farms")
      ->check(CLI::Range(1, 256));
  app.add_option("-d,--run-dir", options.run_dir, "run folder; empty: a new one under ./runs");
  app.add_flag("-r,--resume", options.resume,
               "resume from the newest checkpoint in the run folder");
  app.add_option("-x,--exploration", options.exploration,
                 "exploration strategy, such as epsilon_greedy:linear:1:0.05:0.5, boltzmann:1 or "
                 "icm+boltzmann:1; empty: the algorithm's default");
  app.add_option("-o,--set", arguments.settings, "option of the learner, key=value");
  app.add_option("--init", options.init,
                 "run folder, checkpoint or generalist whose weights the learner starts with "
                 "(ppo, mappo); empty: random weights");
  app.add_option("--credit", options.credit,
                 "reward that each agent learns from if the scenario shares the reward of several "
                 "agents: own (its own reward) or shared (the sum)");
  app.add_option("--checkpoint-period", options.checkpoint_period_s, "seconds between checkpoints");
  app.add_option("--evaluate", options.evaluation_episodes,
                 "greedy evaluation episodes at the end; 0 disables them");
  app.add_option("--random", options.random_episodes,
                 "RANDOM episodes for comparison; 0 disables them");
  app.add_option(
         "--ranks", arguments.ranks,
         "number of processes on this host that train together, a power of two. Results are equal "
         "for 1 to 8, and for more if all runs have the same option shards. 0: one process, or the "
         "processes that mpirun, srun or torchrun started")
      ->check(CLI::Range(0, 4096));
  app.add_option("--rank-start", arguments.times.start_s,
                 "max seconds that a rank waits for the others at the start")
      ->check(CLI::Range(1.0, 86400.0));
  app.add_option("--rank-answer", arguments.times.answer_s,
                 "max seconds that a rank waits for an answer of another rank")
      ->check(CLI::Range(1.0, 86400.0));
  AddScenarioOptions(app, arguments.scenario);
}

// Trains with all farms in this process. If there are several ranks, this process has only the
// farms of its rank.
RunReport TrainHere(Arguments& arguments, ProcessGroup* group) {
  const RunOptions& options = arguments.options;
  EnvironmentOptions& environment = arguments.environment;
  if (environment.farms == 0) environment.farms = DefaultFarms(options.algorithm);
  const auto make = [&](std::uint8_t observation_types) {
    environment.observation_types = observation_types;
    return MakeLocalFarms(arguments.scenario.Load(), environment);
  };
  if (group == nullptr) return Train(options, make, Print, &stop_requested);
  const auto make_share = [&](std::uint8_t observation_types) {
    const FarmShare share = ShareOfRank(environment.farms, group->rank(), group->size());
    EnvironmentOptions own = environment;
    own.observation_types = observation_types;
    own.farms /= group->size();
    return MakeLocalFarms(arguments.scenario.Load(), own, share);
  };
  const RankedRun ranked{*group, make_share};
  const auto print = [&](const RunStatus& status) {
    if (group->rank() == 0) Print(status);
  };
  return Train(options, make, print, &stop_requested, &ranked);
}

int Run(Arguments& arguments, char** argv) {
  const RankVariables variables =
      ReadRankVariables([](const char* name) { return std::getenv(name); });
  const bool is_started = variables.world_size > 1;
  const int ranks = is_started ? variables.world_size : arguments.ranks;
  if (ranks > 1) {
    CheckRanks(arguments.options.algorithm, ranks, is_started ? variables.launcher : "ranks");
    if (!is_started) return RunLocalRanks(ranks, argv);
  }
  if (arguments.ranks == 1 && CanUseRanks(arguments.options.algorithm) &&
      arguments.options.options.find("shards=") == std::string::npos) {
    arguments.options.options += " shards=" + std::to_string(kDefaultShards);
  }
  std::unique_ptr<ProcessGroup> group;
  if (is_started) group = JoinProcessGroup(variables, arguments.times);
  if (arguments.options.run_dir.empty()) arguments.options.run_dir = NewRunFolder();
  StopOnSignals();
  const RunReport report = TrainHere(arguments, group.get());
  std::fprintf(report.code == ExitCode::kOk ? stdout : stderr, "%s", report.summary.c_str());
  return static_cast<int>(report.code);
}

int Main(int argc, char** argv) {
  Arguments arguments;
  RunOptions& options = arguments.options;
  arguments.environment.farms = 0;
  CLI::App app(
      "Trains an agent without ROS, in one or several processes. Ctrl-C saves the run; --resume "
      "continues it.");
  app.option_defaults()->always_capture_default();
  AddOptions(app, arguments);
  return RunWithExitCodes(app, [&] {
    app.footer(ListAlgorithms() +
               "\nexit codes: 0 trained, 2 bad argument, 3 storage, 5 learning failed, 6 another "
               "rank ended, 130 "
               "interrupted and saved");
    app.parse(argc, argv);
    for (const std::string& setting : arguments.settings) options.options += " " + setting;
    options.arguments.assign(argv, argv + argc);
    try {
      return Run(arguments, argv);
    } catch (const RankLost& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return static_cast<int>(ExitCode::kRankLost);
    }
  });
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) { return aquafarm::agents::Main(argc, argv); }
