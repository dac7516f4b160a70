// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/environment/family_environment.h"

#include <gtest/gtest.h>

#include <set>

#include "agents_fixture.h"
#include "aquafarm/base/rng.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "environment_contract.h"

namespace aquafarm::agents::test {
namespace {

std::shared_ptr<const Scenario> Family() {
  Scenario family = LoadScenario(AQUAFARM_SCENARIO_DIR "/families/ranch_family.yaml");
  family.family->width = family.family->height = {8, 14};  // so that episodes are short
  family.family->devices = {1, 3};
  return std::make_shared<const Scenario>(std::move(family));
}

TEST(FamilyEnvironment, KeepsTheContract) {
  FamilyEnvironment environment(Family(), {3, kFeaturesBit, true, 1});
  RunEnvironmentContract(environment, 1500);
}

TEST(FamilyEnvironment, EachEpisodePlaysAnotherRanchOfTheSeed) {
  FamilyEnvironment environment(Family(), {2, kFeaturesBit, true, 1});
  environment.Reset(4, 10);
  const Farm ranch = MakeRanch(*Family(), 4, 11);
  EXPECT_EQ(environment.farm(1).StartHash(), ranch.StartHash());
  std::set<std::int32_t> widths;
  for (std::uint64_t episode = 0; episode < 30; ++episode) {
    widths.insert(MakeRanch(*Family(), 4, episode).scenario().width);
  }
  EXPECT_GE(widths.size(), 5U);
}

TEST(FamilyEnvironment, ResultsDoNotDependOnTheNumberOfThreads) {
  FamilyEnvironment one(Family(), {5, kFeaturesBit, true, 1});
  FamilyEnvironment three(Family(), {5, kFeaturesBit, true, 3});
  const StepResults* expected = &one.Reset(4, 10);
  const StepResults* results = &three.Reset(4, 10);
  std::size_t finished = 0;
  RandomStream rng({1, 0, RngStream::kExploration, 0});
  std::vector<std::uint8_t> actions(expected->rewards.size());
  for (int step = 0; step < 400; ++step) {
    ASSERT_EQ(results->hashes, expected->hashes) << "step " << step;
    ASSERT_EQ(results->features, expected->features) << "step " << step;
    for (std::uint8_t& action : actions) {
      action = static_cast<std::uint8_t>(rng.Below(kActionCount));
    }
    expected = &one.Step(actions);
    results = &three.Step(actions);
    finished += results->finished.size();
  }
  EXPECT_GT(finished, 0U) << "farms start later episodes";
  EXPECT_EQ(three.Save(), one.Save());
}

TEST(FamilyEnvironment, RefusesObservationsOfAFixedSize) {
  const auto refusal_of = [](std::uint8_t bit) {
    return MessageOf<InputError>([bit] { FamilyEnvironment(Family(), {2, bit, false, 1}); });
  };
  const std::string start =
      "scenario ranch_family: is a family of ranches of different sizes, expected ";
  const std::string of_learners = start + "a learner that reads features: use algorithm ppo";
  EXPECT_EQ(refusal_of(kIndexBit), of_learners);
  EXPECT_EQ(refusal_of(kPlanesBit), of_learners);
  EXPECT_EQ(refusal_of(kStatesBit),
            start +
                "one ranch, whose state this policy reads; evaluate the policy 'generalist' or "
                "another policy that reads features, or train without teacher_policy=planner");
}

TEST(FamilyEnvironment, ARanchThatCannotBeDrawnIsNamed) {
  Scenario family = *Family();
  family.family->width = family.family->height = {8, 8};
  family.family->ports = {100, 100};
  try {
    MakeRanch(family, 1, 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no ranch with a valid layout"), std::string::npos);
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
