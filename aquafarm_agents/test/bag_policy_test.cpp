// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/bag/bag_policy.h"

#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <aquafarm_msgs/PolicyChoice.h>
#include <aquafarm_msgs/SavedState.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/agents/base/storage.h"
#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/version.h"
#include "aquafarm/farm/farm.h"
#include "aquafarm/observation/farm_batch.h"
#include "aquafarm/scenario/scenario_yaml.h"

namespace aquafarm_agents {
namespace {

namespace fs = std::filesystem;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;
using aquafarm_msgs::PolicyChoice;
using aquafarm_msgs::SavedState;
using Actions = std::vector<std::vector<std::uint8_t>>;  // by step

constexpr std::int32_t kChangedAt = 3;

class BagPolicy : public testing::Test {
 protected:
  BagPolicy() : folder_(fs::temp_directory_path() / ("bag_policy_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~BagPolicy() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ / name; }

  // A ship that holds until the step limit; it may be moved from outside in step 3.
  std::string MakeBag(bool is_changed) {
    const auto scenario = std::make_shared<const aquafarm::Scenario>(
        aquafarm::LoadScenario(AQUAFARM_TEST_DATA "/tiny.yaml"));
    aquafarm::Farm farm(scenario);
    farm.Reset(5, 0);
    const auto hold = static_cast<std::uint8_t>(aquafarm::Action::kHold);
    const std::string path = Path(is_changed ? "changed.bag" : "plain.bag");
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    ros::Time time(1.0);
    const auto write = [&](const char* topic, auto message) {
      message.seed = 5;
      message.header.stamp = time += ros::Duration(0, 1000);
      bag.write(topic, time, message);
    };
    const auto write_state = [&] {
      FarmState state;
      state.step = static_cast<std::uint64_t>(farm.step());
      state.hash = farm.Hash();
      state.ships.resize(1);
      state.ships[0].action = hold;
      write("/ranch/state", state);
    };
    FarmSpec spec;
    spec.version = aquafarm::kVersion;
    spec.scenario_yaml = aquafarm::ToYaml(*scenario);
    write("/ranch/spec", spec);
    write_state();
    while (!farm.over()) {
      if (is_changed && farm.step() == kChangedAt) {
        MoveShip(farm);
        const std::string data = farm.Save();
        SavedState saved;
        saved.step = kChangedAt;
        saved.data.assign(data.begin(), data.end());
        write("/ranch/saved_state", saved);
        write_state();
      }
      farm.Step(&hold);
      write_state();
    }
    return path;
  }

  static void MoveShip(aquafarm::Farm& farm) {
    const aquafarm::Cell before = farm.ships()[0].cell;
    for (std::int32_t i = 0; i < 36; ++i) {
      const aquafarm::Cell cell{i % 6, i / 6};
      if (cell == before) continue;
      try {
        return farm.PlaceShip(0, cell);
      } catch (const aquafarm::InputError&) {  // a rock
      }
    }
  }

  // A copy of the bag that repeats each state `times(state)` times.
  std::string Copy(const std::string& path, const std::function<int(const FarmState&)>& times,
                   const std::function<void(SavedState&)>& change = nullptr) {
    rosbag::Bag source(path, rosbag::bagmode::Read);
    rosbag::Bag copy(Path("copy.bag"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(source)) {
      const auto state = message.instantiate<FarmState>();
      if (const auto saved = message.instantiate<SavedState>(); saved && change) {
        change(*saved);
        copy.write(message.getTopic(), message.getTime(), *saved);
        continue;
      }
      const int count = state ? times(*state) : 1;
      for (int i = 0; i < count; ++i) {
        copy.write(message.getTopic(), message.getTime() + ros::Duration(0, 50 * i), message);
      }
    }
    return Path("copy.bag");
  }

  BagChoices Ask(const std::string& bag, const std::string& output = "") {
    BagPolicyOptions options;
    options.output = output;
    return AskAlong(bag, aquafarm::agents::FindPolicy("random"), options);
  }

  // Choices of RANDOM in each step; the last one if there are several.
  Actions ChoicesOf(const std::string& bag) {
    EXPECT_EQ("", Ask(bag, Path("asked.bag")).difference);
    rosbag::Bag asked(Path("asked.bag"), rosbag::bagmode::Read);
    Actions actions;
    for (const auto& message : rosbag::View(asked, rosbag::TopicQuery("/ranch/choice"))) {
      const auto choice = message.instantiate<PolicyChoice>();
      actions.resize(choice->step + 1);
      actions[choice->step] = choice->actions;
    }
    return actions;
  }

  std::string DifferenceOf(const std::string& bag) { return Ask(bag).difference; }

  const fs::path folder_;
};

// RANDOM returns another choice at each query, so its choices reveal the number of queries.
TEST_F(BagPolicy, AStateThatComesAgainIsAskedOnce) {
  const std::string bag = MakeBag(false);
  const Actions once = ChoicesOf(bag);
  ASSERT_EQ(60U, once.size());
  EXPECT_EQ(once, ChoicesOf(Copy(bag, [](const FarmState& state) {
              return state.step % 7 == 2 ? 3 : 1;  // like a ranch that pauses
            })));
}

TEST_F(BagPolicy, AStateThatWasChangedIsAskedWithTheMemoryOfBefore) {
  EXPECT_EQ(ChoicesOf(MakeBag(false)), ChoicesOf(MakeBag(true)));
}

// The weights do not matter: any recurrent network carries state.
TEST_F(BagPolicy, AMemoryIsCarriedFromTheEpisodesStartOn) {
  const std::string scenario_file = AQUAFARM_TEST_DATA "/tiny.yaml";
  const std::string train = "timeout -k 1 120 '" AQUAFARM_TRAIN "' '" + scenario_file +
                            "' --algorithm lstm_dqn --steps 400 --evaluate 0 --random 0 " +
                            "--run-dir '" + Path("lstm") + "' >'" + Path("log") + "' 2>&1";
  ASSERT_EQ(0, std::system(train.c_str())) << train;
  const auto saved = aquafarm::agents::FindPolicy(Path("lstm"));
  BagPolicyOptions options;
  options.output = Path("asked.bag");
  EXPECT_EQ("", AskAlong(MakeBag(false), saved, options).difference);

  const auto scenario =
      std::make_shared<const aquafarm::Scenario>(aquafarm::LoadScenario(scenario_file));
  aquafarm::FarmBatch farms(scenario, 1);
  farms.Reset(5, 0, {});
  aquafarm::agents::LocalEnvironment environment(scenario, {1, saved.observation_types, false, 1});
  const auto remembers = aquafarm::agents::MakePolicy(saved, environment.spec());
  const auto forgets = aquafarm::agents::MakePolicy(saved, environment.spec());
  remembers->Begin(5, 1);
  const auto hold = static_cast<std::uint8_t>(aquafarm::Action::kHold);
  std::vector<std::uint8_t> actions;
  std::uint64_t steps = 0;
  int differ = 0;
  rosbag::Bag asked(options.output, rosbag::bagmode::Read);
  for (const auto& message : rosbag::View(asked, rosbag::TopicQuery("/ranch/choice"))) {
    const auto choice = message.instantiate<PolicyChoice>();
    ASSERT_EQ(steps++, choice->step);
    remembers->Act(environment.Load(farms.Save()), actions);
    EXPECT_EQ(actions, choice->actions);
    EXPECT_EQ(remembers->values(), choice->values);
    forgets->Begin(5, 1);
    forgets->Act(environment.Load(farms.Save()), actions);
    differ += forgets->values() != choice->values ? 1 : 0;
    farms.Step(&hold, {});
  }
  EXPECT_EQ(60U, steps);
  EXPECT_EQ(59, differ);  // all but the first
}

TEST_F(BagPolicy, MissingStepsAreNamed) {
  const std::string bag = MakeBag(true);
  EXPECT_EQ("", DifferenceOf(bag));
  const auto without = [&](std::uint64_t first, std::uint64_t last) {
    return DifferenceOf(Copy(bag, [first, last](const FarmState& state) {
      return state.step >= first && state.step <= last ? 0 : 1;
    }));
  };
  EXPECT_EQ("episode 0 step 1: step 0 is missing", without(0, 0));
  EXPECT_EQ("episode 0 step 7: steps 5 to 6 are missing", without(5, 6));
  EXPECT_EQ("episode 0 step 3: steps 2 to 3 are missing", without(2, 3));  // before the change
  int seen = 0;
  EXPECT_EQ("episode 0 step 4: step 3 is missing",
            DifferenceOf(Copy(bag, [&seen](const FarmState& state) {
              return state.step == 3 && seen++ > 0 ? 0 : 1;  // after it
            })));
}

TEST_F(BagPolicy, ASavedStateMustBeOfItsStep) {
  const std::string bag = MakeBag(true);
  const auto always = [](const FarmState&) { return 1; };
  EXPECT_EQ("episode 0 step 2: steps are out of order",
            DifferenceOf(Copy(bag, always, [](SavedState& saved) { saved.step = 2; })));
  EXPECT_EQ("episode 0 step 3: saved_state.data: ",
            DifferenceOf(Copy(bag, always, [](SavedState& saved) {
              saved.data.resize(9);
            })).substr(0, 36));
  const auto late = [](const FarmState& state) { return state.step < 5 ? 0 : 1; };
  EXPECT_EQ("episode 0 step 5: saved_state.step: got 5, its data has 3",
            DifferenceOf(Copy(bag, late, [](SavedState& saved) { saved.step = 5; })));
}

TEST_F(BagPolicy, AFullDiskEndsInAStorageErrorAndLeavesNothing) {
  const std::string bag = MakeBag(false);
  const std::string output = Path("full.bag");
  Ask(bag, output);
  const auto size = static_cast<rlim_t>(fs::file_size(output));
  fs::remove(output);
  const auto ask_within = [&](rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit most;
    most.rlim_cur = most.rlim_max = bytes;
    setrlimit(RLIMIT_FSIZE, &most);
    try {
      Ask(bag, output);
    } catch (const aquafarm::agents::StorageError&) {
      _exit(fs::exists(output) || fs::exists(output + ".active") ? 1 : 0);
    }
    _exit(2);
  };
  for (const rlim_t limit : {rlim_t{100}, rlim_t{4200}, size / 2, size - 10}) {
    EXPECT_EXIT(ask_within(limit), testing::ExitedWithCode(0), "") << limit << " bytes of " << size;
  }
}

}  // namespace
}  // namespace aquafarm_agents
