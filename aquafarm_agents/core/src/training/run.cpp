// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/run.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "aquafarm/agents/base/options.h"
#include "aquafarm/agents/base/text.h"
#include "aquafarm/agents/learning/random_policy.h"
#include "aquafarm/agents/learning/warm_start.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/progress_text.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "learning/parse_checkpoint.h"
#include "training/network_size.h"

namespace aquafarm::agents {
namespace {

// Seed of the evaluation. Equals the default of aquafarm_evaluate, evaluate.launch and benchmarks.
constexpr std::uint64_t kSummarySeed = 1000;

std::string LearnerOptionsOf(const RunOptions& options) {
  if (options.exploration.empty()) return options.options;
  return options.options + " exploration=" + options.exploration;
}

/// One training run. Its members are the state that the steps of Train share.
class Run {
 public:
  Run(RunOptions options, const std::function<void(const RunStatus&)>& on_status,
      const std::atomic<bool>* stop, const RankedRun* ranked)
      : options_(std::move(options)), on_status_(on_status), stop_(stop), ranked_(ranked) {
    report_.status.algorithm = options_.algorithm;
    if (ranked_ == nullptr) return;
    report_.ranks = ranked_->group.size();
    const bool has_shards = options_.options.find("shards=") != std::string::npos;
    if (!has_shards) options_.options += " shards=" + std::to_string(DefaultShards());
  }

  void All(const MakeEnvironment& make_environment);
  void Fail(ExitCode code, const std::string& message) {
    report_.code = code;
    report_.status.message = message;
  }
  RunReport End();

 private:
  void Notify(RunPhase phase, const std::string& message = "") {
    report_.status.phase = phase;
    report_.status.message = message;
    if (on_status_) on_status_(report_.status);
  }
  bool Stopped() const { return stop_ != nullptr && *stop_; }
  ProcessGroup* group() const { return ranked_ == nullptr ? nullptr : &ranked_->group; }
  int DefaultShards() const { return std::max(kDefaultShards, report_.ranks); }
  void Choose(const MakeEnvironment& make_environment);
  std::unique_ptr<Learner> MakeLearner(const Algorithm& algorithm, const EnvironmentSpec& spec);
  void SetDefaultLimit(const Algorithm& algorithm, const EnvironmentSpec& spec);
  void TakeOver(const RunFolder& folder);
  void Initialize(Learner& learner);
  void Agree(const EnvironmentSpec& spec, const Learner& learner, bool has_checkpoint);
  bool Resume(Trainer& trainer, const RunFolder* folder);
  bool ResumeFromRank0(Trainer& trainer, const RunFolder* folder);
  std::string FindCheckpoint(const RunFolder& folder, Checkpoint& checkpoint);
  void Describe(const EnvironmentSpec& spec, const Learner& learner, const RunFolder& folder) const;
  void Train(Environment& environment, Learner& learner, RunFolder* folder);
  void Conclude(TrainingEnd end, const std::string& message, const RunFolder* folder);
  void SavePolicy(const EnvironmentSpec& spec, const Learner& learner, const RunFolder& folder);
  void Evaluate(Environment& environment, const Learner& learner, const RunFolder& folder);
  void Summarise();

  RunOptions options_;
  const std::function<void(const RunStatus&)>& on_status_;
  const std::atomic<bool>* stop_;
  const RankedRun* const ranked_;
  RunReport report_;
};

void Run::All(const MakeEnvironment& make_environment) {
  CheckRunOptions(options_);
  if (options_.algorithm == kAutoAlgorithm) Choose(make_environment);
  const Algorithm& algorithm = FindAlgorithm(options_.algorithm);
  std::optional<RunFolder> folder;  // only on rank 0
  if (group() == nullptr || group()->rank() == 0) {
    folder.emplace(options_.run_dir, options_.resume);
    if (options_.resume) TakeOver(*folder);
  }
  const bool has_checkpoint = options_.resume && folder && folder->NewestCheckpoint().has_value();
  if (!options_.init.empty() && !has_checkpoint) {
    options_.options = WithSizeOf(FindPolicy(options_.init).checkpoint.options, options_.options);
  }
  const auto observation_types =
      static_cast<std::uint8_t>(algorithm.observation_types(LearnerOptionsOf(options_)) |
                                (options_.credit == kCredits[0] ? int{kOwnRewardsBit} : 0));
  std::unique_ptr<Environment> environment = ranked_ == nullptr
                                                 ? make_environment(observation_types)
                                                 : ranked_->make_share(observation_types);
  const EnvironmentSpec whole = WholeSpec(environment->spec(), group());
  report_.farms = whole.farms;
  SetDefaultLimit(algorithm, whole);
  const std::unique_ptr<Learner> learner = MakeLearner(algorithm, environment->spec());
  if (!options_.init.empty() && !has_checkpoint) Initialize(*learner);
  for (const std::string& line : RenamedOptions(options_.options)) {
    Notify(RunPhase::kStarting, line);
  }
  const std::string warning = TakeTorchWarning();
  if (!warning.empty()) Notify(RunPhase::kStarting, warning);
  if (ranked_ != nullptr) Agree(whole, *learner, has_checkpoint);
  Train(*environment, *learner, folder ? &*folder : nullptr);
  if (report_.code != ExitCode::kOk || !folder) return;
  SavePolicy(whole, *learner, *folder);
  if (options_.evaluation_episodes > 0) {
    if (ranked_ != nullptr) environment = make_environment(observation_types);
    Evaluate(*environment, *learner, *folder);
  }
  if (report_.code == ExitCode::kOk) report_.status.message.clear();
}

std::unique_ptr<Learner> Run::MakeLearner(const Algorithm& algorithm, const EnvironmentSpec& spec) {
  const std::string options = LearnerOptionsOf(options_);
  if (ranked_ == nullptr) return algorithm.make(spec, options_.seed, options);
  return algorithm.make_rank(spec, options_.seed, options, ranked_->group);
}

// Sets the default limit and reports large tables.
void Run::SetDefaultLimit(const Algorithm& algorithm, const EnvironmentSpec& spec) {
  if (options_.episodes == 0 && options_.steps == 0) {
    options_.steps = DefaultSteps(algorithm, spec, LearnerOptionsOf(options_));
    if (options_.steps > algorithm.default_steps) {
      Notify(RunPhase::kStarting, "a table of " + std::to_string(spec.state_count) +
                                      " states is trained for " + std::to_string(options_.steps) +
                                      " steps; a network may need fewer: algorithm dqn");
    }
  }
  const std::string note = LargeTableNote(algorithm, spec, LearnerOptionsOf(options_));
  if (!note.empty()) Notify(RunPhase::kStarting, note);
}

// Checks that all ranks were started with the same arguments, and adopts the limits of rank 0.
void Run::Agree(const EnvironmentSpec& spec, const Learner& learner, bool has_checkpoint) {
  Checkpoint policy;
  learner.SavePolicy(policy);
  const nlohmann::json own{{"weights", HashBytes(policy.Section("weights"))},
                           {"algorithm", options_.algorithm},
                           {"options", learner.options()},
                           {"credit", options_.credit},
                           {"seed", options_.seed},
                           {"resume", options_.resume},
                           {"farms", spec.farms},
                           {"scenario_hash", spec.scenario_hash},
                           {"version", spec.version}};
  const nlohmann::json limits{{"episodes", options_.episodes},
                              {"steps", options_.steps},
                              {"has_checkpoint", has_checkpoint}};
  const auto first = nlohmann::json::parse(
      group()->Broadcast(nlohmann::json{{"same", own}, {"limits", limits}}.dump()));
  for (const auto& [name, value] : own.items()) {
    const nlohmann::json& expected = first.at("same").at(name);
    if (value == expected) continue;
    // A checkpoint replaces the initial weights.
    if (name == "weights" && first.at("limits").at("has_checkpoint")) continue;
    throw InputError(name + ": got " + value.dump() + " on rank " +
                     std::to_string(group()->rank()) + ", expected " + expected.dump() +
                     " as on rank 0; start all ranks with the same program and arguments");
  }
  first.at("limits").at("episodes").get_to(options_.episodes);
  first.at("limits").at("steps").get_to(options_.steps);
}

// Selects the algorithm (Fig. 6) by the spec of a temporary environment without observations.
void Run::Choose(const MakeEnvironment& make_environment) {
  const Choice choice = ChooseAlgorithm(make_environment(0)->spec());
  options_.algorithm = report_.status.algorithm = choice.algorithm;
  Notify(RunPhase::kStarting, "auto: " + choice.reason + ": " + choice.algorithm);
  CheckRunOptions(options_);
}

// Reads run.json of a resumed run: `init` with hidden_size, and the limits if no limit is given.
void Run::TakeOver(const RunFolder& folder) {
  const std::string path = folder.path() + "/run.json";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return;
  try {
    const auto run = nlohmann::json::parse(ReadFile(path));
    options_.init = run.value("init", "");
    if (!options_.init.empty()) {
      options_.options = WithSizeOf(run.value("options", ""), options_.options);
    }
    if (options_.episodes != 0 || options_.steps != 0) return;
    run.at("episodes").get_to(options_.episodes);
    run.at("steps").get_to(options_.steps);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": damaged: " + error.what());
  }
}

void Run::Initialize(Learner& learner) {
  const SavedPolicy saved = FindPolicy(options_.init);
  auto* const fits = dynamic_cast<WarmStart*>(&learner);
  if (fits == nullptr || saved.checkpoint.algorithm != options_.algorithm) {
    throw InputError("init: got " + options_.init + ", a policy of " + saved.checkpoint.algorithm +
                     ", for algorithm " + options_.algorithm +
                     "; expected a policy of ppo for ppo, or of mappo for mappo, without icm");
  }
  try {
    fits->LoadWeights(saved.checkpoint);
  } catch (const InputError& error) {
    const bool lacks_tokens = ReadsTokens(saved.checkpoint);
    throw InputError("init: " + options_.init + ": " + error.what() +
                     (lacks_tokens ? "; the scenario needs view: {tokens: true}" : ""));
  }
  Notify(RunPhase::kStarting, "starting with the weights of " + options_.init);
}

// Resumes from the newest undamaged checkpoint. Returns false if there is no checkpoint.
bool Run::Resume(Trainer& trainer, const RunFolder* folder) {
  if (ranked_ != nullptr) return ResumeFromRank0(trainer, folder);
  Checkpoint checkpoint;
  const std::string path = FindCheckpoint(*folder, checkpoint);
  if (path.empty()) return false;
  trainer.Resume(checkpoint, path);
  Notify(RunPhase::kStarting, "resuming from " + path);
  return true;
}

// Rank 0 sends the checkpoint to the other ranks, whose hosts may have no access to the run folder.
bool Run::ResumeFromRank0(Trainer& trainer, const RunFolder* folder) {
  Checkpoint checkpoint;
  std::string path;
  std::string bytes;
  group()->RunOnRank0([&] {
    if (folder != nullptr) path = FindCheckpoint(*folder, checkpoint);
    if (!path.empty()) bytes = ReadFile(path);
  });
  path = group()->Broadcast(path);
  if (path.empty()) return false;
  bytes = group()->Broadcast(bytes);
  trainer.Resume(ParseCheckpoint(bytes, path), path);
  Notify(RunPhase::kStarting, "resuming from " + path);
  return true;
}

// Reads the newest undamaged checkpoint. Returns its path; empty if there is no checkpoint.
std::string Run::FindCheckpoint(const RunFolder& folder, Checkpoint& checkpoint) {
  std::string damage;
  std::string path = folder.ReadNewestCheckpoint(checkpoint, damage);
  if (!damage.empty()) {
    Notify(RunPhase::kStarting, damage + "; using the previous checkpoint");
  }
  return path;
}

void Run::Describe(const EnvironmentSpec& spec, const Learner& learner,
                   const RunFolder& folder) const {
  folder.Write("scenario.yaml", spec.scenario_yaml);
  const nlohmann::json run{{"algorithm", options_.algorithm}, {"options", learner.options()},
                           {"credit", options_.credit},       {"init", options_.init},
                           {"seed", options_.seed},           {"episodes", options_.episodes},
                           {"steps", options_.steps},         {"farms", spec.farms},
                           {"scenario", spec.scenario_name},  {"scenario_hash", spec.scenario_hash},
                           {"version", spec.version},         {"libraries", NetworkLibraries()},
                           {"arguments", options_.arguments}};
  folder.Write("run.json", run.dump(2) + "\n");
}

void Run::Train(Environment& environment, Learner& learner, RunFolder* folder) {
  TrainerOptions options;
  options.algorithm = options_.algorithm;
  options.seed = options_.seed;
  options.episodes = options_.episodes;
  options.steps = options_.steps;
  options.checkpoint_period_s = options_.checkpoint_period_s;
  options.progress_period_s = options_.progress_period_s;
  options.group = group();
  Trainer trainer(environment, learner, options, folder);
  if (options_.resume && !Resume(trainer, folder)) {
    Notify(RunPhase::kStarting,
           options_.run_dir + ": contains no checkpoint yet; starting from the beginning");
  }
  if (trainer.Done() >= 1.0) {
    Notify(RunPhase::kStarting,
           "the run has reached its limit; set larger steps or episodes to continue it");
  }
  RunOnce(group(), [&] {
    if (folder != nullptr) Describe(WholeSpec(environment.spec(), group()), learner, *folder);
  });
  const double exchange_s = group() == nullptr ? 0.0 : group()->exchange_s();
  const TrainingEnd end = trainer.Run(stop_, [&](const TrainingProgress& progress) {
    report_.status.progress = progress;
    report_.status.learner = &learner;
    Notify(RunPhase::kTraining, trainer.TakeNotice());
    report_.status.learner = nullptr;
  });
  const double elapsed_s = report_.status.progress.elapsed_s;
  if (group() != nullptr && elapsed_s > 0.0) {
    report_.exchange_fraction = (group()->exchange_s() - exchange_s) / elapsed_s;
  }
  Conclude(end, trainer.message(), folder);
}

void Run::Conclude(TrainingEnd end, const std::string& message, const RunFolder* folder) {
  const std::string saved = "; saved in " + options_.run_dir;
  const std::string last = folder == nullptr ? ""
                                             : "; the last valid checkpoint is " +
                                                   folder->NewestCheckpoint().value_or("none");
  switch (end) {
    case TrainingEnd::kDone:
      return;
    case TrainingEnd::kInterrupted:
      return Fail(ExitCode::kInterrupted, "interrupted" + saved);
    case TrainingEnd::kLost:
      return Fail(ExitCode::kLost, message + (group() == nullptr ? saved : last));
    case TrainingEnd::kBadInput:
      return Fail(ExitCode::kBadInput, message + last);
    case TrainingEnd::kDiverged:
      return Fail(ExitCode::kDiverged, message + last);
    case TrainingEnd::kStorage:
      return Fail(ExitCode::kStorage, message + last);
    case TrainingEnd::kRankLost:
      return Fail(ExitCode::kRankLost, message + last);
  }
}

void Run::SavePolicy(const EnvironmentSpec& spec, const Learner& learner, const RunFolder& folder) {
  Checkpoint policy;
  policy.kind = Checkpoint::kPolicy;
  policy.algorithm = options_.algorithm;
  policy.options = learner.options();
  policy.spec = spec;
  policy.version = policy.spec.version;
  policy.seed = options_.seed;
  policy.steps = report_.status.progress.steps;
  policy.episodes = report_.status.progress.episodes;
  learner.SavePolicy(policy);
  WriteCheckpoint(folder.policy_path(), policy);
  report_.policy_path = folder.policy_path();
}

void Run::Evaluate(Environment& environment, const Learner& learner, const RunFolder& folder) {
  Notify(RunPhase::kEvaluating, "evaluating on episodes of other seeds");
  EvaluationContext context;
  context.policy = report_.policy_path;
  context.algorithm = options_.algorithm;
  context.training_steps = report_.status.progress.steps;
  context.scenario_name = environment.spec().scenario_name;
  context.scenario_hash = environment.spec().scenario_hash;
  context.version = environment.spec().version;
  context.farms = environment.spec().farms;
  const std::unique_ptr<Policy> greedy = learner.GreedyPolicy();
  report_.status.evaluation = agents::Evaluate(
      environment, *greedy, kSummarySeed, options_.evaluation_episodes, stop_,
      [&](std::size_t over) {
        Notify(RunPhase::kEvaluating, FormatCount(over) + " of " +
                                          std::to_string(options_.evaluation_episodes) +
                                          " episodes played");
      });
  report_.status.has_evaluation = true;
  WriteEvaluation(folder.path() + "/evaluation", report_.status.evaluation, context);
  if (options_.random_episodes > 0) {
    context.policy = context.algorithm = "random";
    context.training_steps = 0;
    RandomPolicy random(environment.spec());
    report_.random =
        agents::Evaluate(environment, random, kSummarySeed, options_.random_episodes, stop_);
    WriteEvaluation(folder.path() + "/evaluation_random", report_.random, context);
  }
  if (Stopped()) Fail(ExitCode::kInterrupted, "interrupted in the evaluation; the policy is saved");
}

void Run::Summarise() {
  const TrainingProgress& progress = report_.status.progress;
  std::string& text = report_.summary;
  if (progress.steps > 0) {
    text += "trained    " + options_.algorithm + ", " + FormatCount(progress.steps) + " steps, " +
            FormatCount(progress.episodes) + " episodes in " + FormatDuration(progress.elapsed_s) +
            "\n";
  }
  if (progress.episodes > 0) text += DescribeReturns(progress) + "\n";
  if (report_.status.has_evaluation) {
    text += "greedy     " + agents::Describe(report_.status.evaluation) + "\n";
  }
  if (!report_.random.episodes.empty()) {
    text += "RANDOM     " + agents::Describe(report_.random) + "\n";
  }
  if (report_.ranks > 1 && report_.code == ExitCode::kOk) {
    char line[120];
    std::snprintf(line, sizeof(line), "ranks      %d, %.1f %% of the time in exchanges\n",
                  report_.ranks, 100.0 * report_.exchange_fraction);
    text += line;
  }
  if (!report_.policy_path.empty()) text += "policy     " + report_.policy_path + "\n";
  if (!report_.status.message.empty()) text += report_.status.message + "\n";
}

RunReport Run::End() {
  if (group() == nullptr || group()->rank() == 0) {
    Summarise();
  } else if (report_.code != ExitCode::kOk && report_.code != ExitCode::kInterrupted) {
    report_.summary =
        "rank " + std::to_string(group()->rank()) + ": " + report_.status.message + "\n";
  }
  report_.status.phase = RunPhase::kEnded;
  if (on_status_) on_status_(report_.status);
  return report_;
}

void CheckAlgorithm(const RunOptions& options) {
  const Algorithm& algorithm = FindAlgorithm(options.algorithm);
  if (algorithm.make == nullptr) {
    throw InputError(options.algorithm +
                     " does not learn; evaluate it with policy:=" + options.algorithm);
  }
  algorithm.observation_types(LearnerOptionsOf(options));  // throws on wrong options
}

}  // namespace

void CheckRunOptions(const RunOptions& options) {
  if (options.algorithm != kAutoAlgorithm) CheckAlgorithm(options);
  if (std::find(kCredits.begin(), kCredits.end(), options.credit) == kCredits.end()) {
    throw InputError("credit: got '" + options.credit + "', expected one of: own, shared");
  }
  if ((options.seed & kEvaluationSeedBit) != 0) {
    throw InputError("seed: got " + std::to_string(options.seed) + ", expected less than 2^63");
  }
  const auto check = [](const char* what, double got, double min) {
    if (got >= min) return;  // false for NaN
    throw InputError(std::string(what) + ": got " + FormatNumber(got) + ", expected at least " +
                     FormatNumber(min));
  };
  check("checkpoint_period_s", options.checkpoint_period_s, 0.0);
  check("progress_period_s", options.progress_period_s, 0.0);
  check("evaluation_episodes", options.evaluation_episodes, 0.0);
  check("random_episodes", options.random_episodes, 0.0);
}

RunReport Train(const RunOptions& options, const MakeEnvironment& make_environment,
                const std::function<void(const RunStatus&)>& on_status,
                const std::atomic<bool>* stop, const RankedRun* ranked) {
  Run run(options, on_status, stop, ranked);
  try {
    run.All(make_environment);
  } catch (const InputError& error) {
    run.Fail(ExitCode::kBadInput, error.what());
  } catch (const StorageError& error) {
    run.Fail(ExitCode::kStorage, error.what());
  } catch (const RankLost& error) {
    run.Fail(ExitCode::kRankLost, error.what());
  } catch (const EnvironmentLost& error) {
    const bool stopped = stop != nullptr && *stop;
    run.Fail(stopped ? ExitCode::kInterrupted : ExitCode::kLost, error.what());
  } catch (const std::exception& error) {
    run.Fail(ExitCode::kInternal, std::string("internal error: ") + error.what());
  }
  return run.End();
}

}  // namespace aquafarm::agents
