// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/run.h"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "agents_fixture.h"
#include "aquafarm/base/version.h"
#include "process.h"

namespace aquafarm::agents::test {
namespace {

class RunTest : public FolderTest {
 protected:
  RunTest() {
    options_.run_dir = folder_ + "/run";
    options_.steps = 60000;
    options_.evaluation_episodes = 50;
    options_.random_episodes = 10;
  }
  RunReport Train(const MakeEnvironment& make) {
    return agents::Train(
        options_, make, [this](const RunStatus& status) { statuses_.push_back(status); }, nullptr);
  }
  RunReport Train() {
    return Train([](std::uint8_t observation_types) {
      return std::make_unique<LocalEnvironment>(TinyFarm(),
                                                EnvironmentOptions{4, observation_types, false, 1});
    });
  }
  RunOptions options_;
  std::vector<RunStatus> statuses_;
};

/// A farm that is lost permanently after some steps.
class LostEnvironment final : public Environment {
 public:
  explicit LostEnvironment(int steps)
      : steps_(steps), farms_(TinyFarm(), {2, kIndexBit, false, 1}) {}
  const EnvironmentSpec& spec() const override { return farms_.spec(); }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first) override {
    return farms_.Reset(seed, first);
  }
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override {
    Check();
    --steps_;
    return farms_.Step(actions);
  }
  std::string Save() override {
    Check();
    return farms_.Save();
  }
  const StepResults& Load(const std::string& bytes) override { return farms_.Load(bytes); }

 private:
  void Check() const {
    if (steps_ <= 0) throw EnvironmentLost("sim node: gone");
  }
  int steps_;
  LocalEnvironment farms_;
};

TEST_F(RunTest, AgentsLearnFromTheirOwnPartByDefault) {
  Scenario team = aquafarm::test::TinyScenario();
  team.ships.count = 2;
  team.ports.cells = {{2, 0}, {2, 1}};
  team.rewards.sharing = RewardSharing::kTeam;
  options_.steps = 500;
  options_.evaluation_episodes = options_.random_episodes = 0;
  std::vector<int> asked;
  const MakeEnvironment make = [&](std::uint8_t observation_types) {
    asked.push_back(observation_types & kOwnRewardsBit);
    return std::make_unique<LocalEnvironment>(Share(team),
                                              EnvironmentOptions{4, observation_types, false, 1});
  };
  ASSERT_EQ(Train(make).code, ExitCode::kOk);
  EXPECT_CONTAINS(ReadFile(options_.run_dir + "/run.json"), "\"credit\": \"own\"");
  options_.resume = true;
  options_.credit = "shared";
  const RunReport other = Train(make);
  EXPECT_EQ(other.code, ExitCode::kBadInput);
  EXPECT_CONTAINS(other.status.message, "credit: the checkpoint has own, this run has shared");
  EXPECT_EQ(asked, (std::vector<int>{kOwnRewardsBit, 0}));
  options_.credit = "mine";
  EXPECT_CONTAINS(Train(make).status.message, "credit: got 'mine', expected one of: own, shared");
}

TEST_F(RunTest, LeavesAFolderThatExplainsItself) {
  const RunReport report = Train();
  ASSERT_EQ(report.code, ExitCode::kOk) << report.status.message;
  EXPECT_EQ(report.status.evaluation.success_rate, 1.0);
  EXPECT_GT(report.status.evaluation.mean_return, report.random.mean_return + 50.0);
  EXPECT_CONTAINS(report.summary, "greedy     success 100.0 %");
  EXPECT_CONTAINS(report.summary, "RANDOM     success");
  EXPECT_CONTAINS(report.summary, "policy     " + report.policy_path);
  for (const char* name : {"scenario.yaml", "run.json", "metrics.csv", "policy.ckpt",
                           "evaluation.csv", "evaluation.json", "evaluation_random.json"}) {
    EXPECT_TRUE(std::filesystem::exists(options_.run_dir + "/" + name)) << name;
  }
  const auto run = nlohmann::json::parse(ReadFile(options_.run_dir + "/run.json"));
  EXPECT_EQ(run.at("algorithm"), "q_learning");
  EXPECT_EQ(run.at("steps"), 60000);
  EXPECT_EQ(run.at("seed"), options_.seed);
  EXPECT_EQ(run.at("version"), kVersion);
  EXPECT_EQ(run.at("scenario_hash"), LoadScenario(options_.run_dir + "/scenario.yaml").hash);
  EXPECT_EQ(statuses_.back().phase, RunPhase::kEnded);
}

TEST_F(RunTest, AnUnknownAlgorithmEndsAtOnceWithTheList) {
  options_.algorithm = "dqm";
  const RunReport report = Train();
  EXPECT_EQ(report.code, ExitCode::kBadInput);
  EXPECT_CONTAINS(report.summary, "expected one of: random, q_learning, sarsa");
  EXPECT_FALSE(std::filesystem::exists(options_.run_dir));
}

TEST_F(RunTest, BadOptionsEndBeforeAnythingIsMade) {
  options_.exploration = "boltzmann:0";
  EXPECT_EQ(Train().code, ExitCode::kBadInput);
  options_.exploration = "";
  options_.options = "alpha=0.1";
  EXPECT_CONTAINS(Train().summary,
                  "got 'alpha', expected one of: exploration, gamma, "
                  "initial_value, learning_rate, mask_illegal");
  EXPECT_FALSE(std::filesystem::exists(options_.run_dir));
}

TEST_F(RunTest, LostFarmsAreSaidAndTheLearnerIsSaved) {
  const auto lose_after = [](int steps) {
    return [steps](std::uint8_t) { return std::make_unique<LostEnvironment>(steps); };
  };
  const RunReport report = Train(lose_after(500));
  EXPECT_EQ(report.code, ExitCode::kLost);
  EXPECT_CONTAINS(report.summary, "sim node: gone; saved in " + options_.run_dir);
  const Checkpoint saved = ReadCheckpoint(*RunFolder::NewestCheckpoint(options_.run_dir));
  EXPECT_GT(saved.steps, 900U);
  EXPECT_FALSE(saved.Has("environment"));

  options_.resume = true;  // with new episodes
  options_.steps = 2000;
  const RunReport resumed = Train(lose_after(1000000));
  EXPECT_EQ(resumed.code, ExitCode::kOk) << resumed.summary;
  EXPECT_GE(resumed.status.progress.steps, 2000U);
}

/// A farm that fails, is lost or comes back after some steps.
class FailingEnvironment final : public Environment {
 public:
  /// @param played receives the farm steps, if given
  FailingEnvironment(int steps, std::function<void()> fail, std::uint64_t* played = nullptr)
      : steps_(steps),
        played_(played),
        fail_(std::move(fail)),
        farms_(TinyFarm(), {4, kFeaturesBit, false, 1}) {}
  const EnvironmentSpec& spec() const override { return farms_.spec(); }
  const StepResults& Reset(std::uint64_t seed, std::uint64_t first) override {
    return farms_.Reset(seed, first);
  }
  const StepResults& Step(const std::vector<std::uint8_t>& actions) override {
    if (--steps_ != 0) {
      const StepResults& results = farms_.Step(actions);
      if (played_ != nullptr) {
        *played_ += static_cast<std::uint64_t>(
            std::count(results.is_first.begin(), results.is_first.end(), std::uint8_t{0}));
      }
      return results;
    }
    fail_();
    has_restarted_ = true;
    return farms_.Reset(1, 1000);
  }
  std::string Save() override { return farms_.Save(); }
  const StepResults& Load(const std::string& bytes) override { return farms_.Load(bytes); }
  bool ConsumeRestart() override { return std::exchange(has_restarted_, false); }

 private:
  int steps_;
  std::uint64_t* played_;
  std::function<void()> fail_;
  bool has_restarted_{};
  LocalEnvironment farms_;
};

/// Rank 0 of two; the other one has the same steps and gradients. Exchanges after `fails` is set
/// would wait for a rank that makes other exchanges.
class TwinGroup final : public ProcessGroup {
 public:
  explicit TwinGroup(const bool& fails) : ProcessGroup(0, 2), fails_(fails) {}
  void Sum(std::vector<float>&, std::vector<double>&) override { Check(); }
  std::vector<std::string> Gather(const std::string& bytes) override {
    Check();
    return {bytes, bytes};
  }
  std::string Broadcast(const std::string& bytes) override {
    Check();
    return bytes;
  }
  void RunOnRank0(const std::function<void()>& work) override {
    Check();
    work();
  }

 private:
  void Check() const {
    if (fails_) throw RankLost("ranks: rank 1 of 2 has ended");
  }
  const bool& fails_;
};

TEST_F(RunTest, ARankThatFailsSaysWhyAndExchangesNothingMore) {
  options_.algorithm = "ppo";
  options_.options = "shards=2 rollout_size=64 hidden_size=8 batch_size=32";
  options_.checkpoint_period_s = 1000.0;
  options_.evaluation_episodes = 0;
  bool fails = false;
  TwinGroup group(fails);
  const auto train = [&](const std::function<void()>& fail) {
    fails = false;
    const RankedRun ranked{group, [&](std::uint8_t) {
                             return std::make_unique<FailingEnvironment>(100, [&] {
                               fails = true;
                               fail();
                             });
                           }};
    return agents::Train(options_, {}, {}, nullptr, &ranked);
  };
  const RunReport bad = train([] { throw InputError("family: no ranch"); });
  EXPECT_EQ(bad.code, ExitCode::kBadInput);
  EXPECT_EQ(bad.status.message, "family: no ranch; the last valid checkpoint is none");
  EXPECT_GT(bad.status.progress.steps, 0U);
  options_.run_dir += "2";
  const RunReport lost = train([] { throw EnvironmentLost("sim node: gone"); });
  EXPECT_EQ(lost.code, ExitCode::kLost);
  EXPECT_EQ(lost.status.message, "sim node: gone; the last valid checkpoint is none");
  EXPECT_FALSE(RunFolder::NewestCheckpoint(options_.run_dir).has_value());
}

TEST_F(RunTest, FarmsThatCameBackAreCountedWithAndWithoutShards) {
  options_.algorithm = "ppo";
  options_.steps = 2000;
  options_.evaluation_episodes = 0;
  options_.progress_period_s = 0.0;
  for (const std::string shards : {"1", "2"}) {
    options_.options = "rollout_size=64 hidden_size=8 batch_size=32 shards=" + shards;
    options_.run_dir = folder_ + "/run" + shards;
    statuses_.clear();
    const RunReport report =
        Train([](std::uint8_t) { return std::make_unique<FailingEnvironment>(100, [] {}); });
    ASSERT_EQ(report.code, ExitCode::kOk) << report.status.message;
    EXPECT_EQ(report.status.progress.restarts, 1U) << shards;
    EXPECT_EQ(std::count_if(statuses_.begin(), statuses_.end(),
                            [](const RunStatus& status) {
                              return status.message.find("lost and restored") != std::string::npos;
                            }),
              1)
        << shards;
  }
}

TEST_F(RunTest, LostFarmsOfSeveralShardsAreSavedWithAllSteps) {
  options_.algorithm = "ppo";
  options_.options = "shards=2 rollout_size=64 hidden_size=8 batch_size=32";
  std::uint64_t played = 0;  // in 99 calls, which no number of rollouts fills
  const RunReport report = Train([&](std::uint8_t) {
    return std::make_unique<FailingEnvironment>(
        100, [] { throw EnvironmentLost("gone"); }, &played);
  });
  EXPECT_EQ(report.code, ExitCode::kLost);
  EXPECT_CONTAINS(report.summary, "gone; saved in " + options_.run_dir);
  EXPECT_EQ(ReadCheckpoint(*RunFolder::NewestCheckpoint(options_.run_dir)).steps, played);
}

TEST_F(RunTest, AFullDiskEndsItAndKeepsTheLastGoodCheckpoint) {
  options_.checkpoint_period_s = 0.0;
  options_.progress_period_s = 0.0;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{50000, before.rlim_max};  // the metrics grow beyond it
  setrlimit(RLIMIT_FSIZE, &small);
  const RunReport report = Train();
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(report.code, ExitCode::kStorage);
  EXPECT_CONTAINS(
      report.summary,
      "cannot be written: File too large; free disk space or correct the permissions, then "
      "resume; the last valid checkpoint is");
  EXPECT_GT(ReadCheckpoint(*RunFolder::NewestCheckpoint(options_.run_dir)).steps, 0U);
}

class Programs : public FolderTest {
 protected:
  int Run(std::vector<std::string> command) {
    Process process(std::move(command), folder_ + "/out.txt");
    const int code = process.Wait();
    output_ = ReadFile(folder_ + "/out.txt");
    return code;
  }
  std::string output_;
};

TEST_F(Programs, ExplainThemselves) {
  EXPECT_EQ(Run({AQUAFARM_TRAIN, "--help"}), 0);
  EXPECT_CONTAINS(output_, "q_learning");
  EXPECT_CONTAINS(output_, "exit codes");
  EXPECT_EQ(Run({AQUAFARM_EVALUATE, "--help"}), 0);
}

TEST_F(Programs, RefuseWhatTheyDoNotKnow) {
  const std::string run = folder_ + "/run";
  EXPECT_EQ(Run({AQUAFARM_TRAIN, "nowhere", "-d", run}), 2);
  EXPECT_CONTAINS(output_, "scenario: got 'nowhere', expected a file or one of: four_squads");
  EXPECT_EQ(Run({AQUAFARM_TRAIN, "paper", "-d", run, "-a", "dqm"}), 2);
  EXPECT_EQ(Run({AQUAFARM_TRAIN, "paper", "-d", run, "--farms", "4097"}), 2);
  EXPECT_EQ(Run({AQUAFARM_TRAIN, "--no-such-option"}), 2);
  EXPECT_EQ(Run({AQUAFARM_EVALUATE, folder_}), 2);
  EXPECT_CONTAINS(output_, "contains neither policy.ckpt nor a checkpoint");
}

class Diverging : public Programs {
 protected:
  /// Trains with more options, which must end the training. `said` is part of the reason.
  void ExpectTheLastGoodCheckpointIsPlayed(const std::string& algorithm,
                                           const std::vector<std::string>& options,
                                           const std::string& said);
  int runs_{};
};

void Diverging::ExpectTheLastGoodCheckpointIsPlayed(const std::string& algorithm,
                                                    const std::vector<std::string>& options,
                                                    const std::string& said) {
  const std::string run = folder_ + "/run" + std::to_string(runs_++);
  std::vector<std::string> command{AQUAFARM_TRAIN, "paper", "-d", run, "-a", algorithm};
  command.insert(command.end(), {"-f", "4", "-n", "100000", "--checkpoint-period", "0"});
  for (const char* option : {"learning_rate=1", "reward_scale=1e9", "max_grad_norm=0", "gamma=1"}) {
    command.insert(command.end(), {"-o", option});
  }
  for (const std::string& option : options) command.insert(command.end(), {"-o", option});
  ASSERT_EQ(Run(command), static_cast<int>(ExitCode::kDiverged)) << output_;
  EXPECT_CONTAINS(output_, said);
  const std::string words = "; the last valid checkpoint is ";
  const std::size_t at = output_.find(words);
  ASSERT_NE(at, std::string::npos) << output_;
  const std::size_t begin = at + words.size();
  const std::string path = output_.substr(begin, output_.find('\n', begin) - begin);
  EXPECT_GT(ReadCheckpoint(path).steps, 0U);
  EXPECT_FALSE(std::filesystem::exists(run + "/policy.ckpt"));
  EXPECT_EQ(Run({AQUAFARM_EVALUATE, path, "-e", "2", "--max-steps", "50"}), 0) << output_;
  EXPECT_CONTAINS(output_, algorithm + " on paper: success ");
}

// The weights grow by 1 per update until the gradients of such rewards overflow a float.
TEST_F(Diverging, NameTheLastGoodCheckpointAndPlayIt) {
  ExpectTheLastGoodCheckpointIsPlayed(
      "dqn",
      {"loss=mse", "target_update_interval=1", "priority_exponent=0", "hidden_size=128",
       "batch_size=8", "learning_starts=500", "buffer_size=1000"},
      "farm steps, on the batch drawn from seed 1 at position ");
  const std::vector<std::string> small{"rollout_size=128", "batch_size=32",
                                       "normalize_advantages=false"};
  const std::string said = "farm steps; expected a finite number: lower learning_rate";
  ExpectTheLastGoodCheckpointIsPlayed("ppo", small, said);
  ExpectTheLastGoodCheckpointIsPlayed("mappo", small, said);
}

TEST_F(Programs, TrainAndEvaluateOnTheShippedFarm) {
  const std::string run = folder_ + "/run";
  ASSERT_EQ(Run({AQUAFARM_TRAIN, "paper", "-d", run, "-n", "2000000", "--evaluate", "100"}), 0)
      << output_;
  EXPECT_CONTAINS(output_, "greedy     success 100.0 %");
  ASSERT_EQ(Run({AQUAFARM_EVALUATE, run, "-e", "200", "-w", folder_ + "/e"}), 0) << output_;
  EXPECT_CONTAINS(output_, "q_learning on paper: success 100.0 %");
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/e.csv"));
  EXPECT_EQ(Run({AQUAFARM_EVALUATE, run, "two_squads"}), 2);
  EXPECT_CONTAINS(output_, "does not fit scenario two_squads");
}

TEST_F(Programs, EvaluateWritesTheRanchOfAnEpisodeOfAFamily) {
  const std::string ranch = folder_ + "/ranch.yaml";
  ASSERT_EQ(Run({AQUAFARM_EVALUATE, "generalist", "ranch_family", "-e", "4", "-w", folder_ + "/all",
                 "--ranch", ranch, "--route-episode", "3"}),
            0)
      << output_;
  ASSERT_EQ(Run({AQUAFARM_EVALUATE, "generalist", ranch, "-e", "4", "-w", folder_ + "/one"}), 0)
      << output_;
  // The fourth episode: steps, return, devices, reason and everything else.
  const auto last_row = [](const std::string& csv) {
    const std::string text = ReadFile(csv);
    return text.substr(text.rfind(',' + std::to_string(EvaluationSeed(1000)) + ",3,"));
  };
  EXPECT_EQ(last_row(folder_ + "/all.csv"), last_row(folder_ + "/one.csv"));
  EXPECT_EQ(Run({AQUAFARM_EVALUATE, "generalist", "paper", "-e", "1", "--ranch", ranch}), 2);
  EXPECT_CONTAINS(output_, "--ranch: scenario paper is one ranch, expected a family");
}

}  // namespace
}  // namespace aquafarm::agents::test
