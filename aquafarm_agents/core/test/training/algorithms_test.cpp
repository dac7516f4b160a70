// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/algorithms.h"

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/learning/random_policy.h"
#include "aquafarm/agents/training/saved_policy.h"

namespace aquafarm::agents::test {
namespace {

TEST(Algorithms, AnUnknownNameIsAnsweredWithThoseThereAre) {
  EXPECT_EQ(MessageOf<InputError>([] { FindAlgorithm("dqm"); }),
            "algorithm: got 'dqm' (did you mean 'dqn'?), expected one of: random, q_learning, "
            "sarsa, dqn, "
            "lstm_dqn, independent_dqn, independent_lstm_dqn, vdn, "
            "maddpg, ppo, mappo, planner, clairvoyant, do_nothing, fetch_by_value");
}

TEST(Algorithms, EachCanBeMadeAndSaysItsOptions) {
  for (const Algorithm& algorithm : Algorithms()) {
    if (algorithm.make == nullptr) continue;
    LocalEnvironment environment(TinyFarm(), {2, algorithm.observation_types(""), false, 1});
    const auto learner = algorithm.make(environment.spec(), 1, "");
    EXPECT_EQ(learner->observation_types(), algorithm.observation_types("")) << algorithm.name;
    EXPECT_GT(algorithm.default_steps, 0U);
    // The resolved options create the same learner.
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

TEST(Algorithms, ALargeTableIsAnnouncedWithItsSize) {
  EnvironmentSpec spec;
  spec.agents = 1;
  spec.state_count = 17'920'000;
  EXPECT_EQ(LargeTableNote(FindAlgorithm("q_learning"), spec, ""),
            "algorithm q_learning: the table of 17920000 states needs 716 MB of memory, and each "
            "checkpoint as much on disk; algorithm:=auto chooses a network, which needs a few MB");
  EXPECT_EQ(LargeTableNote(FindAlgorithm("dqn"), spec, ""), "");
  spec.state_count = 20'000;
  EXPECT_EQ(LargeTableNote(FindAlgorithm("q_learning"), spec, ""), "");
}

// With the default options, deep learners update too rarely for a short test.
std::string Lively(const Algorithm& algorithm) {
  const std::string name = algorithm.name;
  const std::string small =
      "hidden_size=8 batch_size=8 learning_starts=20 buffer_size=300 priority_exponent=0.5";
  if (name.find("lstm_dqn") != std::string::npos) return small + " sequence_length=4 burn_in=2";
  if (name == "maddpg")
    return "hidden_size=8 batch_size=8 learning_starts=20 buffer_size=300 recurrent=true";
  if (name == "ppo" || name == "mappo") return "hidden_size=8 rollout_size=90 batch_size=32";
  return name == "dqn" || name == "independent_dqn" || name == "vdn" ? small : "";
}

void ExpectContinues(const Algorithm& algorithm, const std::string& options,
                     const std::shared_ptr<const Scenario>& scenario = TinyFarm(),
                     std::int32_t farms = 3) {
  LocalEnvironment environment(scenario, {farms, algorithm.observation_types(options), false, 1});
  const auto learner = algorithm.make(environment.spec(), 1, options);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  for (int i = 0; i < 100; ++i) {
    learner->Step(*results, 0.3, actions);
    results = &environment.Step(actions);
  }
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  // Created from the resolved options, because a resumed run may have nothing else.
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
    const std::string name = algorithm.name;
    const bool samples = name == "ppo" || name == "mappo";
    const std::string explored = samples ? "entropy:0.01" : "boltzmann:5";
    ExpectContinues(algorithm, Lively(algorithm) + " exploration=icm:1+" + explored);
  }
  // In the middle of a rollout and of a sequence.
  for (const char* name : {"ppo", "mappo"}) {
    ExpectContinues(FindAlgorithm(name),
                    "hidden_size=8 rollout_size=90 batch_size=32 recurrent=true sequence_length=7");
    ExpectContinues(FindAlgorithm(name),
                    "hidden_size=8 rollout_size=90 batch_size=32 teacher=1 teacher_policy=planner "
                    "teacher_interval=2");
  }
  for (const char* name : {"dqn", "lstm_dqn"}) {
    const Algorithm& algorithm = FindAlgorithm(name);
    ExpectContinues(algorithm, Lively(algorithm) + " ema_rate=0.02 repetition_penalty=2");
  }
}

TEST(Algorithms, PpoWithAPlannerAsTeacherContinuesBitForBit) {
  const std::string options =
      "hidden_size=8 rollout_size=90 batch_size=32 teacher=1 teacher_policy=planner";
  const Algorithm& ppo = FindAlgorithm("ppo");
  ExpectContinues(ppo, options + " shards=2", TinyFarm(), 4);
  Scenario turned = aquafarm::test::TinyScenario();
  turned.view.tokens = true;
  ExpectContinues(ppo, options + " augment=true", Share(turned));
  Scenario squads = aquafarm::test::TinyScenario();
  squads.ships.count = 2;
  squads.ports.cells = {{2, 0}, {2, 1}};
  ExpectContinues(ppo, options, Share(squads));
  ExpectContinues(FindAlgorithm("mappo"), options, Share(squads));
}

class SavedPolicies : public FolderTest {};

TEST_F(SavedPolicies, OfPpoReadNoStatesAlsoIfAPlannerWasTheTeacher) {
  const std::string options = "hidden_size=8 teacher=1 teacher_policy=planner";
  const Algorithm& ppo = FindAlgorithm("ppo");
  LocalEnvironment environment(TinyFarm(), {1, ppo.observation_types(options), false, 1});
  const auto learner = ppo.make(environment.spec(), 1, options);
  EXPECT_EQ(learner->observation_types(), kFeaturesBit | kStatesBit);
  Checkpoint checkpoint;
  checkpoint.kind = Checkpoint::kPolicy;
  checkpoint.algorithm = "ppo";
  checkpoint.options = learner->options();
  checkpoint.spec = environment.spec();
  learner->SavePolicy(checkpoint);
  WriteCheckpoint(folder_ + "/policy.ckpt", checkpoint);
  const SavedPolicy saved = FindPolicy(folder_);
  EXPECT_EQ(saved.observation_types, kFeaturesBit);
  EXPECT_EQ(MakePolicy(saved, environment.spec())->observation_types(), kFeaturesBit);
}

// Checks each sentence of the caption of Fig. 6, with each kind of reward sharing.
TEST(Algorithms, AutoChoosesAsFig6Does) {
  const auto choose = [](Scenario scenario) {
    return ChooseAlgorithm(LocalEnvironment(Share(std::move(scenario)), {}).spec());
  };
  const Choice single = choose(aquafarm::test::TinyScenario());
  EXPECT_EQ(single.algorithm, "lstm_dqn");
  EXPECT_EQ(single.reason, "one rescue squad decides, so a single-agent learner");
  for (const RewardSharing sharing : {RewardSharing::kIndividual, RewardSharing::kTeam}) {
    Scenario squads = aquafarm::test::TinyScenario();
    squads.rewards.sharing = sharing;
    squads.ships.count = 2;
    EXPECT_EQ(choose(squads).algorithm, "vdn");
    EXPECT_EQ(choose(squads).reason,
              "2 rescue squads decide and need coordination, so a multi-agent learner");

    Scenario devices = aquafarm::test::TinyScenario();
    devices.rewards.sharing = sharing;
    devices.ships.count = 0;
    devices.devices.sites = {{{2, 2}, DeviceKind::kMonitoring, 80.0F, true},
                             {{4, 2}, DeviceKind::kMonitoring, 80.0F, true}};
    EXPECT_EQ(choose(devices).algorithm, "independent_dqn");
    EXPECT_EQ(choose(devices).reason,
              "2 self-propelled devices decide, so a single-agent learner for each");
    devices.view.mode = ViewMode::kPartial;
    devices.view.shared_sight = true;
    EXPECT_EQ(choose(devices).algorithm, "vdn");
    EXPECT_EQ(choose(devices).reason,
              "2 networked self-propelled devices decide and need coordination, so a multi-agent "
              "learner");
    devices.devices.sites.pop_back();
    EXPECT_EQ(choose(devices).algorithm, "lstm_dqn") << "a network of one needs no coordination";
  }
}

TEST(Algorithms, AutoChoosesForTheShippedScenarios) {
  for (const auto& [name, algorithm] :
       {std::pair{"paper", "lstm_dqn"}, std::pair{"two_squads", "vdn"},
        std::pair{"four_squads", "vdn"}, std::pair{"smart_devices", "independent_dqn"},
        std::pair{"networked_devices", "vdn"}}) {
    const Scenario scenario =
        LoadScenario(std::string(AQUAFARM_SCENARIO_DIR) + "/" + name + ".yaml");
    EXPECT_EQ(ChooseAlgorithm(LocalEnvironment(Share(scenario), {}).spec()).algorithm, algorithm)
        << name;
  }
}

TEST(RandomPolicy, TakesEveryActionAlikeAndReproduces) {
  LocalEnvironment environment(TinyFarm(), {10, 0, false, 1});
  RandomPolicy policy(environment.spec());
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

// "Each action within the choice reachable (for example, except reefs, islands, etc.)", §4.2.
TEST(RandomPolicy, DrawsEachReachableActionAlike) {
  const std::string options = "actions=reachable";
  const Algorithm& random = FindAlgorithm("random");
  EXPECT_EQ(random.observation_types(options), kFeaturesBit);
  LocalEnvironment environment(TinyFarm(), {1, random.observation_types(options), false, 1});
  const auto learner = random.make(environment.spec(), 1, options);
  EXPECT_EQ(learner->options(), options);
  Checkpoint checkpoint;
  checkpoint.options = learner->options();
  const auto policy = random.make_policy(checkpoint, environment.spec());
  policy->Begin(3, 1);
  // At the port (2, 0): the map ends in the south; islands are in the west and north-west.
  const StepResults& results = environment.Reset(1);
  std::array<int, kActionCount> counts{};
  std::vector<std::uint8_t> actions;
  for (int i = 0; i < 3000; ++i) {
    policy->Act(results, actions);
    ++counts[actions[0]];
  }
  for (std::size_t a = 0; a < kActionCount; ++a) {
    const auto action = static_cast<Action>(a);
    const bool reachable =
        action == Action::kNorth || action == Action::kEast || action == Action::kNorthEast;
    EXPECT_NEAR(counts[a], reachable ? 1000 : 0, reachable ? 130 : 0) << a;
  }
}

TEST(RandomPolicy, NeverCrashesNorActsIllegallyAmongReachableActions) {
  for (const bool reachable : {false, true}) {
    Checkpoint checkpoint;
    checkpoint.options = reachable ? "actions=reachable" : "";
    LocalEnvironment environment(Paper(), {4, kFeaturesBit, false, 1});
    const auto policy = FindAlgorithm("random").make_policy(checkpoint, environment.spec());
    const Evaluation evaluation = Evaluate(environment, *policy, 1, 8);
    EXPECT_EQ(evaluation.mean_crashes == 0.0, reachable);
    EXPECT_GT(evaluation.return_per_step, reachable ? -2.5 : -5.0);
    EXPECT_LT(evaluation.return_per_step, reachable ? -1.0 : -2.5);
  }
}

TEST(RandomPolicy, RefusesAnotherSetOfActions) {
  EXPECT_EQ(MessageOf<InputError>([] { ParseRandomActions("actions=legal"); }),
            "actions: got 'legal', expected one of: all, reachable");
  LocalEnvironment environment(TinyFarm(), {1, 0, false, 1});
  EXPECT_EQ(FindAlgorithm("random").make(environment.spec(), 1, "actions=all")->options(), "")
      << "as in checkpoints from before the option existed";
}

}  // namespace
}  // namespace aquafarm::agents::test
