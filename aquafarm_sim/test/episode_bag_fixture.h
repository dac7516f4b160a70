// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Creates and changes bags of kept episodes.

#include <aquafarm_msgs/EpisodeSummary.h>
#include <aquafarm_msgs/FarmSpec.h>
#include <aquafarm_msgs/FarmState.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/bags/bag_check.h"
#include "aquafarm_sim/bags/episode_recorder.h"
#include "farm_server_fixture.h"

namespace aquafarm_sim::test {

namespace fs = std::filesystem;
using aquafarm_msgs::EpisodeSummary;
using aquafarm_msgs::FarmSpec;
using aquafarm_msgs::FarmState;

// A scenario with a storm and a short step limit.
inline aquafarm::Scenario ShortScenario() {
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

  std::unique_ptr<EpisodeRecorder> Record(FarmServer& ranch, const std::string& keep,
                                          RecorderLimits limits = {}) {
    auto recorder =
        std::make_unique<EpisodeRecorder>(ranch.shared_scenario(), ParseKeep(keep), folder_,
                                          BagFormat{"/ranch/", "map", 10, 3}, limits);
    ranch.SetRecorder(recorder.get());
    return recorder;
  }

  // Takes random joint steps, the same in every call.
  static void Play(FarmServer& ranch, std::int32_t farms, int steps) {
    aquafarm::RandomStream rng({3, 0, aquafarm::RngStream::kExploration, 0});
    aquafarm_msgs::Step::Request request;
    for (int i = 0; i < steps; ++i) {
      request.actions.clear();
      for (std::int32_t k = 0; k < farms * ranch.agents(); ++k) {
        request.actions.push_back(static_cast<std::uint8_t>(rng.Below(aquafarm::kActionCount)));
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

  // Returns one bag of a complete episode of at most 40 steps.
  std::string OneBag() {
    const auto ranch = MakeRanch(ShortScenario());
    {
      const auto recorder = Record(*ranch, "all");
      Play(*ranch, 1, 41);
      ranch->SetRecorder(nullptr);
    }
    return Bags().front();
  }

  static void SendStorm(FarmServer& ranch) {
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

  // Returns one bag of a complete episode with a storm bulletin after 10 steps.
  std::string StormBag() {
    const auto ranch = MakeRanch(ShortScenario());
    {
      const auto recorder = Record(*ranch, "all");
      Play(*ranch, 1, 10);
      SendStorm(*ranch);
      SendStorm(*ranch);  // only the last bulletin of a step counts
      Play(*ranch, 1, 31);
      ranch->SetRecorder(nullptr);
    }
    return Bags().front();
  }

  // Copies a bag message by message. `change` may change a message; it returns false to drop it.
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

// Returns the error message that a bag is refused with.
inline std::string Refusal(const std::string& path, const std::string& ns = "") {
  try {
    CheckBag(path, ns);
  } catch (const aquafarm::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace aquafarm_sim::test
