// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/register_learner.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "agents_fixture.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/algorithms.h"
#include "chain.h"

namespace aquafarm::agents::test {
namespace {

using Rule = TabularLearner<SarsaRule>;

Algorithm Named(const char* name) {
  return {name,
          "a learner of another package",
          true,
          1000,
          [](const std::string&) -> std::uint8_t { return kIndexBit; },
          [](const EnvironmentSpec& spec, std::uint64_t seed, const std::string& options)
              -> std::unique_ptr<Learner> { return std::make_unique<Rule>(spec, seed, options); },
          MakeTabularPolicy};
}

TEST(RegisterLearner, ARegisteredLearnerFollowsThoseOfThisPackage) {
  ASSERT_TRUE(RegisterLearner(Named("elsewhere")));
  EXPECT_STREQ(Algorithms().front().name, "random");
  EXPECT_GT(&FindAlgorithm("elsewhere"), &FindAlgorithm("fetch_by_value"));
  LocalEnvironment environment(TinyFarm(), {2, kIndexBit, false, 1});
  const auto learner = FindAlgorithm("elsewhere").make(environment.spec(), 1, "gamma=0.5");
  EXPECT_NE(learner->options().find("gamma=0.5"), std::string::npos);
}

TEST(RegisterLearner, ALibraryThatCannotBeUsedIsNamed) {
  const std::string missing = MessageOf<InputError>([] { LoadLearners("/none/libmine.so"); });
  EXPECT_EQ(missing.find("AQUAFARM_LEARNERS: /none/libmine.so: cannot be loaded ("), 0U) << missing;
  EXPECT_NE(missing.find("expected a shared library that registers a learner"), std::string::npos);
  EXPECT_EQ(MessageOf<InputError>([] { LoadLearners("libm.so.6"); }),
            "AQUAFARM_LEARNERS: libm.so.6: registers no learner, expected a call of "
            "RegisterLearner while it loads");
}

TEST(RegisterLearner, ALearnerBuiltWithAnotherVersionIsRefused) {
  const auto load_old = [] {
    RegisterLearner(Named("old"), "0.0.1");
    std::cerr << MessageOf<InputError>([] { LoadLearners(""); }) << std::endl;
    std::_Exit(0);
  };
  // In a process of its own, because a registration cannot be undone.
  EXPECT_EXIT(load_old(), testing::ExitedWithCode(0),
              std::string("learner old: built with aquafarm 0.0.1, expected ") + kVersion +
                  ": compile it again");
}

std::vector<Algorithm> ExpectedSarsas(const std::string& libraries) {
  std::vector<Algorithm> found;
  for (const Algorithm& one : LoadLearners(libraries)) {
    if (std::string_view(one.name) == "expected_sarsa") found.push_back(one);
  }
  return found;
}

TEST(RegisterLearner, ALibraryThatIsListedTwiceAddsOneLearner) {
  const std::string library = AQUAFARM_EXPECTED_SARSA;
  const std::string same = std::filesystem::path(library).parent_path() / "." /
                           std::filesystem::path(library).filename();
  EXPECT_EQ(ExpectedSarsas(library + ":" + library + ":" + same).size(), 1U);
}

TEST(RegisterLearner, LibrariesAreLoadedAgainAfterAnError) {
  const std::string library = AQUAFARM_EXPECTED_SARSA;
  EXPECT_THROW(LoadLearners(library + ":/none/libmine.so"), InputError);
  EXPECT_EQ(ExpectedSarsas(library).size(), 1U);
}

std::unique_ptr<Learner> MakeExpectedSarsa(const Chain& chain, const std::string& options) {
  return ExpectedSarsas(AQUAFARM_EXPECTED_SARSA).at(0).make(chain.spec, 1, options);
}

// The value of the action that leads to a state whose best action has the value 4, the others 0.
float ValueBefore(const std::string& mask_illegal, ActionMask legal) {
  Chain chain;
  const auto learner =
      MakeExpectedSarsa(chain, "learning_rate=0.5 gamma=0.9 exploration=epsilon_greedy:0.5 " +
                                   ("mask_illegal=" + mask_illegal));
  const std::vector<float>& values = dynamic_cast<const TableLearner&>(*learner).table().values;
  chain.results.legal = {1U};
  const std::size_t best = kActionCount + chain.Notify(*learner, 1, 0.0F);
  chain.Notify(*learner, 2, 8.0F, EndReason::kAllRetrieved);
  EXPECT_FLOAT_EQ(values.at(best), 4.0F);  // 0 + 0.5 (8 − 0)
  chain.results.is_first = {1};
  const std::size_t action = chain.Notify(*learner, 0, 0.0F);
  chain.results.legal = {legal};
  chain.Notify(*learner, 1, 2.0F);
  return values.at(action);
}

TEST(ExpectedSarsa, AveragesOverTheAllowedActions) {
  EXPECT_FLOAT_EQ(ValueBefore("true", 0b01), 2.8F);    // 0.5 (2 + 0.9 · 4)
  EXPECT_FLOAT_EQ(ValueBefore("true", 0b11), 2.35F);   // 0.5 (2 + 0.9 (0.5 · 4 + 0.5 · 4 / 2))
  EXPECT_FLOAT_EQ(ValueBefore("true", 0b10), 1.0F);    // 0.5 (2 + 0.9 · 0)
  EXPECT_FLOAT_EQ(ValueBefore("false", 0b10), 1.99F);  // 0.5 (2 + 0.9 (0.5 · 4 + 0.5 · 4 / 10))
}

TEST(ExpectedSarsa, RefusesAnExplorationThatItsEquationLacks) {
  const auto refusal_of = [](const std::string& exploration) {
    return MessageOf<InputError>([&] { MakeExpectedSarsa(Chain(), "exploration=" + exploration); });
  };
  const std::string expected = "', expected epsilon_greedy with learner expected_sarsa";
  EXPECT_EQ(refusal_of("boltzmann:5"), "exploration: got 'boltzmann:5" + expected);
  EXPECT_EQ(refusal_of("icm:0.5+epsilon_greedy:0.1"),
            "exploration: got 'icm:0.5+epsilon_greedy:0.1" + expected);
  EXPECT_EQ(refusal_of("epsilon_greedy:0.1"), "");
}

}  // namespace
}  // namespace aquafarm::agents::test
