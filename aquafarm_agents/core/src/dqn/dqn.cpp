// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/dqn/dqn.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include "aquafarm/agents/networks/torch_runtime.h"
#include "aquafarm/base/check.h"
#include "dqn/q_learner.h"
#include "networks/row_network.h"

namespace aquafarm::agents {
namespace {

std::uint8_t EncodingOf(NetworkKind network) {
  return network == NetworkKind::kCnn ? kPlanesBit : kFeaturesBit;
}

/// Takes the greedy action of a network.
template <typename Scalar>
class GreedyDqnPolicy final : public Policy {
 public:
  GreedyDqnPolicy(const EnvironmentSpec& spec, const DeepOptions& options,
                  const std::vector<float>& weights)
      : device_(FindDevice(options.device)),
        shape_(ObservationTraits<Scalar>::Shape(spec)),
        size_(ElementCount(shape_)),
        options_(options),
        network_(MakeNetwork(spec, options, 0)),
        parameters_(*network_, device_) {
    parameters_.FromVector(weights);
    if (options.network == NetworkKind::kMlp && device_.is_cpu()) {
      row_network_.emplace(size_, options, weights);
    }
  }
  std::uint8_t encodings() const override { return EncodingOf(options_.network); }
  void Begin(std::uint64_t, std::int32_t) override {}
  /// Inactive agents get action 0 and value 0. The network evaluates the rows from the first to the
  /// last active agent.
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    const auto is_in_play = [](std::uint8_t flag) { return flag != 0; };
    const auto& flags = results.in_play;
    const auto first = static_cast<std::size_t>(
        std::find_if(flags.begin(), flags.end(), is_in_play) - flags.begin());
    const auto end = static_cast<std::size_t>(
        flags.rend() - std::find_if(flags.rbegin(), flags.rend(), is_in_play));
    actions.assign(results.legal.size(), 0);
    values_.assign(results.legal.size(), 0.0F);
    if (first >= end) return;
    const Scalar* seen = ObservationTraits<Scalar>::Of(results) + first * size_;
    const float* row = Values(seen, end - first);
    for (std::size_t i = first; i < end; ++i, row += kActionCount, seen += size_) {
      if (flags[i] == 0) continue;
      const Best best = BestOf(row, LegalMask(results.legal[i], seen, options_));
      actions[i] = best.action;
      values_[i] = best.value;
    }
  }

 private:
  /// @returns [count, kActionCount], valid until the next call
  const float* Values(const Scalar* seen, std::size_t count) {
    if constexpr (std::is_same_v<Scalar, float>) {
      if (count == 1 && row_network_) return row_network_->Forward(seen);
    }
    const torch::InferenceMode inference;
    computed_ =
        network_
            ->Forward(ObservationTraits<Scalar>::ToInput(seen, WithCount(count, shape_), device_))
            .cpu();
    return computed_.template data_ptr<float>();
  }

  torch::Device device_;
  std::vector<std::int64_t> shape_;
  std::size_t size_;  // size of one observation
  DeepOptions options_;
  std::shared_ptr<QNetwork> network_;
  FlatParameters parameters_;
  torch::Tensor computed_;
  std::optional<RowNetwork> row_network_;  // for feature observations on the CPU
};

/// A minibatch of B samples for the network. A sample contains the transition of one agent, or of
/// all agents of a farm: R rows in total.
template <typename Scalar>
struct Batch {
  std::vector<Scalar> from;
  std::vector<Scalar> to;
  std::vector<std::int64_t> actions;
  std::vector<float> present;        // [R] 1 if the agent is active, 0 if it finished before
  std::vector<float> rewards;        // [B]
  std::vector<float> discounts;      // [R] of the value of `to`
  std::vector<float> forbidden;      // [R, kActionCount] by MaskLogits, for the next actions
  std::vector<float> forbidden_now;  // [R, kActionCount] by MaskLogits, for the actions of `from`
  std::vector<float> weights;        // [B]
  std::vector<std::size_t> drawn;    // [B] row in the replay buffer

  Batch(std::size_t size, std::size_t rows, std::size_t observation_size)
      : from(rows * observation_size),
        to(rows * observation_size),
        actions(rows),
        present(rows, 1.0F),
        rewards(size),
        discounts(rows),
        forbidden(rows * kActionCount),
        forbidden_now(rows * kActionCount),
        weights(size, 1.0F / static_cast<float>(size)),
        drawn(size) {}
};

template <typename Scalar>
class DqnLearner final : public QLearner<Scalar, QNetwork> {
 public:
  DqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
             std::string resolved);

  std::uint8_t encodings() const override { return EncodingOf(options_.network); }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<GreedyDqnPolicy<Scalar>>(spec_, options_,
                                                     optimizer_.acting().ToVector());
  }

 private:
  using Base = QLearner<Scalar, QNetwork>;
  using Base::device_;
  using Base::online_;
  using Base::optimizer_;
  using Base::options_;
  using Base::progress_;
  using Base::replay_;
  using Base::rng_;
  using Base::sampler_;
  using Base::seed_;
  using Base::spec_;
  using Base::target_;
  using Base::ToDevice;

  std::size_t size() const { return static_cast<std::size_t>(options_.batch_size); }
  std::size_t group() const { return options_.joint ? static_cast<std::size_t>(spec_.agents) : 1; }
  std::size_t rows() const { return size() * group(); }
  torch::Tensor ToInput(const Scalar* rows, std::size_t count) const {
    return ObservationTraits<Scalar>::ToInput(rows, WithCount(count, shape_), device_);
  }
  torch::Tensor ActingValues(const StepResults& results) override;
  void Update() override;
  void Draw();
  void DrawAlone(std::size_t i, const TransitionIndex& moment);
  void DrawJoint(std::size_t i, const TransitionIndex& moment);
  void Fill(std::size_t k, std::size_t from, std::size_t to, float discount);
  torch::Tensor SumOfGroups(const torch::Tensor& values) const;
  torch::Tensor Targets(const torch::Tensor& from, const torch::Tensor& actions);
  void Reprioritise(const torch::Tensor& errors);

  const std::vector<std::int64_t> shape_;
  const std::size_t observation_size_;
  Batch<Scalar> batch_;
  std::vector<float> team_rewards_;  // scratch [agents]
};

template <typename Scalar>
DqnLearner<Scalar>::DqnLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                               const DeepOptions& options, std::string resolved)
    : Base(spec, seed, options, std::move(resolved),
           [&] { return MakeNetwork(spec, options, seed); },
           {ElementCount(ObservationTraits<Scalar>::Shape(spec)), 0,
            static_cast<std::size_t>(options.n_step),
            options.joint ? static_cast<std::size_t>(spec.agents) : 1}),
      shape_(ObservationTraits<Scalar>::Shape(spec)),
      observation_size_(ElementCount(shape_)),
      batch_(size(), rows(), observation_size_),
      team_rewards_(static_cast<std::size_t>(spec.agents)) {}

template <typename Scalar>
torch::Tensor DqnLearner<Scalar>::ActingValues(const StepResults& results) {
  const torch::InferenceMode inference;
  return this->acting_
      ->Forward(ToInput(ObservationTraits<Scalar>::Of(results), results.legal.size()))
      .cpu();
}

template <typename Scalar>
void DqnLearner<Scalar>::Draw() {
  for (std::size_t i = 0; i < size(); ++i) {
    const TransitionIndex moment = sampler_.Draw(rng_, i);
    batch_.drawn[i] = replay_.Row(moment.age, moment.entry);
    if (options_.joint) {
      DrawJoint(i, moment);
    } else {
      DrawAlone(i, moment);
    }
  }
  const std::vector<float>& weights = sampler_.ImportanceWeights(progress_);
  for (std::size_t i = 0; i < size(); ++i) {
    batch_.weights[i] = weights[i] / static_cast<float>(size());
  }
}

template <typename Scalar>
void DqnLearner<Scalar>::DrawAlone(std::size_t i, const TransitionIndex& moment) {
  const Transition one =
      replay_.At(moment.age, moment.entry, static_cast<std::size_t>(options_.n_step),
                 static_cast<float>(options_.gamma));
  batch_.rewards[i] = one.reward * static_cast<float>(options_.reward_scale);
  Fill(i, one.from, one.to, one.discount);
}

// The value of an agent that is done is excluded from the team's value.
template <typename Scalar>
void DqnLearner<Scalar>::DrawJoint(std::size_t i, const TransitionIndex& moment) {
  const std::size_t first = moment.entry;
  const JointTransition all =
      replay_.JointAt(moment.age, first, static_cast<std::size_t>(options_.n_step),
                      static_cast<float>(options_.gamma), team_rewards_.data());
  const float sum = std::accumulate(team_rewards_.begin(), team_rewards_.end(), 0.0F);
  // A team reward is repeated for each agent.
  const float reward = spec_.team_reward ? sum / static_cast<float>(group()) : sum;
  batch_.rewards[i] = reward * static_cast<float>(options_.reward_scale);
  const std::size_t from = replay_.Row(moment.age, first);
  for (std::size_t agent = 0; agent < group(); ++agent) {
    const std::size_t k = i * group() + agent;
    const bool is_done = IsTerminated(replay_.reason(all.to + agent));
    batch_.present[k] = replay_.reason(from + agent) == EndReason::kNone ? 1.0F : 0.0F;
    Fill(k, from + agent, all.to + agent, is_done ? 0.0F : all.discount);
  }
}

template <typename Scalar>
void DqnLearner<Scalar>::Fill(std::size_t k, std::size_t from, std::size_t to, float discount) {
  std::copy_n(replay_.observation(from), observation_size_,
              batch_.from.data() + k * observation_size_);
  std::copy_n(replay_.observation(to), observation_size_, batch_.to.data() + k * observation_size_);
  batch_.actions[k] = replay_.action(from);
  batch_.discounts[k] = discount;
  MaskLogits(LegalMask(replay_.legal(to), replay_.observation(to), options_),
             batch_.forbidden.data() + k * kActionCount);
  if (options_.action_gap == 0.0) return;
  MaskLogits(LegalMask(replay_.legal(from), replay_.observation(from), options_),
             batch_.forbidden_now.data() + k * kActionCount);
}

// [R] → [B]: sums the values of a team (value decomposition, Sunehag et al. 2018).
template <typename Scalar>
torch::Tensor DqnLearner<Scalar>::SumOfGroups(const torch::Tensor& values) const {
  if (!options_.joint) return values;
  return values.view({static_cast<std::int64_t>(size()), static_cast<std::int64_t>(group())})
      .sum(1);
}

template <typename Scalar>
torch::Tensor DqnLearner<Scalar>::Targets(const torch::Tensor& from, const torch::Tensor& actions) {
  const torch::NoGradGuard no_grad;
  const auto count = static_cast<std::int64_t>(rows());
  const torch::Tensor to = ToInput(batch_.to.data(), rows());
  const torch::Tensor forbidden = ToDevice(batch_.forbidden, {count, kActionCount});
  torch::Tensor next = target_->Forward(to);
  if (options_.double_dqn) {
    const torch::Tensor best = online_->Forward(to).add_(forbidden).argmax(1, /*keepdim=*/true);
    next = next.gather(1, best).squeeze(1);
  } else {
    next = next.add_(forbidden).amax(1);
  }
  torch::Tensor values = ToDevice(batch_.discounts, {count}) * next;
  if (options_.action_gap > 0.0) {
    const torch::Tensor forbidden_now = ToDevice(batch_.forbidden_now, {count, kActionCount});
    const torch::Tensor gap = AdvantageGap(target_->Forward(from), forbidden_now, actions);
    values -= options_.action_gap * gap * ToDevice(batch_.present, {count});
  }
  return ToDevice(batch_.rewards, {static_cast<std::int64_t>(size())}) + SumOfGroups(values);
}

template <typename Scalar>
void DqnLearner<Scalar>::Update() {
  const BatchOrigin origin{seed_, rng_.position()};
  Draw();
  const auto count = static_cast<std::int64_t>(rows());
  const torch::Tensor actions = ToDevice(batch_.actions, {count, 1});
  const torch::Tensor from = ToInput(batch_.from.data(), rows());
  const torch::Tensor targets = Targets(from, actions);
  torch::Tensor predicted = online_->Forward(from).gather(1, actions).squeeze(1);
  if (options_.joint) predicted = SumOfGroups(predicted * ToDevice(batch_.present, {count}));
  optimizer_.Update(predicted, targets,
                    ToDevice(batch_.weights, {static_cast<std::int64_t>(size())}), origin);
  if (options_.priority_exponent > 0.0) Reprioritise((predicted.detach() - targets).abs());
}

template <typename Scalar>
void DqnLearner<Scalar>::Reprioritise(const torch::Tensor& errors) {
  const torch::Tensor values = errors.cpu();
  const float* error = values.template data_ptr<float>();
  for (std::size_t i = 0; i < size(); ++i) sampler_.UpdatePriority(batch_.drawn[i], error[i]);
}

DeepOptions Parse(const std::string& text, std::string& resolved) {
  return DeepOptions::Parse(text, /*recurrent=*/false, resolved);
}

std::unique_ptr<Learner> MakeLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                     const std::string& text, bool joint) {
  std::string resolved;
  DeepOptions options = Parse(text, resolved);
  options.joint = joint;
  PrepareTorch(options.threads);
  if (options.network == NetworkKind::kCnn) {
    return std::make_unique<DqnLearner<std::uint8_t>>(spec, seed, options, resolved);
  }
  return std::make_unique<DqnLearner<float>>(spec, seed, options, resolved);
}

}  // namespace

std::uint8_t DqnEncodings(const std::string& options) {
  std::string resolved;
  return EncodingOf(Parse(options, resolved).network);
}

std::unique_ptr<Learner> MakeDqn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& text) {
  return MakeLearner(spec, seed, text, /*joint=*/false);
}

std::unique_ptr<Learner> MakeVdn(const EnvironmentSpec& spec, std::uint64_t seed,
                                 const std::string& text) {
  return MakeLearner(spec, seed, text, /*joint=*/true);
}

std::unique_ptr<Policy> MakeDqnPolicy(const Checkpoint& checkpoint, const EnvironmentSpec& spec) {
  std::string resolved;
  DeepOptions options = Parse(checkpoint.options, resolved);
  options.device = PlayingDevice(options.device);
  PrepareTorch(options.threads);
  CheckFits(checkpoint, spec, options.network);
  const std::vector<float> weights = ActingWeights(checkpoint);
  if (options.network == NetworkKind::kCnn) {
    return std::make_unique<GreedyDqnPolicy<std::uint8_t>>(spec, options, weights);
  }
  return std::make_unique<GreedyDqnPolicy<float>>(spec, options, weights);
}

}  // namespace aquafarm::agents
