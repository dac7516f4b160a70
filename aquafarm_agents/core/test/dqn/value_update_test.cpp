// SPDX-License-Identifier: BSD-3-Clause
// One update of DQN, VDN and LSTM-DQN (Eq. 15; Algorithm 2, lines 19 to 22): target, loss,
// gradient, step and target network, against the oracles of value_oracle.h.
#include <algorithm>
#include <cmath>

#include "agents_fixture.h"
#include "aquafarm/agents/networks/deep_options.h"
#include "aquafarm/agents/training/algorithms.h"
#include "networks/replay_sampler.h"
#include "value_oracle.h"

namespace aquafarm::agents::test {
namespace {

constexpr std::size_t kHiddenSize = 4;
constexpr std::size_t kRecordedSteps = 41;
constexpr int kAdamStep = 5;  // Adam steps before the update
constexpr double kTau = 0.25;

const char* const kCommon =
    "hidden_size=4 learning_starts=1000000 buffer_size=400 train_interval=1 learning_rate=0.01 "
    "tau=0.25 exploration=epsilon_greedy:1 gamma=0.9 reward_scale=0.25 threads=1 ";

/// A tiny farm whose episodes are truncated, or one whose disaster terminates them.
std::shared_ptr<const Scenario> Farm(bool truncates, std::int32_t ships, bool team) {
  Scenario scenario = aquafarm::test::TinyScenario();
  scenario.ships.count = ships;
  scenario.step_limit = truncates ? 7 : 100;
  if (team) scenario.rewards.sharing = RewardSharing::kTeam;
  DisasterSpec storm = aquafarm::test::StillDisaster(4.0F, 0.0F, {1.5F}, {-7.0F});
  storm.duration = truncates ? 100 : 7;
  scenario.disasters = {storm};
  return Share(scenario);
}

/// A learner that has recorded kRecordedSteps time steps and is not updated yet, with the data for
/// an oracle.
struct Update {
  DeepOptions options;
  EnvironmentSpec spec;
  bool recurrent{};
  std::vector<StepResults> log;                    // by time step
  std::vector<std::vector<std::uint8_t>> actions;  // by time step
  Checkpoint before;
  Checkpoint after;
  double progress{0.25};

  std::size_t agents() const { return static_cast<std::size_t>(spec.agents); }
  Values Seen(std::size_t moment, std::size_t slot) const {
    const auto features = static_cast<std::size_t>(spec.feature_count);
    const auto begin = log[moment].features.begin() + static_cast<std::ptrdiff_t>(slot * features);
    return {begin, begin + static_cast<std::ptrdiff_t>(features)};
  }
  bool IsStarted(std::size_t moment, std::size_t slot) const {
    return log[moment].is_first[slot / agents()] != 0;
  }
  EndReason Reason(std::size_t moment, std::size_t slot) const {
    return static_cast<EndReason>(log[moment].end_reasons[slot / agents()]);
  }
  double Reward(std::size_t moment, std::size_t slot) const {
    return static_cast<double>(log[moment].rewards[slot]);
  }
};

Values Doubles(const Checkpoint& checkpoint, const std::string& name) {
  std::vector<float> values;
  checkpoint.GetArray(name, checkpoint.Section(name).size() / sizeof(float), values);
  return {values.begin(), values.end()};
}

// Changes the target network and the state of Adam, so that errors in each of them are visible.
void Disturb(Checkpoint& checkpoint) {
  RandomStream rng({77, 0, RngStream::kLearner, 9});
  std::vector<float> target;
  const std::size_t size = checkpoint.Section("weights").size() / sizeof(float);
  checkpoint.GetArray("target_weights", size, target);
  std::vector<float> mean(size);
  std::vector<float> square(size);
  for (std::size_t i = 0; i < size; ++i) {
    target[i] += rng.Uniform(-0.5F, 0.5F);
    mean[i] = rng.Uniform(-1.0F, 1.0F);
    square[i] = rng.Uniform(0.5F, 2.0F);
  }
  checkpoint.SetArray("target_weights", target);
  checkpoint.SetArray("adam.mean", mean);
  checkpoint.SetArray("adam.square", square);
  checkpoint.SetArray("adam", std::vector<std::int64_t>{kAdamStep});
  auto numbers = checkpoint.GetNumbers("optimizer");
  numbers.at("due") = 1.0;  // one update is due
  checkpoint.SetNumbers("optimizer", numbers);
}

Update MakeUpdate(const std::string& algorithm, const std::string& options,
                  std::shared_ptr<const Scenario> scenario) {
  const std::string text = kCommon + options;
  const Algorithm& entry = FindAlgorithm(algorithm);
  LocalEnvironment environment(std::move(scenario), {2, entry.observation_types(text), false, 1});
  const auto learner = entry.make(environment.spec(), 3, text);
  Update update;
  update.recurrent = algorithm == "lstm_dqn";
  std::string resolved;
  update.options = DeepOptions::Parse(text, update.recurrent, resolved);
  update.spec = environment.spec();
  const StepResults* results = &environment.Reset(1);
  for (std::size_t moment = 0; moment < kRecordedSteps; ++moment) {
    update.log.push_back(*results);
    update.actions.emplace_back();
    if (moment + 1 == kRecordedSteps) {
      learner->Save(update.before);
      Disturb(update.before);
      learner->Load(update.before);
    }
    learner->Step(*results, update.progress, update.actions.back());
    results = &environment.Step(update.actions.back());
  }
  learner->Save(update.after);
  return update;
}

struct Batch {
  std::vector<TransitionIndex> moments;
  std::vector<double> weights;  // importance weights, the largest is 1
};

// Returns the transitions that the learner draws, from its random stream.
Batch Draw(const Update& update, std::size_t steps, std::size_t group) {
  const auto& spec = update.spec;
  const std::size_t recurrent_state = update.recurrent ? 2 * kHiddenSize : 0;
  Replay<float> replay({static_cast<std::size_t>(update.options.buffer_size),
                        static_cast<std::size_t>(spec.farms) * update.agents(), spec.agents,
                        static_cast<std::size_t>(spec.feature_count), recurrent_state});
  ReplaySampler<float> sampler(replay, update.options, steps, group);
  replay.Load(update.before);
  sampler.Load(update.before);
  const std::vector<float> no_state(recurrent_state * replay.slots());
  replay.Add(update.log.back(), update.log.back().features.data(), no_state.data());
  sampler.Add();
  std::vector<std::uint64_t> position;
  update.before.GetArray("chance", 1, position);
  RandomStream rng({3, 0, RngStream::kLearner, 1});
  rng.Seek(position[0]);
  Batch batch;
  for (std::size_t i = 0; i < static_cast<std::size_t>(update.options.batch_size); ++i) {
    batch.moments.push_back(sampler.Draw(rng, i));
  }
  const std::vector<float>& weights = sampler.ImportanceWeights(update.progress);
  batch.weights.assign(weights.begin(), weights.end());
  return batch;
}

/// One term of a loss: a sample's target y, and the weight of the loss of Σ Q(s, a) − y.
struct Term {
  double target{};
  double weight{};
};

double LossOf(LossKind kind, double error) {
  if (kind == LossKind::kMse) return error * error;
  const double size = std::abs(error);
  return size < 1.0 ? 0.5 * size * size : size - 0.5;  // Huber 1964
}

std::size_t BestOf(const Update& update, const Values& values, std::size_t moment,
                   std::size_t slot) {
  std::size_t best = kActionCount;
  for (std::size_t a = 0; a < kActionCount; ++a) {
    const bool legal = ((update.log[moment].legal[slot] >> a) & 1U) != 0;
    if (update.options.mask_illegal && !legal) continue;
    if (best == kActionCount || values[a] > values[best]) best = a;
  }
  return best;
}

/// Sum of rewards over at most n steps, its last time step, and the discount of the value there.
struct Return {
  double reward{};
  double discount{1.0};
  std::size_t to{};
};

Return SumRewards(const Update& update, std::size_t moment, std::size_t slot, std::size_t steps) {
  Return sum;
  for (std::size_t k = 1; k <= steps; ++k) {
    sum.to = moment + k;
    sum.reward += sum.discount * update.Reward(sum.to, slot);
    sum.discount *= update.options.gamma;
    if (update.Reason(sum.to, slot) == EndReason::kNone) continue;
    if (update.Reason(sum.to, slot) != EndReason::kStepLimit) sum.discount = 0.0;
    break;
  }
  sum.reward *= update.options.reward_scale;
  return sum;
}

/// Compares the learner's update with `terms`; `predict` computes their predictions.
void ExpectUpdate(const Update& update, const std::vector<Term>& terms,
                  const std::function<Values(const Values& parameters)>& predict) {
  const Values online = Doubles(update.before, "weights");
  const auto loss = [&](const Values& parameters) {
    const Values predicted = predict(parameters);
    double sum = 0.0;
    for (std::size_t i = 0; i < terms.size(); ++i) {
      sum += terms[i].weight * LossOf(update.options.loss, predicted[i] - terms[i].target);
    }
    return sum;
  };
  const Values predicted = predict(online);
  double square = 0.0;
  double weights = 0.0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    square += terms[i].weight * std::pow(predicted[i] - terms[i].target, 2);
    weights += terms[i].weight;
  }
  const auto measured = std::get<double>(update.after.GetNumbers("optimizer").at("loss"));
  const double scale = update.options.reward_scale * update.options.reward_scale;
  EXPECT_NEAR(measured, square / weights / scale, 1e-4 * square / weights / scale) << "the loss";

  Values gradient = Differences(online, loss);
  double norm = 0.0;
  for (const double one : gradient) norm += one * one;
  norm = std::sqrt(norm);
  const double limit = update.options.max_grad_norm;
  for (double& one : gradient) one *= limit > 0.0 && norm > limit ? limit / norm : 1.0;
  const Values mean = Doubles(update.before, "adam.mean");
  const Values expected = AdamOracle(online, gradient, mean, Doubles(update.before, "adam.square"),
                                     kAdamStep + 1, 0.01);
  const Values found = Doubles(update.after, "weights");
  const Values found_mean = Doubles(update.after, "adam.mean");
  const Values target = Doubles(update.before, "target_weights");
  const Values found_target = Doubles(update.after, "target_weights");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR((found_mean[i] - 0.9 * mean[i]) / 0.1, gradient[i], 2e-5 * (1.0 + norm))
        << "gradient of parameter " << i;
    ASSERT_NEAR(found[i], expected[i], 2e-6) << "parameter " << i;
    ASSERT_NEAR(found_target[i], kTau * expected[i] + (1.0 - kTau) * target[i], 2e-6)
        << "parameter " << i << " of the target network";
  }
}

// Checks that a batch contains the expected ends of episodes.
void ExpectEnds(const Update& update, const Batch& batch, bool truncates) {
  int ended = 0;
  for (const TransitionIndex& moment : batch.moments) {
    const EndReason reason = update.Reason(moment.age + 1, moment.slot);
    if (reason == EndReason::kNone) continue;
    EXPECT_EQ(reason == EndReason::kStepLimit, truncates);
    ++ended;
  }
  EXPECT_GT(ended, 2) << "of " << batch.moments.size();
}

void ExpectDqn(const std::string& options, bool truncates) {
  SCOPED_TRACE(options + (truncates ? " truncated" : " terminated"));
  const Update update = MakeUpdate("dqn", options, Farm(truncates, 1, false));
  const auto steps = static_cast<std::size_t>(update.options.n_step);
  const Batch batch = Draw(update, steps, 1);
  ExpectEnds(update, batch, truncates);
  const Values online = Doubles(update.before, "weights");
  const Values target = Doubles(update.before, "target_weights");
  std::vector<Term> terms;
  for (std::size_t i = 0; i < batch.moments.size(); ++i) {
    const TransitionIndex& moment = batch.moments[i];
    const Return sum = SumRewards(update, moment.age, moment.slot, steps);
    const Values seen = update.Seen(sum.to, moment.slot);
    const Values values = MlpOracle(target, seen, kHiddenSize);
    const Values chooses =
        update.options.double_dqn ? MlpOracle(online, seen, kHiddenSize) : values;
    const double next = values[BestOf(update, chooses, sum.to, moment.slot)];
    terms.push_back({sum.reward + sum.discount * next,
                     batch.weights[i] / static_cast<double>(batch.moments.size())});
  }
  ExpectUpdate(update, terms, [&](const Values& parameters) {
    Values predicted;
    for (const auto& [age, slot] : batch.moments) {
      predicted.push_back(
          MlpOracle(parameters, update.Seen(age, slot), kHiddenSize)[update.actions[age][slot]]);
    }
    return predicted;
  });
}

TEST(DqnUpdate, IsEquation15) {
  for (const bool truncates : {false, true}) ExpectDqn("preset=paper ", truncates);
}

TEST(DqnUpdate, IsThatOfEachSwitch) {
  const std::string plain = "preset=paper ";
  for (const char* change :
       {"double_dqn=true", "n_step=3", "loss=huber", "max_grad_norm=0.01", "mask_illegal=true",
        "priority_exponent=0.6",
        "double_dqn=true n_step=2 loss=huber mask_illegal=true priority_exponent=0.6"}) {
    for (const bool truncates : {false, true}) ExpectDqn(plain + change, truncates);
  }
}

// VDN: the team's value is the sum of its agents' values (Sunehag et al. 2018).
void ExpectVdn(const std::string& options, bool team) {
  SCOPED_TRACE(options + (team ? " team" : " individual"));
  const Update update = MakeUpdate("vdn", options, Farm(false, 2, team));
  const std::size_t agents = update.agents();
  const Batch batch = Draw(update, 1, agents);
  const Values online = Doubles(update.before, "weights");
  const Values target = Doubles(update.before, "target_weights");
  std::vector<Term> terms;
  for (const auto& [age, first] : batch.moments) {
    Term term{0.0, 1.0 / static_cast<double>(batch.moments.size())};
    for (std::size_t agent = first; agent < first + agents; ++agent) {
      const Return sum = SumRewards(update, age, agent, 1);
      const Values seen = update.Seen(sum.to, agent);
      const Values values = MlpOracle(target, seen, kHiddenSize);
      const Values chooses =
          update.options.double_dqn ? MlpOracle(online, seen, kHiddenSize) : values;
      // A team reward is repeated for each agent.
      term.target += sum.reward / (team ? static_cast<double>(agents) : 1.0) +
                     sum.discount * values[BestOf(update, chooses, sum.to, agent)];
    }
    terms.push_back(term);
  }
  ExpectUpdate(update, terms, [&](const Values& parameters) {
    Values predicted;
    for (const auto& [age, first] : batch.moments) {
      predicted.push_back(0.0);
      for (std::size_t agent = first; agent < first + agents; ++agent) {
        predicted.back() +=
            MlpOracle(parameters, update.Seen(age, agent), kHiddenSize)[update.actions[age][agent]];
      }
    }
    return predicted;
  });
}

TEST(VdnUpdate, FitsTheSumOfTheAgentsValues) {
  for (const bool team : {false, true}) {
    ExpectVdn("preset=paper", team);
    ExpectVdn("preset=paper double_dqn=true mask_illegal=true", team);
  }
}

Memory Empty() { return {Values(kHiddenSize), Values(kHiddenSize)}; }

// Returns the recurrent state of an agent before a time step, computed from the start of its
// episode with the acting network.
Memory CarriedInto(const Update& update, const Values& parameters, std::size_t moment,
                   std::size_t slot) {
  std::size_t first = moment;
  while (!update.IsStarted(first, slot)) --first;
  Memory memory = Empty();
  for (std::size_t m = first; m < moment; ++m) {
    LstmOracle(parameters, update.Seen(m, slot), kHiddenSize, update.options.skip_connection,
               memory);
  }
  return memory;
}

TEST(LstmDqnUpdate, IsAlgorithm2) {
  for (const bool truncates : {false, true}) {
    SCOPED_TRACE(truncates);
    const Update update = MakeUpdate("lstm_dqn", "preset=paper", Farm(truncates, 1, false));
    const Batch batch = Draw(update, 1, 1);
    ExpectEnds(update, batch, truncates);
    const Values online = Doubles(update.before, "weights");
    const Values target = Doubles(update.before, "target_weights");
    std::vector<Term> terms;
    for (const auto& [age, slot] : batch.moments) {
      const Return sum = SumRewards(update, age, slot, 1);
      // Q of the target network at s_{j+1} with the stored c_j and h_j of the agent (line 20).
      Memory carried = CarriedInto(update, online, age + 1, slot);
      const Values values =
          LstmOracle(target, update.Seen(age + 1, slot), kHiddenSize, false, carried);
      terms.push_back({sum.reward + sum.discount * *std::max_element(values.begin(), values.end()),
                       1.0 / static_cast<double>(batch.moments.size())});
    }
    std::vector<Memory> stored;
    for (const auto& [age, slot] : batch.moments) {
      stored.push_back(CarriedInto(update, online, age, slot));
    }
    ExpectUpdate(update, terms, [&](const Values& parameters) {
      Values predicted;
      for (std::size_t i = 0; i < terms.size(); ++i) {
        const auto& [age, slot] = batch.moments[i];
        Memory memory = stored[i];
        predicted.push_back(LstmOracle(parameters, update.Seen(age, slot), kHiddenSize, false,
                                       memory)[update.actions[age][slot]]);
      }
      return predicted;
    });
  }
}

/// A sequence of steps that LSTM-DQN is trained with.
struct Run {
  std::size_t slot{};
  std::size_t warm_from{};  // first time step of the burn-in; `first` without a burn-in
  std::size_t first{};
  std::size_t last{};  // time step after the last one used for training
};

Run RunOf(const Update& update, const TransitionIndex& moment) {
  const auto burn_in = static_cast<std::size_t>(update.options.burn_in);
  Run run{moment.slot, moment.age, moment.age, moment.age};
  while (moment.age - run.warm_from < burn_in && !update.IsStarted(run.warm_from, run.slot)) {
    --run.warm_from;
  }
  // A sequence near the start of its episode begins at that start, with a zero state.
  if (update.IsStarted(run.warm_from, run.slot)) run.first = run.warm_from;
  run.last = run.first;
  while (run.last - run.first < static_cast<std::size_t>(update.options.sequence_length) &&
         run.last + 1 < kRecordedSteps && update.Reason(run.last, run.slot) == EndReason::kNone) {
    ++run.last;
  }
  return run;
}

// Returns the values of a network along a sequence, from the state that the acting network stored.
std::vector<Values> Along(const Update& update, const Run& run, const Values& acting,
                          const Values& warming, const Values& parameters) {
  const bool skip = update.options.skip_connection;
  Memory memory = CarriedInto(update, acting, run.warm_from, run.slot);
  for (std::size_t m = run.warm_from; m < run.first; ++m) {
    LstmOracle(warming, update.Seen(m, run.slot), kHiddenSize, skip, memory);
  }
  std::vector<Values> values;
  for (std::size_t m = run.first; m <= run.last; ++m) {
    values.push_back(LstmOracle(parameters, update.Seen(m, run.slot), kHiddenSize, skip, memory));
  }
  return values;
}

void ExpectSequences(const std::string& options, bool truncates) {
  SCOPED_TRACE(options + (truncates ? " truncated" : " terminated"));
  const Update update = MakeUpdate("lstm_dqn", options, Farm(truncates, 1, false));
  const Batch batch = Draw(update, 1, 1);
  const Values online = Doubles(update.before, "weights");
  const Values target = Doubles(update.before, "target_weights");
  std::vector<Run> runs;
  std::vector<Term> terms;
  double learnt = 0.0;
  for (std::size_t i = 0; i < batch.moments.size(); ++i) {
    const Run run = RunOf(update, batch.moments[i]);
    const auto values = Along(update, run, online, target, target);
    const auto chooses =
        update.options.double_dqn ? Along(update, run, online, online, online) : values;
    for (std::size_t m = run.first; m < run.last; ++m) {
      const std::size_t reach =
          std::min(static_cast<std::size_t>(update.options.n_step), run.last - m);
      const Return sum = SumRewards(update, m, run.slot, reach);
      const std::size_t best = BestOf(update, chooses[sum.to - run.first], sum.to, run.slot);
      terms.push_back(
          {sum.reward + sum.discount * values[sum.to - run.first][best], batch.weights[i]});
      learnt += 1.0;
    }
    runs.push_back(run);
  }
  for (Term& term : terms) term.weight /= learnt;
  ExpectUpdate(update, terms, [&](const Values& parameters) {
    Values predicted;
    for (const Run& run : runs) {
      // The burn-in has no gradient and uses the weights before the update.
      const auto values = Along(update, run, online, online, parameters);
      for (std::size_t m = run.first; m < run.last; ++m) {
        predicted.push_back(values[m - run.first][update.actions[m][run.slot]]);
      }
    }
    return predicted;
  });
}

TEST(LstmDqnUpdate, IsThatOfItsSequences) {
  const std::string plain = "preset=paper replayed=sequences ";
  for (const char* change : {"sequence_length=3 burn_in=0", "sequence_length=3 burn_in=2",
                             "sequence_length=4 burn_in=2 n_step=2",
                             "sequence_length=3 burn_in=1 double_dqn=true mask_illegal=true "
                             "skip_connection=true loss=huber"}) {
    for (const bool truncates : {false, true}) ExpectSequences(plain + change, truncates);
  }
}

}  // namespace
}  // namespace aquafarm::agents::test
