// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Tests that every implementation of the Environment interface must pass.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "aquafarm/agents/environment/environment.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents::test {

/// Random actions of the learners' action space; equal seeds give equal actions.
class RandomActions {
 public:
  explicit RandomActions(std::uint64_t seed)
      : stream_(StreamKey{seed, 0, RngStream::kExploration, 0}) {}
  std::vector<std::uint8_t> Next(std::size_t slots) {
    std::vector<std::uint8_t> actions(slots);
    for (auto& action : actions) action = static_cast<std::uint8_t>(stream_.Below(kActionCount));
    return actions;
  }

 private:
  RandomStream stream_;
};

/// Compares most fields. The excluded fields are `finished`, `terms`, `energy`, `distance` and
/// `states`.
inline void ExpectSame(const StepResults& a, const StepResults& b) {
  EXPECT_EQ(a.rewards, b.rewards);
  EXPECT_EQ(a.outcomes, b.outcomes);
  EXPECT_EQ(a.legal, b.legal);
  EXPECT_EQ(a.end_reasons, b.end_reasons);
  EXPECT_EQ(a.is_first, b.is_first);
  EXPECT_EQ(a.active, b.active);
  EXPECT_EQ(a.hashes, b.hashes);
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.planes, b.planes);
}

inline void ExpectFirstObservations(const EnvironmentSpec& spec, const StepResults& results) {
  const auto farms = static_cast<std::size_t>(spec.farms);
  EXPECT_EQ(results.is_first, std::vector<std::uint8_t>(farms, 1));
  EXPECT_EQ(results.end_reasons, std::vector<std::uint8_t>(farms, 0));
  EXPECT_EQ(results.rewards, std::vector<float>(SlotCount(spec), 0.0F));
  EXPECT_EQ(results.legal.size(), SlotCount(spec));
  EXPECT_EQ(results.active, std::vector<std::uint8_t>(SlotCount(spec), 1));
  EXPECT_EQ(results.outcomes.size(), SlotCount(spec));
  EXPECT_EQ(results.hashes.size(), farms);
  EXPECT_TRUE(results.finished.empty());
}

/// Checks that a pickup or drop-off was illegal if and only if the mask before the step excluded
/// it.
/// @param before mask of legal actions before the step
/// @param outcome Outcome of the action
inline void ExpectMaskHeld(std::uint8_t action, ActionMask before, std::uint8_t outcome) {
  if (action < kMoveCount || outcome == static_cast<std::uint8_t>(Outcome::kOutOfPlay)) return;
  const bool illegal = outcome == static_cast<std::uint8_t>(Outcome::kIllegalPickup) ||
                       outcome == static_cast<std::uint8_t>(Outcome::kIllegalDropOff);
  EXPECT_EQ(illegal, ((before >> action) & 1U) == 0) << "action " << +action;
}

/// Plays random actions and checks the results of each step, partly against the previous step.
inline void ExpectStepsKeepTheRules(Environment& environment, std::uint64_t seed, int steps,
                                    bool one_ship_masks) {
  const EnvironmentSpec& spec = environment.spec();
  const auto farms = static_cast<std::uint64_t>(spec.farms);
  RandomActions random(seed);
  StepResults last = environment.Reset(seed);
  ExpectFirstObservations(spec, last);
  std::map<std::int32_t, std::uint64_t> next_episode;
  std::vector<double> returns(farms, 0.0);
  std::vector<std::int32_t> length(farms, 0);
  for (int step = 0; step < steps; ++step) {
    const auto actions = random.Next(SlotCount(spec));
    const StepResults& now = environment.Step(actions);
    std::size_t ended = 0;
    for (std::size_t farm = 0; farm < farms; ++farm) {
      EXPECT_EQ(now.is_first[farm] != 0, last.end_reasons[farm] != 0) << "next-step reset";
      for (std::size_t agent = 0; agent < static_cast<std::size_t>(spec.agents); ++agent) {
        const std::size_t k = farm * static_cast<std::size_t>(spec.agents) + agent;
        if (!now.index.empty()) {
          EXPECT_LT(now.index[k], spec.state_count);
        }
        if (now.is_first[farm] != 0) {
          EXPECT_EQ(now.active[k], 1) << "every agent begins";
        } else {
          EXPECT_LE(now.active[k], last.active[k]) << "none comes back";
          EXPECT_EQ(now.outcomes[k] == static_cast<std::uint8_t>(Outcome::kOutOfPlay),
                    last.active[k] == 0);
        }
        if (now.is_first[farm] != 0) {
          EXPECT_EQ(now.rewards[k], 0.0F);
        } else if (one_ship_masks) {
          ExpectMaskHeld(actions[k], last.legal[k], now.outcomes[k]);
        }
        returns[farm] += static_cast<double>(now.rewards[k]);
      }
      if (now.is_first[farm] != 0) {
        returns[farm] = 0.0;
        length[farm] = 0;
      } else {
        ++length[farm];
      }
      if (now.end_reasons[farm] == 0) continue;
      ASSERT_LT(ended, now.finished.size());
      const EpisodeSummary& result = now.finished[ended++];
      EXPECT_EQ(result.farm, static_cast<std::int32_t>(farm)) << "finished in farm order";
      EXPECT_EQ(static_cast<std::uint8_t>(result.reason), now.end_reasons[farm]);
      EXPECT_EQ(result.seed, seed);
      const auto expected = next_episode.emplace(result.farm, farm).first;
      EXPECT_EQ(result.episode, expected->second) << "farm i plays i, i + N, i + 2N";
      expected->second += farms;
      EXPECT_EQ(result.steps, length[farm]);
      EXPECT_LE(result.steps, spec.step_limit);
      EXPECT_NEAR(static_cast<double>(result.episode_return), returns[farm],
                  1e-3 * (1.0 + std::abs(returns[farm])));
    }
    EXPECT_EQ(ended, now.finished.size());
    last = now;
    if (::testing::Test::HasFailure()) return;
  }
}

inline void ExpectSeedsReproduce(Environment& environment, int steps) {
  std::vector<std::vector<std::uint64_t>> runs[2];
  for (auto& run : runs) {
    RandomActions random(7);
    run.push_back(environment.Reset(11, 3).hashes);
    for (int i = 0; i < steps; ++i) {
      run.push_back(environment.Step(random.Next(SlotCount(environment.spec()))).hashes);
    }
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_NE(environment.Reset(12, 3).hashes, runs[0][0]) << "another seed";
}

inline void ExpectSaveAndLoadContinue(Environment& environment, int steps) {
  RandomActions random(13);
  environment.Reset(5);
  const std::size_t slots = SlotCount(environment.spec());
  for (int i = 0; i < steps; ++i) environment.Step(random.Next(slots));
  const StepResults standing = environment.Step(random.Next(slots));
  const std::string saved = environment.Save();
  std::vector<std::vector<std::uint8_t>> actions;
  std::vector<StepResults> expected;
  for (int i = 0; i < steps; ++i) {
    actions.push_back(random.Next(slots));
    expected.push_back(environment.Step(actions.back()));
  }
  environment.Reset(99);
  ExpectSame(environment.Load(saved), standing);
  for (std::size_t i = 0; i < actions.size(); ++i) {
    ExpectSame(environment.Step(actions[i]), expected[i]);
    if (::testing::Test::HasFailure()) return;
  }
}

inline void ExpectBadBytesAreRefused(Environment& environment) {
  environment.Reset(5);
  const std::string saved = environment.Save();
  EXPECT_THROW(environment.Load("no farm at all"), InputError);
  EXPECT_THROW(environment.Load(saved.substr(0, saved.size() / 2)), InputError);
  const std::vector<std::uint8_t> actions(SlotCount(environment.spec()), 0);
  const StepResults after = environment.Step(actions);
  environment.Reset(5);
  ExpectSame(environment.Step(actions), after);
}

/// Runs all tests on an environment.
/// @param environment its results must contain hashes
/// @param steps number of random steps in the test of the rules
/// @param one_ship_masks whether to compare outcomes with masks. This requires that no other ship
///   acts between the computation of a mask and the action, for example that a farm has one agent
inline void RunEnvironmentContract(Environment& environment, int steps = 600,
                                   bool one_ship_masks = true) {
  const EnvironmentSpec& spec = environment.spec();
  EXPECT_FALSE(spec.scenario_name.empty());
  EXPECT_FALSE(spec.scenario_yaml.empty());
  EXPECT_FALSE(spec.version.empty());
  EXPECT_GE(spec.farms, 1);
  EXPECT_GE(spec.agents, 1);
  EXPECT_GT(spec.width * spec.height, 0);
  ExpectStepsKeepTheRules(environment, 21, steps, one_ship_masks);
  ExpectSeedsReproduce(environment, 50);
  ExpectSaveAndLoadContinue(environment, 60);
  ExpectBadBytesAreRefused(environment);
  const std::vector<std::uint8_t> too_few(SlotCount(spec) - 1, 0);
  EXPECT_THROW(environment.Step(too_few), LogicError);
  EXPECT_THROW(environment.Step(std::vector<std::uint8_t>(SlotCount(spec), kActionCount + 1)),
               LogicError);
  EXPECT_FALSE(environment.ConsumeRestart());
}

}  // namespace aquafarm::agents::test
