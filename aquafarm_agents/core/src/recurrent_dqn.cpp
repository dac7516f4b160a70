// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <utility>

#include "aquafarm/agents/dqn.h"
#include "aquafarm/agents/replay.h"
#include "aquafarm/check.h"
#include "deep_policy.h"
#include "moment_sampler.h"
#include "value_optimizer.h"

namespace aquafarm::agents {
namespace {

std::shared_ptr<RecurrentNetwork> MakeRecurrent(const EnvironmentSpec& spec,
                                                const DeepOptions& options, std::uint64_t seed) {
  auto network =
      std::make_shared<RecurrentNetwork>(spec.feature_count, options.hidden, options.dueling);
  DrawWeights(*network, seed, 0);
  return network;
}

/// What every agent carries from step to step: h and c, [entries, 2, hidden], zero when an episode
/// begins.
class Carry {
 public:
  Carry(std::size_t entries, std::int64_t hidden)
      : hidden_(hidden), values_(entries * 2 * static_cast<std::size_t>(hidden)) {}

  std::size_t size_of_one() const { return 2 * static_cast<std::size_t>(hidden_); }
  std::vector<float>& values() { return values_; }
  const std::vector<float>& values() const { return values_; }

  void ClearStarted(const Results& results, std::int32_t agents) {
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

  /// h and c of rows [count, 2, hidden].
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

/// One step of all agents: values [entries, kActionCount], the carry moved on.
torch::Tensor StepNetwork(RecurrentNetwork& network, const Results& results, std::int64_t features,
                          Carry& carry, torch::Device device) {
  const auto entries = static_cast<std::int64_t>(results.legal.size());
  RecurrentNetwork::State state = carry.ToState(device);
  const torch::Tensor values = network.Forward(
      Sight<float>::ToInput(results.features.data(), {1, entries, features}, device), state);
  carry.Take(state);
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
        carry_(0, options.hidden) {
    parameters_.FromVector(weights);
  }
  std::uint8_t encodings() const override { return kFeaturesBit; }
  void Begin(std::uint64_t, std::int32_t farms) override {
    carry_ =
        Carry(static_cast<std::size_t>(farms) * static_cast<std::size_t>(agents_), options_.hidden);
  }
  void Act(const Results& results, std::vector<std::uint8_t>& actions) override {
    const torch::NoGradGuard no_grad;
    carry_.ClearStarted(results, agents_);
    const torch::Tensor values = StepNetwork(*network_, results, features_, carry_, device_);
    actions.resize(results.legal.size());
    values_.resize(actions.size());
    const float* row = values.data_ptr<float>();
    const float* seen = results.features.data();
    for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount, seen += features_) {
      const Best best = BestOf(row, Allowed(results.legal[i], seen, options_));
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
  Carry carry_;
};

/// A minibatch of B runs of moments, time first. A run has burn_in moments that warm up the state,
/// then the moments 0 … T whose first T are learnt from while their episode lasts.
struct SequenceBatch {
  std::vector<float> warm_up;         // [burn_in, B, F]
  std::vector<float> observations;    // [T + 1, B, F]
  std::vector<float> carry;           // [B, 2, hidden] before the first moment of warm_up
  std::vector<float> keeps_state;     // [B] 0: the run begins its episode, with an empty state
  std::vector<std::int64_t> actions;  // [T, B]
  std::vector<float> rewards;         // [T, B] summed over the steps to `next`
  std::vector<float> discounts;       // [T, B] of the value at `next`
  std::vector<std::int64_t> next;     // [T, B] moment that the target looks at
  std::vector<float> forbidden;       // [T + 1, B, kActionCount]
  std::vector<float> weights;         // [T, B], summing to 1 at most; 0: not learnt
  std::vector<std::size_t> rows;      // [T, B] of the replay

  SequenceBatch(std::size_t b, std::size_t t, std::size_t burn_in, std::size_t features,
                std::size_t carry_size)
      : warm_up(burn_in * b * features),
        observations((t + 1) * b * features),
        carry(b * carry_size),
        keeps_state(b),
        actions(t * b),
        rewards(t * b),
        discounts(t * b),
        next(t * b),
        forbidden((t + 1) * b * kActionCount),
        weights(t * b),
        rows(t * b) {}
};

class RecurrentDqnLearner final : public Learner {
 public:
  RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
                      std::string resolved);

  std::uint8_t encodings() const override { return kFeaturesBit; }
  std::string options() const override { return resolved_; }
  void Step(const Results& results, double progress, std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override { return optimizer_.status(explorer_.level()); }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<RecurrentPolicy>(spec_, options_, optimizer_.online().ToVector());
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    checkpoint.SetArray("weights", optimizer_.online().ToVector());
  }
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

 private:
  std::size_t batch() const { return static_cast<std::size_t>(options_.batch); }
  std::size_t sequence() const { return static_cast<std::size_t>(options_.sequence); }
  std::size_t burn_in() const { return static_cast<std::size_t>(options_.burn_in); }
  std::size_t features() const { return static_cast<std::size_t>(spec_.feature_count); }
  template <typename T>
  torch::Tensor ToDevice(std::vector<T>& values, std::vector<std::int64_t> shape) const {
    return torch::from_blob(values.data(), shape, torch::CppTypeToScalarType<T>::value).to(device_);
  }
  void Update();
  void Draw();
  void DrawOne(std::size_t b);
  void FillRun(std::size_t b, std::size_t age, std::size_t entry);
  RecurrentNetwork::State WarmState(RecurrentNetwork& network);
  void Reprioritise(const torch::Tensor& errors);

  const EnvironmentSpec spec_;
  const std::uint64_t seed_;
  const DeepOptions options_;
  const std::string resolved_;
  const torch::Device device_;
  std::shared_ptr<RecurrentNetwork> online_;
  std::shared_ptr<RecurrentNetwork> target_;
  ValueOptimizer optimizer_;
  Explorer explorer_;
  RandomStream chance_;
  Carry carry_;
  Replay<float> replay_;
  MomentSampler<float> sampler_;
  double progress_{};
  SequenceBatch batch_;
};

RecurrentDqnLearner::RecurrentDqnLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                         const DeepOptions& options, std::string resolved)
    : spec_(spec),
      seed_(seed),
      options_(options),
      resolved_(std::move(resolved)),
      device_(FindDevice(options.device)),
      online_(MakeRecurrent(spec, options, seed)),
      target_(MakeRecurrent(spec, options, seed)),
      optimizer_(options, *online_, *target_, device_),
      explorer_(options.exploration, seed, EntryCount(spec)),
      chance_({seed, 0, Purpose::kLearner, 1}),
      carry_(EntryCount(spec), options.hidden),
      replay_({static_cast<std::size_t>(options.replay), EntryCount(spec), spec.agents, features(),
               carry_.size_of_one()}),
      sampler_(replay_, options, 1),
      batch_(batch(), sequence(), burn_in(), features(), carry_.size_of_one()) {}

void RecurrentDqnLearner::Step(const Results& results, double progress,
                               std::vector<std::uint8_t>& actions) {
  carry_.ClearStarted(results, spec_.agents);
  progress_ = progress;
  replay_.Add(results, results.features.data(), carry_.values().data());
  sampler_.Remember();
  optimizer_.Count(FarmSteps(results), progress);
  while (optimizer_.TakeDue()) Update();

  explorer_.SetProgress(progress);
  actions.resize(results.legal.size());
  const torch::NoGradGuard no_grad;
  const torch::Tensor values = StepNetwork(*online_, results, spec_.feature_count, carry_, device_);
  const float* row = values.data_ptr<float>();
  const float* seen = results.features.data();
  for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount, seen += features()) {
    const ActionMask allowed = Allowed(results.legal[i], seen, options_);
    actions[i] = explorer_.Choose(row, allowed, BestOf(row, allowed), i);
  }
  replay_.SetActions(actions);
}

// Draws a moment to learn from, and where to warm up the state before it: at most burn_in moments
// back, with the state stored there. A run never crosses an episode: near its beginning it starts
// there, with the empty state that is exact.
void RecurrentDqnLearner::DrawOne(std::size_t b) {
  const auto [age, entry] = sampler_.Draw(chance_, b);
  std::size_t back = 0;
  while (back < burn_in() && back < age && !replay_.started(replay_.Row(age - back, entry))) ++back;
  const bool at_start = replay_.started(replay_.Row(age - back, entry));
  // Full burn-in, or from the episode's first moment; what the ring has dropped cannot warm up.
  const bool warms_up = back == burn_in() && !at_start;
  const std::size_t first = warms_up ? age : age - back;
  const std::size_t from = warms_up ? age - burn_in() : first;
  const bool empty = !warms_up && at_start;
  batch_.keeps_state[b] = empty ? 0.0F : 1.0F;
  for (std::size_t t = 0; t < burn_in(); ++t) {
    const std::size_t row = replay_.Row(warms_up ? from + t : first, entry);
    std::copy_n(replay_.observation(row), features(),
                batch_.warm_up.data() + (t * batch() + b) * features());
  }
  std::copy_n(replay_.carry(replay_.Row(from, entry)), carry_.size_of_one(),
              batch_.carry.data() + b * carry_.size_of_one());
  FillRun(b, first, entry);
}

void RecurrentDqnLearner::FillRun(std::size_t b, std::size_t age, std::size_t entry) {
  const std::size_t steps = sequence();
  std::size_t last = 0;  // moment at which the run ends
  while (last < steps && replay_.Begins(age + last, entry, 1)) ++last;
  for (std::size_t t = 0; t <= steps; ++t) {
    const std::size_t row = replay_.Row(age + std::min(t, last), entry);
    std::copy_n(replay_.observation(row), features(),
                batch_.observations.data() + (t * batch() + b) * features());
    const ActionMask allowed = Allowed(replay_.legal(row), replay_.observation(row), options_);
    MarkForbidden(allowed, batch_.forbidden.data() + (t * batch() + b) * kActionCount);
  }
  for (std::size_t t = 0; t < steps; ++t) {
    const std::size_t i = t * batch() + b;
    const bool is_learnt = t < last;
    batch_.rows[i] = replay_.Row(age + std::min(t, last), entry);
    batch_.weights[i] = is_learnt ? 1.0F : 0.0F;
    batch_.actions[i] = 0;
    batch_.rewards[i] = batch_.discounts[i] = 0.0F;
    batch_.next[i] = static_cast<std::int64_t>(last);
    if (!is_learnt) continue;
    const std::size_t reach = std::min(static_cast<std::size_t>(options_.n_step), last - t);
    const Transition one = replay_.At(age + t, entry, reach, static_cast<float>(options_.discount));
    batch_.actions[i] = one.action;
    batch_.rewards[i] = one.reward * static_cast<float>(options_.reward_scale);
    batch_.discounts[i] = one.discount;
    batch_.next[i] = static_cast<std::int64_t>(t + reach);
  }
}

void RecurrentDqnLearner::Draw() {
  for (std::size_t b = 0; b < batch(); ++b) DrawOne(b);
  const std::vector<float>& importance = sampler_.Weigh(progress_);
  float sum = 0.0F;
  for (std::size_t i = 0; i < batch_.weights.size(); ++i) {
    sum += batch_.weights[i];
    batch_.weights[i] *= importance[i % batch()];
  }
  for (float& weight : batch_.weights) weight /= sum;
}

RecurrentNetwork::State RecurrentDqnLearner::WarmState(RecurrentNetwork& network) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<std::int64_t>(batch());
  RecurrentNetwork::State state =
      Carry::StateOf(batch_.carry.data(), count, options_.hidden, device_);
  if (burn_in() == 0) return state;
  network.WarmUp(ToDevice(batch_.warm_up, {options_.burn_in, count, spec_.feature_count}), state);
  const torch::Tensor keeps = ToDevice(batch_.keeps_state, {1, count, 1});
  return {state.first * keeps, state.second * keeps};
}

void RecurrentDqnLearner::Update() {
  if (replay_.size() < 2 + burn_in() + sequence() || !sampler_.IsReady()) return;
  const BatchOrigin origin{seed_, chance_.position()};
  Draw();
  const auto count = static_cast<std::int64_t>(batch());
  const std::int64_t steps = options_.sequence;
  const torch::Tensor observations =
      ToDevice(batch_.observations, {steps + 1, count, spec_.feature_count});
  RecurrentNetwork::State state = WarmState(*online_);
  const torch::Tensor values = online_->Forward(observations, state);
  torch::Tensor targets;
  {
    const torch::NoGradGuard no_grad;
    RecurrentNetwork::State target_state = WarmState(*target_);
    torch::Tensor next = target_->Forward(observations, target_state);
    const torch::Tensor forbidden = ToDevice(batch_.forbidden, {steps + 1, count, kActionCount});
    next =
        options_.double_q
            ? next.gather(2, (values.detach() + forbidden).argmax(2, /*keepdim=*/true)).squeeze(2)
            : (next + forbidden).amax(2);
    next = next.gather(0, ToDevice(batch_.next, {steps, count}));
    targets = ToDevice(batch_.rewards, {steps, count}) +
              ToDevice(batch_.discounts, {steps, count}) * next;
  }
  const torch::Tensor predicted =
      values.narrow(0, 0, steps).gather(2, ToDevice(batch_.actions, {steps, count, 1})).squeeze(2);
  optimizer_.Update(predicted, targets, ToDevice(batch_.weights, {steps, count}), origin);
  if (options_.priority > 0.0) Reprioritise((predicted.detach() - targets).abs());
}

// Each step of a run by its own error. (R2D2 has one priority a sequence, which is fixed there.)
void RecurrentDqnLearner::Reprioritise(const torch::Tensor& errors) {
  const torch::Tensor values = errors.cpu().contiguous();
  const float* const error = values.data_ptr<float>();
  for (std::size_t i = 0; i < batch_.rows.size(); ++i) {
    if (batch_.weights[i] > 0.0F) sampler_.SetError(batch_.rows[i], error[i]);
  }
}

void RecurrentDqnLearner::Save(Checkpoint& checkpoint) const {
  optimizer_.Save(checkpoint);
  replay_.Save(checkpoint);
  sampler_.Save(checkpoint);
  checkpoint.SetArray("streams", explorer_.positions());
  checkpoint.SetArray("chance", std::vector<std::uint64_t>{chance_.position()});
  checkpoint.SetArray("carry", carry_.values());
}

void RecurrentDqnLearner::Load(const Checkpoint& checkpoint) {
  std::vector<std::uint64_t> positions;
  std::vector<std::uint64_t> chance;
  std::vector<float> carry;
  checkpoint.GetArray("streams", EntryCount(spec_), positions);
  checkpoint.GetArray("chance", 1, chance);
  checkpoint.GetArray("carry", carry_.values().size(), carry);
  optimizer_.Load(checkpoint);
  replay_.Load(checkpoint);
  sampler_.Load(checkpoint);
  explorer_.Seek(positions);
  chance_.Seek(chance[0]);
  carry_.values() = std::move(carry);
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
  const DeepOptions options = Parse(checkpoint.options, resolved);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, NetworkKind::kMlp);
  std::vector<float> weights;
  checkpoint.GetArray("weights", checkpoint.Section("weights").size() / sizeof(float), weights);
  return std::make_unique<RecurrentPolicy>(spec, options, weights);
}

}  // namespace aquafarm::agents
