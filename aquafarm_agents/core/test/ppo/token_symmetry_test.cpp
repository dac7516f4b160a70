// SPDX-License-Identifier: BSD-3-Clause
// Turned tokens are those that the encoder writes for a turned ranch.
#include "ppo/token_symmetry.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "agents_fixture.h"
#include "aquafarm/agents/learning/exploration.h"
#include "aquafarm/agents/ppo/ppo.h"
#include "aquafarm/agents/training/algorithms.h"
#include "token_ranch.h"

namespace aquafarm::agents::test {
namespace {

using aquafarm::test::kTokenShip;
using aquafarm::test::kTokenSide;
using aquafarm::test::TokensOf;
using aquafarm::test::TurnedTokenScenario;

/// Applies a symmetry of TokenSymmetry to the map, around its middle.
Cell Place(Cell cell, std::size_t symmetry) {
  if ((symmetry & 4U) != 0) std::swap(cell.x, cell.y);
  if ((symmetry & 2U) != 0) cell.y = kTokenSide - 1 - cell.y;
  if ((symmetry & 1U) != 0) cell.x = kTokenSide - 1 - cell.x;
  return cell;
}

Scenario Turned(std::size_t symmetry) {
  return TurnedTokenScenario([symmetry](Cell cell) { return Place(cell, symmetry); });
}

TokenLayout PlainLayout() { return LayoutOfTokens(Encoder(Turned(0)).feature_names()); }

TEST(TokenSymmetry, TurnedTokensAreThoseOfTheTurnedRanch) {
  const TokenLayout layout = PlainLayout();
  const std::vector<float> plain = TokensOf(Turned(0), kTokenShip);
  for (std::size_t number = 0; number < kSymmetries; ++number) {
    const std::vector<float> expected = TokensOf(Turned(number), Place(kTokenShip, number));
    if (number > 0) {
      EXPECT_NE(plain, expected);
    }
    std::vector<float> turned(plain.size());
    TokenSymmetry(layout, number).Turn(plain.data(), turned.data());
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_NEAR(turned[i], expected[i], 1e-5F) << number << ' ' << layout.names[i];
    }
  }
}

TEST(TokenSymmetry, ActionsTurnAsTheMapDoes) {
  const TokenLayout layout = PlainLayout();
  for (std::size_t number = 0; number < kSymmetries; ++number) {
    const TokenSymmetry symmetry(layout, number);
    for (std::uint8_t action = 0; action < kActionCount; ++action) {
      const std::uint8_t turned = symmetry.Turn(action);
      EXPECT_EQ(symmetry.TurnBack(turned), action);
      EXPECT_EQ(symmetry.Turn(MaskOf(static_cast<Action>(action))),
                MaskOf(static_cast<Action>(turned)));
      if (action >= kMoveCount) {
        EXPECT_EQ(turned, action);
        continue;
      }
      const Cell from = Place({5, 5}, number);
      const Cell to = Place({5 + kMoves[action].x, 5 + kMoves[action].y}, number);
      EXPECT_EQ(kMoves[turned], (Cell{to.x - from.x, to.y - from.y})) << number;
    }
    EXPECT_EQ(symmetry.Turn(kAllActions), kAllActions);
  }
}

StepResults ResultsOf(const std::vector<float>& tokens) {
  StepResults results;
  results.features = tokens;
  results.legal = {kAllActions};
  results.active = {1};
  results.is_first = {1};
  results.end_reasons = {0};
  results.rewards = {0.0F};
  return results;
}

TEST(TokenSymmetry, ASymmetricPolicyPlaysATurnedRanchAsTheRanch) {
  const LocalEnvironment environment(std::make_shared<const Scenario>(Turned(0)),
                                     {1, kFeaturesBit, false, 1});
  const TokenLayout layout = PlainLayout();
  int differences = 0;  // of a policy without the option
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const bool is_symmetric : {false, true}) {
      const auto policy =
          MakePpo(environment.spec(), seed, is_symmetric ? "symmetric=true" : "")->GreedyPolicy();
      std::uint8_t plain = 0;
      float value = 0.0F;
      for (std::size_t number = 0; number < kSymmetries; ++number) {
        policy->Begin(1, 1);
        std::vector<std::uint8_t> actions;
        policy->Act(ResultsOf(TokensOf(Turned(number), Place(kTokenShip, number))), actions);
        const std::uint8_t action = TokenSymmetry(layout, number).TurnBack(actions[0]);
        if (number == 0) {
          plain = action;
          value = policy->values()[0];
        }
        if (!is_symmetric) {
          differences += action == plain ? 0 : 1;
          continue;
        }
        EXPECT_EQ(action, plain) << seed << ' ' << number;
        EXPECT_NEAR(policy->values()[0], value, 1e-4F * (1.0F + std::abs(value))) << number;
      }
    }
  }
  EXPECT_GT(differences, 10);
}

// A training that sees turned ranches still learns the plain one.
TEST(TokenSymmetry, AnAugmentedTrainingSolvesATinyFarm) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 60;
  scenario.view.tokens = true;
  LocalEnvironment environment(Share(scenario), {16, kFeaturesBit, false, 1});
  const auto learner = MakePpo(environment.spec(), 1,
                               "hidden_size=32 rollout_size=512 batch_size=128 epochs=4 "
                               "learning_rate=linear:0.003:0:1 gamma=0.97 augment=true");
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  for (int step = 0; step < 1500; ++step) {
    learner->Step(*results, step / 1500.0, actions);
    results = &environment.Step(actions);
  }
  const auto policy = learner->GreedyPolicy();
  policy->Begin(1, 16);
  results = &environment.Reset(1);
  int solved = 0;
  for (int step = 0; step < 20; ++step) {
    policy->Act(*results, actions);
    results = &environment.Step(actions);
    for (const auto& episode : results->finished) solved += episode.Success() ? 1 : 0;
  }
  EXPECT_GE(solved, 16);
}

TEST(TokenSymmetry, AnAugmentedTrainingContinuesBitForBit) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.view.tokens = true;
  scenario.step_limit = 20;
  LocalEnvironment environment(Share(scenario), {3, kFeaturesBit, false, 1});
  const std::string options = "hidden_size=8 rollout_size=90 batch_size=32 augment=true";
  const auto learner = MakePpo(environment.spec(), 1, options);
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> expected;
  const StepResults* results = &environment.Reset(1);
  for (int i = 0; i < 100; ++i) {
    learner->Step(*results, 0.3, actions);
    results = &environment.Step(actions);
  }
  Checkpoint saved;
  learner->Save(saved);
  const auto resumed = MakePpo(environment.spec(), 1, options);
  resumed->Load(saved);
  for (int i = 0; i < 100; ++i) {
    learner->Step(*results, 0.6, expected);
    resumed->Step(*results, 0.6, actions);
    ASSERT_EQ(actions, expected) << i;
    results = &environment.Step(actions);
  }
}

TEST(TokenSymmetry, OptionsThatTurnTokensNeedThem) {
  LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  for (const std::string option : {"augment", "symmetric"}) {
    EXPECT_CONTAINS(
        MessageOf<InputError>([&] { MakePpo(environment.spec(), 1, option + "=true"); }),
        option + ": got true, expected false in a scenario without view.tokens");
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
