// SPDX-License-Identifier: BSD-3-Clause
// PPO learns tiny farms with each option, respects the masks and stops at a non-finite loss.
// training/algorithms_test and training/resume_test check that it continues bit-identically.
#include "aquafarm/agents/ppo/ppo.h"

#include <algorithm>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/ppo/ppo_options.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/trainer.h"

namespace aquafarm::agents::test {
namespace {

constexpr const char* kSmall =
    "hidden_size=32 rollout_size=512 batch_size=128 epochs=4 learning_rate=linear:0.003:0:1 "
    "gamma=0.97 ";

struct Progress {
  double before{};
  double after{};
};

Progress Learn(const std::string& options, std::uint64_t steps,
               std::shared_ptr<const Scenario> scenario = TinyFarm()) {
  LocalEnvironment environment(std::move(scenario), {16, PpoObservationTypes(options), false, 1});
  const auto learner = FindAlgorithm("ppo").make(environment.spec(), 1, options);
  Progress progress;
  progress.before = Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
  TrainerOptions trainer;
  trainer.algorithm = "ppo";
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  progress.after = Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
  return progress;
}

void ExpectSolves(const std::string& options, std::uint64_t steps) {
  const Progress progress = Learn(options, steps);
  EXPECT_LT(progress.before, 0.5) << options;
  EXPECT_GE(progress.after, 0.98) << options;
}

TEST(Ppo, SolvesATinyFarm) { ExpectSolves(kSmall, 30000); }

TEST(Ppo, SolvesItWithEachSwitchTurnedRound) {
  for (const std::string change :
       {"value_clip_range=0.2", "normalize_advantages=false", "mask_blocked=false",
        "clip_range=linear:0.3:0.1:1", "exploration=icm:1+entropy:0.01", "policy=sampled"}) {
    ExpectSolves(kSmall + change, 40000);
  }
}

TEST(Ppo, SolvesATinyFarmWithAMemory) {
  ExpectSolves(kSmall + std::string("recurrent=true sequence_length=8"), 40000);
}

// So few steps are not enough without a teacher.
TEST(Ppo, ImitatesThePlanner) {
  constexpr std::uint64_t kSteps = 4000;
  const std::string options = kSmall + std::string("teacher=1 teacher_policy=planner ");
  for (const char* interval : {"teacher_interval=1", "teacher_interval=3"}) {
    EXPECT_GE(Learn(options + interval, kSteps).after, 0.98) << interval;
  }
  EXPECT_LT(Learn(kSmall, kSteps).after, 0.5);
}

TEST(Ppo, OnlyTheRuleNeedsEntityTokens) {
  LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  EXPECT_CONTAINS(
      MessageOf<InputError>([&] { MakePpo(environment.spec(), 1, "teacher=linear:0:1:1"); }),
      "expected 0 in a scenario without view.tokens, which the rule reads");
  EXPECT_EQ(PpoObservationTypes("teacher=1"), kFeaturesBit);
  EXPECT_EQ(PpoObservationTypes("teacher_policy=planner"), kFeaturesBit)
      << "teacher=0: the planner is not used";
  EXPECT_EQ(PpoObservationTypes("teacher=1 teacher_policy=planner"), kFeaturesBit | kStatesBit);
}

TEST(Ppo, SharesOneNetworkAmongSeveralShips) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 60;
  scenario.ships.count = 2;
  scenario.ports.cells = {{2, 0}, {2, 1}};
  const Progress progress = Learn(kSmall, 60000, Share(scenario));
  EXPECT_GE(progress.after, 0.98);
}

TEST(Ppo, SamplesOnlyWhatTheMasksAllow) {
  LocalEnvironment environment(TinyFarm(), {4, kFeaturesBit, false, 1});
  for (const bool is_masked : {false, true}) {
    const std::string options = is_masked ? "" : "mask_blocked=false mask_illegal=false";
    const auto learner = MakePpo(environment.spec(), 1, options);
    const StepResults* results = &environment.Reset(1, 0);
    std::vector<std::uint8_t> actions;
    int refused = 0;
    for (int step = 0; step < 300; ++step) {
      learner->Step(*results, 0.0, actions);
      results = &environment.Step(actions);
      for (std::size_t i = 0; i < results->outcomes.size(); ++i) {
        const bool is_step = results->is_first[i] == 0;
        refused += is_step && results->outcomes[i] != static_cast<std::uint8_t>(Outcome::kOk);
      }
    }
    if (is_masked) {
      EXPECT_EQ(refused, 0);
    } else {
      EXPECT_GT(refused, 100);
    }
  }
}

TEST(Ppo, GreedyPoliciesRepeatAndSampledOnesFollowTheirSeed) {
  LocalEnvironment environment(TinyFarm(), {16, kFeaturesBit, false, 1});
  const StepResults& results = environment.Reset(1, 0);
  const auto actions_of = [&](const std::string& options, std::uint64_t seed) {
    const auto policy = MakePpo(environment.spec(), 1, options)->GreedyPolicy();
    policy->Begin(seed, 16);
    std::vector<std::uint8_t> actions;
    policy->Act(results, actions);
    return actions;
  };
  EXPECT_EQ(actions_of("", 1), actions_of("", 2));
  EXPECT_EQ(actions_of("policy=sampled", 1), actions_of("policy=sampled", 1));
  EXPECT_NE(actions_of("policy=sampled", 1), actions_of("policy=sampled", 2));
}

// Policies that have learned nothing move in circles.
TEST(Ppo, ARepetitionPenaltyEndsCircles) {
  LocalEnvironment environment(TinyFarm(400), {1, kFeaturesBit, false, 1});
  int solved[2] = {};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const bool has_penalty : {false, true}) {
      const std::string options = has_penalty ? "repetition_penalty=1" : "";
      const auto policy = MakePpo(environment.spec(), seed, options)->GreedyPolicy();
      const double success = Evaluate(environment, *policy, 1, 1).success_rate;
      solved[has_penalty ? 1 : 0] += success > 0.0 ? 1 : 0;
    }
  }
  EXPECT_LE(solved[0], 2);
  EXPECT_GE(solved[1], 8);
}

// As a ship's node, which receives only its own share of the results.
TEST(Ppo, PlaysAShipByItsOwnShareAsAmongAll) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = 2;
  scenario.ports.cells = {{2, 0}, {2, 1}};
  LocalEnvironment environment(Share(scenario), {1, kFeaturesBit, false, 1});
  for (const std::string options : {"hidden_size=8", "hidden_size=8 recurrent=true"}) {
    const auto learner = MakePpo(environment.spec(), 1, options);
    const auto both = learner->GreedyPolicy();
    const auto own = learner->GreedyPolicy();
    both->Begin(1, 1);
    own->Begin(1, 1);
    std::vector<std::uint8_t> actions;
    std::vector<std::uint8_t> own_actions;
    const StepResults* all = &environment.Reset(1, 0);
    for (int step = 0; step < 20; ++step) {
      StepResults share = *all;
      share.active[0] = 0;
      std::fill_n(share.features.begin(), environment.spec().feature_count, 0.0F);
      both->Act(*all, actions);
      own->Act(share, own_actions);
      ASSERT_EQ(own_actions[1], actions[1]) << options << ' ' << step;
      EXPECT_EQ(own_actions[0], 0);
      EXPECT_EQ(own->values()[0], 0.0F);
      EXPECT_NEAR(own->values()[1], both->values()[1], 1e-3F) << options << ' ' << step;
      actions[0] = static_cast<std::uint8_t>(step % kMoveCount);
      all = &environment.Step(actions);
    }
  }
}

void ExpectThatANanEndsTheTraining(const std::string& algorithm, const std::string& more = "") {
  const std::string options = "hidden_size=8 rollout_size=64 batch_size=32" + more;
  LocalEnvironment environment(TinyFarm(), {8, kFeaturesBit, false, 1});
  const auto learner = FindAlgorithm(algorithm).make(environment.spec(), 1, options);
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  std::string& weights = checkpoint.sections["weights"];
  std::fill_n(weights.begin() + 40, 4, '\xff');  // a NaN
  learner->Load(checkpoint);
  TrainerOptions trainer_options;
  trainer_options.algorithm = algorithm;
  trainer_options.steps = 200000;
  Trainer trainer(environment, *learner, trainer_options);
  EXPECT_EQ(trainer.Run(), TrainingEnd::kDiverged);
  EXPECT_EQ(trainer.message().find(algorithm + ": loss: got "), 0U) << trainer.message();
  EXPECT_CONTAINS(trainer.message(),
                  "farm steps; expected a finite number: lower learning_rate or "
                  "reward_scale");
}

TEST(Ppo, ALossThatIsNotFiniteEndsTheTraining) {
  ExpectThatANanEndsTheTraining("ppo");
  ExpectThatANanEndsTheTraining("ppo", " recurrent=true sequence_length=4");
  ExpectThatANanEndsTheTraining("mappo");
}

TEST(Mappo, RefusesEntityTokens) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.view.tokens = true;
  LocalEnvironment environment(Share(scenario), {1, kFeaturesBit, false, 1});
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MakeMappo(environment.spec(), 1, ""); }),
                  "algorithm: got mappo in a scenario with view.tokens, expected ppo");
}

// The value's network is not part of a policy, which acts by an agent's own observation.
TEST(Mappo, PoliciesAreThoseOfPpoWithoutValues) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = 2;
  scenario.ports.cells = {{2, 0}, {2, 1}};
  LocalEnvironment environment(Share(scenario), {1, kFeaturesBit, false, 1});
  const EnvironmentSpec& spec = environment.spec();
  Checkpoint policies[2];
  const Learner* made[2];
  const auto ppo = MakePpo(spec, 1, "hidden_size=8");
  const auto mappo = MakeMappo(spec, 1, "hidden_size=8");
  made[0] = ppo.get();
  made[1] = mappo.get();
  for (int i = 0; i < 2; ++i) made[i]->SavePolicy(policies[i]);
  EXPECT_EQ(policies[0].Section("weights"), policies[1].Section("weights"));
  const auto policy = mappo->GreedyPolicy();
  policy->Begin(1, 1);
  std::vector<std::uint8_t> actions;
  policy->Act(environment.Reset(1, 0), actions);
  EXPECT_EQ(actions.size(), 2U);
  EXPECT_TRUE(policy->values().empty());
}

TEST(Ppo, WrongOptionsAreAnsweredWithWhatIsAllowed) {
  for (const auto& [options, words] :
       {std::pair{"clip=0.1",
                  "options: got 'clip', expected one of: augment, batch_size, clip_range"},
        std::pair{"epochs=0", "epochs: got 0, expected [1, 100]"},
        std::pair{"batch_size=2.5", "batch_size: got 2.5, expected a whole number"},
        std::pair{"policy=best", "policy: got 'best', expected one of: greedy, sampled"},
        std::pair{"preset=paper", "preset: got 'paper', expected one of: tuned, large"},
        std::pair{"exploration=boltzmann:1",
                  "exploration: got 'boltzmann:1', expected entropy for a learner that samples "
                  "its own policy"},
        std::pair{"exploration=icm+epsilon_greedy", "expected entropy for a learner"}}) {
    EXPECT_CONTAINS(MessageOf<InputError>([o = options] { PpoObservationTypes(o); }), words);
  }
}

TEST(Ppo, HasAPresetForLayoutsThatChange) {
  std::string resolved;
  const PpoOptions large = PpoOptions::Parse("preset=large", resolved);
  EXPECT_EQ(large.hidden_size, 256);
  EXPECT_CONTAINS(resolved, "preset=large");
  EXPECT_EQ(PpoOptions::Parse("preset=large hidden_size=64", resolved).hidden_size, 64);
}

TEST(Ppo, CollectsTheSameNumberOfStepsFromAnyNumberOfFarms) {
  PpoOptions options;
  EXPECT_EQ(options.Horizon(256), 64);
  EXPECT_EQ(options.Horizon(16), 1024);
  EXPECT_EQ(options.Horizon(4096), 8) << "no fewer";
  options.recurrent = true;
  options.sequence_length = 48;
  EXPECT_EQ(options.Horizon(256), 96) << "whole sequences";
}

TEST(Ppo, PoliciesThatDoNotFitAreRefusedWithWhatDiffers) {
  LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  const auto learner = MakePpo(environment.spec(), 1, "hidden_size=8");
  Checkpoint checkpoint;
  checkpoint.algorithm = "ppo";
  checkpoint.options = learner->options();
  checkpoint.spec = environment.spec();
  learner->SavePolicy(checkpoint);
  EXPECT_NE(MakePpoPolicy(checkpoint, environment.spec()), nullptr);
  EnvironmentSpec other = environment.spec();
  other.feature_names[2] = "tide";
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MakePpoPolicy(checkpoint, other); }),
                  "does not fit scenario tiny: feature 2: the policy has ");
  checkpoint.sections["weights"].resize(40);
  EXPECT_CONTAINS(MessageOf<InputError>([&] { MakePpoPolicy(checkpoint, environment.spec()); }),
                  "weights: got 10 numbers, expected ");
}

}  // namespace
}  // namespace aquafarm::agents::test
