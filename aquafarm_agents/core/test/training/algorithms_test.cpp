// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/algorithms.h"

#include "agents_fixture.h"
#include "aquafarm/agents/learning/random_policy.h"

namespace aquafarm::agents::test {
namespace {

TEST(Algorithms, AnUnknownNameIsAnsweredWithThoseThereAre) {
  EXPECT_EQ(MessageOf<InputError>([] { FindAlgorithm("dqm"); }),
            "algorithm: got 'dqm', expected one of: random, q_learning, sarsa, dqn, "
            "lstm_dqn, independent_dqn, independent_lstm_dqn, vdn, "
            "maddpg, ppo, planner, clairvoyant");
}

TEST(Algorithms, EachCanBeMadeAndSaysItsOptions) {
  for (const Algorithm& algorithm : Algorithms()) {
    if (algorithm.make == nullptr) continue;
    LocalEnvironment environment(TinyFarm(), {2, algorithm.encodings(""), false, 1});
    const auto learner = algorithm.make(environment.spec(), 1, "");
    EXPECT_EQ(learner->encodings(), algorithm.encodings("")) << algorithm.name;
    EXPECT_GT(algorithm.default_steps, 0U);
    // What it says of itself makes the same again.
    EXPECT_EQ(algorithm.make(environment.spec(), 1, learner->options())->options(),
              learner->options());
  }
}

TEST(Algorithms, ATableOfManyStatesIsTrainedForLonger) {
  EnvironmentSpec spec;
  const auto steps = [&spec](const char* name) {
    return DefaultSteps(FindAlgorithm(name), spec, "");
  };
  spec.state_count = 20'000;
  EXPECT_EQ(steps("q_learning"), 4'000'000U);
  spec.state_count = 17'920'000;
  EXPECT_EQ(steps("q_learning"), 144'000'000U);
  EXPECT_EQ(steps("sarsa"), 144'000'000U);
  EXPECT_EQ(steps("dqn"), 200'000U);
}

// Deep learners learn too rarely for a short test unless told otherwise.
std::string Lively(const Algorithm& algorithm) {
  const std::string name = algorithm.name;
  const std::string small = "hidden=8 batch=8 start=20 replay=300 priority=0.5";
  if (name.find("lstm_dqn") != std::string::npos) return small + " sequence=4 burn_in=2";
  if (name == "maddpg") return "hidden=8 batch=8 start=20 replay=300 recurrent=true";
  if (name == "ppo") return "hidden_size=8 rollout_size=90 batch_size=32";
  return name == "dqn" || name == "independent_dqn" || name == "vdn" ? small : "";
}

void ExpectContinues(const Algorithm& algorithm, const std::string& options) {
  LocalEnvironment environment(TinyFarm(), {3, algorithm.encodings(options), false, 1});
  const auto learner = algorithm.make(environment.spec(), 1, options);
  std::vector<std::uint8_t> actions;
  const Results* results = &environment.Reset(1);
  for (int i = 0; i < 100; ++i) {
    learner->Step(*results, 0.3, actions);
    results = &environment.Step(actions);
  }
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  // From what it says of itself: a resumed run may be given no more than that.
  const auto resumed = algorithm.make(environment.spec(), 1, learner->options());
  EXPECT_EQ(resumed->options(), learner->options()) << algorithm.name << ' ' << options;
  resumed->Load(checkpoint);
  std::vector<std::uint8_t> expected;
  for (int i = 0; i < 100; ++i) {
    learner->Step(*results, 0.6, expected);
    resumed->Step(*results, 0.6, actions);
    ASSERT_EQ(actions, expected) << algorithm.name << ' ' << options;
    results = &environment.Step(actions);
  }
  Checkpoint a;
  Checkpoint b;
  learner->Save(a);
  resumed->Save(b);
  EXPECT_EQ(a.sections, b.sections) << algorithm.name << ' ' << options;
}

TEST(Algorithms, EachContinuesBitForBit) {
  for (const Algorithm& algorithm : Algorithms()) {
    if (algorithm.make == nullptr) continue;
    ExpectContinues(algorithm, Lively(algorithm));
    if (!algorithm.learns) continue;
    const bool samples = std::string(algorithm.name) == "ppo";
    const std::string explored = samples ? "entropy:0.01" : "boltzmann:5";
    ExpectContinues(algorithm, Lively(algorithm) + " exploration=icm:1+" + explored);
  }
  // In the middle of a rollout and of a sequence.
  ExpectContinues(FindAlgorithm("ppo"),
                  "hidden_size=8 rollout_size=90 batch_size=32 recurrent=true sequence_length=7");
  for (const char* name : {"dqn", "lstm_dqn"}) {
    const Algorithm& algorithm = FindAlgorithm(name);
    ExpectContinues(algorithm, Lively(algorithm) + " average_rate=0.02 repetition_penalty=2");
  }
}

TEST(Algorithms, AutoChoosesByThoseWhoDecideAndSaysWhy) {
  const auto choose = [](Scenario scenario) {
    return ChooseAlgorithm(LocalEnvironment(Share(std::move(scenario)), {}).spec());
  };
  const Choice single = choose(aquafarm::test::TinyScenario());
  EXPECT_EQ(single.algorithm, "lstm_dqn");
  EXPECT_EQ(single.reason, "one rescue ship decides, so a single-agent learner");
  Scenario several = aquafarm::test::TinyScenario();
  several.ships.count = 2;
  EXPECT_EQ(choose(several).algorithm, "independent_dqn");
  EXPECT_EQ(choose(several).reason,
            "2 rescue ships decide, each for its own reward, so independent learners");
  several.rewards.sharing = RewardSharing::kTeam;
  EXPECT_EQ(choose(several).algorithm, "vdn");
  EXPECT_EQ(choose(several).reason,
            "2 rescue ships decide for a shared reward, so a multi-agent learner");
}

TEST(RandomPolicy, TakesEveryActionAlikeAndReproduces) {
  RandomPolicy policy(1);
  std::array<int, kActionCount> counts{};
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> first;
  policy.Begin(3, 10);
  policy.Act({}, first);
  for (int i = 0; i < 1000; ++i) {
    policy.Act({}, actions);
    for (const std::uint8_t action : actions) ++counts[action];
  }
  for (const int count : counts) EXPECT_NEAR(count, 1000, 130);
  policy.Begin(3, 10);
  policy.Act({}, actions);
  EXPECT_EQ(actions, first);
}

}  // namespace
}  // namespace aquafarm::agents::test
