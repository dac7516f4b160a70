// SPDX-License-Identifier: BSD-3-Clause
#include "networks/value_optimizer.h"

#include <algorithm>
#include <cmath>

#include "aquafarm/base/check.h"
#include "learning/moving_error.h"
#include "learning/saved_numbers.h"

namespace aquafarm::agents {
namespace {

constexpr std::uint64_t kUpdatesPerLook = 8;  // updates per measurement of the reported loss
constexpr const char* kAverage = "average_weights";

}  // namespace

std::vector<float> ActingWeights(const Checkpoint& checkpoint) {
  const char* const name = checkpoint.Has(kAverage) ? kAverage : "weights";
  std::vector<float> weights;
  checkpoint.GetArray(name, checkpoint.Section(name).size() / sizeof(float), weights);
  return weights;
}

ValueOptimizer::ValueOptimizer(const DeepOptions& options, torch::nn::Module& online,
                               torch::nn::Module& target, torch::nn::Module& acting,
                               torch::Device device)
    : options_(options), online_(online, device), target_(target, device), loss_(std::nanf("")) {
  const torch::NoGradGuard no_grad;
  if (options.ema_rate > 0.0) average_.emplace(acting, device);
  for (FlatParameters* const copy : {&target_, average_ ? &*average_ : &target_}) {
    copy->values().copy_(this->online().values());
    copy->values().set_requires_grad(false);
  }
}

void ValueOptimizer::Count(std::uint64_t farm_steps, double progress) {
  steps_ += farm_steps;
  if (steps_ > options_.learning_starts)
    due_ += static_cast<double>(farm_steps) / options_.train_interval.At(progress);
  learning_rate_ = options_.learning_rate.At(progress);
}

bool ValueOptimizer::TakeDue() {
  if (due_ < 1.0) return false;
  due_ -= 1.0;
  return true;
}

void ValueOptimizer::Differentiate(std::size_t count, const float* predicted, const float* targets,
                                   const float* weights, float* slopes, const BatchOrigin& origin) {
  double loss = 0.0;
  double square = 0.0;
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const float error = predicted[i] - targets[i];
    const bool is_square = options_.loss == LossKind::kMse;
    const bool is_linear = !is_square && !(std::abs(error) < 1.0F);  // Huber 1964
    const float slope = is_linear ? std::copysign(1.0F, error) : error;
    const auto weight = static_cast<double>(weights[i]);
    const auto wide = static_cast<double>(error);
    weight_sum += weight;
    square += weight * wide * wide;
    loss += weight * (is_square   ? wide * wide
                      : is_linear ? std::abs(wide) - 0.5
                                  : 0.5 * wide * wide);
    slopes[i] = (is_square ? 2.0F : 1.0F) * slope * weights[i];
  }
  if (!std::isfinite(loss)) Fail("loss: got " + std::to_string(loss), origin);
  if (updates_ % kUpdatesPerLook == 0) Measure(square / weight_sum);
  evaluated_ = loss;
}

void ValueOptimizer::Learn(const BatchOrigin& origin) {
  if (!online_.Step(learning_rate_, options_.max_grad_norm)) {
    Fail("gradient: not finite, with a loss of " + std::to_string(evaluated_), origin);
  }
  ++updates_;
  if (average_) {  // arithmetic mean at first, then an exponential moving average
    average_->MoveTowards(online(),
                          std::max(options_.ema_rate, 1.0 / static_cast<double>(updates_)));
  }
  if (options_.tau > 0.0) {
    target_.MoveTowards(online(), options_.tau);
  } else if (updates_ % options_.target_update_interval == 0) {
    target_.MoveTowards(online(), 1.0);
  }
}

void ValueOptimizer::Fail(const std::string& what, const BatchOrigin& origin) const {
  throw LearnerFailed(what + " at update " + std::to_string(updates_ + 1) + ", after " +
                      std::to_string(steps_) + " farm steps, on the batch drawn from seed " +
                      std::to_string(origin.seed) + " at position " +
                      std::to_string(origin.position) +
                      "; expected a number: try a smaller learning_rate or reward_scale");
}

void ValueOptimizer::Measure(double mean_square) {
  const auto value =
      static_cast<float>(mean_square / (options_.reward_scale * options_.reward_scale));
  loss_ = MoveError(loss_, value);
}

LearnerStatus ValueOptimizer::status(double exploration) const {
  return {loss_, static_cast<float>(exploration), static_cast<float>(learning_rate_)};
}

template <typename Self, typename Visit>
void ValueOptimizer::VisitNumbers(Self& self, const Visit& visit) {
  visit("due", self.due_);
  visit("steps", self.steps_);
  visit("updates", self.updates_);
  visit("learning_rate", self.learning_rate_);
  visit("loss", self.loss_);
}

void ValueOptimizer::Save(Checkpoint& checkpoint) const {
  online_.Save(checkpoint);
  checkpoint.SetArray("target_weights", target_.ToVector());
  if (average_) checkpoint.SetArray(kAverage, average_->ToVector());
  SaveNumbers(checkpoint, "optimizer", [this](const auto& visit) { VisitNumbers(*this, visit); });
}

void ValueOptimizer::Load(const Checkpoint& checkpoint) {
  std::vector<float> target;
  std::vector<float> average;
  checkpoint.GetArray("target_weights", static_cast<std::size_t>(target_.size()), target);
  if (average_) {
    checkpoint.GetArray(kAverage, static_cast<std::size_t>(target_.size()), average);
  }
  LoadNumbers<double>(checkpoint, "optimizer", "optimizer.numbers",
                      [this](const auto& visit) { VisitNumbers(*this, visit); });
  online_.Load(checkpoint);
  target_.FromVector(target);
  if (average_) average_->FromVector(average);
}

}  // namespace aquafarm::agents
