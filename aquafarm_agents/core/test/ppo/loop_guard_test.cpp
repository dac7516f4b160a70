// SPDX-License-Identifier: BSD-3-Clause
#include "ppo/loop_guard.h"

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/ppo/ppo.h"

namespace aquafarm::agents::test {
namespace {

Scenario WithTokens() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 100;
  scenario.view.tokens = true;
  return scenario;
}

TEST(LoopGuard, ActsWhenASituationOccursForTheGivenTime) {
  LocalEnvironment environment(Share(WithTokens()), {1, kFeaturesBit, false, 1});
  const RouteRule rule(LayoutOfTokens(environment.spec().feature_names));
  LoopGuard guard(environment.spec(), 1, 3);
  const StepResults* results = &environment.Reset(1);
  const auto ask = [&] {
    return guard.ActionOf(0, results->features.data(), results->is_first[0] != 0, kAllActions);
  };
  std::vector<std::uint8_t> actions{static_cast<std::uint8_t>(Action::kEast)};
  for (int visit = 1; visit < 6; ++visit) {  // to and fro
    const auto action = ask();
    EXPECT_EQ(action.has_value(), visit == 5) << visit;  // for the third time where it began
    if (action) {
      EXPECT_EQ(*action, rule.ActionOf(results->features.data(), kAllActions));
    }
    results = &environment.Step(actions);
    actions[0] = static_cast<std::uint8_t>(visit % 2 == 1 ? Action::kWest : Action::kEast);
  }
  EXPECT_TRUE(ask().has_value()) << "until it picks up or drops off a device";
  results = &environment.Reset(1);
  EXPECT_FALSE(ask().has_value()) << "until the episode ends";
}

TEST(LoopGuard, LeavesTheChoiceToThePolicyIfTheRouteHasRisk) {
  Scenario risky = WithTokens();
  risky.disasters = {aquafarm::test::StillDisaster(2.0F, 1.0F, {0.5F}, {-10.0F})};
  for (const bool is_risky : {false, true}) {
    LocalEnvironment environment(Share(is_risky ? risky : WithTokens()),
                                 {1, kFeaturesBit, false, 1});
    LoopGuard guard(environment.spec(), 1, 1);
    const StepResults& results = environment.Reset(1);
    const auto action = guard.ActionOf(0, results.features.data(), true, kAllActions);
    EXPECT_EQ(action.has_value(), !is_risky);
  }
}

TEST(LoopGuard, LeadsTheWayIfTheRingCoversTheWholeRanch) {
  Scenario covered = WithTokens();
  covered.disasters = {aquafarm::test::StillDisaster(2.0F, 1.0F, {50.0F}, {-10.0F})};
  LocalEnvironment environment(Share(covered), {1, kFeaturesBit, false, 1});
  LoopGuard guard(environment.spec(), 1, 1);
  const StepResults& results = environment.Reset(1);
  EXPECT_TRUE(guard.ActionOf(0, results.features.data(), true, kAllActions).has_value());
}

// Policies that have learned nothing move in circles.
TEST(LoopGuard, PoliciesOfPpoLeaveTheirLoops) {
  LocalEnvironment environment(Share(WithTokens()), {1, kFeaturesBit, false, 1});
  int solved[2] = {};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const bool is_guarded : {false, true}) {
      const auto policy =
          MakePpo(environment.spec(), seed, is_guarded ? "max_visits=2" : "")->GreedyPolicy();
      const double success = Evaluate(environment, *policy, 1, 1).success_rate;
      solved[is_guarded ? 1 : 0] += success > 0.0 ? 1 : 0;
    }
  }
  EXPECT_LE(solved[0], 2);
  EXPECT_EQ(solved[1], 10);
}

TEST(LoopGuard, NeedsTokens) {
  LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MakePpo(environment.spec(), 1, "max_visits=3"); }),
                  "max_visits: got 3, expected 0 in a scenario without view.tokens");
}

}  // namespace
}  // namespace aquafarm::agents::test
