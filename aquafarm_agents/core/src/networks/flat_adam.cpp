// SPDX-License-Identifier: BSD-3-Clause
#include "networks/flat_adam.h"

#include <cmath>
#include <utility>
#include <vector>

#include "networks/adam_step.h"

namespace aquafarm::agents {
namespace {

constexpr float kEpsilon = 1e-8F;  // as in libtorch

}  // namespace

FlatAdam::FlatAdam(torch::nn::Module& module, torch::Device device)
    : parameters_(module, device),
      adam_({parameters_.values()}, torch::optim::AdamOptions(1e-3)),
      state_(MakeState()) {}

bool FlatAdam::Step(const torch::Tensor& loss, double learning_rate, double max_grad_norm) {
  parameters_.values().mutable_grad().zero_();
  loss.backward();
  return Step(learning_rate, max_grad_norm);
}

bool FlatAdam::Step(double learning_rate, double max_grad_norm) {
  torch::Tensor& gradient = parameters_.values().mutable_grad();
  const auto size = static_cast<std::size_t>(parameters_.size());
  const bool is_plain = gradient.is_cpu() && gradient.scalar_type() == torch::kFloat;
  const double norm =
      is_plain ? GradientNorm(gradient.data_ptr<float>(), size) : gradient.norm().item<double>();
  if (!std::isfinite(norm)) return false;
  if (is_plain) {
    state_.step(state_.step() + 1);
    const double scale = max_grad_norm > 0.0 && norm > max_grad_norm ? max_grad_norm / norm : 1.0;
    AdamStep(size, gradient.data_ptr<float>(), scale, learning_rate,
             static_cast<std::uint64_t>(state_.step()), kEpsilon,
             state_.exp_avg().data_ptr<float>(), state_.exp_avg_sq().data_ptr<float>(),
             parameters_.values().data_ptr<float>());
    return true;
  }
  if (max_grad_norm > 0.0 && norm > max_grad_norm) gradient.mul_(max_grad_norm / norm);
  static_cast<torch::optim::AdamOptions&>(adam_.param_groups()[0].options()).lr(learning_rate);
  adam_.step();
  return true;
}

// libtorch creates the state of Adam at its first step. This function creates it earlier, so that
// it can be saved and loaded at any time.
torch::optim::AdamParamState& FlatAdam::MakeState() {
  auto& states = adam_.state();
#if TORCH_VERSION_MAJOR >= 2
  void* const key = parameters_.values().unsafeGetTensorImpl();
#else
  const std::string key = c10::guts::to_string(parameters_.values().unsafeGetTensorImpl());
#endif
  auto& state = states[key];
  if (!state) {
    auto fresh = std::make_unique<torch::optim::AdamParamState>();
    fresh->step(0);
    fresh->exp_avg(torch::zeros_like(parameters_.values(), torch::requires_grad(false)));
    fresh->exp_avg_sq(torch::zeros_like(parameters_.values(), torch::requires_grad(false)));
    state = std::move(fresh);
  }
  return static_cast<torch::optim::AdamParamState&>(*state);
}

void FlatAdam::Save(Checkpoint& checkpoint, const std::string& prefix) const {
  const auto to_vector = [](const torch::Tensor& tensor) {
    const torch::Tensor values = tensor.detach().cpu();
    return std::vector<float>(values.data_ptr<float>(), values.data_ptr<float>() + values.numel());
  };
  checkpoint.SetArray(prefix + "weights", parameters_.ToVector());
  checkpoint.SetArray(prefix + "adam.mean", to_vector(state_.exp_avg()));
  checkpoint.SetArray(prefix + "adam.square", to_vector(state_.exp_avg_sq()));
  checkpoint.SetArray(prefix + "adam", std::vector<std::int64_t>{state_.step()});
}

void FlatAdam::Load(const Checkpoint& checkpoint, const std::string& prefix) {
  const auto size = static_cast<std::size_t>(parameters_.size());
  std::vector<float> weights;
  std::vector<float> mean;
  std::vector<float> square;
  std::vector<std::int64_t> step;
  checkpoint.GetArray(prefix + "weights", size, weights);
  checkpoint.GetArray(prefix + "adam.mean", size, mean);
  checkpoint.GetArray(prefix + "adam.square", size, square);
  checkpoint.GetArray(prefix + "adam", 1, step);
  parameters_.FromVector(weights);
  const auto shape = static_cast<std::int64_t>(size);
  state_.exp_avg().copy_(torch::from_blob(mean.data(), {shape}));
  state_.exp_avg_sq().copy_(torch::from_blob(square.data(), {shape}));
  state_.step(step[0]);
}

}  // namespace aquafarm::agents
