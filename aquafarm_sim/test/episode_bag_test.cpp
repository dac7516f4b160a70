// SPDX-License-Identifier: BSD-3-Clause
// Kept episodes as bags, and what verify_bag finds in bags that were changed.
#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/SavedState.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "aquafarm/check.h"
#include "aquafarm/rng.h"
#include "aquafarm/scenario_yaml.h"
#include "aquafarm_sim/bag_check.h"
#include "aquafarm_sim/episode_recorder.h"
#include "ranch_fixture.h"

namespace aquafarm_sim::test {
namespace {

namespace fs = std::filesystem;
using aquafarm_msgs::EpisodeSummary;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// A storm, and an end soon enough.
aquafarm::Scenario ShortScenario() {
  aquafarm::Scenario scenario = aquafarm::test::TinyScenario();
  scenario.disasters.emplace_back();
  scenario.step_limit = 40;
  return aquafarm::ParseScenario(aquafarm::ToYaml(scenario), "test");
}

class EpisodeBag : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "aquafarm_bags_XXXXXX").string();
    ASSERT_NE(nullptr, mkdtemp(name.data()));
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<EpisodeRecorder> Record(Ranch& ranch, const std::string& keep,
                                          RecorderLimits limits = {}) {
    auto recorder =
        std::make_unique<EpisodeRecorder>(ranch.shared_scenario(), ParseKeep(keep), folder_,
                                          BagFormat{"/ranch/", "map", 10, 3}, limits);
    ranch.SetRecorder(recorder.get());
    return recorder;
  }

  // Random joint steps, the same every time.
  static void Play(Ranch& ranch, std::int32_t farms, int steps) {
    aquafarm::RandomStream chance({3, 0, aquafarm::Purpose::kExploration, 0});
    aquafarm_msgs::Step::Request request;
    for (int i = 0; i < steps; ++i) {
      request.actions.clear();
      for (std::int32_t k = 0; k < farms * ranch.agents(); ++k) {
        request.actions.push_back(static_cast<std::uint8_t>(chance.Below(aquafarm::kActionCount)));
      }
      ASSERT_TRUE(ranch.Step(request).ok);
    }
  }

  std::vector<std::string> Bags() const {
    std::vector<std::string> bags;
    for (const auto& entry : fs::directory_iterator(folder_)) bags.push_back(entry.path());
    std::sort(bags.begin(), bags.end());
    return bags;
  }

  // One bag of a whole episode of 40 steps or fewer.
  std::string OneBag() {
    const auto ranch = MakeRanch(ShortScenario());
    {
      const auto recorder = Record(*ranch, "all");
      Play(*ranch, 1, 41);
      ranch->SetRecorder(nullptr);
    }
    return Bags().front();
  }

  static void SendStorm(Ranch& ranch) {
    aquafarm_msgs::SetDisaster storm;
    storm.request.id = 0;
    storm.request.info.kind = 0;
    storm.request.info.grade = 4;
    storm.request.info.radii = {9.0F};
    storm.request.info.risks = {-20.0F};
    storm.request.info.duration = 100;
    ranch.SetDisaster(storm.request, storm.response);
    ASSERT_TRUE(storm.response.ok) << storm.response.message;
  }

  // One bag of a whole episode into which a storm was sent after 10 steps.
  std::string StormBag() {
    const auto ranch = MakeRanch(ShortScenario());
    {
      const auto recorder = Record(*ranch, "all");
      Play(*ranch, 1, 10);
      SendStorm(*ranch);
      SendStorm(*ranch);  // the last of a step is what counts
      Play(*ranch, 1, 31);
      ranch->SetRecorder(nullptr);
    }
    return Bags().front();
  }

  // Copies a bag, message by message, as `change` says: true keeps a message.
  std::string Changed(const std::string& bag, bool compressed,
                      const std::function<bool(FarmSpec*, FarmState*, EpisodeSummary*)>& change) {
    const std::string path = folder_ + "/changed.bag";
    rosbag::Bag from(bag);
    rosbag::Bag to(path, rosbag::bagmode::Write);
    if (compressed) to.setCompression(rosbag::compression::LZ4);
    for (const auto& message : rosbag::View(from)) {
      const auto spec = message.instantiate<FarmSpec>();
      const auto state = message.instantiate<FarmState>();
      const auto summary = message.instantiate<EpisodeSummary>();
      if (const auto saved = message.instantiate<aquafarm_msgs::SavedState>()) {
        to.write(message.getTopic(), message.getTime(), *saved);
        continue;
      }
      if (!change(spec.get(), state.get(), summary.get())) continue;
      if (spec) to.write(message.getTopic(), message.getTime(), *spec);
      if (state) to.write(message.getTopic(), message.getTime(), *state);
      if (summary) to.write(message.getTopic(), message.getTime(), *summary);
    }
    to.close();
    return path;
  }

  std::string folder_;
};

// What a bag is refused with.
std::string Refusal(const std::string& path, const std::string& ns = "") {
  try {
    CheckBag(path, ns);
  } catch (const aquafarm::InputError& error) {
    return error.what();
  }
  return "";
}

TEST_F(EpisodeBag, EveryEpisodeOfEveryFarmIsKeptAndIdentical) {
  const auto ranch = MakeRanch(ShortScenario(), 3);
  {
    const auto recorder = Record(*ranch, "all");
    Play(*ranch, 3, 130);
    ranch->SetRecorder(nullptr);
  }
  EXPECT_GE(Bags().size(), 9U);
  for (const std::string& bag : Bags()) {
    const BagCheck check = CheckBag(bag, "");
    EXPECT_EQ("", check.difference) << bag;
    EXPECT_EQ(1U, check.episodes);
    EXPECT_EQ(0U, check.unfinished);
  }
  EXPECT_EQ(0U, fs::path(Bags()[0]).filename().string().find("episode_00000000_seed_5_return_"));
}

TEST_F(EpisodeBag, KeepSaysWhichEpisodesBecomeBags) {
  const auto run = [this](const std::string& keep) {
    for (const std::string& bag : Bags()) fs::remove(bag);
    const auto ranch = MakeRanch(ShortScenario());
    const auto recorder = Record(*ranch, keep);
    Play(*ranch, 1, 41 * 12);
    ranch->SetRecorder(nullptr);
  };
  const auto value = [](const std::string& path) {
    return std::stof(path.substr(path.find("return_") + 7));
  };
  run("all");
  std::vector<std::string> all = Bags();
  ASSERT_GE(all.size(), 12U);
  const auto by_return = [&](const auto& a, const auto& b) { return value(a) < value(b); };
  const float best = value(*std::max_element(all.begin(), all.end(), by_return));
  const float worst = value(*std::min_element(all.begin(), all.end(), by_return));
  ASSERT_LT(worst, best);
  run("every:5");
  ASSERT_GE(Bags().size(), 3U);
  EXPECT_NE(std::string::npos, Bags()[0].find("episode_00000000_"));
  EXPECT_NE(std::string::npos, Bags()[1].find("episode_00000005_"));
  run("best");
  ASSERT_EQ(1U, Bags().size());
  EXPECT_EQ(best, value(Bags()[0]));
  run("worst");
  ASSERT_EQ(1U, Bags().size());
  EXPECT_EQ(worst, value(Bags()[0]));
  run("failures");
  EXPECT_EQ(all.size(), Bags().size());  // random play of 40 steps brings nothing home
}

TEST_F(EpisodeBag, WhatComesFromOutsideIsPartOfTheEpisode) {
  const auto ranch = MakeRanch(ShortScenario());
  {
    const auto recorder = Record(*ranch, "all");
    Play(*ranch, 1, 10);
    aquafarm_msgs::SaveState save;
    ranch->SaveState(save.response);
    SendStorm(*ranch);
    Play(*ranch, 1, 32);
    aquafarm_msgs::LoadState load;
    load.request.data = save.response.data;
    ranch->LoadState(load.request, load.response);
    ASSERT_TRUE(load.response.ok) << load.response.message;
    Play(*ranch, 1, 32);
    ranch->SetRecorder(nullptr);
  }
  ASSERT_EQ(2U, Bags().size());  // the same episode twice, with and without the storm
  for (const std::string& bag : Bags()) EXPECT_EQ("", CheckBag(bag, "").difference) << bag;
}

TEST_F(EpisodeBag, AnEpisodeLoadedAtItsStartBeginsAsItWasSaved) {
  const auto ranch = MakeRanch(ShortScenario());
  aquafarm_msgs::SaveState save;
  SendStorm(*ranch);
  ranch->SaveState(save.response);
  Play(*ranch, 1, 41);
  {
    const auto recorder = Record(*ranch, "all");
    aquafarm_msgs::LoadState load;
    load.request.data = save.response.data;
    ranch->LoadState(load.request, load.response);
    ASSERT_TRUE(load.response.ok) << load.response.message;
    Play(*ranch, 1, 41);
    ranch->SetRecorder(nullptr);
    EXPECT_EQ("", recorder->fault());
  }
  ASSERT_EQ(1U, Bags().size());
  const BagCheck check = CheckBag(Bags()[0], "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(std::vector<std::uint64_t>{0}, check.changed_at);
}

TEST_F(EpisodeBag, ChangesFromOutsideAreCountedAndHideNoMissingStep) {
  const std::string whole = StormBag();
  const BagCheck check = CheckBag(whole, "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(", changed from outside at step 10", ChangesInWords(check));
  int tenth = 0;
  const std::string gap = Changed(whole, true, [&tenth](FarmSpec*, FarmState* state, auto*) {
    if (state == nullptr || state->step < 5 || state->step > 10) return true;
    return state->step == 10 && ++tenth == 2;  // that after the change
  });
  EXPECT_EQ("episode 0 step 10: steps 5 to 10 are missing", CheckBag(gap, "").difference);
  tenth = 0;
  const std::string back = Changed(whole, true, [&tenth](FarmSpec*, FarmState* state, auto*) {
    if (state != nullptr && state->step == 10 && ++tenth == 1) state->step = 11;
    return true;
  });
  EXPECT_EQ("episode 0 step 11: step 10 is missing", CheckBag(back, "").difference);
}

TEST_F(EpisodeBag, EverySummaryBelongsToItsEpisodeAndEveryEndHasOne) {
  const std::string bag = OneBag();
  const auto difference = [&](auto change) {
    return CheckBag(Changed(bag, true, change), "").difference;
  };
  const std::string missing = "episode 0 step 40: the episode is over, but its summary is missing";
  EXPECT_EQ(missing, difference([](FarmSpec*, FarmState*, EpisodeSummary* summary) {
              if (summary != nullptr) summary->seed += 1;
              return true;
            }));
  EXPECT_EQ(missing, difference([](FarmSpec*, FarmState*, EpisodeSummary* summary) {
              if (summary != nullptr) summary->episode += 1;
              return true;
            }));
  EXPECT_EQ(missing, difference([](FarmSpec*, FarmState*, EpisodeSummary* summary) {
              return summary == nullptr;
            }));
  EXPECT_EQ("episode 7 of seed 5: a summary that no states belong to",
            difference([](FarmSpec*, FarmState* state, EpisodeSummary* summary) {
              if (summary != nullptr) summary->episode = 7;
              return state == nullptr || state->step < 20;  // not over
            }));
  EXPECT_EQ("episode 0 step 5: state.observer: got 0, simulated -1",
            difference([](FarmSpec*, FarmState* state, auto*) {
              if (state != nullptr && state->step == 5) state->observer = 0;
              return true;
            }));
}

TEST_F(EpisodeBag, ASecondSpecThatDiffersIsFound) {
  const std::string path = Changed(OneBag(), true, [](auto*, auto*, auto*) { return true; });
  FarmSpec spec;
  std::string topic;
  {
    rosbag::Bag bag(path);
    for (const auto& message : rosbag::View(bag)) {
      if (const auto one = message.instantiate<FarmSpec>()) spec = *one, topic = message.getTopic();
    }
  }
  const auto append = [&] {
    rosbag::Bag bag(path, rosbag::bagmode::Append);
    bag.write(topic, ros::Time(100), spec);
  };
  append();
  EXPECT_EQ("", CheckBag(path, "").difference);
  spec.rewards.step = -2.0F;
  append();
  EXPECT_EQ("episode 0 of seed 5: two specs that differ", CheckBag(path, "").difference);
}

// The tape of an episode in which all hold.
EpisodeTape HeldTape(const std::shared_ptr<const aquafarm::Scenario>& scenario) {
  aquafarm::Farm farm(scenario);
  farm.Reset(5, 0);
  EpisodeTape tape;
  tape.seed = 5;
  const std::vector<std::uint8_t> hold(farm.ships().size(),
                                       static_cast<std::uint8_t>(aquafarm::Action::kHold));
  while (!farm.over()) {
    farm.Step(hold.data());
    tape.actions.insert(tape.actions.end(), hold.begin(), hold.end());
  }
  tape.record = farm.record();
  return tape;
}

TEST_F(EpisodeBag, AFullDiskCostsTheBagAndNotTheProcess) {
  const auto scenario = std::make_shared<const aquafarm::Scenario>(ShortScenario());
  const EpisodeTape tape = HeldTape(scenario);
  const BagFormat format{"/ranch/", "map", 10, 1};
  const std::string path = folder_ + "/x.bag";
  WriteEpisodeBag(scenario, tape, format, path);
  const auto size = static_cast<rlim_t>(fs::file_size(path));
  fs::remove(path);
  fs::create_symlink("/dev/full", path + ".active");
  EXPECT_THROW(WriteEpisodeBag(scenario, tape, format, path), std::runtime_error);
  EXPECT_TRUE(Bags().empty());
  const auto write_within = [&](rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit most;
    most.rlim_cur = most.rlim_max = bytes;
    setrlimit(RLIMIT_FSIZE, &most);
    try {
      WriteEpisodeBag(scenario, tape, format, path);
    } catch (const std::runtime_error&) {
      _exit(Bags().empty() ? 0 : 1);
    }
    _exit(2);
  };
  for (const rlim_t limit : {rlim_t{100}, rlim_t{4200}, size / 2, size - 10}) {
    EXPECT_EXIT(write_within(limit), testing::ExitedWithCode(0), "")
        << limit << " bytes of " << size;
  }
}

TEST_F(EpisodeBag, ATapeThatDoesNotGiveItsResultLeavesNothing) {
  const auto scenario = std::make_shared<const aquafarm::Scenario>(ShortScenario());
  EpisodeTape tape = HeldTape(scenario);
  tape.record.episode_return += 1.0F;
  EXPECT_THROW(WriteEpisodeBag(scenario, tape, {}, folder_ + "/x.bag"), TapeError);
  EXPECT_TRUE(Bags().empty());
}

TEST_F(EpisodeBag, ADiskThatDoesNotFollowEndsTheKeepingNotTheFarms) {
  const auto ranch = MakeRanch(ShortScenario(), 32);
  const auto recorder = Record(*ranch, "all", {1, std::chrono::milliseconds(0)});
  Play(*ranch, 32, 90);  // 32 episodes end in one step
  EXPECT_EQ("the disk does not follow", recorder->fault());
  ranch->SetRecorder(nullptr);
}

TEST_F(EpisodeBag, ABagOfTheSameNameStays) {
  OneBag();
  OneBag();
  ASSERT_EQ(2U, Bags().size());
  for (const std::string& bag : Bags()) EXPECT_EQ("", CheckBag(bag, "").difference) << bag;
}

TEST_F(EpisodeBag, AMissingStepIsNamed) {
  const std::string whole = OneBag();
  const std::string bag = Changed(whole, true, [](FarmSpec*, FarmState* state, auto*) {
    return state == nullptr || state->step != 7;
  });
  EXPECT_EQ("episode 0 step 8: step 7 is missing", CheckBag(bag, "").difference);
  const std::string late = Changed(whole, true, [](FarmSpec*, FarmState* state, auto*) {
    return state == nullptr || state->step < 30;
  });
  EXPECT_EQ("episode 0 step 40: missing: the bag's states end with step 29",
            CheckBag(late, "").difference);
}

TEST_F(EpisodeBag, AnEditedRewardIsNamedWithBothNumbers) {
  const std::string bag = Changed(OneBag(), true, [](FarmSpec*, FarmState* state, auto*) {
    if (state != nullptr && state->step == 12) state->ships[0].reward = 1000.0F;
    return true;
  });
  const std::string difference = CheckBag(bag, "").difference;
  EXPECT_EQ(0U, difference.find("episode 0 step 12: state.ships[0].reward: got 1000, simulated -"))
      << difference;
}

TEST_F(EpisodeBag, AnEditedSummarySpecActionOrLastBitIsFound) {
  const std::string bag = OneBag();
  const auto difference = [&](auto change) {
    return CheckBag(Changed(bag, true, change), "").difference;
  };
  EXPECT_EQ("episode 0 step 40: episode.success: got 1, simulated 0",
            difference([](FarmSpec*, FarmState*, EpisodeSummary* summary) {
              if (summary != nullptr) summary->success = 1;
              return true;
            }));
  EXPECT_EQ(0U, difference([](FarmSpec* spec, FarmState*, auto*) {
                  if (spec != nullptr) spec->rewards.step = -2.0F;
                  return true;
                }).find("episode 0 step 0: spec.rewards.step: got -2, simulated -1"));
  EXPECT_NE("", difference([](FarmSpec*, FarmState* state, auto*) {
              if (state != nullptr && state->step == 3) {
                state->ships[0].action =
                    static_cast<std::uint8_t>((state->ships[0].action + 1) % 8);
              }
              return true;
            }));
  EXPECT_EQ(0U, difference([](FarmSpec*, FarmState* state, auto*) {
                  if (state != nullptr && state->step == 5) state->hash ^= 1U;
                  return true;
                }).find("episode 0 step 5: state.hash: got "));
  EXPECT_EQ("episode 0 step 5: state.ships[0].action: got 99, expected [0, 10]",
            difference([](FarmSpec*, FarmState* state, auto*) {
              if (state != nullptr && state->step == 5) state->ships[0].action = 99;
              return true;
            }));
}

TEST_F(EpisodeBag, AFlippedBitAnywhereInTheRecordingIsFound) {
  const std::string bag = OneBag();
  std::ifstream file(bag, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  const std::string bytes = content.str();
  // The compressed chunk lies behind the file's header of 4 kB; it is most of the rest.
  const std::size_t begin = 4200;
  ASSERT_GT(bytes.size(), begin + 2000);
  for (int i = 0; i < 60; ++i) {
    std::string flipped = bytes;
    const std::size_t place = begin + static_cast<std::size_t>(i) * (bytes.size() - begin) / 60;
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << (i % 8)));
    const std::string path = folder_ + "/flipped.bag";
    std::ofstream(path, std::ios::binary) << flipped;
    bool found = false;
    try {
      found = !CheckBag(path, "").difference.empty();
    } catch (const std::exception&) {
      found = true;
    }
    EXPECT_TRUE(found) << "byte " << place << " bit " << i % 8 << " of " << bytes.size();
  }
}

TEST_F(EpisodeBag, BagsThatCannotBeCheckedHaveTheirLine) {
  const std::string bag = OneBag();
  EXPECT_NE(std::string::npos, Refusal(folder_ + "/none.bag").find("damaged or no bag"));
  std::ofstream(folder_ + "/text.bag") << "no bag";
  EXPECT_NE(std::string::npos, Refusal(folder_ + "/text.bag").find("damaged or no bag"));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 return spec == nullptr;
                               })).find("no topic spec, so nothing says what was played"));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 if (spec != nullptr) spec->version = "9.9.9";
                                 return true;
                               })).find("recorded by version 9.9.9, this is "));
  EXPECT_NE(std::string::npos, Refusal(bag, "/lake").find("no ranch /lake/, there is: /ranch/"));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 return spec != nullptr;
                               })).find("no state follows its spec"));
}

TEST_F(EpisodeBag, AnEpisodeWithoutItsEndSaysSo) {
  const std::string bag =
      Changed(OneBag(), true, [](FarmSpec*, FarmState* state, EpisodeSummary* summary) {
        return summary == nullptr && (state == nullptr || state->step < 20);
      });
  const BagCheck check = CheckBag(bag, "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(1U, check.unfinished);
}

TEST(Keep, RefusesWhatItDoesNotKnow) {
  for (const char* wrong : {"some", "every:", "every:0", "every:-1", "every:2x", ""}) {
    try {
      ParseKeep(wrong);
      FAIL() << wrong;
    } catch (const aquafarm::InputError& error) {
      EXPECT_EQ(std::string("~keep: got '") + wrong +
                    "', expected none, all, every:N, best, worst or failures",
                error.what());
    }
  }
  EXPECT_EQ(7U, ParseKeep("every:7").every);
}

TEST(Keep, AFolderThatCannotBeMadeIsRefused) {
  try {
    EpisodeRecorder(nullptr, {}, "/proc/none", {});
    FAIL();
  } catch (const aquafarm::InputError& error) {
    EXPECT_STREQ("~keep_dir: got '/proc/none', expected a folder to write to", error.what());
  }
}

}  // namespace
}  // namespace aquafarm_sim::test
