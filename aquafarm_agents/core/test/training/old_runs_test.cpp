// SPDX-License-Identifier: BSD-3-Clause
// Run folders of earlier versions load, play and resume (test/data/version_0_1_0).
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "agents_fixture.h"
#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/learning/checkpoint.h"
#include "process.h"

namespace aquafarm::agents::test {
namespace {

namespace fs = std::filesystem;

class OldRunTest : public FolderTest, public ::testing::WithParamInterface<const char*> {
 protected:
  OldRunTest() {
    fs::copy(old_run(), run_, fs::copy_options::recursive);
    recorded_ = nlohmann::json::parse(ReadFile(run_ / "run.json"));
  }

  static fs::path old_run() {
    return fs::path(AQUAFARM_CORE_DIR) / "test/data/version_0_1_0" / GetParam();
  }

  int Execute(std::vector<std::string> arguments) {
    return Process(std::move(arguments), folder_ + "/log").Wait();
  }
  std::string Log() const { return ReadFile(folder_ + "/log"); }

  /// The arguments that resume the run as it was started, up to a number of farm steps.
  std::vector<std::string> ResumeArguments(std::int64_t steps) const {
    std::vector<std::string> arguments{AQUAFARM_TRAIN,
                                       (run_ / "scenario.yaml").string(),
                                       "--resume",
                                       "-d",
                                       run_.string(),
                                       "-n",
                                       std::to_string(steps),
                                       "--evaluate",
                                       "0",
                                       "--random",
                                       "0"};
    const std::vector<std::string> given = recorded_["arguments"];
    for (std::size_t i = 0; i + 1 < given.size(); ++i) {
      const std::string& name = given[i];
      if (name != "-a" && name != "-s" && name != "-f" && name != "-o" && name != "-x") continue;
      arguments.insert(arguments.end(), {name, given[i + 1]});
    }
    return arguments;
  }

  fs::path run_{folder_ + "/run"};
  nlohmann::json recorded_;
};

TEST_P(OldRunTest, PolicyIsReadAndPlayed) {
  ASSERT_EQ(Execute({AQUAFARM_EVALUATE, run_.string(), "-e", "2", "-f", "2", "-w",
                     folder_ + "/evaluation"}),
            0)
      << Log();
  const auto now = nlohmann::json::parse(ReadFile(folder_ + "/evaluation.json"));
  const auto then = nlohmann::json::parse(ReadFile(run_ / "evaluation.json"));
  for (const char* key : {"algorithm", "scenario_hash", "training_steps"}) {
    EXPECT_EQ(now[key], then[key]) << key;
  }
}

TEST_P(OldRunTest, RunResumesFromItsCheckpoint) {
  const std::int64_t before = recorded_["steps"];
  const std::int64_t after = before + 200;
  ASSERT_EQ(Execute(ResumeArguments(after)), 0) << Log();
  const auto now = nlohmann::json::parse(ReadFile(run_ / "run.json"));
  EXPECT_GE(now["steps"].get<std::int64_t>(), after);
  EXPECT_EQ(now["algorithm"], recorded_["algorithm"]);
  EXPECT_EQ(now["seed"], recorded_["seed"]);
}

INSTANTIATE_TEST_SUITE_P(Version010, OldRunTest,
                         ::testing::Values("q_learning", "sarsa", "dqn", "icm_dqn", "lstm_dqn",
                                           "independent_dqn", "independent_lstm_dqn", "vdn",
                                           "maddpg", "mappo"),
                         [](const auto& run) { return std::string(run.param); });

class OldTableTest : public OldRunTest {};

TEST_P(OldTableTest, ResumedRunEndsWithTheSameTableAsThen) {
  ASSERT_EQ(Execute(ResumeArguments(8000)), 0) << Log();
  const Checkpoint now = ReadCheckpoint(run_ / "policy.ckpt");
  const Checkpoint then = ReadCheckpoint(run_ / "policy_after_8000_steps.ckpt");
  EXPECT_EQ(now.sections, then.sections);
  EXPECT_EQ(now.options, then.options);
}

INSTANTIATE_TEST_SUITE_P(Version010, OldTableTest, ::testing::Values("q_learning", "sarsa"),
                         [](const auto& run) { return std::string(run.param); });

}  // namespace
}  // namespace aquafarm::agents::test
