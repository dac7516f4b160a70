// SPDX-License-Identifier: BSD-3-Clause
// DQN and LSTM-DQN learn tiny farms with each option, and continue bit-identically.
#include "aquafarm/agents/dqn/dqn.h"

#include <algorithm>
#include <array>

#include "agents_fixture.h"
#include "aquafarm/agents/evaluation/evaluation.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/trainer.h"
#include "networks/deep_policy.h"
#include "networks/networks.h"
#include "networks/value_optimizer.h"

namespace aquafarm::agents::test {
namespace {

constexpr const char* kSmall =
    "hidden_size=32 batch_size=32 learning_starts=500 buffer_size=5000 target_update_interval=50 "
    "train_interval=4 "
    "learning_rate=linear:0.002:0.0001:1 ";
constexpr const char* kSmallRecurrent =
    "hidden_size=24 batch_size=16 learning_starts=500 buffer_size=5000 target_update_interval=50 "
    "train_interval=8 sequence_length=8 "
    "burn_in=4 learning_rate=linear:0.003:0.0001:1 ";

/// Success rate of a greedy policy on unseen seeds, before and after training.
struct Progress {
  double before{};
  double after{};
};

Progress Learn(const std::string& algorithm, const std::string& options, std::uint64_t steps,
               std::uint64_t seed) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(TinyFarm(), {8, entry.observation_types(options), false, 1});
  const auto learner = entry.make(environment.spec(), seed, options);
  Progress progress;
  progress.before = Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
  TrainerOptions trainer;
  trainer.algorithm = algorithm;
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  progress.after = Evaluate(environment, *learner->GreedyPolicy(), 1, 50).success_rate;
  return progress;
}

/// The last bits of a training depend on the BLAS, and a short training fails sometimes. One of two
/// seeds must succeed.
void ExpectSolves(const std::string& algorithm, const std::string& options, std::uint64_t steps) {
  Progress progress;
  for (const std::uint64_t seed : {1, 2}) {
    progress = Learn(algorithm, options, steps, seed);
    EXPECT_LT(progress.before, 0.5) << options;
    if (progress.after >= 0.98) return;
  }
  EXPECT_GE(progress.after, 0.98) << options;
}

/// Trains a learner, and expects that the value of its policy at the start of an episode is about
/// the discounted return of the episode.
void ExpectValuesInTheUnitOfRewards(const std::string& algorithm, const std::string& options,
                                    std::uint64_t steps) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(TinyFarm(), {1, entry.observation_types(options), false, 1});
  const auto learner = entry.make(environment.spec(), 1, options);
  TrainerOptions trainer;
  trainer.algorithm = algorithm;
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  std::string resolved;
  const double gamma = DeepOptions::Parse(options, algorithm == "lstm_dqn", resolved).gamma;
  const auto policy = learner->GreedyPolicy();
  policy->Begin(1, 1);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(1);
  policy->Act(*results, actions);
  const double value = policy->values()[0];
  double expected = 0.0;
  double weight = 1.0;
  for (int step = 0; step < 100; ++step, weight *= gamma) {
    results = &environment.Step(actions);
    expected += weight * double{results->rewards[0]};
    if (results->end_reasons[0] != 0) break;
    policy->Act(*results, actions);
  }
  EXPECT_GT(expected, 50.0) << "a rescue";
  EXPECT_NEAR(value, expected, 0.2 * expected) << options;
}

std::string Resolved(const std::string& options, bool recurrent) {
  std::string resolved;
  DeepOptions::Parse(options, recurrent, resolved);
  return resolved;
}

TEST(Dqn, SolvesATinyFarm) { ExpectSolves("dqn", kSmall, 12000); }

TEST(DeepPolicies, HaveValuesInTheUnitOfTheRewards) {
  ExpectValuesInTheUnitOfRewards("dqn", kSmall, 20000);
  ExpectValuesInTheUnitOfRewards("dqn", kSmall + std::string("reward_scale=0.2"), 20000);
  ExpectValuesInTheUnitOfRewards("lstm_dqn", kSmallRecurrent, 20000);
}

TEST(Dqn, SolvesItWithEachSwitchTurnedRound) {
  for (const std::string change :
       {"double_dqn=false", "dueling=true", "n_step=3", "priority_exponent=0", "loss=mse",
        "tau=0.01", "ema_rate=0.02", "action_gap=0.5", "repetition_penalty=0.5",
        "exploration=boltzmann"}) {
    EXPECT_NE(Resolved(kSmall + change, false), Resolved(kSmall, false)) << change;
    ExpectSolves("dqn", kSmall + change, 20000);
  }
  // The learner must first learn to avoid illegal actions, so it explores longer.
  ExpectSolves(
      "dqn",
      kSmall + std::string("mask_illegal=false exploration=epsilon_greedy:linear:1:0.05:0.5"),
      40000);
}

TEST(Curiosity, GoesWithEveryLearnerOfValues) {
  const std::string curious = "exploration=icm+epsilon_greedy:0.1";
  ExpectSolves("q_learning", curious, 60000);
  ExpectSolves("sarsa", curious, 60000);
  ExpectSolves("dqn", kSmall + curious, 20000);
  ExpectSolves("lstm_dqn", kSmallRecurrent + curious, 20000);
}

TEST(Dqn, SolvesItFromThePlanes) {
  ExpectSolves("dqn",
               "network=cnn hidden_size=16 batch_size=32 learning_starts=500 buffer_size=5000 "
               "target_update_interval=50 "
               "learning_rate=linear:0.002:0.0001:1",
               12000);
}

TEST(RecurrentDqn, SolvesATinyFarm) { ExpectSolves("lstm_dqn", kSmallRecurrent, 20000); }

TEST(RecurrentDqn, SolvesItWithEachSwitchTurnedRound) {
  for (const std::string change :
       {"double_dqn=false", "dueling=true", "n_step=3", "priority_exponent=0", "loss=mse",
        "tau=0.01", "ema_rate=0.02", "repetition_penalty=0.5", "exploration=boltzmann"}) {
    EXPECT_NE(Resolved(kSmallRecurrent + change, true), Resolved(kSmallRecurrent, true)) << change;
    ExpectSolves("lstm_dqn", kSmallRecurrent + change, 20000);
  }
  // The action gap also widens errors, so training takes longer.
  ExpectSolves("lstm_dqn", kSmallRecurrent + std::string("action_gap=0.5"), 40000);
}

TEST(RecurrentDqn, SolvesItWithThePapersTuples) {
  ExpectSolves("lstm_dqn",
               "hidden_size=24 batch_size=64 learning_starts=500 buffer_size=5000 "
               "target_update_interval=50 train_interval=4 "
               "replayed=paper_tuple learning_rate=linear:0.003:0.0001:1",
               24000);
}

// The tiny farm with its device at a cell from which only one route takes at most two steps.
std::shared_ptr<const Scenario> OneWayFarm() {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.step_limit = 60;
  scenario.devices.sites.front().cell = {4, 2};
  return Share(scenario);
}

// Returns the value of the best legal action minus that of the second best, at the start of an
// episode, after a training.
float GapOf(std::uint64_t seed, const std::string& algorithm, const std::string& options,
            std::uint64_t steps) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(OneWayFarm(), {8, entry.observation_types(options), false, 1});
  const auto learner = entry.make(environment.spec(), seed, options);
  TrainerOptions trainer;
  trainer.algorithm = algorithm;
  trainer.steps = steps;
  EXPECT_EQ(Trainer(environment, *learner, trainer).Run(), TrainingEnd::kDone);
  Checkpoint checkpoint;
  checkpoint.algorithm = algorithm;
  checkpoint.options = learner->options();
  checkpoint.spec = environment.spec();
  learner->SavePolicy(checkpoint);
  std::vector<float> weights = ActingWeights(checkpoint);
  const StepResults& results = environment.Reset(1);
  const bool recurrent = algorithm == "lstm_dqn";
  std::string resolved;
  const DeepOptions parsed = DeepOptions::Parse(options, recurrent, resolved);
  const torch::NoGradGuard no_grad;
  const std::int64_t features = environment.spec().feature_count;
  std::vector<float> seen(results.features.begin(), results.features.begin() + features);
  const torch::Tensor input = torch::from_blob(seen.data(), {1, features});
  torch::Tensor values;
  if (recurrent) {
    RecurrentNetwork network(features, parsed.hidden_size, parsed.dueling);
    FlatParameters(network, torch::kCPU).FromVector(weights);
    const torch::Tensor empty = torch::zeros({1, 1, parsed.hidden_size});
    RecurrentNetwork::State state{empty, empty};
    values = network.Forward(input.unsqueeze(0), state)[0];
  } else {
    const auto network = MakeNetwork(environment.spec(), parsed, 0);
    FlatParameters(*network, torch::kCPU).FromVector(weights);
    values = network->Forward(input);
  }
  std::array<float, kActionCount> forbidden{};
  MaskLogits(LegalMask(results.legal[0], true), forbidden.data());
  const torch::Tensor best =
      std::get<0>((values + torch::from_blob(forbidden.data(), {1, kActionCount})).topk(2, 1));
  return (best[0][0] - best[0][1]).item<float>();
}

// Mean of some trainings: the last bits of a training depend on the BLAS, and so does its gap.
float Gap(const std::string& algorithm, const std::string& options, std::uint64_t steps,
          std::uint64_t trainings) {
  float sum = 0.0F;
  for (std::uint64_t seed = 1; seed <= trainings; ++seed) {
    sum += GapOf(seed, algorithm, options, steps);
  }
  return sum / static_cast<float>(trainings);
}

TEST(Dqn, ActionGapSetsTheBestActionApart) {
  const float plain = Gap("dqn", kSmall, 40000, 3);
  EXPECT_GT(plain, 0.05F) << "a step of -1, times 0.05, and what comes later by one";
  EXPECT_GT(Gap("dqn", kSmall + std::string("action_gap=0.5"), 40000, 3), 1.4F * plain)
      << "twice, if exact";
}

TEST(RecurrentDqn, ActionGapSetsTheBestActionApart) {
  const float plain = Gap("lstm_dqn", kSmallRecurrent, 20000, 2);
  EXPECT_GT(plain, 0.02F);
  EXPECT_GT(Gap("lstm_dqn", kSmallRecurrent + std::string("action_gap=0.5"), 40000, 2),
            1.3F * plain);
}

struct Crashes {
  int exploring{};
  int greedy{};
};

/// Crashes in `steps` steps of an untrained learner, and in as many steps of its greedy policy.
Crashes CrashesIn(const std::string& algorithm, const std::string& options, int steps) {
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(TinyFarm(), {4, entry.observation_types(options), false, 1});
  const auto learner = entry.make(environment.spec(), 1, options);
  const auto policy = learner->GreedyPolicy();
  policy->Begin(1, 4);
  std::vector<std::uint8_t> actions;
  const auto count = [&](const auto& act) {
    int crashes = 0;
    const StepResults* results = &environment.Reset(1, 0);
    for (int step = 0; step < steps; ++step) {
      act(*results);
      results = &environment.Step(actions);
      for (const EpisodeSummary& ended : results->finished) crashes += ended.crashes;
    }
    return crashes;
  };
  return {count([&](const StepResults& results) { learner->Step(results, 0.0, actions); }),
          count([&](const StepResults& results) { policy->Act(results, actions); })};
}

TEST(Dqn, MaskBlockedKeepsShipsOffRocksIslandsAndTheMapsEdge) {
  int greedy = 0;
  for (const auto& [algorithm, small] :
       {std::pair{"dqn", kSmall}, std::pair{"lstm_dqn", kSmallRecurrent}, std::pair{"vdn", kSmall},
        std::pair{"independent_dqn", kSmall},
        std::pair{"maddpg",
                  "hidden_size=16 batch_size=8 learning_starts=100000 buffer_size=1000 "}}) {
    const std::string options = small + std::string("exploration=epsilon_greedy:1 ");
    const Crashes freely = CrashesIn(algorithm, options + "mask_blocked=false", 300);
    EXPECT_GT(freely.exploring, 50) << algorithm;
    greedy += freely.greedy;
    const Crashes masked = CrashesIn(algorithm, options + "mask_blocked=true", 300);
    EXPECT_EQ(masked.exploring, 0) << algorithm;
    EXPECT_EQ(masked.greedy, 0) << algorithm;
  }
  EXPECT_GT(greedy, 50) << "those without the mask, who know nothing";
  ExpectSolves("dqn", kSmall + std::string("mask_blocked=true"), 12000);
}

TEST(Dqn, PaperModeTurnsEverySwitchOff) {
  std::string resolved;
  const DeepOptions paper = DeepOptions::Parse("preset=paper", false, resolved);
  EXPECT_FALSE(paper.double_dqn);
  EXPECT_FALSE(paper.dueling);
  EXPECT_EQ(paper.n_step, 1);
  EXPECT_EQ(paper.priority_exponent, 0.0);
  EXPECT_EQ(paper.ema_rate, 0.0);
  EXPECT_EQ(paper.action_gap, 0.0);
  EXPECT_EQ(paper.repetition_penalty, 0.0);
  EXPECT_EQ(paper.reward_scale, 1.0);
  EXPECT_FALSE(paper.mask_illegal);
  EXPECT_FALSE(paper.mask_blocked);
  EXPECT_EQ(paper.loss, LossKind::kMse);
  EXPECT_EQ(paper.max_grad_norm, 0.0);
  EXPECT_EQ(paper.gamma, 0.99) << "§2.3";
  EXPECT_EQ(paper.tau, 0.0) << "§3.4.3: a copy, now and then";
  EXPECT_TRUE(DeepOptions::Parse("preset=paper double_dqn=true", false, resolved).double_dqn);
  EXPECT_CONTAINS(resolved, "preset=paper");
}

TEST(RecurrentDqn, PaperModeIsAlgorithm2) {
  std::string resolved;
  const DeepOptions paper = DeepOptions::Parse("preset=paper", true, resolved);
  EXPECT_EQ(paper.gamma, 0.99) << "§2.3";
  EXPECT_GT(paper.tau, 0.0) << "line 22";
  EXPECT_LE(paper.tau, 1.0);
  EXPECT_EQ(paper.train_interval.kind, ScheduleKind::kConstant);
  EXPECT_EQ(paper.train_interval.start, 1.0) << "lines 12 to 23";
  EXPECT_FALSE(paper.skip_connection);
  EXPECT_TRUE(paper.paper_tuple) << "line 19";
  EXPECT_FALSE(paper.double_dqn) << "line 20";
  EXPECT_EQ(paper.loss, LossKind::kMse) << "line 21";
  EXPECT_EQ(paper.exploration.kind, ExplorationKind::kEpsilonGreedy) << "line 13";
  EXPECT_FALSE(paper.mask_illegal) << "line 13: random among all actions";
  EXPECT_CONTAINS(resolved, "skip_connection=false");
  EXPECT_TRUE(DeepOptions::Parse("", true, resolved).skip_connection);
  EXPECT_CONTAINS(resolved, "skip_connection=true");
}

TEST(RecurrentDqn, HasTheMemoryAloneBelowItsHeadWithoutTheSkipConnection) {
  RecurrentNetwork network(3, 4, /*dueling=*/false, /*skip_connection=*/false);
  const auto size = [&network](const char* name) {
    return network.named_parameters()[name].sizes();
  };
  EXPECT_EQ(size("second.weight"), (std::vector<std::int64_t>{4, 4}));
  EXPECT_EQ(size("head.advantage.weight"), (std::vector<std::int64_t>{kActionCount, 4}));
}

TEST(Dqn, WrongOptionsAreAnsweredWithWhatIsAllowed) {
  for (const auto& [options, words] :
       {std::pair{"doubel_dqn=true",
                  "options: got 'doubel_dqn', expected one of: action_gap, batch_size"},
        std::pair{"network=rnn", "network: got 'rnn', expected one of: mlp, cnn"},
        std::pair{"network=cnn mask_blocked=true", "mask_blocked: got true, expected false"},
        std::pair{"batch_size=0", "batch_size: got 0, expected [1, 65536]"},
        std::pair{"batch_size=2.5", "batch_size: got 2.5, expected a whole number"},
        std::pair{"loss=l1", "loss: got 'l1', expected one of: huber, mse"},
        std::pair{"sequence_length=8", "options: got 'sequence_length'"},
        std::pair{"device=gpu", "device: got 'gpu', expected one of: auto, cpu, cuda"}}) {
    EXPECT_CONTAINS(MessageOf<InputError>([o = options] { DqnObservationTypes(o); }), words);
  }
}

TEST(RecurrentDqn, WarmsUpForLessThanItLearnsFrom) {
  EXPECT_CONTAINS(
      MessageOf<InputError>([] { RecurrentDqnObservationTypes("sequence_length=4 burn_in=4"); }),
      "burn_in: got 4, expected less than sequence_length, which is 4");
  RecurrentDqnObservationTypes("sequence_length=1 burn_in=0");
}

TEST(RecurrentDqn, ReplaysThePapersTuplesByName) {
  for (const std::string name : {"preset=paper", "replayed=paper_tuple"}) {
    const std::string resolved = Resolved(name, true);
    EXPECT_CONTAINS(resolved, "replayed=paper_tuple");
    EXPECT_CONTAINS(resolved, "sequence_length=1 ");
    EXPECT_CONTAINS(resolved, "burn_in=0 ");
  }
  EXPECT_CONTAINS(
      MessageOf<InputError>(
          [] { RecurrentDqnObservationTypes("replayed=paper_tuple sequence_length=8"); }),
      "paper_tuple with sequence_length=8 burn_in=0, expected 1 and 0, or replayed=sequences");
  EXPECT_CONTAINS(MessageOf<InputError>([] { RecurrentDqnObservationTypes("replayed=tuples"); }),
                  "replayed: got 'tuples', expected one of: sequences, paper_tuple");
}

TEST(RecurrentDqn, SumsRewardsOverNoMoreStepsThanItLearnsFrom) {
  EXPECT_CONTAINS(
      MessageOf<InputError>([] { RecurrentDqnObservationTypes("sequence_length=4 n_step=5"); }),
      "n_step: got 5, expected at most sequence_length, which is 4");
  RecurrentDqnObservationTypes("sequence_length=4 n_step=4");
}

TEST(Dqn, ANonFiniteLossEndsTheTraining) {
  const std::string options = "hidden_size=8 batch_size=8 learning_starts=10 buffer_size=500";
  LocalEnvironment environment(TinyFarm(), {8, kFeaturesBit, false, 1});
  const auto learner = MakeDqn(environment.spec(), 1, options);
  Checkpoint checkpoint;
  learner->Save(checkpoint);
  std::string& weights = checkpoint.sections["weights"];
  std::fill_n(weights.begin() + 40, 4, '\xff');  // a NaN
  learner->Load(checkpoint);
  TrainerOptions trainer_options;
  trainer_options.algorithm = "dqn";
  trainer_options.steps = 200000;
  Trainer trainer(environment, *learner, trainer_options);
  EXPECT_EQ(trainer.Run(), TrainingEnd::kDiverged);
  EXPECT_CONTAINS(trainer.message(), "loss: got ");
  EXPECT_CONTAINS(trainer.message(), "farm steps, on the batch drawn from seed 1 at position ");
}

TEST(DeepPolicies, ThatDoNotFitAreRefusedWithWhatDiffers) {
  for (const char* algorithm : {"dqn", "lstm_dqn"}) {
    LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
    const Algorithm& entry = FindAlgorithm(algorithm);
    const auto learner = entry.make(environment.spec(), 1, "hidden_size=8");
    Checkpoint checkpoint;
    checkpoint.algorithm = algorithm;
    checkpoint.options = learner->options();
    checkpoint.spec = environment.spec();
    learner->SavePolicy(checkpoint);
    EXPECT_NE(entry.make_policy(checkpoint, environment.spec()), nullptr);
    EnvironmentSpec other = environment.spec();
    other.feature_names[2] = "tide";
    EXPECT_CONTAINS(MessageOf<InputError>([&] { entry.make_policy(checkpoint, other); }),
                    "does not fit scenario tiny: feature 2: the policy has " +
                        environment.spec().feature_names[2] + ", the farm has tide");
    other.feature_count += 3;
    EXPECT_CONTAINS(MessageOf<InputError>([&] { entry.make_policy(checkpoint, other); }),
                    "does not fit scenario tiny: features: the policy has " +
                        std::to_string(other.feature_count - 3));
    checkpoint.sections["weights"].resize(40);
    EXPECT_THROW(entry.make_policy(checkpoint, environment.spec()), InputError);
  }
}

// Returns the actions of a policy in `count` episodes, starting with episode `first`.
std::vector<std::vector<std::uint8_t>> ActionsIn(Environment& environment, Policy& policy,
                                                 std::uint64_t first, std::size_t count) {
  policy.Begin(1, 1);
  std::vector<std::vector<std::uint8_t>> episodes(1);
  std::vector<std::uint8_t> actions;
  const StepResults* results = &environment.Reset(3, first);
  while (true) {
    policy.Act(*results, actions);
    if (results->end_reasons[0] == 0) episodes.back().push_back(actions[0]);
    results = &environment.Step(actions);
    if (results->finished.empty()) continue;
    if (episodes.size() == count) return episodes;
    episodes.emplace_back();
  }
}

TEST(RecurrentDqn, ForgetsAtAnEpisodesStart) {
  LocalEnvironment environment(TinyFarm(), {1, kFeaturesBit, false, 1});
  const auto learner = MakeRecurrentDqn(environment.spec(), 1, "hidden_size=16");
  Checkpoint checkpoint;
  checkpoint.algorithm = "lstm_dqn";
  checkpoint.options = learner->options();
  checkpoint.spec = environment.spec();
  learner->SavePolicy(checkpoint);
  std::string& bytes = checkpoint.sections["weights"];
  std::vector<float> weights(bytes.size() / sizeof(float));
  checkpoint.GetArray("weights", weights.size(), weights);
  for (float& weight : weights) weight *= 4.0F;  // so that the recurrent state matters
  checkpoint.SetArray("weights", weights);
  const auto policy = FindAlgorithm("lstm_dqn").make_policy(checkpoint, environment.spec());
  const auto in_a_row = ActionsIn(environment, *policy, 0, 6);
  for (std::uint64_t episode = 0; episode < 6; ++episode) {
    EXPECT_EQ(in_a_row[episode], ActionsIn(environment, *policy, episode, 1)[0])
        << "episode " << episode;
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
