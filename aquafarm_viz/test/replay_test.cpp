// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_viz/replay/replay.h"

#include <gtest/gtest.h>
#include <std_msgs/Header.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm_viz/scene/trail.h"
#include "fixture.h"

namespace aquafarm_viz {
namespace {

namespace fs = std::filesystem;

class Replay : public testing::Test {
 protected:
  Replay() : path_(fs::temp_directory_path() / ("replay_test_" + std::to_string(getpid()))) {}
  ~Replay() override { fs::remove(path_); }

  // Writes episodes 12 and 14 with steps 0, 2, 4 … 98, two steps per 0.2 s, and observations.
  std::string MakeBag() {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    double seconds = 1.0;
    for (const std::uint64_t episode : {12U, 14U}) {
      auto spec = test::MakeSpec();
      spec.episode = episode;
      bag.write("/aquafarm/spec", ros::Time(seconds), spec);
      for (std::uint64_t step = 0; step < 100; step += 2) {
        auto state = test::MakeState();
        state.episode = episode;
        state.step = step;
        state.ships[0].x = std::abs(static_cast<int>(step / 2) % 16 - 8);  // oscillates
        bag.write("/aquafarm/state", ros::Time(seconds += 0.2), state);
        bag.write("/aquafarm/ship_0/observation", ros::Time(seconds), state);
      }
    }
    return path_;
  }

  static std::string FaultOf(const std::string& path) {
    try {
      ReplayTape tape(path);
    } catch (const std::runtime_error& fault) {
      return fault.what();
    }
    return "";
  }

  const std::string path_;
};

TEST_F(Replay, FindsAStepOrTheNextLaterOneOrTheLast) {
  const ReplayTape tape(MakeBag());
  EXPECT_EQ(tape.steps().size(), 100U);  // observations do not count
  const auto& at = tape.steps().front();
  EXPECT_EQ(tape.Find(at, 12, 4)->step, 4U);
  EXPECT_EQ(tape.Find(at, 14, 5)->step, 6U);
  EXPECT_EQ(tape.Find(at, 14, 5)->episode, 14U);
  EXPECT_EQ(tape.Find(at, 12, 5000)->step, 98U);
  EXPECT_FALSE(tape.Find(at, 13, 0));
  EXPECT_NEAR(tape.StepPeriod_s(at.run), 0.1, 1e-6);
}

TEST_F(Replay, MissingStepsAndAnotherVersionAreSaid) {
  using Notes = std::vector<std::string>;
  const std::string missing = "98 steps are missing; 'verify' names the first";
  const ReplayTape tape(MakeBag());
  const std::string own = test::MakeSpec().version;
  EXPECT_EQ(tape.Notes(own), Notes({missing}));
  EXPECT_EQ(tape.Notes("9.9"),
            Notes({missing, "recorded by version " + own + ", this is 9.9; shown nevertheless"}));
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    auto spec = test::MakeSpec();
    spec.version = "";
    bag.write("/aquafarm/spec", ros::Time(1.0), spec);
    for (const std::uint64_t step : {3U, 5U}) {
      auto state = test::MakeState();
      state.step = step;
      bag.write("/aquafarm/state", ros::Time(double(step)), state);
    }
  }
  EXPECT_EQ(ReplayTape(path_).Notes("9.9"),
            Notes({"1 step is missing; 'verify' names it",
                   "recorded by an unnamed version, this is 9.9; shown nevertheless"}));
}

TEST_F(Replay, AJumpBringsTheSpecTheWholeWayAndTheStepLast) {
  const ReplayTape tape(MakeBag());
  const auto step = *tape.Find(tape.steps().front(), 14, 60);
  const auto positions = tape.UpTo(step);
  EXPECT_EQ(positions.back(), step.position);
  std::vector<std::uint64_t> steps;
  bool has_spec = false;
  for (const std::size_t position : positions) {
    const auto& message = tape.messages()[position];
    if (const auto spec = message.instantiate<aquafarm_msgs::FarmSpec>()) {
      has_spec = has_spec || spec->episode == 14;
    } else if (message.getTopic() == "/aquafarm/state") {
      const auto state = message.instantiate<aquafarm_msgs::FarmState>();
      EXPECT_EQ(state->episode, 14U);
      steps.push_back(state->step);
    }
  }
  EXPECT_TRUE(has_spec);
  ASSERT_EQ(steps.size(), 31U);
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i], 2 * i);
}

TEST_F(Replay, ABagOfVersion010IsShownWithTheMessagesOfThisOne) {
  if (!fs::exists(OLD_BAG)) GTEST_SKIP() << "this copy of the package has no aquafarm_sim";
  const ReplayTape tape(OLD_BAG);
  EXPECT_GT(tape.steps().size(), 5U);
  int states = 0;
  for (const auto& message : tape.messages()) {
    if (!IsState(message)) continue;
    ++states;
    const std::string now = ros::message_traits::md5sum<aquafarm_msgs::FarmState>();
    EXPECT_NE(message.getMD5Sum(), now);
    EXPECT_EQ(AdvertiseOptionsOf(message, 1).md5sum, now);
  }
  EXPECT_GT(states, 5);
}

TEST_F(Replay, TrailsAndRoutesAfterAJumpAreThoseOfPlayingThrough) {
  const ReplayTape tape(MakeBag());
  const auto step = *tape.Find(tape.steps().front(), 14, 60);
  Trail played[2]{Trail(), Trail(Trail::kWhole)};
  Trail jumped[2]{Trail(), Trail(Trail::kWhole)};
  const auto take = [&](Trail* ways, std::size_t position) {
    const auto& message = tape.messages()[position];
    if (message.getTopic() != "/aquafarm/state") return;
    const auto state = message.instantiate<aquafarm_msgs::FarmState>();
    for (int i = 0; i < 2; ++i) ways[i].Update(*state);
  };
  for (std::size_t i = 0; i <= step.position; ++i) take(played, i);
  for (const std::size_t position : tape.UpTo(step)) take(jumped, position);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(jumped[i].Find(0)->places, played[i].Find(0)->places);
    EXPECT_EQ(jumped[i].Find(0)->bearing_deg, played[i].Find(0)->bearing_deg);
  }
  EXPECT_EQ(played[0].Find(0)->places.size(), Trail::kLength);
  EXPECT_EQ(played[1].Find(0)->places.size(), 31U);
}

// Writes episode 5 of seed 1, episode 5 of seed 1000, then episode 5 of seed 1 again. Each spec
// follows its first state.
std::string WithTwoSeeds(const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  double seconds = 1.0;
  for (const std::uint64_t seed : {1U, 1000U, 1U}) {
    for (std::uint64_t step = 0; step < 10; ++step) {
      auto state = test::MakeState();
      state.seed = seed;
      state.episode = 5;
      state.step = step;
      bag.write("/aquafarm/state", ros::Time(seconds += 0.1), state);
      if (step != 0) continue;
      auto spec = test::MakeSpec();
      spec.seed = seed;
      spec.episode = 5;
      bag.write("/aquafarm/spec", ros::Time(seconds += 0.1), spec);
    }
  }
  return path;
}

TEST_F(Replay, AJumpStaysInTheRunOfItsSeed) {
  const ReplayTape tape(WithTwoSeeds(path_));
  for (std::size_t run = 0; run < 3; ++run) {
    const auto& shown = tape.steps()[10 * run + 3];
    EXPECT_EQ(shown.run, run);
    EXPECT_EQ(tape.Find(shown, 5, 7)->position, tape.steps()[10 * run + 7].position);
    EXPECT_EQ(tape.Find(shown, 5, 99)->position, tape.steps()[10 * run + 9].position);
  }
}

TEST_F(Replay, AJumpSendsTheSpecOfItsEpisodeFirstThoughItLiesBehind) {
  const ReplayTape tape(WithTwoSeeds(path_));
  const auto positions = tape.UpTo(tape.steps()[10]);  // the first of seed 1000
  const auto spec = tape.messages()[positions.front()].instantiate<aquafarm_msgs::FarmSpec>();
  ASSERT_NE(spec, nullptr);
  EXPECT_EQ(spec->seed, 1000U);
  EXPECT_EQ(positions, (std::vector<std::size_t>{positions.front(), tape.steps()[10].position}));
}

TEST_F(Replay, AtIsTheStepThatIsShownAtAPosition) {
  const ReplayTape tape(MakeBag());
  EXPECT_EQ(tape.At(0).step, 0U);
  const auto step = *tape.Find(tape.steps().front(), 12, 10);
  EXPECT_EQ(tape.At(step.position).step, 10U);
  EXPECT_EQ(tape.At(step.position - 1).step, 8U);
}

TEST_F(Replay, ABagThatCannotBeShownHasItsLine) {
  EXPECT_EQ(FaultOf("/nowhere/x.bag"), "/nowhere/x.bag: no such file");
  test::DamageIndex(MakeBag());
  EXPECT_EQ(
      FaultOf(path_).find(path_ + ": damaged: an index that does not match its chunk at byte "),
      0U);
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/aquafarm/state", ros::Time(1.0), test::MakeState());
  }
  EXPECT_EQ(FaultOf(path_),
            path_ +
                ": no topic spec, so it is unknown what was played; record spec and state, as "
                "record.launch does");
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    bag.write("/aquafarm/spec", ros::Time(1.0), test::MakeSpec());
  }
  EXPECT_EQ(FaultOf(path_),
            path_ + ": got no episode with a spec and states, expected at least one");
  {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    // A connection with the type of a state and an invalid definition.
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = "aquafarm_msgs/FarmState";
    (*header)["md5sum"] = "00000000000000000000000000000000";
    (*header)["message_definition"] = "uint8 old";
    bag.write("/aquafarm/state", ros::Time(1.0), std_msgs::Header(), header);
  }
  EXPECT_EQ(FaultOf(path_),
            path_ +
                ": topic /aquafarm/state has another aquafarm_msgs/FarmState than this "
                "version; use the version that recorded the bag");
}

}  // namespace
}  // namespace aquafarm_viz
