// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/register_learner.h"

#include "agents_fixture.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/algorithms.h"

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

const bool kRegistered = RegisterLearner(Named("elsewhere"));

TEST(RegisterLearner, ARegisteredLearnerFollowsThoseOfThisPackage) {
  ASSERT_TRUE(kRegistered);
  EXPECT_STREQ(Algorithms().front().name, "random");
  EXPECT_STREQ(Algorithms().back().name, "elsewhere");
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
  RegisterLearner(Named("old"), "0.0.1");
  EXPECT_EQ(MessageOf<InputError>([] { LoadLearners(""); }),
            std::string("learner old: built with aquafarm 0.0.1, expected ") + kVersion +
                ": compile it again");
}

}  // namespace
}  // namespace aquafarm::agents::test
