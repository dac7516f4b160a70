// SPDX-License-Identifier: BSD-3-Clause
// Recording of kept episodes as bags.
#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/SavedState.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/bag_check.h"
#include "aquafarm_sim/bags/episode_recorder.h"
#include "episode_bag_fixture.h"

namespace aquafarm_sim::test {
namespace {

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

TEST_F(EpisodeBag, SaysThePaceAndRateThatItsEpisodeBeganWith) {
  const auto ranch = MakeRanch(ShortScenario());
  {
    const auto recorder = Record(*ranch, "all");
    Play(*ranch, 1, 41);
    aquafarm_msgs::SetPace faster;
    faster.request.rate_hz = 50.0;
    ranch->SetPace(faster.request, faster.response);
    ASSERT_TRUE(faster.response.ok);
    Play(*ranch, 1, 90);  // the second episode started before the change
    ranch->SetRecorder(nullptr);
  }
  std::vector<double> rates;
  for (const std::string& path : Bags()) {
    EXPECT_EQ("", CheckBag(path, "").difference);
    rosbag::Bag bag(path);
    rosbag::View view(bag, rosbag::TopicQuery("/ranch/state"));
    rates.push_back(view.begin()->instantiate<FarmState>()->rate_hz);
  }
  ASSERT_GE(rates.size(), 2U);
  EXPECT_EQ(rates.front(), 10.0);
  EXPECT_EQ(rates.back(), 50.0);
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
  EXPECT_EQ(all.size(), Bags().size());  // 40 random steps deliver no device
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

EpisodeLog HeldLog(const std::shared_ptr<const aquafarm::Scenario>& scenario) {
  aquafarm::Farm farm(scenario);
  farm.Reset(5, 0);
  EpisodeLog log;
  log.seed = 5;
  const std::vector<std::uint8_t> hold(farm.ships().size(),
                                       static_cast<std::uint8_t>(aquafarm::Action::kHold));
  while (!farm.over()) {
    farm.Step(hold.data());
    log.actions.insert(log.actions.end(), hold.begin(), hold.end());
  }
  log.record = farm.record();
  return log;
}

TEST_F(EpisodeBag, AFullDiskCostsTheBagAndNotTheProcess) {
  const auto scenario = std::make_shared<const aquafarm::Scenario>(ShortScenario());
  const EpisodeLog log = HeldLog(scenario);
  const BagFormat format{"/ranch/", "map", 10, 1};
  const std::string path = folder_ + "/x.bag";
  EpisodeBagWriter writer(scenario, format);
  writer.Write(log, path);
  const auto size = static_cast<rlim_t>(fs::file_size(path));
  fs::remove(path);
  fs::create_symlink("/dev/full", path + ".partial");
  EXPECT_THROW(writer.Write(log, path), std::runtime_error);
  EXPECT_TRUE(Bags().empty());
  const auto write_within = [&](rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit most;
    most.rlim_cur = most.rlim_max = bytes;
    setrlimit(RLIMIT_FSIZE, &most);
    try {
      writer.Write(log, path);
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

TEST_F(EpisodeBag, PartialBagsOfKilledProcessesAreRemovedAndThoseBeingWrittenStay) {
  const auto touch = [this](const std::string& name) {
    std::ofstream(folder_ + "/" + name) << "#ROSBAG V2.0";
    return folder_ + "/" + name;
  };
  const std::string abandoned = touch("episode_00000001_seed_1_return_+1.0.bag.partial");
  const std::string written = touch("episode_00000002_seed_1_return_+1.0.bag.partial");
  const std::string of_others = touch("day.bag.partial");
  // rosbag record -O episode_00000004_seed_1_return_+1.0.bag writes this one and locks nothing.
  const std::string recorded = touch("episode_00000004_seed_1_return_+1.0.bag.active");
  const std::string whole = touch("episode_00000003_seed_1_return_+1.0.bag");
  const int file = open(written.c_str(), O_RDONLY);
  ASSERT_EQ(flock(file, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(RemoveAbandonedBags(folder_), 1);
  EXPECT_FALSE(fs::exists(abandoned));
  EXPECT_TRUE(fs::exists(written) && fs::exists(of_others) && fs::exists(whole));
  EXPECT_TRUE(fs::exists(recorded));
  close(file);
  EXPECT_EQ(RemoveAbandonedBags(folder_), 1);
  EXPECT_EQ(RemoveAbandonedBags("/nowhere"), 0);
}

TEST_F(EpisodeBag, AFileThatAnotherProcessWritesIsNotTouched) {
  const auto scenario = std::make_shared<const aquafarm::Scenario>(ShortScenario());
  const std::string path = folder_ + "/x.bag";
  const std::string active = path + ".partial";
  std::ofstream(active) << "half";
  const int file = open(active.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(flock(file, LOCK_EX), 0);  // a lock of another open file, as of another process
  EXPECT_THROW(EpisodeBagWriter(scenario, {}).Write(HeldLog(scenario), path), std::runtime_error);
  EXPECT_EQ(fs::file_size(active), 4U);
  EXPECT_FALSE(fs::exists(path));
  close(file);
}

TEST_F(EpisodeBag, ALogThatDoesNotGiveItsResultLeavesNothing) {
  const auto scenario = std::make_shared<const aquafarm::Scenario>(ShortScenario());
  EpisodeLog log = HeldLog(scenario);
  log.record.episode_return += 1.0F;
  EXPECT_THROW(EpisodeBagWriter(scenario, {}).Write(log, folder_ + "/x.bag"), ReplayError);
  EXPECT_TRUE(Bags().empty());
}

TEST_F(EpisodeBag, ADiskThatDoesNotFollowEndsTheKeepingNotTheFarms) {
  const auto ranch = MakeRanch(ShortScenario(), 32);
  const auto recorder = Record(*ranch, "all", {1, std::chrono::milliseconds(0)});
  Play(*ranch, 32, 90);  // 32 episodes end in one step
  EXPECT_NE(recorder->fault().find("wait for the disk after 0 ms, expected less than 1; use a"),
            std::string::npos)
      << recorder->fault();
  ranch->SetRecorder(nullptr);
}

TEST_F(EpisodeBag, ABagOfTheSameNameStays) {
  OneBag();
  OneBag();
  ASSERT_EQ(2U, Bags().size());
  for (const std::string& bag : Bags()) EXPECT_EQ("", CheckBag(bag, "").difference) << bag;
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
    EpisodeRecorder(std::make_shared<const aquafarm::Scenario>(ShortScenario()), {}, "/proc/none",
                    {});
    FAIL();
  } catch (const aquafarm::InputError& error) {
    EXPECT_STREQ("~keep_dir: got '/proc/none', expected a folder that can be written",
                 error.what());
  }
}

}  // namespace
}  // namespace aquafarm_sim::test
