// SPDX-License-Identifier: BSD-3-Clause
// Multi-agent learners: each solves a tiny farm of two ships, agents that are done stop learning,
// and restored learners continue bit-identically.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/learning/replay.h"
#include "aquafarm/agents/learning/tabular.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/trainer.h"

namespace aquafarm::agents::test {
namespace {

constexpr const char* kSmall =
    "hidden_size=32 batch_size=32 learning_starts=500 buffer_size=5000 target_update_interval=50 "
    "train_interval=4 "
    "learning_rate=linear:0.002:0.0001:1";

constexpr const char* kSmallRecurrent =
    "hidden_size=24 batch_size=16 learning_starts=500 buffer_size=5000 target_update_interval=50 "
    "train_interval=8 sequence_length=4 "
    "burn_in=2 learning_rate=linear:0.003:0.0001:1";

/// Two ships at two ports, two devices, team reward.
Scenario TwoShips() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = 2;
  scenario.ports.cells = {{2, 0}, {2, 1}};
  scenario.devices.sites = {{{2, 3}, DeviceKind::kMonitoring, 60.0F, false},
                            {{4, 2}, DeviceKind::kMonitoring, 80.0F, false}};
  scenario.rewards.sharing = RewardSharing::kTeam;
  scenario.step_limit = 60;
  return scenario;
}

/// Two self-propelled devices, and a ship that picks up a third device.
Scenario SmartDevices() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.devices.sites.push_back({{4, 1}, DeviceKind::kMonitoring, 70.0F, true});
  scenario.devices.sites.push_back({{1, 3}, DeviceKind::kMonitoring, 60.0F, true});
  scenario.step_limit = 60;
  return scenario;
}

double SuccessAfter(const std::string& algorithm, const std::string& options, std::uint64_t steps,
                    const Scenario& scenario, std::uint8_t credit = kOwnRewardsBit) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(
      Share(scenario),
      {8, static_cast<std::uint8_t>(entry.observation_types(options) | credit), false, 1});
  const auto learner = entry.make(environment.spec(), 1, options);
  const double before = Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
  EXPECT_LT(before, 0.5) << algorithm;
  TrainerOptions trainer;
  trainer.algorithm = algorithm;
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  return Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
}

TEST(TwoShips, AreLedHomeByLearnersOfValues) {
  EXPECT_GE(SuccessAfter("q_learning", "", 200000, TwoShips()), 0.98);
  EXPECT_GE(SuccessAfter("dqn", kSmall, 24000, TwoShips()), 0.98);
  EXPECT_GE(SuccessAfter("independent_dqn", kSmall, 24000, TwoShips()), 0.98);
  EXPECT_GE(SuccessAfter("vdn", kSmall, 24000, TwoShips()), 0.98);
  EXPECT_GE(SuccessAfter("vdn", std::string(kSmall) + " action_gap=0.5", 40000, TwoShips()), 0.98);
}

TEST(TwoShips, AreLedHomeByLearnersOfValuesThatRemember) {
  for (const char* algorithm : {"lstm_dqn", "independent_lstm_dqn"}) {
    EXPECT_GE(SuccessAfter(algorithm, kSmallRecurrent, 24000, TwoShips()), 0.98) << algorithm;
  }
}

// The shipped settings except for the size and a longer exploration, because the runs are short.
const std::string kActors =
    "learning_starts=500 buffer_size=20000 exploration=epsilon_greedy:linear:1:0.05:0.5 "
    "hidden_size=";

TEST(TwoShips, AreLedHomeByActorsWithACriticThatSeesAll) {
  EXPECT_GE(SuccessAfter("maddpg", kActors + "64", 24000, TwoShips()), 0.98);
}

TEST(TwoShips, AreLedHomeByActorsThatReceiveOnlyTheTeamReward) {
  EXPECT_GE(SuccessAfter("maddpg", kActors + "64", 24000, TwoShips(), /*credit=*/0), 0.98);
}

TEST(TwoShips, AreLedHomeByActorsThatRemember) {
  EXPECT_GE(SuccessAfter("maddpg", kActors + "32 recurrent=true window=3 batch_size=32", 24000,
                         TwoShips()),
            0.98);
}

// MADDPG as printed by Lowe et al., except that all agents share one critic: targets by the own
// target actor, uniform replay, one network per actor.
TEST(TwoShips, AreLedHomeByActorsAsPrinted) {
  constexpr const char* kPrinted =
      "hidden_size=32 learning_starts=500 buffer_size=20000 actor_rate=0.001 logit_penalty=0.01 "
      "best_response=false "
      "priority_exponent=0 shared=false mask_blocked=false "
      "exploration=epsilon_greedy:linear:1:0.05:0.5";
  EXPECT_GE(SuccessAfter("maddpg", kPrinted, 24000, TwoShips()), 0.98);
}

const std::string kTogether =
    "hidden_size=32 rollout_size=512 batch_size=128 epochs=4 learning_rate=linear:0.003:0:1 "
    "gamma=0.97 ";

TEST(TwoShips, AreLedHomeByOnePolicyWithAValueThatSeesAll) {
  EXPECT_GE(SuccessAfter("mappo", kTogether, 40000, TwoShips()), 0.98);
  EXPECT_GE(SuccessAfter("mappo", kTogether + "team_share=linear:0:1:0.5", 40000, TwoShips()),
            0.98);
  EXPECT_GE(SuccessAfter("mappo", kTogether, 40000, TwoShips(), /*credit=*/0), 0.98);
}

TEST(TwoShips, AreLedHomeByOnePolicyThatRemembers) {
  EXPECT_GE(
      SuccessAfter("mappo", kTogether + "recurrent=true sequence_length=8", 40000, TwoShips()),
      0.98);
}

// In a replay filled by one episode the oldest time steps have no complete window.
TEST(Maddpg, LearnsWithMemoryFromAReplayThatHoldsNoStart) {
  Scenario scenario = TwoShips();
  scenario.step_limit = 5000;
  const std::string options =
      "recurrent=true window=8 hidden_size=8 batch_size=32 learning_starts=50 buffer_size=100 "
      "train_interval=2 "
      "shared=false";
  LocalEnvironment environment(Share(scenario), {2, kFeaturesBit, false, 1});
  const auto learner = FindAlgorithm("maddpg").make(environment.spec(), 1, options);
  TrainerOptions trainer;
  trainer.algorithm = "maddpg";
  trainer.steps = 600;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  EXPECT_TRUE(std::isfinite(learner->status().loss));
}

TEST(Maddpg, ANonFiniteLossOfAnActorNamesItsBatch) {
  const std::string options =
      "hidden_size=8 batch_size=8 learning_starts=10 buffer_size=500 train_interval=2";
  LocalEnvironment environment(Share(TwoShips()), {2, kFeaturesBit, false, 1});
  const auto learner = FindAlgorithm("maddpg").make(environment.spec(), 1, options);
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  std::fill_n(checkpoint.sections["weights"].begin() + 40, 4, '\xff');  // a NaN
  learner->Load(checkpoint);
  std::vector<std::uint8_t> actions;
  std::uint64_t position = 0;
  const StepResults* results = &environment.Reset(1);
  std::string message;
  for (int i = 0; i < 100 && message.empty(); ++i) {
    Checkpoint before;
    learner->Save(before);
    position = std::get<std::uint64_t>(before.GetNumbers("maddpg.counters").at("rng"));
    message = MessageOf<LearnerFailed>([&] { learner->Step(*results, 0.1, actions); });
    results = &environment.Step(actions);
  }
  EXPECT_CONTAINS(message, "loss of the actors: is not finite at update 1, after ");
  EXPECT_CONTAINS(message, "farm steps, on the batch drawn from seed 1 at position " +
                               std::to_string(position) + ";");
}

TEST(SmartDevices, DriveThemselvesHomeNextToAShip) {
  EXPECT_GE(SuccessAfter("q_learning", "", 200000, SmartDevices()), 0.98);
  EXPECT_GE(SuccessAfter("independent_dqn", kSmall, 24000, SmartDevices()), 0.98);
  EXPECT_GE(SuccessAfter("vdn", kSmall, 24000, SmartDevices()), 0.98);
}

TEST(SmartDevices, AreLedHomeByOnePolicyWithAValueThatSeesAll) {
  EXPECT_GE(SuccessAfter("mappo", kTogether, 40000, SmartDevices()), 0.98);
  EXPECT_GE(SuccessAfter("mappo", kTogether + "team_share=1", 40000, SmartDevices()), 0.98);
}

// Agents that are delivered early are done. The values of the others must not depend on them.
TEST(SmartDevices, AreLedHomeByActorsWithOwnRewardsOrTheTeams) {
  EXPECT_GE(SuccessAfter("maddpg", kActors + "64", 24000, SmartDevices()), 0.98);
  Scenario team = SmartDevices();
  team.rewards.sharing = RewardSharing::kTeam;
  EXPECT_GE(SuccessAfter("maddpg", kActors + "64", 32000, team, /*credit=*/0), 0.98);
}

TEST(DoneAgents, LearnNothingMoreFromATable) {
  EnvironmentSpec spec;
  spec.farms = 1;
  spec.agents = 2;
  spec.state_count = 3;
  TabularLearner<QLearningRule> learner(spec, 1,
                                        "learning_rate=0.5 gamma=0.9 exploration=epsilon_greedy:0");
  StepResults results;
  results.legal = {kAllActions, kAllActions};
  results.end_reasons = {0};
  std::vector<std::uint8_t> actions;
  const auto step = [&](bool is_first, std::uint8_t active, float reward) {
    results.is_first = {is_first ? std::uint8_t{1} : std::uint8_t{0}};
    results.index = {0, 1};
    results.active = {1, active};
    results.rewards = {0.0F, reward};
    learner.Step(results, 0.0, actions);
  };
  step(true, 1, 0.0F);
  step(false, 0, 10.0F);  // the second agent delivers itself
  const std::vector<float> once = learner.table().values;
  EXPECT_EQ(once[3 * kActionCount + kActionCount], 5.0F) << "no bootstrap past its end";
  step(false, 0, 99.0F);
  step(false, 0, 99.0F);
  EXPECT_EQ(learner.table().values, once);
}

TEST(DoneAgents, EndTheirTransitionsInAReplayWhileTheOthersContinue) {
  Replay<float> replay({100, 2, 2, 1, 0});
  StepResults results;
  results.legal = {kAllActions, kAllActions};
  const float observations[] = {0.0F, 0.0F};
  for (int t = 0; t < 6; ++t) {
    results.rewards = {1.0F, 2.0F};
    results.end_reasons = {0};
    results.is_first = {t == 0 ? std::uint8_t{1} : std::uint8_t{0}};
    results.active = {1, t < 2 ? std::uint8_t{1} : std::uint8_t{0}};
    replay.Add(results, observations);
    replay.SetActions({0, 0});
  }
  EXPECT_TRUE(replay.Begins(1, 1, 2));
  EXPECT_FALSE(replay.Begins(2, 1, 2));
  EXPECT_TRUE(replay.Begins(2, 0, 2));
  const Transition last = replay.At(0, 1, 3, 0.5F);
  EXPECT_FLOAT_EQ(last.reward, 2.0F + 0.5F * 2.0F);
  EXPECT_EQ(last.discount, 0.0F);
  // For the team the episode continues.
  float rewards[2];
  const JointTransition all = replay.JointAt(0, 0, 3, 0.5F, rewards);
  EXPECT_FLOAT_EQ(rewards[0], 1.0F * 1.75F);
  EXPECT_FLOAT_EQ(rewards[1], 2.0F * 1.75F);
  EXPECT_FLOAT_EQ(all.discount, 0.125F);
  EXPECT_EQ(all.to, replay.Row(3, 0));
}

class Saved : public testing::TestWithParam<std::string> {};
class SavedWithDevice : public Saved {};  // learners with the option device

Checkpoint PolicyOf(const Learner& learner, const std::string& algorithm,
                    const EnvironmentSpec& spec) {
  Checkpoint checkpoint;
  checkpoint.algorithm = algorithm;
  checkpoint.options = learner.options();
  checkpoint.spec = spec;
  learner.SavePolicy(checkpoint);
  return checkpoint;
}

TEST_P(Saved, LearnersOfSeveralAgentsContinueBitIdentically) {
  const std::string options = GetParam() == "mappo"
                                  ? "hidden_size=8 rollout_size=300 batch_size=32 team_share=0.5"
                                  : "hidden_size=8 batch_size=8 learning_starts=50 buffer_size=500";
  const Algorithm& entry = FindAlgorithm(GetParam());
  LocalEnvironment environment(Share(SmartDevices()),
                               {2, entry.observation_types(options), false, 1});
  const auto one = entry.make(environment.spec(), 1, options);
  const auto other = entry.make(environment.spec(), 1, options);
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> again;
  const StepResults* now = &environment.Reset(1);
  for (int i = 0; i < 200; ++i) {
    one->Step(*now, 0.1, actions);
    now = &environment.Step(actions);
  }
  Checkpoint checkpoint;
  one->Save(checkpoint);
  other->Load(checkpoint);
  for (int i = 0; i < 100; ++i) {
    one->Step(*now, 0.2, actions);
    other->Step(*now, 0.2, again);
    ASSERT_EQ(actions, again) << "step " << i;
    now = &environment.Step(actions);
  }
  Checkpoint a;
  Checkpoint b;
  one->SavePolicy(a);
  other->SavePolicy(b);
  EXPECT_TRUE(a.sections == b.sections);
}

TEST_P(Saved, PoliciesForTwoShipsAreRefusedByAFarmWithFour) {
  const Algorithm& entry = FindAlgorithm(GetParam());
  Scenario scenario = TwoShips();
  scenario.name = "two";
  LocalEnvironment two(Share(scenario), {1, kFeaturesBit, false, 1});
  const auto learner = entry.make(two.spec(), 1, "hidden_size=8");
  const Checkpoint checkpoint = PolicyOf(*learner, GetParam(), two.spec());
  EXPECT_NE(entry.make_policy(checkpoint, two.spec()), nullptr);
  scenario.name = "four";
  scenario.ships.count = 4;
  LocalEnvironment four(Share(scenario), {1, kFeaturesBit, false, 1});
  EXPECT_CONTAINS(
      MessageOf<InputError>([&] { entry.make_policy(checkpoint, four.spec()); }),
      GetParam() +
          " of scenario two does not fit scenario four: agents: the policy has 2, the farm has 4");
}

void ExpectTheOwnShareIsEnough(const std::string& algorithm, const std::string& options) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(Share(TwoShips()), {1, kFeaturesBit, false, 1});
  const EnvironmentSpec& spec = environment.spec();
  const auto learner = entry.make(spec, 1, options);
  const Checkpoint checkpoint = PolicyOf(*learner, algorithm, spec);
  const auto both = entry.make_policy(checkpoint, spec);
  const auto own = entry.make_policy(checkpoint, spec);
  both->Begin(1, 1);
  own->Begin(1, 1);
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> own_actions;
  const StepResults* all = &environment.Reset(1, 0);
  for (int step = 0; step < 20; ++step) {
    StepResults share = *all;
    share.active[0] = 0;
    std::fill_n(share.features.begin(), spec.feature_count, 0.0F);
    both->Act(*all, actions);
    own->Act(share, own_actions);
    ASSERT_EQ(own_actions[1], actions[1]) << options << ' ' << step;
    ASSERT_EQ(own->values().size(), both->values().size());
    if (!own->values().empty()) {
      EXPECT_NEAR(own->values()[1], both->values()[1], 1e-4F) << options << ' ' << step;
    }
    actions[0] = static_cast<std::uint8_t>(step % kMoveCount);
    all = &environment.Step(actions);
  }
}

// A ship's own node has only the observations of that ship.
TEST_P(Saved, PoliciesPlayAShipByItsOwnShareAsAmongAll) {
  ExpectTheOwnShareIsEnough(GetParam(), "hidden_size=8");
  if (GetParam() == "mappo") ExpectTheOwnShareIsEnough("mappo", "hidden_size=8 recurrent=true");
  if (GetParam() != "maddpg") return;
  ExpectTheOwnShareIsEnough("maddpg", "hidden_size=8 shared=false");
  ExpectTheOwnShareIsEnough("maddpg", "hidden_size=8 recurrent=true");
  ExpectTheOwnShareIsEnough("maddpg", "hidden_size=8 shared=false recurrent=true");
}

// The weights are the same on every device. On a machine with CUDA this test is weaker.
TEST_P(SavedWithDevice, PoliciesTrainedOnCudaPlayWhereThereIsNone) {
  const Algorithm& entry = FindAlgorithm(GetParam());
  LocalEnvironment environment(Share(TwoShips()), {1, kFeaturesBit, false, 1});
  const auto learner = entry.make(environment.spec(), 1, "hidden_size=8 device=cpu");
  Checkpoint checkpoint = PolicyOf(*learner, GetParam(), environment.spec());
  const std::string cpu = "device=cpu";
  const std::size_t at = checkpoint.options.find(cpu);
  ASSERT_NE(at, std::string::npos) << checkpoint.options;
  checkpoint.options.replace(at, cpu.size(), "device=cuda");
  const auto policy = entry.make_policy(checkpoint, environment.spec());
  const auto own = learner->GreedyPolicy();
  policy->Begin(1, 1);
  own->Begin(1, 1);
  std::vector<std::uint8_t> actions;
  std::vector<std::uint8_t> own_actions;
  const StepResults* results = &environment.Reset(1, 0);
  for (int step = 0; step < 20; ++step) {
    policy->Act(*results, actions);
    own->Act(*results, own_actions);
    ASSERT_EQ(actions, own_actions) << step;
    results = &environment.Step(actions);
  }
}

TEST(DoneAgents, AreNeitherAskedNorValuedWhereverTheyStand) {
  Scenario scenario = TwoShips();
  scenario.ships.count = 3;
  LocalEnvironment environment(Share(scenario), {1, kFeaturesBit, false, 1});
  const auto learner = FindAlgorithm("dqn").make(environment.spec(), 1, "hidden_size=8");
  const Checkpoint checkpoint = PolicyOf(*learner, "dqn", environment.spec());
  const auto policy = FindAlgorithm("dqn").make_policy(checkpoint, environment.spec());
  StepResults results = environment.Reset(1, 0);
  std::vector<std::uint8_t> actions;
  policy->Act(results, actions);
  const std::vector<float> values = policy->values();
  for (std::size_t done = 0; done < 3; ++done) {
    results.active = {1, 1, 1};
    results.active[done] = 0;
    policy->Act(results, actions);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(policy->values()[i], i == done ? 0.0F : values[i], 1e-4F) << done << ' ' << i;
    }
    EXPECT_EQ(actions[done], 0) << done;
  }
  for (std::size_t left = 0; left < 3; ++left) {
    results.active = {0, 0, 0};
    results.active[left] = 1;
    policy->Act(results, actions);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(policy->values()[i], i == left ? values[i] : 0.0F, 1e-4F) << left << ' ' << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SavedWithDevice,
                         testing::Values("dqn", "lstm_dqn", "independent_dqn",
                                         "independent_lstm_dqn", "vdn", "maddpg"),
                         [](const auto& test) { return test.param; });
INSTANTIATE_TEST_SUITE_P(All, Saved,
                         testing::Values("dqn", "lstm_dqn", "independent_dqn",
                                         "independent_lstm_dqn", "vdn", "maddpg", "mappo"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace aquafarm::agents::test
