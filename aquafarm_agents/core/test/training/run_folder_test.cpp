// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/run_folder.h"

#include <sys/wait.h>

#include <filesystem>
#include <fstream>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/metrics_file.h"

namespace aquafarm::agents::test {
namespace {

using RunFolderTest = FolderTest;

TEST_F(RunFolderTest, InUseByAnotherIsRefused) {
  const RunFolder mine(folder_ + "/run", false);
  EXPECT_CONTAINS(MessageOf<StorageError>([&] { RunFolder(folder_ + "/run", true); }),
                  "is in use by another training (process " + std::to_string(getpid()) + ")");
}

TEST_F(RunFolderTest, IsFreeAgainWhenItsProcessHasDied) {
  const pid_t child = fork();
  if (child == 0) {
    new RunFolder(folder_ + "/run", false);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(RunFolder(folder_ + "/run", false));
}

TEST_F(RunFolderTest, HoldingARunIsRefusedUnlessResumed) {
  { RunFolder(folder_ + "/run", false).Write("run.json", "{}"); }
  EXPECT_CONTAINS(MessageOf<InputError>([&] { RunFolder(folder_ + "/run", false); }),
                  "already contains a run; resume it or choose another folder");
  EXPECT_NO_THROW(RunFolder(folder_ + "/run", true));
  EXPECT_CONTAINS(MessageOf<InputError>([&] { RunFolder(folder_ + "/other", true); }),
                  "/other: contains no run to resume");
}

TEST_F(RunFolderTest, WhereNothingCanBeWrittenIsRefusedAtOnce) {
  WriteFileAtomically(folder_ + "/file", "x");
  EXPECT_CONTAINS(MessageOf<StorageError>([&] { RunFolder(folder_ + "/file/run", false); }),
                  "/file/run: cannot be created: Not a directory");
  EXPECT_THROW(RunFolder("/proc/aquafarm", false), StorageError);
  EXPECT_THROW(RunFolder("", false), InputError);
}

TEST_F(RunFolderTest, KeepsTheLastTwoCheckpoints) {
  const RunFolder run(folder_ + "/run", false);
  EXPECT_FALSE(run.NewestCheckpoint());
  Checkpoint checkpoint;
  for (const std::uint64_t steps : {5U, 50U, 1000U}) {
    checkpoint.steps = steps;
    run.SaveCheckpoint(checkpoint);
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() + "/checkpoints")) {
    count += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(count, 2);
  EXPECT_EQ(ReadCheckpoint(*run.NewestCheckpoint()).steps, 1000U);
}

TEST_F(RunFolderTest, RemovesWhatAKilledWriterLeft) {
  { const RunFolder run(folder_ + "/run", false); }
  WriteFileAtomically(folder_ + "/run/run.json", "{}");
  const std::vector<std::string> left{folder_ + "/run/checkpoints/step_7.ckpt.tmp",
                                      folder_ + "/run/policy.ckpt.tmp"};
  for (const std::string& path : left) std::ofstream(path) << "half";
  const RunFolder run(folder_ + "/run", true);
  for (const std::string& path : left) EXPECT_FALSE(std::filesystem::exists(path)) << path;
  EXPECT_TRUE(std::filesystem::exists(folder_ + "/run/run.json"));
}

using MetricsFileTest = FolderTest;

TEST_F(MetricsFileTest, ContinuesWhereTheCheckpointWas) {
  const std::string path = folder_ + "/metrics.csv";
  EpisodeSummary result;
  result.reason = EndReason::kStepLimit;
  result.episode_return = 0.1F;
  result.energy = 2.5;
  result.distance = 0.75;
  std::uint64_t size = 0;
  {
    MetricsFile metrics(path);
    metrics.Append(1, 10, result, {0.5F, 0.25F, 0.125F});
    size = metrics.size();
    metrics.Append(2, 20, result, {});
    metrics.Sync();
    EXPECT_EQ(std::filesystem::file_size(path), metrics.size());
  }
  const std::string whole = ReadFile(path);
  EXPECT_CONTAINS(whole, "\n1,10,0,0,0,0,0.1,0,0,0,0,0,0,step_limit,0,0.25,0.125,0.5,2.5,0.75\n");
  {
    MetricsFile metrics(path, size);
    metrics.Append(2, 20, result, {});
    metrics.Sync();
  }
  EXPECT_EQ(ReadFile(path), whole);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MetricsFile(path, 100000); }),
                  "expected at least the 100000 that the checkpoint records");
}

TEST_F(MetricsFileTest, HasTheColumnsThatOtherProgramsRead) {
  EXPECT_EQ(EpisodeColumns(),
            "farm,seed,episode,steps,return,delivered,devices,delivered_health,crashes,"
            "collisions,steps_in_disaster,reason,success");
  EXPECT_EQ(AddedColumns(), ",energy_kwh,distance_km");
}

// Makes a file of an older version, which has only these columns, and appends an episode.
void Continue(const std::string& path, const std::string& header) {
  std::ofstream(path) << header;
  EpisodeSummary result;
  result.energy = 2.5;
  MetricsFile metrics(path, header.size());
  metrics.Append(1, 10, result, {0.5F, 0.25F, 0.125F});
  metrics.Sync();
}

TEST_F(MetricsFileTest, OfVersion010ContinuesWithItsOwnColumns) {
  const std::string path = folder_ + "/metrics.csv";
  const std::string header =
      "number,total_steps," + EpisodeColumns() + ",exploration,learning_rate,loss\n";
  Continue(path, header);
  EXPECT_EQ(ReadFile(path), header + "1,10,0,0,0,0,0,0,0,0,0,0,0,none,0,0.25,0.125,0.5\n");
}

TEST_F(MetricsFileTest, WithSomeOfTheAddedColumnsContinuesWithThese) {
  const std::string path = folder_ + "/metrics.csv";
  { MetricsFile(path).Flush(); }
  std::string header = ReadFile(path);
  header.replace(header.find(",distance_km"), std::string::npos, "\n");
  Continue(path, header);
  EXPECT_EQ(ReadFile(path), header + "1,10,0,0,0,0,0,0,0,0,0,0,0,none,0,0.25,0.125,0.5,2.5\n");
}

TEST_F(MetricsFileTest, WithUnknownColumnsIsRefused) {
  const std::string path = folder_ + "/metrics.csv";
  { MetricsFile(path).Flush(); }
  const std::string header = ReadFile(path);
  for (const char* last : {"distance_nm\n", "distance\n", "distance_km,fuel\n"}) {
    std::string other = header;
    other.replace(other.find("distance_km"), std::string::npos, last);
    std::ofstream(path) << other;
    EXPECT_CONTAINS(MessageOf<InputError>([&] { MetricsFile(path, other.size()); }),
                    path + ":1: got the columns 'number,");
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
