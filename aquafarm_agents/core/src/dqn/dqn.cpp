// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/dqn/dqn.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "aquafarm/agents/networks/torch_runtime.h"
#include "dqn/q_learner.h"
#include "networks/value_network.h"

namespace aquafarm::agents {
namespace {

std::uint8_t ObservationTypeOf(NetworkKind network) {
  return network == NetworkKind::kCnn ? kPlanesBit : kFeaturesBit;
}

/// Takes the greedy action of a network.
template <typename Scalar>
class GreedyDqnPolicy final : public Policy {
 public:
  GreedyDqnPolicy(const EnvironmentSpec& spec, const DeepOptions& options,
                  const std::vector<float>& weights)
      : size_(ElementCount(ObservationTraits<Scalar>::Shape(spec))),
        options_(options),
        network_(MakeNetwork(spec, options, 0)),
        parameters_(*network_, FindDevice(options.device)),
        computed_(MakeValueNetwork<Scalar>(spec, options, network_, parameters_, Learns::kNo)) {
    parameters_.FromVector(weights);
  }
  std::uint8_t observation_types() const override { return ObservationTypeOf(options_.network); }
  void Begin(std::uint64_t, std::int32_t) override {}
  /// Inactive agents get action 0 and value 0. The network evaluates the rows from the first to the
  /// last active agent.
  void Act(const StepResults& results, std::vector<std::uint8_t>& actions) override {
    const auto is_active = [](std::uint8_t flag) { return flag != 0; };
    const auto& flags = results.active;
    const auto first = static_cast<std::size_t>(
        std::find_if(flags.begin(), flags.end(), is_active) - flags.begin());
    const auto end = static_cast<std::size_t>(
        flags.rend() - std::find_if(flags.rbegin(), flags.rend(), is_active));
    actions.assign(results.legal.size(), 0);
    values_.assign(results.legal.size(), 0.0F);
    if (first >= end) return;
    const Scalar* seen = ObservationTraits<Scalar>::Of(results) + first * size_;
    const float* row = computed_->Forward(end - first, seen);
    for (std::size_t i = first; i < end; ++i, row += kActionCount, seen += size_) {
      if (flags[i] == 0) continue;
      const Best best = BestOf(row, LegalMask(results.legal[i], seen, options_));
      actions[i] = best.action;
      values_[i] = best.value / static_cast<float>(options_.reward_scale);
    }
  }

 private:
  std::size_t size_;  // size of one observation
  DeepOptions options_;
  std::shared_ptr<QNetwork> network_;
  FlatParameters parameters_;
  std::unique_ptr<ValueNetwork<Scalar>> computed_;
};

/// A minibatch of B samples for the network. A sample is a transition of one agent, or of all
/// agents of a farm (VDN). Each agent of each sample has one row; R is the number of rows.
template <typename Scalar>
struct Batch {
  std::vector<Scalar> seen;           // [2, R, …] observations before and after the transition
  std::vector<std::uint8_t> actions;  // [R]
  std::vector<float> present;         // [R] 1 if the agent is active before the transition, else 0
  std::vector<float> rewards;         // [B]
  std::vector<float> discounts;       // [R] factor of the value after the transition
  std::vector<ActionMask> allowed;    // [R] actions allowed after the transition
  std::vector<ActionMask> allowed_now;  // [R] actions allowed before the transition
  std::vector<float> weights;           // [B]
  std::vector<std::size_t> drawn;       // [B] row of the sample in the replay buffer
  std::vector<float> predicted;         // [B]
  std::vector<float> targets;           // [B]
  std::vector<float> slopes;            // [B] d loss / d predicted
  std::vector<float> row_slopes;        // [R] d loss / d value of the action taken

  Batch(std::size_t size, std::size_t rows, std::size_t observation_size)
      : seen(2 * rows * observation_size),
        actions(rows),
        present(rows, 1.0F),
        rewards(size),
        discounts(rows),
        allowed(rows),
        allowed_now(rows),
        weights(size, 1.0F / static_cast<float>(size)),
        drawn(size),
        predicted(size),
        targets(size),
        slopes(size),
        row_slopes(rows) {}
};

template <typename Scalar>
class DqnLearner final : public QLearner<Scalar, QNetwork> {
 public:
  DqnLearner(const EnvironmentSpec& spec, std::uint64_t seed, const DeepOptions& options,
             std::string resolved);

  std::uint8_t observation_types() const override { return ObservationTypeOf(options_.network); }
  std::unique_ptr<Policy> GreedyPolicy() const override {
    return std::make_unique<GreedyDqnPolicy<Scalar>>(spec_, options_,
                                                     optimizer_.acting().ToVector());
  }

 private:
  using Base = QLearner<Scalar, QNetwork>;
  using Base::observation_size_;
  using Base::optimizer_;
  using Base::options_;
  using Base::progress_;
  using Base::replay_;
  using Base::rng_;
  using Base::sampler_;
  using Base::seed_;
  using Base::spec_;

  std::size_t size() const { return static_cast<std::size_t>(options_.batch_size); }
  std::size_t group() const { return options_.joint ? static_cast<std::size_t>(spec_.agents) : 1; }
  std::size_t rows() const { return size() * group(); }
  const float* ActingValues(const StepResults& results) override {
    auto& network = average_values_ ? *average_values_ : *online_values_;
    return network.Forward(results.legal.size(), ObservationTraits<Scalar>::Of(results));
  }
  void Update() override;
  void Draw();
  void DrawAlone(std::size_t i, const TransitionIndex& moment);
  void DrawJoint(std::size_t i, const TransitionIndex& moment);
  void Fill(std::size_t k, std::size_t from, std::size_t to, float discount);
  void Evaluate();

  const std::unique_ptr<ValueNetwork<Scalar>> online_values_;
  const std::unique_ptr<ValueNetwork<Scalar>> target_values_;
  const std::unique_ptr<ValueNetwork<Scalar>> average_values_;  // null without a moving average
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
      online_values_(MakeValueNetwork<Scalar>(spec, options, Base::online_, optimizer_.online(),
                                              Learns::kYes)),
      target_values_(
          MakeValueNetwork<Scalar>(spec, options, Base::target_, optimizer_.target(), Learns::kNo)),
      average_values_(optimizer_.average() == nullptr
                          ? nullptr
                          : MakeValueNetwork<Scalar>(spec, options, Base::average_,
                                                     *optimizer_.average(), Learns::kNo)),
      batch_(size(), rows(), observation_size_),
      team_rewards_(static_cast<std::size_t>(spec.agents)) {}

template <typename Scalar>
void DqnLearner<Scalar>::Draw() {
  for (std::size_t i = 0; i < size(); ++i) {
    const TransitionIndex moment = sampler_.Draw(rng_, i);
    batch_.drawn[i] = replay_.Row(moment.age, moment.slot);
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
      replay_.At(moment.age, moment.slot, static_cast<std::size_t>(options_.n_step),
                 static_cast<float>(options_.gamma));
  batch_.rewards[i] = one.reward * static_cast<float>(options_.reward_scale);
  Fill(i, one.from, one.to, one.discount);
}

// The team's value does not include the values of agents that are done.
template <typename Scalar>
void DqnLearner<Scalar>::DrawJoint(std::size_t i, const TransitionIndex& moment) {
  const std::size_t first = moment.slot;
  const JointTransition all =
      replay_.JointAt(moment.age, first, static_cast<std::size_t>(options_.n_step),
                      static_cast<float>(options_.gamma), team_rewards_.data());
  const float sum = std::accumulate(team_rewards_.begin(), team_rewards_.end(), 0.0F);
  // With a team reward, each agent's reward is already the sum over the team.
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
  Scalar* const seen = batch_.seen.data();
  std::copy_n(replay_.observation(from), observation_size_, seen + k * observation_size_);
  std::copy_n(replay_.observation(to), observation_size_, seen + (rows() + k) * observation_size_);
  batch_.actions[k] = replay_.action(from);
  batch_.discounts[k] = discount;
  batch_.allowed[k] = LegalMask(replay_.legal(to), replay_.observation(to), options_);
  batch_.allowed_now[k] = LegalMask(replay_.legal(from), replay_.observation(from), options_);
}

// Computes predictions and targets (Eq. 15). With VDN, each is a sum over the agents of a farm
// (Sunehag et al. 2018).
template <typename Scalar>
void DqnLearner<Scalar>::Evaluate() {
  const Scalar* const to = batch_.seen.data() + rows() * observation_size_;
  const bool has_gap = options_.action_gap > 0.0;
  const float* const online =
      online_values_->Forward((options_.double_dqn ? 2 : 1) * rows(), batch_.seen.data());
  const float* const target = has_gap ? target_values_->Forward(2 * rows(), batch_.seen.data())
                                      : target_values_->Forward(rows(), to);
  const float* const next = target + (has_gap ? rows() * kActionCount : 0);
  const float* const choosing = options_.double_dqn ? online + rows() * kActionCount : next;
  batch_.targets = batch_.rewards;
  std::fill(batch_.predicted.begin(), batch_.predicted.end(), 0.0F);
  for (std::size_t k = 0; k < rows(); ++k) {
    const std::size_t i = k / group();
    const std::size_t row = k * kActionCount;
    batch_.predicted[i] += batch_.present[k] * online[row + batch_.actions[k]];
    // An agent that is done has no next value.
    if (batch_.discounts[k] > 0.0F) {
      const Best best = BestOf(choosing + row, batch_.allowed[k]);
      batch_.targets[i] += batch_.discounts[k] * next[row + best.action];
    }
    if (has_gap && batch_.present[k] > 0.0F) {
      batch_.targets[i] -= static_cast<float>(options_.action_gap) *
                           AdvantageGap(target + row, batch_.allowed_now[k], batch_.actions[k]);
    }
  }
}

template <typename Scalar>
void DqnLearner<Scalar>::Update() {
  const BatchOrigin origin{seed_, rng_.position()};
  Draw();
  Evaluate();
  optimizer_.Differentiate(size(), batch_.predicted.data(), batch_.targets.data(),
                           batch_.weights.data(), batch_.slopes.data(), origin);
  for (std::size_t k = 0; k < rows(); ++k) {
    batch_.row_slopes[k] = batch_.slopes[k / group()] * batch_.present[k];
  }
  this->SpreadSlopes(batch_.row_slopes, batch_.actions);
  online_values_->Backward(rows(), this->value_slopes_.data());
  optimizer_.Learn(origin);
  if (options_.priority_exponent == 0.0) return;
  for (std::size_t i = 0; i < size(); ++i) {
    sampler_.UpdatePriority(batch_.drawn[i], std::abs(batch_.predicted[i] - batch_.targets[i]));
  }
}

DeepOptions ParseFeedForward(const std::string& text, std::string& resolved) {
  return DeepOptions::Parse(text, /*recurrent=*/false, resolved);
}

std::unique_ptr<Learner> MakeLearner(const EnvironmentSpec& spec, std::uint64_t seed,
                                     const std::string& text, bool joint) {
  std::string resolved;
  DeepOptions options = ParseFeedForward(text, resolved);
  options.joint = joint;
  PrepareTorch(options.threads);
  if (options.network == NetworkKind::kCnn) {
    return std::make_unique<DqnLearner<std::uint8_t>>(spec, seed, options, resolved);
  }
  return std::make_unique<DqnLearner<float>>(spec, seed, options, resolved);
}

}  // namespace

std::uint8_t DqnObservationTypes(const std::string& options) {
  std::string resolved;
  return ObservationTypeOf(ParseFeedForward(options, resolved).network);
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
  DeepOptions options = ParseFeedForward(checkpoint.options, resolved);
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
