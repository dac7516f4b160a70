// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/checkpoint.h"

#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "agents_fixture.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/saved_policy.h"
#include "aquafarm/base/hash.h"
#include "learning/saved_numbers.h"

namespace aquafarm::agents::test {
namespace {

Checkpoint Example() {
  Checkpoint checkpoint;
  checkpoint.kind = Checkpoint::kTraining;
  checkpoint.algorithm = "q_learning";
  checkpoint.options = "gamma=0.97";
  checkpoint.version = "0.1.0";
  checkpoint.seed = 7;
  checkpoint.steps = 1ULL << 40U;
  checkpoint.episodes = 12;
  checkpoint.spec.scenario_name = "tiny";
  checkpoint.spec.scenario_hash = 0xfedcba9876543210ULL;
  checkpoint.spec.farms = 3;
  checkpoint.spec.agents = 2;
  checkpoint.spec.state_count = 5;
  checkpoint.sections["empty"] = "";
  checkpoint.SetArray("table", std::vector<float>{1.5F, -0.0F, 3e38F});
  return checkpoint;
}

using CheckpointFile = FolderTest;

TEST_F(CheckpointFile, ReadsBackToTheSame) {
  const std::string path = folder_ + "/a.ckpt";
  WriteCheckpoint(path, Example());
  const Checkpoint read = ReadCheckpoint(path);
  EXPECT_EQ(read.sections, Example().sections);
  EXPECT_EQ(read.steps, 1ULL << 40U);
  EXPECT_EQ(read.spec.scenario_hash, 0xfedcba9876543210ULL);
  EXPECT_EQ(read.options, "gamma=0.97");
  EXPECT_EQ(read.spec.agents, 2);
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

// The options are those of a version whose LSTM always had the skip connection.
TEST_F(CheckpointFile, OfAnLstmDqnFromBeforeHasTheSkipConnection) {
  const std::string path = folder_ + "/a.ckpt";
  Checkpoint old = Example();
  old.algorithm = "lstm_dqn";
  old.options = "preset=paper sequence=1 start=5000";
  WriteCheckpoint(path, old);
  EXPECT_EQ(ReadCheckpoint(path).options,
            "learning_starts=5000 preset=paper sequence_length=1 skip_connection=true");
  old.options = "preset=paper skip_connection=false";
  WriteCheckpoint(path, old);
  EXPECT_EQ(ReadCheckpoint(path).options, "preset=paper skip_connection=false");
}

TEST_F(CheckpointFile, EveryCutIsRefused) {
  const std::string path = folder_ + "/a.ckpt";
  WriteCheckpoint(path, Example());
  const std::string bytes = ReadFile(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    WriteFileAtomically(path, bytes.substr(0, size));
    EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(path); }), "truncated");
  }
  WriteFileAtomically(path, bytes + "x");
  EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(path); }), "too long");
}

TEST_F(CheckpointFile, EveryFlippedByteIsRefused) {
  const std::string path = folder_ + "/a.ckpt";
  WriteCheckpoint(path, Example());
  const std::string bytes = ReadFile(path);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    WriteFileAtomically(path, damaged);
    EXPECT_NE(MessageOf<InputError>([&] { ReadCheckpoint(path); }), "") << "byte " << i;
  }
}

TEST_F(CheckpointFile, RefusalsSayWhatTheFileIs) {
  const std::string path = folder_ + "/a.ckpt";
  EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(path); }),
                  path + ": cannot be read: No such file");
  EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(folder_); }), "is a folder");
  WriteFileAtomically(path, std::string(100, 'x'));
  EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(path); }),
                  "does not start with 'aquaCKPT'");
  WriteCheckpoint(path, Example());
  std::string bytes = ReadFile(path);
  bytes[8] = 9;
  WriteFileAtomically(path, bytes);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { ReadCheckpoint(path); }), "of format 9, expected 2");
}

TEST_F(CheckpointFile, MissingAndWrongSectionsAreNamed) {
  const Checkpoint checkpoint = Example();
  std::vector<float> values;
  EXPECT_CONTAINS(MessageOf<InputError>([&] { checkpoint.Section("streams"); }), "'streams'");
  EXPECT_CONTAINS(MessageOf<InputError>([&] { checkpoint.GetArray("table", 4, values); }),
                  "section 'table': got 12 bytes, expected 16");
}

TEST_F(CheckpointFile, LentArraysAreWrittenWithoutACopy) {
  const std::string path = folder_ + "/a.ckpt";
  std::vector<float> table(1000, 1.0F);
  Checkpoint lends = Example();
  lends.sections.erase("table");
  lends.lends = true;
  lends.LendArray("table", table);
  lends.LendArray("agent1/a", table);
  EXPECT_EQ(static_cast<const void*>(lends.Section("table").data()), table.data());
  table[7] = 2.0F;
  WriteCheckpoint(path, lends);
  const std::string written = ReadFile(path);
  const Checkpoint read = ReadCheckpoint(path);
  std::vector<float> values;
  read.GetArray("table", 1000, values);
  EXPECT_EQ(values, table);

  Checkpoint copies = Example();
  copies.LendArray("table", table);
  copies.LendArray("agent1/a", table);
  EXPECT_NE(static_cast<const void*>(copies.Section("table").data()), table.data());
  WriteCheckpoint(path, copies);
  EXPECT_EQ(ReadFile(path), written) << "the file is the same";

  Checkpoint whole;
  whole.AddPart("agent1/", Checkpoint(lends));
  EXPECT_EQ(static_cast<const void*>(whole.Section("agent1/table").data()), table.data());
  EXPECT_EQ(whole.Part("agent1/").Section("table"), lends.Section("table"));
  EXPECT_FALSE(whole.Part("agent2/").Has("table"));
}

struct Learnt {
  double due{0.25};
  std::uint64_t steps{1ULL << 60U};
  float loss{0.1F};
};

template <typename Self, typename Visit>
void VisitLearnt(Self& self, const Visit& visit) {
  visit("due", self.due);
  visit("steps", self.steps);
  visit("loss", self.loss);
}

TEST(SavedNumbers, AreReadByNameOrInTheOrderOfOlderVersions) {
  const Learnt saved;
  Checkpoint checkpoint = Example();
  SaveNumbers(checkpoint, "learnt", [&](const auto& visit) { VisitLearnt(saved, visit); });
  Learnt loaded{0.0, 0, 0.0F};
  const auto load = [&] {
    LoadNumbers<double>(checkpoint, "learnt", "learnt.numbers",
                        [&](const auto& visit) { VisitLearnt(loaded, visit); });
  };
  load();
  EXPECT_EQ(loaded.due, saved.due);
  EXPECT_EQ(loaded.steps, saved.steps);
  EXPECT_EQ(loaded.loss, saved.loss);

  checkpoint.sections.erase("learnt");
  EXPECT_CONTAINS(MessageOf<InputError>(load), "no section 'learnt'");
  checkpoint.SetArray("learnt.numbers", std::vector<double>{0.5, 3.0, 0.75});
  load();
  EXPECT_EQ(loaded.due, 0.5);
  EXPECT_EQ(loaded.steps, 3U);
  EXPECT_EQ(loaded.loss, 0.75F);

  checkpoint.SetNumbers("learnt", {{"due", 0.5}, {"steps", std::uint64_t{3}}});
  EXPECT_CONTAINS(MessageOf<InputError>(load), "section 'learnt': has no number 'loss'");
  for (const double steps : {-1.0, 1e300, std::nan("")}) {
    checkpoint.SetNumbers("learnt", {{"due", 0.5}, {"steps", steps}, {"loss", 0.5}});
    EXPECT_CONTAINS(MessageOf<InputError>(load), "damaged, use another checkpoint");
  }
  checkpoint.sections["learnt"] = "\xff";
  EXPECT_CONTAINS(MessageOf<InputError>(load), "section 'learnt': is damaged");
  checkpoint.sections["learnt"] = std::string(1'000'000, '\x81');  // lists in lists
  EXPECT_CONTAINS(MessageOf<InputError>(load), "section 'learnt': is damaged");
}

TEST(SavedNumbers, OfARandomStreamAreItsDraws) {
  RandomStream saved({7, 0, RngStream::kLearner, 1});
  for (int i = 0; i < 5; ++i) saved.Next();
  Checkpoint checkpoint = Example();
  SaveNumbers(checkpoint, "learnt", [&](const auto& visit) { visit("rng", saved); });
  EXPECT_EQ(std::get<std::uint64_t>(checkpoint.GetNumbers("learnt").at("rng")), 5U);
  RandomStream loaded(saved.key());
  LoadNumbers<std::uint64_t>(checkpoint, "learnt", "",
                             [&](const auto& visit) { visit("rng", loaded); });
  EXPECT_EQ(loaded.position(), 5U);
  EXPECT_EQ(loaded.Next(), saved.Next());
}

// An untrusted file can have a correct checksum; the parser must not use up the stack.
TEST_F(CheckpointFile, AnIndexThatNestsAMillionDeepIsRefused) {
  const std::string path = folder_ + "/deep.ckpt";
  WriteCheckpoint(path, Example());
  std::string bytes = ReadFile(path).substr(0, 40) + std::string(1'000'000, '\x81');
  const std::uint64_t sizes[3] = {1'000'000, 0, HashBytes(std::string_view(bytes).substr(40))};
  std::memcpy(bytes.data() + 16, sizes, sizeof(sizes));
  std::ofstream(path) << bytes;
  EXPECT_EQ(MessageOf<InputError>([&] { ReadCheckpoint(path); }),
            path + ": index: damaged bytes: nested too deeply");
}

TEST_F(CheckpointFile, AnUnwritablePlaceIsSaid) {
  EXPECT_CONTAINS(
      MessageOf<StorageError>([&] { WriteCheckpoint(folder_ + "/no/a.ckpt", Example()); }),
      "cannot be written: No such file or directory");
}

// A file size limit simulates a full disk.
TEST_F(CheckpointFile, AFullDiskKeepsTheLastGoodOne) {
  const std::string path = folder_ + "/a.ckpt";
  WriteCheckpoint(path, Example());
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{10000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  Checkpoint large = Example();
  large.sections["table"] = std::string(100000, 'x');
  const std::string message = MessageOf<StorageError>([&] { WriteCheckpoint(path, large); });
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_CONTAINS(message, path + ": cannot be written: File too large");
  EXPECT_EQ(ReadCheckpoint(path).sections, Example().sections);
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

TEST(CheckContinues, SaysWhatDiffers) {
  const Checkpoint checkpoint = Example();
  EnvironmentSpec spec = checkpoint.spec;
  spec.version = "0.1.0";
  const auto refuse = [&](const std::string& algorithm, const std::string& options,
                          std::uint64_t seed, const EnvironmentSpec& now) {
    return MessageOf<InputError>(
        [&] { CheckContinues(checkpoint, "a.ckpt", algorithm, options, seed, now); });
  };
  EXPECT_EQ(refuse("q_learning", "gamma=0.97", 7, spec), "");
  EXPECT_CONTAINS(
      refuse("sarsa", "gamma=0.97", 7, spec),
      "a.ckpt: cannot be resumed: algorithm: the checkpoint has q_learning, this run has sarsa");
  EXPECT_CONTAINS(refuse("q_learning", "gamma=0.9", 7, spec),
                  "options: the checkpoint has gamma=0.97, this run has gamma=0.9");
  EXPECT_CONTAINS(refuse("q_learning", "gamma=0.97", 8, spec),
                  "seed: the checkpoint has 7, this run has 8");
  EnvironmentSpec other = spec;
  other.scenario_name = "red_tide";
  other.scenario_hash = 1;
  EXPECT_CONTAINS(
      refuse("q_learning", "gamma=0.97", 7, other),
      "scenario: the checkpoint has tiny (hash fedcba9876543210), this run has red_tide (hash "
      "0000000000000001)");
  other = spec;
  other.version = "0.2.0";
  EXPECT_CONTAINS(refuse("q_learning", "gamma=0.97", 7, other),
                  "version: the checkpoint has 0.1.0, this run has 0.2.0");
  other = spec;
  other.farms = 4;
  EXPECT_CONTAINS(refuse("q_learning", "gamma=0.97", 7, other),
                  "farms: the checkpoint has 3, this run has 4");
}

using SavedPolicyFile = FolderTest;

TEST_F(SavedPolicyFile, PlaysLikeTheLearnerThatSavedIt) {
  LocalEnvironment environment(TinyFarm(), {2, kIndexBit, false, 1});
  TabularLearner<SarsaRule> learner(environment.spec(), 1, "");
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  for (int i = 0; i < 500; ++i) {
    learner.Step(*results, 0.5, actions);
    results = &environment.Step(actions);
  }
  Checkpoint checkpoint = Example();
  checkpoint.kind = Checkpoint::kPolicy;
  checkpoint.algorithm = "sarsa";
  checkpoint.spec = environment.spec();
  checkpoint.version = checkpoint.spec.version;
  learner.SavePolicy(checkpoint);
  WriteCheckpoint(folder_ + "/policy.ckpt", checkpoint);
  const SavedPolicy saved = FindPolicy(folder_);
  EXPECT_EQ(saved.observation_types, kIndexBit);
  const auto policy = MakePolicy(saved, environment.spec());
  std::vector<std::uint8_t> expected;
  learner.GreedyPolicy()->Act(*results, expected);
  policy->Act(*results, actions);
  EXPECT_EQ(actions, expected);

  EnvironmentSpec other = environment.spec();
  other.width = 30;
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MakePolicy(saved, other); }),
                  "does not fit scenario tiny: width: the policy has 5, the farm has 30");
  SavedPolicy old = saved;
  old.checkpoint.version = "0.0.1";
  EXPECT_CONTAINS(
      MessageOf<InputError>([&] { MakePolicy(old, environment.spec()); }),
      "policy.ckpt: was trained by aquafarm 0.0.1, expected " + environment.spec().version);
}

TEST_F(SavedPolicyFile, AFolderWithoutAPolicyIsRefused) {
  EXPECT_CONTAINS(MessageOf<InputError>([&] { FindPolicy(folder_); }),
                  "contains neither policy.ckpt nor a checkpoint");
  EXPECT_EQ(FindPolicy("random").checkpoint.algorithm, "random");
}

}  // namespace
}  // namespace aquafarm::agents::test
