// SPDX-License-Identifier: BSD-3-Clause
// Checks of changed and damaged bags by verify_bag.
#include "aquafarm_sim/bags/bag_check.h"

#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/SavedState.h>
#include <gtest/gtest.h>
#include <nav_msgs/OccupancyGrid.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <sstream>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/episode_recorder.h"
#include "aquafarm_sim/bags/read_bag.h"
#include "episode_bag_fixture.h"

namespace aquafarm_sim::test {
namespace {

TEST_F(EpisodeBag, ChangesFromOutsideAreCountedAndHideNoMissingStep) {
  const std::string whole = StormBag();
  const BagCheck check = CheckBag(whole, "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(", changed from outside at step 10", ChangesInWords(check));
  int tenth = 0;
  const std::string gap = Changed(whole, true, [&tenth](FarmSpec*, FarmState* state, auto*) {
    if (state == nullptr || state->step < 5 || state->step > 10) return true;
    return state->step == 10 && ++tenth == 2;  // the state after the change
  });
  EXPECT_EQ("episode 0 step 10: steps 5 to 10 are missing", CheckBag(gap, "").difference);
  const std::string one = Changed(whole, true, [](FarmSpec*, FarmState* state, auto*) {
    return state == nullptr || state->step != 10;
  });
  EXPECT_EQ("episode 0 step 10: step 10 is missing", CheckBag(one, "").difference);
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
  EXPECT_EQ("episode 7 of seed 5: a summary without states",
            difference([](FarmSpec*, FarmState* state, EpisodeSummary* summary) {
              if (summary != nullptr) summary->episode = 7;
              return state == nullptr || state->step < 20;  // the episode does not end
            }));
  EXPECT_EQ("episode 0 step 5: state.observer: got 0, simulated -1",
            difference([](FarmSpec*, FarmState* state, auto*) {
              if (state != nullptr && state->step == 5) state->observer = 0;
              return true;
            }));
}

TEST_F(EpisodeBag, AnAbortedRunOfTheSameEpisodeHasNoSummary) {
  const std::string whole = OneBag();
  for (const std::uint64_t last : {std::uint64_t{5}, std::uint64_t{39}}) {
    const std::string path = folder_ + "/again.bag";
    rosbag::Bag from(whole);
    rosbag::Bag to(path, rosbag::bagmode::Write);
    for (const bool is_aborted : {true, false}) {
      for (const auto& message : rosbag::View(from)) {
        const ros::Time time = message.getTime() + ros::Duration(is_aborted ? 0.0 : 1e5);
        const auto state = message.instantiate<FarmState>();
        if (is_aborted && (message.instantiate<EpisodeSummary>() != nullptr ||
                           (state != nullptr && state->step > last))) {
          continue;
        }
        if (state != nullptr || message.instantiate<FarmSpec>() != nullptr || !is_aborted) {
          to.write(message.getTopic(), time, message);
        }
      }
    }
    to.close();
    const BagCheck check = CheckBag(path, "");
    EXPECT_EQ("", check.difference) << last;
    EXPECT_EQ(2, check.episodes);
    EXPECT_EQ(1, check.unfinished);
    fs::remove(path);
  }
}

TEST(OldBag, OfVersion010IsVerifiedInSpiteOfItsOtherComments) {
  const BagCheck check = CheckBag(AQUAFARM_SIM_TEST_DATA "/version_0_1_0.bag", "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(1U, check.episodes);
}

TEST(OldBag, WithOtherCommentsInItsDefinitionsIsVerified) {
  const BagCheck check = CheckBag(AQUAFARM_SIM_TEST_DATA "/before_2026_11_28.bag", "");
  EXPECT_EQ("", check.difference);
  EXPECT_EQ(1U, check.episodes);
}

TEST(OldBag, HasZerosForTheFieldsThatItLacks) {
  const std::string path = AQUAFARM_SIM_TEST_DATA "/version_0_1_0.bag";
  std::size_t states = 0;
  float joint_return = 0.0F;
  ReadingBag(path, [&] {
    rosbag::Bag bag;
    OpenBag<FarmState, EpisodeSummary>(bag, path);
    for (const auto& message : rosbag::View(bag)) {
      if (const auto state = Instantiate<FarmState>(message)) {
        ++states;
        joint_return = state->joint_return;
        EXPECT_EQ(0.0, state->total_distance);
        EXPECT_EQ(0.0F, state->ships.at(0).terms.energy);
      } else if (const auto summary = Instantiate<EpisodeSummary>(message)) {
        EXPECT_EQ(joint_return, summary->episode_return);
        EXPECT_EQ(0.0, summary->distance);
        EXPECT_NE(0, summary->reason);  // the field after the added ones
      }
    }
  });
  EXPECT_GT(states, 5U);
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

TEST_F(EpisodeBag, AnEditedChartIsFoundAlthoughItPrecedesTheStates) {
  const std::string whole = OneBag();
  const std::string path = folder_ + "/chart.bag";
  int charts = 0;
  {
    rosbag::Bag from(whole);
    rosbag::Bag to(path, rosbag::bagmode::Write);
    for (const auto& message : rosbag::View(from)) {
      const auto grid = message.instantiate<nav_msgs::OccupancyGrid>();
      if (grid == nullptr || message.getTopic() != "/ranch/chart") {
        to.write(message.getTopic(), message.getTime(), message);
        continue;
      }
      ++charts;
      grid->data[3] = static_cast<std::int8_t>(grid->data[3] == 0 ? 100 : 0);
      to.write(message.getTopic(), message.getTime(), *grid);
    }
  }
  ASSERT_EQ(charts, 1);
  EXPECT_EQ("", CheckBag(whole, "").difference);
  const std::string difference = CheckBag(path, "").difference;
  EXPECT_EQ(0U, difference.find("episode 0 step 0: chart.data[3]: got ")) << difference;
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

// Checks a bag and returns the result: "found" (also as an error message with the bag's path),
// "hides" (no difference), or a fault of the reader. A separate process checks the bag, so that a
// crash of the reader does not end the test.
std::string EndOf(const std::string& path) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      _exit(CheckBag(path, "").difference.empty() ? 1 : 0);
    } catch (const aquafarm::InputError& error) {
      _exit(std::string(error.what()).rfind(path + ": ", 0) == 0 ? 0 : 2);
    } catch (...) {
      _exit(3);
    }
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  if (WIFSIGNALED(status)) return strsignal(WTERMSIG(status));
  const std::vector<std::string> ends{"found", "hides", "no line", "another exception"};
  return ends.at(static_cast<std::size_t>(WEXITSTATUS(status)));
}

// The messages of a bag with their connections, as text.
std::string MessagesOf(const std::string& path) {
  rosbag::Bag bag(path);
  std::string all;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    all += message.getTopic() + ' ' + message.getMD5Sum() + message.getMessageDefinition() +
           std::to_string(message.getTime().toNSec()) + bytes;
  }
  return all;
}

// Makes `count` bags from a bag, each with one flipped bit. The bits are spread evenly over the
// bytes from `begin` to the end.
void FlipBits(const std::string& bag, std::size_t begin, std::size_t count) {
  std::ifstream file(bag, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  const std::string bytes = content.str();
  ASSERT_GT(bytes.size(), begin + 2000);
  for (std::size_t i = 0; i < count; ++i) {
    std::string flipped = bytes;
    const std::size_t place = begin + i * (bytes.size() - begin) / count;
    flipped[place] = static_cast<char>(flipped[place] ^ (1 << (i % 8)));
    const std::string path = bag + ".flipped";
    std::ofstream(path, std::ios::binary) << flipped;
    const std::string end = EndOf(path);
    // LZ4 can express the same bytes in several ways: such a flip changes no message.
    if (end == "hides" && MessagesOf(path) == MessagesOf(bag)) continue;
    EXPECT_EQ("found", end) << "byte " << place << " bit " << i % 8 << " of " << bytes.size();
  }
}

// The compressed chunk follows the header of 4 kB and makes up most of the file.
TEST_F(EpisodeBag, AFlippedBitAnywhereInTheRecordingIsFound) { FlipBits(OneBag(), 4200, 60); }

// No checksum protects the lengths, offsets and names that rosbag's reader trusts.
TEST_F(EpisodeBag, ABagWhoseIndexIsDamagedHasItsLine) {
  const std::string bag = OneBag();
  const std::size_t size = fs::file_size(bag);
  FlipBits(bag, size - 3000, 120);
  fs::resize_file(bag, size - 10);
  EXPECT_EQ(0U, Refusal(bag).find(bag + ": damaged: a length beyond its end at byte "));
}

std::string ContentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream content;
  content << file.rdbuf();
  return content.str();
}

// Overwrites the bytes at an offset.
void Put(const std::string& path, std::size_t place, const std::string& bytes) {
  ASSERT_NE(place, std::string::npos);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(place));
  file << bytes;
}

rlim_t DataLimit() {
  rlimit limit{};
  EXPECT_EQ(getrlimit(RLIMIT_DATA, &limit), 0);
  return limit.rlim_cur;
}

// No checksum protects uncompressed data. Here 2^25 is added to the number of a state's ships,
// which requests 4 GB.
TEST_F(EpisodeBag, ALengthThatAsksForAnyMemoryHasItsLine) {
  const std::string path = Changed(OneBag(), false, [](auto*, auto*, auto*) { return true; });
  const rlim_t before = DataLimit();
  EXPECT_EQ("", CheckBag(path, "").difference);
  EXPECT_EQ(before, DataLimit());
  std::string ship;
  {
    rosbag::Bag bag(path);
    for (const auto& message : rosbag::View(bag)) {
      const auto state = message.instantiate<FarmState>();
      if (!state || state->step != 9) continue;
      ship.resize(ros::serialization::serializationLength(state->ships));
      auto* bytes = reinterpret_cast<std::uint8_t*>(ship.data());
      ros::serialization::OStream stream(bytes, static_cast<std::uint32_t>(ship.size()));
      stream.next(state->ships);
    }
  }
  Put(path, ContentOf(path).find(ship) + 3, "\x02");
  EXPECT_EQ(path + ": damaged: reading it needs more memory than a bag of its size may use",
            Refusal(path));
  EXPECT_EQ(before, DataLimit());
}

// Only reading a bag has a memory limit. The code that uses its messages has none.
TEST_F(EpisodeBag, WhatIsDoneWithABagHasNoBoundOfMemory) {
  const std::string path = OneBag();
  const rlim_t before = DataLimit();
  ReadingBag(path, [&] {
    rosbag::Bag bag;
    OpenBag<FarmState>(bag, path);
    EXPECT_EQ(before, DataLimit());
    rosbag::View states(bag, rosbag::TypeQuery("aquafarm_msgs/FarmState"));
    EXPECT_NE(nullptr, Instantiate<FarmState>(*states.begin()));
    EXPECT_EQ(before, DataLimit());
  });
  EXPECT_THROW(ReadingBag(path, [] { throw std::bad_alloc(); }), std::bad_alloc);
}

// rosbag's reader allocates twice the size of a chunk and ends the process if the allocation fails.
TEST_F(EpisodeBag, AChunkOfAnySizeHasItsLine) {
  const std::string path = folder_ + "/chunks.bag";
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    bag.setChunkThreshold(600'000);
    aquafarm::RandomStream rng({3, 0, aquafarm::RngStream::kExploration, 0});
    aquafarm_msgs::SavedState saved;
    saved.data.resize(700'000);
    for (auto& byte : saved.data) byte = static_cast<std::uint8_t>(rng.Below(256));
    for (const double time : {1.0, 2.0}) bag.write("/ranch/saved_state", ros::Time(time), saved);
  }
  const std::string content = ContentOf(path);
  const std::size_t second = content.rfind("compression=lz4");
  ASSERT_NE(second, content.find("compression=lz4"));
  Put(path, content.find("size=", second) + 8, "\x66");  // 1.6 GiB
  EXPECT_EQ("found", EndOf(path));
  EXPECT_EQ(0U, Refusal(path).find(path + ": damaged: a chunk of more than 256 MiB at byte 70"))
      << Refusal(path);
}

TEST_F(EpisodeBag, AMessageWithoutATopicAndAChunkListedTwiceHaveTheirLine) {
  const std::string path = folder_ + "/chunks.bag";
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.setChunkThreshold(1000);
    aquafarm_msgs::SavedState saved;
    saved.data.resize(2000);
    for (int i = 0; i < 2; ++i) bag.write("/ranch/saved_state", ros::Time(1.0), saved);
  }
  const std::string sound = ContentOf(path);
  EXPECT_EQ(path +
                ": no topic spec, so it is unknown what was played; record spec and state, as "
                "record.launch does",
            Refusal(path));
  const std::string place = "chunk_pos=";
  const std::size_t last = sound.rfind(place) + place.size();
  const std::size_t first = sound.rfind(place, last - place.size() - 1) + place.size();
  Put(path, last, sound.substr(first, 8));
  EXPECT_EQ(0U, Refusal(path).find(path + ": damaged: wrong chunk info at byte ")) << Refusal(path);
  std::ofstream(path, std::ios::binary) << sound;
  const std::string zero(4, '\0');
  const std::string connection = "conn=" + zero + std::string("\x04\0\0\0op=\x07", 8);
  for (std::size_t at = sound.find(connection); at != std::string::npos;
       at = sound.find(connection, at + 1)) {
    Put(path, at + 5, "\x05");
  }
  EXPECT_EQ(0U, Refusal(path).find(path + ": damaged: a message without a topic at byte "))
      << Refusal(path);
}

TEST_F(EpisodeBag, BagsThatCannotBeCheckedHaveTheirLine) {
  const std::string bag = OneBag();
  EXPECT_EQ(folder_ + "/none.bag: no such file", Refusal(folder_ + "/none.bag"));
  std::ofstream(folder_ + "/text.bag") << "no bag";
  EXPECT_NE(std::string::npos, Refusal(folder_ + "/text.bag").find("damaged or not a bag"));
  const std::string late = folder_ + "/late.bag";
  {
    ros::Time time;  // a value that no constructor accepts
    time.sec = time.nsec = UINT32_MAX;
    rosbag::Bag(late, rosbag::bagmode::Write)
        .write("/ranch/saved_state", time, aquafarm_msgs::SavedState());
  }
  EXPECT_EQ(0U, Refusal(late).find(late + ": damaged or not a bag: ")) << Refusal(late);
  // Replaces the count of connections in the header, which is padded to 4 kB.
  const std::string encrypted = Changed(bag, true, [](auto*, auto*, auto*) { return true; });
  const std::string content = ContentOf(encrypted);
  Put(encrypted, content.find("chunk_count="), "encryptor=a/b");
  EXPECT_EQ(encrypted + ": encrypted; run 'rosbag decrypt' first", Refusal(encrypted));
  EXPECT_EQ(folder_ + ": damaged or not a bag: not a regular file", Refusal(folder_));
  const std::string pipe = folder_ + "/pipe.bag";
  ASSERT_EQ(0, mkfifo(pipe.c_str(), 0600));
  EXPECT_EQ(pipe + ": damaged or not a bag: not a regular file", Refusal(pipe));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 return spec == nullptr;
                               })).find("no topic spec, so it is unknown what was played"));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 if (spec != nullptr) spec->version = "9.9.9";
                                 return true;
                               })).find("recorded by version 9.9.9, this is "));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 if (spec != nullptr) spec->version = "";
                                 return true;
                               })).find(": recorded by an unnamed version, this is "));
  const std::string no_scenario = Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
    if (spec != nullptr) spec->scenario_yaml = "name: {";
    return true;
  });
  EXPECT_EQ(0U, Refusal(no_scenario).find(no_scenario + ": spec.scenario_yaml:"))
      << Refusal(no_scenario);
  const std::string other = folder_ + "/other.bag";
  {
    aquafarm_msgs::SavedState no_spec;
    rosbag::Bag(other, rosbag::bagmode::Write).write("/ranch/spec", ros::Time(1.0), no_spec);
  }
  EXPECT_EQ(other +
                ": topic /ranch/spec: got type aquafarm_msgs/SavedState, expected "
                "aquafarm_msgs/FarmSpec; record spec and state, as record.launch does",
            Refusal(other));
  EXPECT_NE(std::string::npos, Refusal(bag, "/lake").find("no ranch /lake/, there is: /ranch/"));
  EXPECT_NE(std::string::npos, Refusal(Changed(bag, false, [](FarmSpec* spec, auto*, auto*) {
                                 return spec != nullptr;
                               })).find("got no episode with a spec and states"));
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

}  // namespace
}  // namespace aquafarm_sim::test
