// SPDX-License-Identifier: BSD-3-Clause
// Plays a saved policy greedily in this process, without ROS.

#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "app.h"
#include "aquafarm/agents/base/exit_code.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/family_environment.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/evaluation/rollout_values.h"
#include "aquafarm/agents/evaluation/route.h"
#include "aquafarm/agents/evaluation/tabular_model.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/planning/optimum.h"
#include "aquafarm/agents/planning/team_bound.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/scenario/limits.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm::agents {
namespace {

struct Arguments {
  std::string policy;
  ScenarioChoice scenario;
  std::string output;
  std::string route;
  std::uint64_t route_episode{};
  std::string ranch;
  std::string values;
  std::int32_t values_episodes{1};
  double values_discount{1.0};
  std::string matrices;
  std::string matrix_policy{"epsilon_greedy:0"};
  bool bound{};
  std::size_t optimum{};
  std::uint64_t seed{1000};
  std::optional<std::uint64_t> policy_seed;
  std::int32_t episodes{1000};
  EnvironmentOptions environment{64, 0, false, 1};
};

// Returns the path or name of the scenario. The default is the scenario in the policy's run folder.
std::string ScenarioOf(const Arguments& arguments, const SavedPolicy& saved) {
  namespace fs = std::filesystem;
  if (!arguments.scenario.name.empty()) return arguments.scenario.name;
  const fs::path file = fs::path(saved.path).parent_path();
  std::error_code ignored;
  for (const fs::path& folder : {file, file.parent_path()}) {
    const std::string path = (folder / "scenario.yaml").string();
    if (fs::exists(path, ignored)) return path;
  }
  throw InputError(
      "scenario: got none, expected a scenario file or name: there is no scenario.yaml "
      "with the policy " +
      saved.path);
}

// Returns the mean of TeamBound over the played episodes.
double MeanBound(const std::shared_ptr<const Scenario>& scenario, const Evaluation& evaluation) {
  const auto count = static_cast<std::int32_t>(evaluation.episodes.size());
  double sum = 0.0;
  Farm farm(scenario);
  for (std::int32_t episode = 0; episode < count && !stop_requested; ++episode) {
    farm.Reset(evaluation.seed, static_cast<std::uint64_t>(episode));
    sum += TeamBound(farm);
  }
  return sum / count;
}

// Throws InputError if a given option needs one ranch but the scenario is a family.
void RefuseForFamily(const Arguments& arguments, const Scenario& scenario) {
  if (!scenario.family) return;
  const auto refuse = [&scenario](bool is_given, const char* option) {
    if (!is_given) return;
    throw InputError(std::string(option) + ": scenario " + scenario.name +
                     " is a family of ranches, expected one ranch");
  };
  refuse(arguments.bound, "--bound");
  refuse(!arguments.values.empty(), "--values");
  refuse(!arguments.matrices.empty(), "--matrices");
  refuse(!arguments.route.empty(), "--route");
}

// Returns a farm at the start of an episode.
Farm StartOf(const std::shared_ptr<const Scenario>& scenario, std::uint64_t seed,
             std::uint64_t episode) {
  if (scenario->family) return MakeRanch(*scenario, seed, episode);
  Farm farm(scenario);
  farm.Reset(seed, episode);
  return farm;
}

// Writes the ranch of an episode of a family as a separate scenario. At the same seed and number,
// the episode of this scenario is equal to that of the family.
void WriteRanch(const Arguments& arguments, const std::shared_ptr<const Scenario>& family) {
  if (!family->family) {
    throw InputError("--ranch: scenario " + family->name + " is one ranch, expected a family");
  }
  Scenario ranch =
      StartOf(family, EvaluationSeed(arguments.seed), arguments.route_episode).scenario();
  ranch.name = std::filesystem::path(arguments.ranch).stem().string();
  WriteFileAtomically(arguments.ranch, ToYaml(ranch));
}

void PrintOptimum(const std::shared_ptr<const Scenario>& scenario, const Evaluation& evaluation,
                  std::size_t max_states) {
  const OptimumShare share = CompareWithOptimum(
      evaluation.episodes,
      [&scenario](std::uint64_t seed, std::uint64_t episode) {
        return StartOf(scenario, seed, episode);
      },
      max_states, evaluation.seed, &stop_requested);
  if (share.planned == 0) {
    std::printf("optimum: every episode is too large to plan\n");
    return;
  }
  std::printf(
      "optimum %.1f, return %.1f, share %.4f [95 %%: %.4f, %.4f] of %zu episodes (%zu too large); "
      "%zu of %zu solved\n",
      share.mean_optimum, share.mean_return, share.share, share.low, share.high, share.planned,
      share.too_large, share.solved, share.solvable);
}

// Plays the episodes and reports their progress.
Evaluation Play(const Arguments& arguments, Environment& environment, Policy& policy) {
  AccountsOf accounts;
  DeviceOutcomes devices;
  if (const auto* const local = dynamic_cast<const LocalEnvironment*>(&environment)) {
    accounts = [local, &devices](std::int32_t farm) {
      devices.Add(local->batch().farm(farm).devices());
      return local->batch().farm(farm).SettleAccounts();
    };
  } else if (const auto* const family = dynamic_cast<const FamilyEnvironment*>(&environment)) {
    devices.are_same = false;
    accounts = [family, &devices](std::int32_t farm) {
      devices.Add(family->farm(farm).devices());
      return family->farm(farm).SettleAccounts();
    };
  }
  Evaluation evaluation = Evaluate(
      environment, policy, arguments.seed, arguments.episodes, &stop_requested,
      [&arguments](std::size_t over) {
        std::printf("%zu of %d episodes played\n", over, arguments.episodes);
        std::fflush(stdout);
      },
      arguments.policy_seed, accounts);
  evaluation.devices = std::move(devices);
  return evaluation;
}

// Computes and writes what the options request in addition to the evaluation.
// @returns false if it was interrupted
bool WriteRequested(const Arguments& arguments, const SavedPolicy& saved,
                    const std::shared_ptr<const Scenario>& scenario, const EnvironmentSpec& spec,
                    Evaluation& evaluation) {
  const auto make_policy = [&saved](const EnvironmentSpec& of) { return MakePolicy(saved, of); };
  if (arguments.bound) {
    evaluation.mean_bound = MeanBound(scenario, evaluation);
    if (stop_requested) return false;
    std::printf("upper bound %.1f per episode", *evaluation.mean_bound);
    if (*evaluation.mean_bound > 0.0) {
      std::printf(", share of it %.3f", evaluation.mean_return / *evaluation.mean_bound);
    }
    std::printf("\n");
  }
  if (arguments.optimum > 0) {
    PrintOptimum(scenario, evaluation, arguments.optimum);
    if (stop_requested) return false;
  }
  if (!arguments.values.empty()) {
    const RolloutValues values = PlayValues(
        scenario, saved.observation_types, make_policy, arguments.seed, arguments.route_episode,
        arguments.values_episodes, &stop_requested, arguments.values_discount);
    if (stop_requested) return false;
    WriteValues(arguments.values, values, saved.path, *scenario);
  }
  if (!arguments.matrices.empty()) {
    WriteMatrices(arguments.matrices, *scenario, saved.checkpoint, arguments.matrix_policy,
                  arguments.values_discount);
  }
  if (!arguments.ranch.empty()) WriteRanch(arguments, scenario);
  if (!arguments.route.empty()) {
    const Route route = TraceRoute(scenario, saved.observation_types, make_policy, arguments.seed,
                                   arguments.route_episode, &stop_requested);
    if (stop_requested) return false;
    WriteRoute(arguments.route, route, spec);
  }
  return true;
}

ExitCode Run(Arguments arguments) {
  const SavedPolicy saved = FindPolicy(arguments.policy);
  arguments.environment.observation_types = saved.observation_types;
  arguments.scenario.name = ScenarioOf(arguments, saved);
  // Tokens from the environment are cheaper than tokens computed from the states.
  if (ReadsTokens(saved.checkpoint)) {
    arguments.scenario.tokens = true;
    arguments.environment.observation_types &= static_cast<std::uint8_t>(~kStatesBit);
  }
  const auto scenario = arguments.scenario.Load();
  RefuseForFamily(arguments, *scenario);
  const std::unique_ptr<Environment> environment = MakeLocalFarms(scenario, arguments.environment);
  const EnvironmentSpec& spec = environment->spec();
  const std::unique_ptr<Policy> policy = MakePolicy(saved, spec);
  if (arguments.bound) TeamBound(Farm(scenario));  // fails early if the scenario has no bound
  const std::string warning = TakeTorchWarning();
  if (!warning.empty()) std::fprintf(stderr, "%s\n", warning.c_str());
  Evaluation evaluation = Play(arguments, *environment, *policy);
  std::printf("%s on %s: %s\n", saved.checkpoint.algorithm.c_str(), spec.scenario_name.c_str(),
              Describe(evaluation).c_str());
  const std::string losses = DescribeLosses(evaluation);
  if (!losses.empty()) std::printf("%s\n", losses.c_str());
  std::fflush(stdout);  // before steps that may still fail
  if (evaluation.complete && !WriteRequested(arguments, saved, scenario, spec, evaluation)) {
    return ExitCode::kInterrupted;
  }
  // The evaluation is written last: if a complete one exists, all files exist.
  if (!arguments.output.empty()) {
    WriteEvaluation(arguments.output, evaluation,
                    {saved.path, saved.checkpoint.algorithm, saved.checkpoint.steps,
                     spec.scenario_name, spec.scenario_hash, spec.version, spec.farms});
  }
  return evaluation.complete ? ExitCode::kOk : ExitCode::kInterrupted;
}

void AddEpisodeOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("policy", arguments.policy,
                 "run folder, checkpoint file, FILE.py, FILE.zip (docs/python.md), generalist, "
                 "random, planner, clairvoyant, do_nothing or fetch_by_value")
      ->required();
  app.add_option("scenario", arguments.scenario.name,
                 "scenario file or name; empty: the one in the policy's run folder");
  app.add_option("-e,--episodes", arguments.episodes, "number of episodes")
      ->check(CLI::Range(1, 10000000));
  app.add_option("-s,--seed", arguments.seed, "seed of the episodes");
  app.add_option(
      "--policy-seed", arguments.policy_seed,
      "seed of a policy that draws its actions, such as random; default: the seed of the "
      "episodes");
  app.add_option("-f,--farms", arguments.environment.farms, "number of parallel farms")
      ->check(CLI::Range(1, kMaxFarms));
}

void AddOutputOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("-w,--write", arguments.output,
                 "write <this>.csv and <this>.json; empty: nothing");
  app.add_option(
      "--route", arguments.route,
      "write an episode's route and actions, and the best move in each cell, to this JSON file; "
      "empty: nothing");
  app.add_option("--route-episode", arguments.route_episode,
                 "number of the episode for --route, --values and --ranch");
  app.add_option("--ranch", arguments.ranch,
                 "write the ranch that a family draws for one episode to this YAML file, as a "
                 "scenario; empty: nothing");
  app.add_option(
      "--values", arguments.values,
      "play an episode from each start cell of ship 0 and write the returns and the scenario's sea "
      "to this JSON file; empty: nothing");
  app.add_option("--values-episodes", arguments.values_episodes, "episodes that --values averages")
      ->check(CLI::Range(1, 10000));
  app.add_option("--values-discount", arguments.values_discount,
                 "discount γ of --values (Eq. 10) and of V* in --matrices; 1: undiscounted")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--matrices", arguments.matrices,
                 "write <this>_policy.mtx (Eq. 9), <this>_transitions.mtx (Eq. 4) and "
                 "<this>_states.csv with V* (Eq. 11) of a tabular policy; empty: nothing");
  app.add_option("--matrix-policy", arguments.matrix_policy,
                 "policy of --matrices: epsilon_greedy:ε (0 is greedy) or boltzmann:T");
  app.add_flag("--bound", arguments.bound,
               "print the return as a share of an upper bound, in which the best ship fetches each "
               "device, without conflicts and with known disasters");
  app.add_option(
      "--optimum", arguments.optimum,
      "print the share of the clairvoyant optimum over the episodes whose plans have at most "
      "this number of (cell, devices) states; 0: no share");
}

int Main(int argc, char** argv) {
  Arguments arguments;
  arguments.scenario.name.clear();
  CLI::App app(
      "Plays a saved policy greedily on episodes of evaluation seeds and reports the results.");
  app.footer("exit codes: 0 played, 2 bad argument or policy, 3 storage, 130 interrupted");
  app.option_defaults()->always_capture_default();
  AddEpisodeOptions(app, arguments);
  AddOutputOptions(app, arguments);
  AddScenarioOptions(app, arguments.scenario);
  return RunWithExitCodes(app, [&] {
    app.parse(argc, argv);
    StopOnSignals();
    return static_cast<int>(Run(arguments));
  });
}

}  // namespace
}  // namespace aquafarm::agents

int main(int argc, char** argv) { return aquafarm::agents::Main(argc, argv); }
