// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/exploration.h"

#include <cmath>

#include "agents_fixture.h"
#include "aquafarm/agents/learning/checkpoint.h"

namespace aquafarm::agents::test {
namespace {

constexpr float kValues[kActionCount] = {0, 1, 2, 3, 4, 5, 6, 9, 8, 7};

std::array<int, kActionCount> Counts(const std::string& options, ActionMask allowed, int draws) {
  Explorer explorer(ParseExploration(options), 1, 1);
  std::array<int, kActionCount> counts{};
  for (int i = 0; i < draws; ++i) {
    ++counts[explorer.Choose(kValues, allowed, BestOf(kValues, allowed), 0)];
  }
  return counts;
}

TEST(BestOf, IsTheLowestNumberAmongEquals) {
  const float equal[kActionCount] = {1, 3, 3, 0, 0, 0, 0, 0, 0, 3};
  EXPECT_EQ(BestOf(equal, kAllActions).action, 1);
  EXPECT_EQ(BestOf(equal, kAllActions & ~0b10U).action, 2);
  EXPECT_EQ(BestOf(kValues, 0b0100000101).action, 8);
}

TEST(EpsilonGreedy, ExploresInEveryActionAlike) {
  const auto counts = Counts("epsilon_greedy:0.5", kAllActions, 20000);
  EXPECT_NEAR(counts[7], 0.55 * 20000, 300);
  for (std::size_t a = 0; a < kActionCount; ++a) {
    if (a == 7) continue;
    EXPECT_NEAR(counts[a], 0.05 * 20000, 150) << a;
  }
}

TEST(EpsilonGreedy, ZeroIsGreedyAndOneIsRandom) {
  EXPECT_EQ(Counts("epsilon_greedy:0", kAllActions, 100)[7], 100);
  EXPECT_NEAR(Counts("epsilon_greedy:1", kAllActions, 10000)[7], 1000, 150);
}

TEST(EpsilonGreedy, KeepsToTheMask) {
  const auto counts = Counts("epsilon_greedy:1", 0b1000000101, 3000);
  EXPECT_EQ(counts[0] + counts[2] + counts[9], 3000);
  EXPECT_NEAR(counts[9], 1000, 120);
}

TEST(Boltzmann, FollowsEquation8) {
  const auto probabilities = BoltzmannProbabilities(kValues, kAllActions, 2.0);
  double sum = 0.0;
  for (const double p : probabilities) sum += p;
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(probabilities[7] / probabilities[8], std::exp(0.5), 1e-12);
  const auto counts = Counts("boltzmann:2", kAllActions, 20000);
  for (std::size_t a = 0; a < kActionCount; ++a) {
    EXPECT_NEAR(counts[a], 20000 * probabilities[a], 4 * std::sqrt(20000 * probabilities[a]) + 5);
  }
}

TEST(Boltzmann, SurvivesHugeValuesAndTinyTemperatures) {
  const float huge[kActionCount] = {3e38F, -3e38F, 0, 0, 0, 0, 0, 0, 0, 0};
  for (const double temperature : {1e-6, 1.0, 1e6}) {
    const auto probabilities = BoltzmannProbabilities(huge, kAllActions, temperature);
    EXPECT_NEAR(probabilities[0], 1.0, 1e-12);
    for (const double p : probabilities) EXPECT_TRUE(std::isfinite(p));
  }
}

TEST(Boltzmann, IsUniformWhenHotAndGreedyWhenCold) {
  EXPECT_NEAR(BoltzmannProbabilities(kValues, kAllActions, 1e6)[0], 0.1, 1e-4);
  EXPECT_NEAR(BoltzmannProbabilities(kValues, kAllActions, 1e-3)[7], 1.0, 1e-9);
}

TEST(Boltzmann, NeverTakesWhatIsNotAllowed) {
  const auto counts = Counts("boltzmann:100", 0b0000000011, 1000);
  EXPECT_EQ(counts[0] + counts[1], 1000);
}

TEST(Explorer, EachEntryHasAStreamOfItsOwnAndContinuesWhereItWas) {
  const auto options = ParseExploration("epsilon_greedy:1");
  Explorer one(options, 4, 2);
  Explorer other(options, 4, 2);
  const Best best = BestOf(kValues, kAllActions);
  std::vector<int> of_entry_1;
  for (int i = 0; i < 50; ++i) of_entry_1.push_back(one.Choose(kValues, kAllActions, best, 1));
  for (int i = 0; i < 17; ++i) {
    other.Choose(kValues, kAllActions, best, 0);  // draws of slot 0 do not affect slot 1
    EXPECT_EQ(other.Choose(kValues, kAllActions, best, 1), of_entry_1[static_cast<std::size_t>(i)]);
  }
  Checkpoint saved;
  other.Save(saved);
  Explorer resumed(options, 4, 2);
  resumed.Load(saved);
  for (std::size_t i = 17; i < 50; ++i) {
    EXPECT_EQ(resumed.Choose(kValues, kAllActions, best, 1), of_entry_1[i]);
  }
}

TEST(Exploration, TextReadsBackAndRefusalsSayWhatIsAllowed) {
  for (const std::string text : {"epsilon_greedy:linear:1:0.05:0.5", "boltzmann:1",
                                 "icm:2+epsilon_greedy:0.1", "icm:linear:1:0:0.5+boltzmann:3"}) {
    EXPECT_EQ(ToString(ParseExploration(text)), text);
  }
  const auto refuse = [](const std::string& text) {
    return MessageOf<InputError>([&] { ParseExploration(text); });
  };
  EXPECT_EQ(ToString(ParseExploration("icm")),
            "icm:linear:1:0:0.5+epsilon_greedy:linear:1:0.05:0.5");
  EXPECT_FALSE(ParseExploration("icm:0+boltzmann:1").is_curious());
  for (const char* text : {"curious", "icmp", "icm+icm", "icm+greedy", "icm+"}) {
    EXPECT_CONTAINS(refuse(text), "expected epsilon_greedy or boltzmann");
  }
  EXPECT_CONTAINS(refuse("icm:-1"), "exploration: icm: got -1, expected [0, 1e+06]");
  EXPECT_CONTAINS(refuse("epsilon_greedy:1.5"), "got 1.5, expected [0, 1]");
  EXPECT_CONTAINS(refuse("boltzmann:0"), "got 0, expected [1e-06, 1e+06]");
}

TEST(Exploration, LearnersOfPoliciesTakeEntropyAndOthersDoNot) {
  const auto parse = [](const std::string& text) {
    return ParseExploration(text, ExplorationOf::kPolicies);
  };
  for (const std::string text : {"entropy:0.01", "icm:2+entropy:linear:0.02:0:1"}) {
    EXPECT_EQ(ToString(parse(text)), text);
    EXPECT_EQ(ToString(ParseExploration(text, ExplorationOf::kAny)), text);
  }
  EXPECT_EQ(ToString(parse("icm")), "icm:linear:1:0:0.5+entropy:linear:0.02:0:1");
  for (const char* text : {"boltzmann", "epsilon_greedy:0.1", "icm+boltzmann:1", "entropic"}) {
    EXPECT_CONTAINS(MessageOf<InputError>([&] { parse(text); }),
                    "expected entropy for a learner that samples its own policy");
  }
  EXPECT_CONTAINS(MessageOf<InputError>([&] { parse("entropy:-1"); }),
                  "got -1, expected [0, 1000]");
  EXPECT_CONTAINS(MessageOf<InputError>([] { ParseExploration("entropy:0.01"); }),
                  "exploration: got 'entropy:0.01', expected epsilon_greedy or boltzmann");
}

TEST(Exploration, EachKindHasAName) {
  for (int i = 0; i < kExplorationKindCount; ++i) {
    EXPECT_NE(ToString(static_cast<ExplorationKind>(i)), "?");
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
