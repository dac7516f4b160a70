// SPDX-License-Identifier: BSD-3-Clause
// A training that was stopped and resumed gives bit-identical results to an uninterrupted one.
#include <filesystem>

#include "agents_fixture.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/trainer.h"
#include "process.h"

namespace aquafarm::agents::test {
namespace {

class Resume : public FolderTest {
 protected:
  TrainingEnd TrainInProcess(const std::string& run, const std::string& algorithm, bool resume,
                             int stop_after_reports, std::uint64_t episodes = 0) {
    LocalEnvironment environment(Share(aquafarm::test::CrowdedScenario(1, 0)),
                                 {3, kIndexBit, false, 1});
    const auto learner = FindAlgorithm(algorithm).make(environment.spec(), 4, "");
    RunFolder folder(folder_ + "/" + run, resume);
    TrainerOptions options;
    options.algorithm = algorithm;
    options.seed = 4;
    options.steps = episodes == 0 ? 6000 : 0;
    options.episodes = episodes;
    options.checkpoint_period_s = 0.0;  // at every check of the clock
    options.progress_period_s = 0.0;
    Trainer trainer(environment, *learner, options, &folder);
    const auto newest = folder.NewestCheckpoint();
    if (resume) trainer.Resume(ReadCheckpoint(*newest), *newest);
    std::atomic<bool> stop{false};
    int reports = 0;
    return trainer.Run(&stop, [&](const TrainingProgress&) {
      if (++reports == stop_after_reports) stop = true;
    });
  }

  void ExpectSameRuns(const std::string& a, const std::string& b) {
    const auto newest = [&](const std::string& run) {
      return RunFolder::NewestCheckpoint(folder_ + "/" + run).value_or("none");
    };
    EXPECT_EQ(std::filesystem::path(newest(a)).filename(),
              std::filesystem::path(newest(b)).filename());
    EXPECT_TRUE(ReadFile(newest(a)) == ReadFile(newest(b))) << "checkpoints differ";
    EXPECT_TRUE(ReadFile(folder_ + "/" + a + "/metrics.csv") ==
                ReadFile(folder_ + "/" + b + "/metrics.csv"))
        << "metrics differ";
  }

  static std::string StepsOf(const std::string& run) {
    if (run.find(".memory") != std::string::npos) return "100000";
    return run.find("ppo") != std::string::npos ? "200000" : "4000000";
  }
  /// @param run name of the run: the name of the algorithm, `.memory` for a recurrent network, and
  /// more
  std::vector<std::string> Command(const std::string& run, bool resume) const {
    std::vector<std::string> command{AQUAFARM_TRAIN,
                                     "paper",
                                     "--steps",
                                     StepsOf(run),
                                     "--farms",
                                     "8",
                                     "--run-dir",
                                     folder_ + "/" + run,
                                     "--evaluate",
                                     "0",
                                     "--algorithm",
                                     run.substr(0, run.find('.')),
                                     "--checkpoint-period",
                                     "0.05",
                                     "--scenarios",
                                     AQUAFARM_SCENARIO_DIR};
    if (run.find(".memory") != std::string::npos) {
      command.insert(command.end(), {"--set", "recurrent=true", "--set", "hidden_size=16"});
    }
    if (resume) command.emplace_back("--resume");
    return command;
  }
  std::string Output(const std::string& run) const { return folder_ + "/" + run + ".txt"; }

  /// Starts a run and sends it signals shortly after its next checkpoint.
  int StopAfterACheckpoint(const std::string& run, bool resume, int signal, int count = 1) {
    const auto newest = [&] {
      return RunFolder::NewestCheckpoint(folder_ + "/" + run).value_or("none");
    };
    const std::string before = newest();
    Process process(Command(run, resume), Output(run));
    EXPECT_TRUE(WaitUntil([&] { return newest() != before; })) << ReadFile(Output(run));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    for (int i = 0; i < count; ++i) {
      process.Kill(signal);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return process.Wait();
  }
};

TEST_F(Resume, StoppedInProcessEqualsNeverStopped) {
  for (const std::string name : {"random", "q_learning", "sarsa"}) {
    EXPECT_EQ(TrainInProcess(name + "_whole", name, false, 0), TrainingEnd::kDone);
    EXPECT_EQ(TrainInProcess(name + "_parts", name, false, 100), TrainingEnd::kInterrupted);
    EXPECT_EQ(TrainInProcess(name + "_parts", name, true, 7), TrainingEnd::kInterrupted);
    EXPECT_EQ(TrainInProcess(name + "_parts", name, true, 0), TrainingEnd::kDone);
    ExpectSameRuns(name + "_whole", name + "_parts");
  }
}

TEST_F(Resume, WorksForLimitsByEpisodes) {
  EXPECT_EQ(TrainInProcess("whole", "sarsa", false, 0, 60), TrainingEnd::kDone);
  EXPECT_EQ(TrainInProcess("parts", "sarsa", false, 50, 60), TrainingEnd::kInterrupted);
  EXPECT_EQ(TrainInProcess("parts", "sarsa", true, 0, 60), TrainingEnd::kDone);
  ExpectSameRuns("whole", "parts");
}

TEST_F(Resume, KilledEqualsNeverStopped) {
  for (const std::string name : {"q_learning", "sarsa", "ppo", "ppo.memory", "mappo.memory"}) {
    const std::string whole = name + ".whole";
    const std::string parts = name + ".parts";
    Process uninterrupted(Command(whole, false), Output(whole));
    ASSERT_EQ(uninterrupted.Wait(), 0) << ReadFile(Output(whole));
    EXPECT_EQ(StopAfterACheckpoint(parts, false, SIGKILL), -SIGKILL);
    EXPECT_EQ(StopAfterACheckpoint(parts, true, SIGKILL), -SIGKILL);
    Process rest(Command(parts, true), Output(parts));
    ASSERT_EQ(rest.Wait(), 0) << ReadFile(Output(parts));
    EXPECT_CONTAINS(ReadFile(Output(parts)), "resuming from");
    ExpectSameRuns(whole, parts);
    EXPECT_TRUE(ReadFile(folder_ + "/" + whole + "/policy.ckpt") ==
                ReadFile(folder_ + "/" + parts + "/policy.ckpt"));
  }
}

TEST_F(Resume, CtrlCSavesAndResumes) {
  EXPECT_EQ(StopAfterACheckpoint("q_learning.run", false, SIGINT), 130);
  EXPECT_CONTAINS(ReadFile(Output("q_learning.run")), "interrupted; saved in");
  Process again(Command("q_learning.run", false), Output("again"));
  EXPECT_EQ(again.Wait(), 2);
  EXPECT_CONTAINS(ReadFile(Output("again")), "already contains a run");
  Process rest(Command("q_learning.run", true), Output("rest"));
  EXPECT_EQ(rest.Wait(), 0) << ReadFile(Output("rest"));
}

// When a benchmark is killed, the kernel sends its programs a signal for each of its threads.
TEST_F(Resume, SignalsInQuickSuccessionAreOne) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string run = "q_learning." + std::to_string(signal);
    EXPECT_EQ(StopAfterACheckpoint(run, false, signal, 5), 130);
    EXPECT_CONTAINS(ReadFile(Output(run)), "interrupted; saved in");
  }
}

TEST_F(Resume, ADamagedCheckpointIsRefused) {
  TrainInProcess("run", "q_learning", false, 20);
  const std::string path = *RunFolder::NewestCheckpoint(folder_ + "/run");
  std::string bytes = ReadFile(path);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  WriteFileAtomically(path, bytes);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { TrainInProcess("run", "q_learning", true, 0); }),
                  path + ": damaged: the checksum is");
}

TEST_F(Resume, AnotherAlgorithmIsRefused) {
  TrainInProcess("run", "q_learning", false, 20);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { TrainInProcess("run", "sarsa", true, 0); }),
                  "algorithm: the checkpoint has q_learning, this run has sarsa");
}

}  // namespace
}  // namespace aquafarm::agents::test
