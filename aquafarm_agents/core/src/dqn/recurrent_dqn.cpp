// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/agents/dqn/dqn.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "dqn/q_learner.h"
#include "networks/sequence_batch.h"
#include "networks/value_network.h"

namespace aquafarm::agents {
namespace {

std::shared_ptr<RecurrentNetwork> MakeRecurrent(const EnvironmentSpec& spec,
                                                const DeepOptions& options, std::uint64_t seed) {
  auto network = std::make_shared<RecurrentNetwork>(spec.feature_count, options.hidden_size,
                                                    options.dueling, options.skip_connection);
  DrawWeights(*network, seed, 0);
  return network;
}

/// Recurrent state of every agent: h and c, [slots, 2, hidden], zero at the start of an episode.
class RecurrentState {
 public:
  RecurrentState(std::size_t slots, std::int64_t hidden)
      : hidden_(hidden), values_(slots * 2 * static_cast<std::size_t>(hidden)) {}

  std::size_t size_of_one() const { return 2 * static_cast<std::size_t>(hidden_); }
  std::vector<float>& values() { return values_; }
  const std::vector<float>& values() const { return values_; }

  void ClearStarted(const StepResults& results, std::int32_t agents) {
    const std::size_t of_farm = static_cast<std::size_t>(agents) * size_of_one();
    for (std::size_t farm = 0; farm < results.is_first.size(); ++farm) {
      if (results.is_first[farm] == 0) continue;
      const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(farm * of_farm);
      std::fill_n(begin, of_farm, 0.0F);
    }
  }

 private:
  std::int64_t hidden_;
  std::vector<float> values_;
};

class RecurrentPolicy final : public Policy {
 public:
  RecurrentPolicy(const EnvironmentSpec& spec, const DeepOptions& options,
                  const std::vector<float>& weights)
      : agents_(spec.agents),
        features_(spec.feature_count),
        options_(options),
        network_(MakeRecurrent(spec, options, 0)),
        parameters_(*network_, FindDevice(options.device)),
        computed_(MakeRecurrentValueNetwork(spec, options, network_, parameters_, Learns::kNo)),
        recurrent_state_(0, options.hidden_size) {
    parameters_.FromVector(weights);
  }
  std::uint8_t observation_types() const override { return kFeaturesBit; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    recurrent_state_ = RecurrentState(
        static_cast<std::size_t>(farms) * static_cast<std::size_t>(agents_), options_.hidden_size);
  }
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    recurrent_state_.ClearStarted(results, agents_);
    actions.resize(results.legal.size());
    values_.resize(actions.size());
    const float* row = computed_->Forward(1, actions.size(), results.features.data(),
                                          recurrent_state_.values().data());
    const float* seen = results.features.data();
    for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount, seen += features_) {
      const Best best = BestOf(row, LegalMask(results.legal[i], seen, options_));
      actions[i] = best.action;
      values_[i] = best.value / static_cast<float>(options_.reward_scale);
    }
  }

 private:
  std::int32_t agents_;
  std::int64_t features_;
  DeepOptions options_;
  std::shared_ptr<RecurrentNetwork> network_;
  FlatParameters parameters_;
  std::unique_ptr<RecurrentValueNetwork> computed_;
  RecurrentState recurrent_state_;
};

class RecurrentDqnLearner final : public QLearner<float, RecurrentNetwork> {
 public:
  RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
                      std::string resolved);

  std::uint8_t observation_types() const override { return kFeaturesBit; }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<RecurrentPolicy>(spec_, options_, optimizer_.acting().ToVector());
  }

 private:
  std::size_t features() const { return static_cast<std::size_t>(spec_.feature_count); }
  const float* RecurrentStates(const StepResults& results) override;
  bool CanSample() const override;
  const float* ActingValues(const StepResults& results) override {
    auto& network = average_values_ ? *average_values_ : *online_values_;
    return network.Forward(1, results.legal.size(), results.features.data(),
                           recurrent_state_.values().data());
  }
  void SaveOwn(Checkpoint& checkpoint) const override;
  void LoadOwn(const Checkpoint& checkpoint) override;
  void Update() override;
  void Draw();
  const float* ValuesAlong(RecurrentValueNetwork& network);
  void SetTargets(const float* values);
  void Reprioritise();

  RecurrentState recurrent_state_;
  const std::unique_ptr<RecurrentValueNetwork> online_values_;
  const std::unique_ptr<RecurrentValueNetwork> target_values_;
  const std::unique_ptr<RecurrentValueNetwork> average_values_;  // null without a moving average
  SequenceBatch batch_;
  std::vector<float> state_;      // for Forward, [B, 2, hidden]; with paper_tuple [2, B, 2, hidden]
  std::vector<float> predicted_;  // [T, B]
  std::vector<float> targets_;    // [T, B]
  std::vector<float> slopes_;     // [T, B] d loss / d predicted
};

RecurrentDqnLearner::RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const DeepOptions& options, std::string resolved)
    : QLearner(spec, seed, options, std::move(resolved),
               [&] { return MakeRecurrent(spec, options, seed); },
               {static_cast<std::size_t>(spec.feature_count),
                2 * static_cast<std::size_t>(options.hidden_size), 1, 1}),
      recurrent_state_(SlotCount(spec), options.hidden_size),
      online_values_(
          MakeRecurrentValueNetwork(spec, options, online_, optimizer_.online(), Learns::kYes)),
      target_values_(
          MakeRecurrentValueNetwork(spec, options, target_, optimizer_.target(), Learns::kNo)),
      average_values_(optimizer_.average() == nullptr
                          ? nullptr
                          : MakeRecurrentValueNetwork(spec, options, average_,
                                                      *optimizer_.average(), Learns::kNo)),
      batch_(options, features(), recurrent_state_.size_of_one()),
      predicted_(batch_.weights.size()),
      targets_(batch_.weights.size()),
      slopes_(batch_.weights.size()) {}

const float* RecurrentDqnLearner::RecurrentStates(const StepResults& results) {
  recurrent_state_.ClearStarted(results, spec_.agents);
  return recurrent_state_.values().data();
}

bool RecurrentDqnLearner::CanSample() const {
  return replay_.size() >=
         2 + static_cast<std::size_t>(options_.burn_in + options_.sequence_length);
}

void RecurrentDqnLearner::Draw() {
  for (std::size_t b = 0; b < batch_.size(); ++b) {
    batch_.Fill(b, replay_, sampler_.Draw(rng_, b), options_);
  }
  const std::vector<float>& importance = sampler_.ImportanceWeights(progress_);
  float sum = 0.0F;
  for (std::size_t i = 0; i < batch_.weights.size(); ++i) {
    sum += batch_.weights[i];
    batch_.weights[i] *= importance[i % batch_.size()];
  }
  for (float& weight : batch_.weights) weight /= sum;
}

// Returns the values at all time steps of the batch, [T + 1, B, kActionCount]. A sequence is
// evaluated from the recurrent state at its beginning. With paper_tuple, a sequence is a single
// transition (T = 1). Each of its two observations is evaluated with the recurrent state stored for
// it (Algorithm 2), so that the network evaluates 2 B rows in one time step.
const float* RecurrentDqnLearner::ValuesAlong(RecurrentValueNetwork& network) {
  state_ = batch_.recurrent_state;
  if (options_.paper_tuple) {
    state_.insert(state_.end(), batch_.recurrent_state_after.begin(),
                  batch_.recurrent_state_after.end());
    return network.Forward(1, 2 * batch_.size(), batch_.observations.data(), state_.data());
  }
  if (options_.burn_in > 0) {
    network.WarmUp(static_cast<std::size_t>(options_.burn_in), batch_.size(), batch_.warm_up.data(),
                   state_.data());
    const std::size_t of_one = recurrent_state_.size_of_one();
    for (std::size_t b = 0; b < batch_.size(); ++b) {
      if (batch_.warms_up[b] > 0.0F) continue;
      std::copy_n(batch_.recurrent_state.data() + b * of_one, of_one, state_.data() + b * of_one);
    }
  }
  return network.Forward(static_cast<std::size_t>(options_.sequence_length) + 1, batch_.size(),
                         batch_.observations.data(), state_.data());
}

// Computes the targets: line 20 of Algorithm 2. @param values ValuesAlong of the online network
void RecurrentDqnLearner::SetTargets(const float* values) {
  const float* const target = ValuesAlong(*target_values_);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    targets_[i] = batch_.rewards[i];
    if (batch_.weights[i] == 0.0F) continue;  // the episode has ended
    if (batch_.discounts[i] > 0.0F) {
      const std::size_t next =
          static_cast<std::size_t>(batch_.next[i]) * batch_.size() + i % batch_.size();
      const float* const chooses = (options_.double_dqn ? values : target) + next * kActionCount;
      const Best best = BestOf(chooses, batch_.allowed[next]);
      targets_[i] += batch_.discounts[i] * target[next * kActionCount + best.action];
    }
    if (options_.action_gap > 0.0) {
      targets_[i] -= static_cast<float>(options_.action_gap) *
                     AdvantageGap(target + i * kActionCount, batch_.allowed[i], batch_.actions[i]);
    }
  }
}

void RecurrentDqnLearner::Update() {
  const BatchOrigin origin{seed_, rng_.position()};
  Draw();
  const float* const values = ValuesAlong(*online_values_);
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    predicted_[i] = values[i * kActionCount + batch_.actions[i]];
  }
  SetTargets(values);
  optimizer_.Differentiate(predicted_.size(), predicted_.data(), targets_.data(),
                           batch_.weights.data(), slopes_.data(), origin);
  SpreadSlopes(slopes_, batch_.actions);
  online_values_->Backward(slopes_.size(), value_slopes_.data());
  optimizer_.Learn(origin);
  if (options_.priority_exponent > 0.0) Reprioritise();
}

// Each step of a sequence gets its own priority. (R2D2 has one priority per sequence.)
void RecurrentDqnLearner::Reprioritise() {
  for (std::size_t i = 0; i < batch_.rows.size(); ++i) {
    if (batch_.weights[i] == 0.0F) continue;
    sampler_.UpdatePriority(batch_.rows[i], std::abs(predicted_[i] - targets_[i]));
  }
}

void RecurrentDqnLearner::SaveOwn(Checkpoint& checkpoint) const {
  QLearner::SaveOwn(checkpoint);
  checkpoint.SetArray("carry", recurrent_state_.values());
}

void RecurrentDqnLearner::LoadOwn(const Checkpoint& checkpoint) {
  std::vector<float> recurrent_state;
  checkpoint.GetArray("carry", recurrent_state_.values().size(), recurrent_state);
  QLearner::LoadOwn(checkpoint);
  recurrent_state_.values() = std::move(recurrent_state);
}

DeepOptions ParseRecurrent(const std::string& text, std::string& resolved) {
  return DeepOptions::Parse(text, /*recurrent=*/true, resolved);
}

}  // namespace

std::uint8_t RecurrentDqnObservationTypes(const std::string& options) {
  std::string resolved;
  ParseRecurrent(options, resolved);
  return kFeaturesBit;
}

std::unique_ptr<Learner> MakeRecurrentDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                          const std::string& text) {
  std::string resolved;
  const DeepOptions options = ParseRecurrent(text, resolved);
  PrepareTorch(options.threads);
  return std::make_unique<RecurrentDqnLearner>(spec, seed, options, resolved);
}

std::unique_ptr<Policy> MakeRecurrentDqnPolicy(const Checkpoint& checkpoint,
                                               const EnvironmentSpec& spec) {
  std::string resolved;
  DeepOptions options = ParseRecurrent(checkpoint.options, resolved);
  options.device = PlayingDevice(options.device);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, NetworkKind::kMlp);
  return std::make_unique<RecurrentPolicy>(spec, options, ActingWeights(checkpoint));
}

}  // namespace aquafarm::agents
