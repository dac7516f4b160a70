// SPDX-License-Identifier: BSD-3-Clause
#include "value_optimizer.h"

#include <cmath>

#include "aquafarm/check.h"

namespace aquafarm::agents {
namespace {

constexpr float kLossShare = 0.01F;  // of a new loss in the moving average

}  // namespace

ValueOptimizer::ValueOptimizer(const DeepOptions& options, torch::nn::Module& online,
                               torch::nn::Module& target, torch::Device device)
    : options_(options),
      online_(online, device),
      target_(target, device),
      adam_({online_.values()}, torch::optim::AdamOptions(options.learning_rate.At(0.0))),
      loss_(std::nanf("")) {
  const torch::NoGradGuard no_grad;
  target_.values().copy_(online_.values());
  target_.values().set_requires_grad(false);
  AdamState();
}

void ValueOptimizer::Count(std::uint64_t farm_steps, double progress) {
  steps_ += farm_steps;
  if (steps_ > options_.start) due_ += static_cast<double>(farm_steps) / options_.steps_per_update;
  learning_rate_ = options_.learning_rate.At(progress);
}

bool ValueOptimizer::TakeDue() {
  if (due_ < 1.0) return false;
  due_ -= 1.0;
  return true;
}

void ValueOptimizer::Update(const torch::Tensor& predicted, const torch::Tensor& targets,
                            const torch::Tensor& weights) {
  const torch::Tensor each = options_.loss == LossKind::kMse
                                 ? torch::mse_loss(predicted, targets, at::Reduction::None)
                                 : torch::smooth_l1_loss(predicted, targets, at::Reduction::None);
  const torch::Tensor loss = (each * weights).sum();
  const float value = loss.item<float>();
  if (!std::isfinite(value)) {
    throw LearnerFailed("loss: got " + std::to_string(value) + " at update " +
                        std::to_string(updates_ + 1) + ", after " + std::to_string(steps_) +
                        " farm steps; expected a number: try a smaller learning_rate or "
                        "reward_scale");
  }
  torch::Tensor gradient = online_.values().grad();
  gradient.zero_();
  loss.backward();
  if (options_.gradient_limit > 0.0) {
    const double norm = gradient.norm().item<double>();
    if (norm > options_.gradient_limit) gradient.mul_(options_.gradient_limit / norm);
  }
  static_cast<torch::optim::AdamOptions&>(adam_.param_groups()[0].options()).lr(learning_rate_);
  adam_.step();
  ++updates_;
  const torch::NoGradGuard no_grad;
  if (options_.target_rate > 0.0) {
    target_.values().lerp_(online_.values(), options_.target_rate);
  } else if (updates_ % options_.target_period == 0) {
    target_.values().copy_(online_.values());
  }
  loss_ = std::isnan(loss_) ? value : loss_ + kLossShare * (value - loss_);
}

LearnerStatus ValueOptimizer::status(double exploration) const {
  return {loss_, static_cast<float>(exploration), static_cast<float>(learning_rate_)};
}

// Made by the library at its first step; made here before, so that it can be saved and loaded at
// any time.
torch::optim::AdamParamState& ValueOptimizer::AdamState() {
  auto& states = adam_.state();
#if TORCH_VERSION_MAJOR >= 2
  void* const key = online_.values().unsafeGetTensorImpl();
#else
  const std::string key = c10::guts::to_string(online_.values().unsafeGetTensorImpl());
#endif
  auto& state = states[key];
  if (!state) {
    auto fresh = std::make_unique<torch::optim::AdamParamState>();
    fresh->step(0);
    fresh->exp_avg(torch::zeros_like(online_.values(), torch::requires_grad(false)));
    fresh->exp_avg_sq(torch::zeros_like(online_.values(), torch::requires_grad(false)));
    state = std::move(fresh);
  }
  return static_cast<torch::optim::AdamParamState&>(*state);
}

void ValueOptimizer::Save(Checkpoint& checkpoint) const {
  auto& adam = const_cast<ValueOptimizer*>(this)->AdamState();
  const auto to_vector = [](const torch::Tensor& tensor) {
    const torch::Tensor values = tensor.detach().cpu();
    return std::vector<float>(values.data_ptr<float>(), values.data_ptr<float>() + values.numel());
  };
  checkpoint.SetArray("weights", online_.ToVector());
  checkpoint.SetArray("target_weights", target_.ToVector());
  checkpoint.SetArray("adam.mean", to_vector(adam.exp_avg()));
  checkpoint.SetArray("adam.square", to_vector(adam.exp_avg_sq()));
  checkpoint.SetArray(
      "optimizer.numbers",
      std::vector<double>{static_cast<double>(adam.step()), due_, static_cast<double>(steps_),
                          static_cast<double>(updates_), learning_rate_,
                          static_cast<double>(loss_)});
}

void ValueOptimizer::Load(const Checkpoint& checkpoint) {
  const auto size = static_cast<std::size_t>(online_.size());
  std::vector<float> online;
  std::vector<float> target;
  std::vector<float> mean;
  std::vector<float> square;
  std::vector<double> numbers;
  checkpoint.GetArray("weights", size, online);
  checkpoint.GetArray("target_weights", size, target);
  checkpoint.GetArray("adam.mean", size, mean);
  checkpoint.GetArray("adam.square", size, square);
  checkpoint.GetArray("optimizer.numbers", 6, numbers);
  online_.FromVector(online);
  target_.FromVector(target);
  auto& adam = AdamState();
  const auto shape = static_cast<std::int64_t>(size);
  adam.exp_avg().copy_(torch::from_blob(mean.data(), {shape}));
  adam.exp_avg_sq().copy_(torch::from_blob(square.data(), {shape}));
  adam.step(static_cast<std::int64_t>(numbers[0]));
  due_ = numbers[1];
  steps_ = static_cast<std::uint64_t>(numbers[2]);
  updates_ = static_cast<std::uint64_t>(numbers[3]);
  learning_rate_ = numbers[4];
  loss_ = static_cast<float>(numbers[5]);
}

}  // namespace aquafarm::agents
