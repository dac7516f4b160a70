// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/agents/dqn/dqn.h"
#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/base/check.h"
#include "dqn/q_learner.h"
#include "networks/sequence_batch.h"

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
  RecurrentState(std::size_t entries, std::int64_t hidden)
      : hidden_(hidden), values_(entries * 2 * static_cast<std::size_t>(hidden)) {}

  std::size_t size_of_one() const { return 2 * static_cast<std::size_t>(hidden_); }
  std::vector<float>& values() { return values_; }
  const std::vector<float>& values() const { return values_; }

  void ClearStarted(const StepResults& results, std::int32_t agents) {
    const std::size_t of_farm = static_cast<std::size_t>(agents) * size_of_one();
    for (std::size_t farm = 0; farm < results.started.size(); ++farm) {
      if (results.started[farm] == 0) continue;
      const auto begin = values_.begin() + static_cast<std::ptrdiff_t>(farm * of_farm);
      std::fill_n(begin, of_farm, 0.0F);
    }
  }

  RecurrentNetwork::State ToState(torch::Device device) {
    return StateOf(values_.data(), static_cast<std::int64_t>(values_.size() / size_of_one()),
                   hidden_, device);
  }
  void Take(const RecurrentNetwork::State& state) {
    const torch::Tensor both =
        torch::stack({state.first.squeeze(0), state.second.squeeze(0)}, 1).cpu();
    std::copy_n(both.data_ptr<float>(), values_.size(), values_.data());
  }

  /// Returns h and c of rows [count, 2, hidden].
  static RecurrentNetwork::State StateOf(float* rows, std::int64_t count, std::int64_t hidden,
                                         torch::Device device) {
    const torch::Tensor both = torch::from_blob(rows, {count, 2, hidden}).to(device);
    return {both.select(1, 0).unsqueeze(0).contiguous(),
            both.select(1, 1).unsqueeze(0).contiguous()};
  }

 private:
  std::int64_t hidden_;
  std::vector<float> values_;
};

/// Steps all agents: returns values [slots, kActionCount] and updates the recurrent states.
torch::Tensor StepNetwork(RecurrentNetwork& network, const StepResults& results,
                          std::int64_t features, RecurrentState& recurrent_state,
                          torch::Device device) {
  const auto entries = static_cast<std::int64_t>(results.legal.size());
  RecurrentNetwork::State state = recurrent_state.ToState(device);
  const torch::Tensor values = network.Forward(
      ObservationTraits<float>::ToInput(results.features.data(), {1, entries, features}, device),
      state);
  recurrent_state.Take(state);
  return values.squeeze(0).cpu().contiguous();
}

class RecurrentPolicy final : public Policy {
 public:
  RecurrentPolicy(const EnvironmentSpec& spec, const DeepOptions& options,
                  const std::vector<float>& weights)
      : device_(FindDevice(options.device)),
        agents_(spec.agents),
        features_(spec.feature_count),
        options_(options),
        network_(MakeRecurrent(spec, options, 0)),
        parameters_(*network_, device_),
        recurrent_state_(0, options.hidden_size) {
    parameters_.FromVector(weights);
  }
  std::uint8_t encodings() const override { return kFeaturesBit; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    recurrent_state_ = RecurrentState(
        static_cast<std::size_t>(farms) * static_cast<std::size_t>(agents_), options_.hidden_size);
  }
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    const torch::NoGradGuard no_grad;
    recurrent_state_.ClearStarted(results, agents_);
    const torch::Tensor values =
        StepNetwork(*network_, results, features_, recurrent_state_, device_);
    actions.resize(results.legal.size());
    values_.resize(actions.size());
    const float* row = values.data_ptr<float>();
    const float* seen = results.features.data();
    for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount, seen += features_) {
      const Best best = BestOf(row, LegalMask(results.legal[i], seen, options_));
      actions[i] = best.action;
      values_[i] = best.value;
    }
  }

 private:
  torch::Device device_;
  std::int32_t agents_;
  std::int64_t features_;
  DeepOptions options_;
  std::shared_ptr<RecurrentNetwork> network_;
  FlatParameters parameters_;
  RecurrentState recurrent_state_;
};

class RecurrentDqnLearner final : public QLearner<float, RecurrentNetwork> {
 public:
  RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
                      std::string resolved);

  std::uint8_t encodings() const override { return kFeaturesBit; }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<RecurrentPolicy>(spec_, options_, optimizer_.acting().ToVector());
  }

 private:
  std::size_t features() const { return static_cast<std::size_t>(spec_.feature_count); }
  const float* RecurrentStates(const StepResults& results) override;
  bool CanSample() const override;
  torch::Tensor ActingValues(const StepResults& results) override;
  void SaveOwn(Checkpoint& checkpoint) const override;
  void LoadOwn(const Checkpoint& checkpoint) override;
  void Update() override;
  void Draw();
  RecurrentNetwork::State WarmState(RecurrentNetwork& network);
  torch::Tensor ValuesAlong(RecurrentNetwork& network, const torch::Tensor& observations);
  torch::Tensor Targets(const torch::Tensor& observations, const torch::Tensor& actions,
                        const torch::Tensor& values);
  void Reprioritise(const torch::Tensor& errors);

  RecurrentState recurrent_state_;
  SequenceBatch batch_;
};

RecurrentDqnLearner::RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const DeepOptions& options, std::string resolved)
    : QLearner(spec, seed, options, std::move(resolved),
               [&] { return MakeRecurrent(spec, options, seed); },
               {static_cast<std::size_t>(spec.feature_count),
                2 * static_cast<std::size_t>(options.hidden_size), 1, 1}),
      recurrent_state_(EntryCount(spec), options.hidden_size),
      batch_(options, features(), recurrent_state_.size_of_one()) {}

const float* RecurrentDqnLearner::RecurrentStates(const StepResults& results) {
  recurrent_state_.ClearStarted(results, spec_.agents);
  return recurrent_state_.values().data();
}

torch::Tensor RecurrentDqnLearner::ActingValues(const StepResults& results) {
  const torch::NoGradGuard no_grad;
  return StepNetwork(*acting_, results, spec_.feature_count, recurrent_state_, device_);
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

RecurrentNetwork::State RecurrentDqnLearner::WarmState(RecurrentNetwork& network) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<std::int64_t>(batch_.size());
  RecurrentNetwork::State state =
      RecurrentState::StateOf(batch_.recurrent_state.data(), count, options_.hidden_size, device_);
  if (options_.burn_in == 0) return state;
  const RecurrentNetwork::State stored = state;
  network.WarmUp(ToDevice(batch_.warm_up, {options_.burn_in, count, spec_.feature_count}), state);
  const torch::Tensor warms_up = ToDevice(batch_.warms_up, {1, count, 1}) > 0.0F;
  return {torch::where(warms_up, state.first, stored.first),
          torch::where(warms_up, state.second, stored.second)};
}

// Returns [T + 1, B, kActionCount]. Algorithm 2 evaluates both ends of a tuple with the state
// stored there. A sequence is evaluated from the state at its beginning.
torch::Tensor RecurrentDqnLearner::ValuesAlong(RecurrentNetwork& network,
                                               const torch::Tensor& observations) {
  RecurrentNetwork::State state = WarmState(network);
  if (!options_.paper_tuple) return network.Forward(observations, state);
  const torch::Tensor before = network.Forward(observations.narrow(0, 0, 1), state);
  RecurrentNetwork::State after = RecurrentState::StateOf(batch_.recurrent_state_after.data(),
                                                          static_cast<std::int64_t>(batch_.size()),
                                                          options_.hidden_size, device_);
  return torch::cat({before, network.Forward(observations.narrow(0, 1, 1), after)});
}

// Returns [T, B] of Algorithm 2, line 20. `values` are those of the online network.
torch::Tensor RecurrentDqnLearner::Targets(const torch::Tensor& observations,
                                           const torch::Tensor& actions,
                                           const torch::Tensor& values) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<std::int64_t>(batch_.size());
  const std::int64_t steps = options_.sequence_length;
  const torch::Tensor told = ValuesAlong(*target_, observations);
  const torch::Tensor forbidden = ToDevice(batch_.forbidden, {steps + 1, count, kActionCount});
  torch::Tensor next =
      options_.double_dqn
          ? told.gather(2, (values.detach() + forbidden).argmax(2, /*keepdim=*/true)).squeeze(2)
          : (told + forbidden).amax(2);
  next = next.gather(0, ToDevice(batch_.next, {steps, count}));
  torch::Tensor targets =
      ToDevice(batch_.rewards, {steps, count}) + ToDevice(batch_.discounts, {steps, count}) * next;
  if (options_.action_gap > 0.0) {
    targets -= options_.action_gap *
               AdvantageGap(told.narrow(0, 0, steps), forbidden.narrow(0, 0, steps), actions);
  }
  return targets;
}

void RecurrentDqnLearner::Update() {
  const BatchOrigin origin{seed_, rng_.position()};
  Draw();
  const auto count = static_cast<std::int64_t>(batch_.size());
  const std::int64_t steps = options_.sequence_length;
  const torch::Tensor observations =
      ToDevice(batch_.observations, {steps + 1, count, spec_.feature_count});
  const torch::Tensor actions = ToDevice(batch_.actions, {steps, count, 1});
  const torch::Tensor values = ValuesAlong(*online_, observations);
  const torch::Tensor targets = Targets(observations, actions, values);
  const torch::Tensor predicted = values.narrow(0, 0, steps).gather(2, actions).squeeze(2);
  optimizer_.Update(predicted, targets, ToDevice(batch_.weights, {steps, count}), origin);
  if (options_.priority_exponent > 0.0) Reprioritise((predicted.detach() - targets).abs());
}

// Each step of a sequence gets its own priority. (R2D2 has one priority per sequence.)
void RecurrentDqnLearner::Reprioritise(const torch::Tensor& errors) {
  const torch::Tensor values = errors.cpu().contiguous();
  const float* const error = values.data_ptr<float>();
  for (std::size_t i = 0; i < batch_.rows.size(); ++i) {
    if (batch_.weights[i] > 0.0F) sampler_.UpdatePriority(batch_.rows[i], error[i]);
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

DeepOptions Parse(const std::string& text, std::string& resolved) {
  return DeepOptions::Parse(text, /*recurrent=*/true, resolved);
}

}  // namespace

std::uint8_t RecurrentDqnEncodings(const std::string& options) {
  std::string resolved;
  Parse(options, resolved);
  return kFeaturesBit;
}

std::unique_ptr<Learner> MakeRecurrentDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                          const std::string& text) {
  std::string resolved;
  const DeepOptions options = Parse(text, resolved);
  PrepareTorch(options.threads);
  return std::make_unique<RecurrentDqnLearner>(spec, seed, options, resolved);
}

std::unique_ptr<Policy> MakeRecurrentDqnPolicy(const Checkpoint& checkpoint,
                                               const EnvironmentSpec& spec) {
  std::string resolved;
  DeepOptions options = Parse(checkpoint.options, resolved);
  options.device = PlayingDevice(options.device);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, NetworkKind::kMlp);
  return std::make_unique<RecurrentPolicy>(spec, options, ActingWeights(checkpoint));
}

}  // namespace aquafarm::agents
