// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/dqn.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "aquafarm/agents/replay.h"
#include "aquafarm/check.h"
#include "deep_policy.h"
#include "value_optimizer.h"

namespace aquafarm::agents {
namespace {

constexpr float kSmallestPriority = 1e-4F;

/// Plays the best action of a network.
template <typename Scalar>
class GreedyDqnPolicy final : public Policy {
 public:
  GreedyDqnPolicy(const EnvironmentSpec& spec, const DeepOptions& options,
                  const std::vector<float>& weights)
      : device_(FindDevice(options.device)),
        shape_(Sight<Scalar>::Shape(spec)),
        bits_(options.network == NetworkKind::kCnn ? kPlanesBit : kFeaturesBit),
        mask_illegal_(options.mask_illegal),
        network_(MakeNetwork(spec, options, 0)),
        parameters_(*network_, device_) {
    parameters_.FromVector(weights);
  }
  std::uint8_t encodings() const override { return bits_; }
  void Begin(std::uint64_t, std::int32_t) override {}
  void Act(const Results& results, std::vector<std::uint8_t>& actions) override {
    const torch::InferenceMode inference;
    actions.resize(results.legal.size());
    const torch::Tensor values =
        network_
            ->Forward(Sight<Scalar>::ToInput(Sight<Scalar>::Of(results),
                                             WithCount(actions.size(), shape_), device_))
            .cpu();
    const float* row = values.data_ptr<float>();
    for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount) {
      actions[i] = BestOf(row, Allowed(results.legal[i], mask_illegal_)).action;
    }
  }

 private:
  torch::Device device_;
  std::vector<std::int64_t> shape_;
  std::uint8_t bits_;
  bool mask_illegal_;
  std::shared_ptr<QNetwork> network_;
  FlatParameters parameters_;
};

/// A minibatch on its way from the replay to the network.
template <typename Scalar>
struct Batch {
  std::vector<Scalar> from;
  std::vector<Scalar> to;
  std::vector<std::int64_t> actions;
  std::vector<float> rewards;
  std::vector<float> discounts;
  std::vector<float> forbidden;  // [B, kActionCount] by MarkForbidden, of the next actions
  std::vector<float> weights;
  std::vector<std::size_t> rows;

  Batch(std::size_t size, std::size_t observation_size)
      : from(size * observation_size),
        to(size * observation_size),
        actions(size),
        rewards(size),
        discounts(size),
        forbidden(size * kActionCount),
        weights(size, 1.0F / static_cast<float>(size)),
        rows(size) {}
};

template <typename Scalar>
class DqnLearner final : public Learner {
 public:
  DqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
             std::string resolved);

  std::uint8_t encodings() const override {
    return options_.network == NetworkKind::kCnn ? kPlanesBit : kFeaturesBit;
  }
  std::string options() const override { return resolved_; }
  void Step(const Results& results, double progress, std::vector<std::uint8_t>& actions) override;
  LearnerStatus status() const override { return optimizer_.status(explorer_.level()); }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<GreedyDqnPolicy<Scalar>>(spec_, options_,
                                                     optimizer_.online().ToVector());
  }
  void SavePolicy(Checkpoint& checkpoint) const override {
    checkpoint.SetArray("weights", optimizer_.online().ToVector());
  }
  void Save(Checkpoint& checkpoint) const override;
  void Load(const Checkpoint& checkpoint) override;

 private:
  std::size_t size() const { return static_cast<std::size_t>(options_.batch); }
  bool is_prioritised() const { return options_.priority > 0.0; }
  torch::Tensor ToInput(const Scalar* rows, std::size_t count) const {
    return Sight<Scalar>::ToInput(rows, WithCount(count, shape_), device_);
  }
  template <typename T>
  torch::Tensor ToDevice(std::vector<T>& values, std::vector<std::int64_t> shape) const {
    return torch::from_blob(values.data(), shape, torch::CppTypeToScalarType<T>::value).to(device_);
  }
  void Choose(const Results& results, std::vector<std::uint8_t>& actions);
  void Remember(const Results& results);
  void Update();
  bool Draw();
  std::pair<std::size_t, std::size_t> DrawUniform();  // age, entry
  std::pair<std::size_t, std::size_t> DrawByPriority(std::size_t i);
  void WeighImportance();
  torch::Tensor Targets();
  void Reprioritise(const torch::Tensor& errors);

  const EnvironmentSpec spec_;
  const std::uint64_t seed_;
  const DeepOptions options_;
  const std::string resolved_;
  const torch::Device device_;
  const std::vector<std::int64_t> shape_;
  const std::size_t observation_size_;
  std::shared_ptr<QNetwork> online_;
  std::shared_ptr<QNetwork> target_;
  ValueOptimizer optimizer_;
  Explorer explorer_;
  RandomStream chance_;
  Replay<Scalar> replay_;
  std::unique_ptr<SumTree> priorities_;  // by row of the replay; null: uniform
  float largest_priority_{1.0F};
  double progress_{};
  Batch<Scalar> batch_;
};

template <typename Scalar>
DqnLearner<Scalar>::DqnLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                               const DeepOptions& options, std::string resolved)
    : spec_(spec),
      seed_(seed),
      options_(options),
      resolved_(std::move(resolved)),
      device_(FindDevice(options.device)),
      shape_(Sight<Scalar>::Shape(spec)),
      observation_size_(static_cast<std::size_t>(
          std::accumulate(shape_.begin(), shape_.end(), std::int64_t{1}, std::multiplies<>()))),
      online_(MakeNetwork(spec, options, seed)),
      target_(MakeNetwork(spec, options, seed)),
      optimizer_(options, *online_, *target_, device_),
      explorer_(options.exploration, seed, EntryCount(spec)),
      chance_({seed, 0, Purpose::kLearner, 1}),
      replay_({static_cast<std::size_t>(options.replay), EntryCount(spec), spec.agents,
               observation_size_, 0}),
      batch_(size(), observation_size_) {
  if (is_prioritised()) priorities_ = std::make_unique<SumTree>(replay_.rows());
}

template <typename Scalar>
void DqnLearner<Scalar>::Step(const Results& results, double progress,
                              std::vector<std::uint8_t>& actions) {
  progress_ = progress;
  Remember(results);
  optimizer_.Count(FarmSteps(results), progress);
  while (optimizer_.TakeDue()) Update();
  Choose(results, actions);
  replay_.SetActions(actions);
}

template <typename Scalar>
void DqnLearner<Scalar>::Remember(const Results& results) {
  replay_.Add(results, Sight<Scalar>::Of(results));
  if (!is_prioritised()) return;
  const auto steps = static_cast<std::size_t>(options_.n_step);
  for (std::size_t entry = 0; entry < replay_.entries(); ++entry) {
    priorities_->Set(replay_.Row(replay_.size() - 1, entry), 0.0F);  // whatever was there is gone
    if (replay_.size() <= steps) continue;
    const std::size_t age = replay_.size() - 1 - steps;
    const bool begins = replay_.Begins(age, entry, steps);
    priorities_->Set(replay_.Row(age, entry), begins ? largest_priority_ : 0.0F);
  }
}

template <typename Scalar>
void DqnLearner<Scalar>::Choose(const Results& results, std::vector<std::uint8_t>& actions) {
  explorer_.SetProgress(progress_);
  actions.resize(results.legal.size());
  const torch::InferenceMode inference;
  const torch::Tensor values =
      online_->Forward(ToInput(Sight<Scalar>::Of(results), actions.size())).cpu();
  const float* row = values.template data_ptr<float>();
  for (std::size_t i = 0; i < actions.size(); ++i, row += kActionCount) {
    const ActionMask allowed = Allowed(results.legal[i], options_.mask_illegal);
    actions[i] = explorer_.Choose(row, allowed, BestOf(row, allowed), i);
  }
}

template <typename Scalar>
std::pair<std::size_t, std::size_t> DqnLearner<Scalar>::DrawUniform() {
  const auto moments =
      static_cast<std::uint32_t>(replay_.size() - static_cast<std::size_t>(options_.n_step));
  for (;;) {  // few moments are an episode's last
    const std::size_t age = chance_.Below(moments);
    const std::size_t entry = chance_.Below(static_cast<std::uint32_t>(replay_.entries()));
    if (replay_.Begins(age, entry, static_cast<std::size_t>(options_.n_step))) {
      return {age, entry};
    }
  }
}

template <typename Scalar>
std::pair<std::size_t, std::size_t> DqnLearner<Scalar>::DrawByPriority(std::size_t i) {
  const float total = priorities_->Total();
  const float share = (static_cast<float>(i) + chance_.Unit()) / static_cast<float>(size());
  const std::size_t row = priorities_->Find(share * total);
  batch_.weights[i] = priorities_->Get(row) / total;
  return {replay_.Age(row), row % replay_.entries()};
}

// w = (N P)^-β over the largest of the batch; β rises to 1 with progress.
template <typename Scalar>
void DqnLearner<Scalar>::WeighImportance() {
  const double exponent = options_.importance + (1.0 - options_.importance) * progress_;
  float largest = 0.0F;
  for (float& weight : batch_.weights) {
    weight = static_cast<float>(std::pow(static_cast<double>(weight), -exponent));
    largest = std::max(largest, weight);
  }
  for (float& weight : batch_.weights) weight /= largest * static_cast<float>(size());
}

// Fills the batch. False while there is nothing to draw from.
template <typename Scalar>
bool DqnLearner<Scalar>::Draw() {
  const auto steps = static_cast<std::size_t>(options_.n_step);
  if (replay_.size() <= steps) return false;
  if (is_prioritised() && !(priorities_->Total() > 0.0F)) return false;
  for (std::size_t i = 0; i < size(); ++i) {
    const auto [age, entry] = is_prioritised() ? DrawByPriority(i) : DrawUniform();
    const Transition one = replay_.At(age, entry, steps, static_cast<float>(options_.discount));
    std::copy_n(replay_.observation(one.from), observation_size_,
                batch_.from.data() + i * observation_size_);
    std::copy_n(replay_.observation(one.to), observation_size_,
                batch_.to.data() + i * observation_size_);
    batch_.actions[i] = one.action;
    batch_.rewards[i] = one.reward * static_cast<float>(options_.reward_scale);
    batch_.discounts[i] = one.discount;
    batch_.rows[i] = one.from;
    const ActionMask allowed = Allowed(replay_.legal(one.to), options_.mask_illegal);
    MarkForbidden(allowed, batch_.forbidden.data() + i * kActionCount);
  }
  if (is_prioritised()) WeighImportance();
  return true;
}

template <typename Scalar>
torch::Tensor DqnLearner<Scalar>::Targets() {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<std::int64_t>(size());
  const torch::Tensor to = ToInput(batch_.to.data(), size());
  const torch::Tensor forbidden = ToDevice(batch_.forbidden, {count, kActionCount});
  torch::Tensor next = target_->Forward(to);
  if (options_.double_q) {
    const torch::Tensor best = online_->Forward(to).add_(forbidden).argmax(1, /*keepdim=*/true);
    next = next.gather(1, best).squeeze(1);
  } else {
    next = next.add_(forbidden).amax(1);
  }
  return ToDevice(batch_.rewards, {count}) + ToDevice(batch_.discounts, {count}) * next;
}

template <typename Scalar>
void DqnLearner<Scalar>::Update() {
  const BatchOrigin origin{seed_, chance_.position()};
  if (!Draw()) return;
  const auto count = static_cast<std::int64_t>(size());
  const torch::Tensor targets = Targets();
  const torch::Tensor actions = ToDevice(batch_.actions, {count, 1});
  const torch::Tensor predicted =
      online_->Forward(ToInput(batch_.from.data(), size())).gather(1, actions).squeeze(1);
  optimizer_.Update(predicted, targets, ToDevice(batch_.weights, {count}), origin);
  if (is_prioritised()) Reprioritise((predicted.detach() - targets).abs());
}

template <typename Scalar>
void DqnLearner<Scalar>::Reprioritise(const torch::Tensor& errors) {
  const torch::Tensor values = errors.cpu();
  const float* error = values.template data_ptr<float>();
  for (std::size_t i = 0; i < size(); ++i) {
    const float priority =
        std::pow(error[i] + kSmallestPriority, static_cast<float>(options_.priority));
    largest_priority_ = std::max(largest_priority_, priority);
    priorities_->Set(batch_.rows[i], priority);
  }
}

template <typename Scalar>
void DqnLearner<Scalar>::Save(Checkpoint& checkpoint) const {
  optimizer_.Save(checkpoint);
  replay_.Save(checkpoint);
  checkpoint.SetArray("streams", explorer_.positions());
  checkpoint.SetArray("chance", std::vector<std::uint64_t>{chance_.position()});
  if (!is_prioritised()) return;
  std::vector<float> priorities;
  for (std::size_t row = 0; row < replay_.rows(); ++row)
    priorities.push_back(priorities_->Get(row));
  priorities.push_back(largest_priority_);
  checkpoint.SetArray("priorities", priorities);
}

template <typename Scalar>
void DqnLearner<Scalar>::Load(const Checkpoint& checkpoint) {
  std::vector<std::uint64_t> positions;
  std::vector<std::uint64_t> chance;
  std::vector<float> priorities;
  checkpoint.GetArray("streams", EntryCount(spec_), positions);
  checkpoint.GetArray("chance", 1, chance);
  if (is_prioritised()) checkpoint.GetArray("priorities", replay_.rows() + 1, priorities);
  optimizer_.Load(checkpoint);
  replay_.Load(checkpoint);
  explorer_.Seek(positions);
  chance_.Seek(chance[0]);
  if (!is_prioritised()) return;
  for (std::size_t row = 0; row < replay_.rows(); ++row) priorities_->Set(row, priorities[row]);
  largest_priority_ = priorities.back();
}

DeepOptions Parse(const std::string& text, std::string& resolved) {
  return DeepOptions::Parse(text, /*recurrent=*/false, resolved);
}

}  // namespace

std::uint8_t DqnEncodings(const std::string& options) {
  std::string resolved;
  return Parse(options, resolved).network == NetworkKind::kCnn ? kPlanesBit : kFeaturesBit;
}

std::unique_ptr<Learner> MakeDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& text) {
  std::string resolved;
  const DeepOptions options = Parse(text, resolved);
  PrepareTorch(options.threads);
  if (options.network == NetworkKind::kCnn) {
    return std::make_unique<DqnLearner<std::uint8_t>>(spec, seed, options, resolved);
  }
  return std::make_unique<DqnLearner<float>>(spec, seed, options, resolved);
}

std::unique_ptr<Policy> MakeDqnPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  std::string resolved;
  const DeepOptions options = Parse(checkpoint.options, resolved);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, options.network);
  const std::size_t size = checkpoint.Section("weights").size() / sizeof(float);
  std::vector<float> weights;
  checkpoint.GetArray("weights", size, weights);
  if (options.network == NetworkKind::kCnn) {
    return std::make_unique<GreedyDqnPolicy<std::uint8_t>>(spec, options, weights);
  }
  return std::make_unique<GreedyDqnPolicy<float>>(spec, options, weights);
}

}  // namespace aquafarm::agents
