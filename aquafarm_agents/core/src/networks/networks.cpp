// SPDX-License-Identifier: BSD-3-Clause
#include "networks/networks.h"

#include <cmath>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"
#include "networks/adam_step.h"
#include "networks/fused.h"

namespace aquafarm::agents {
namespace {

namespace nn = torch::nn;

class MlpNetwork final : public QNetwork {
 public:
  MlpNetwork(std::int64_t features, std::int64_t hidden, bool dueling)
      : first_(register_module("first", nn::Linear(features, hidden))),
        second_(register_module("second", nn::Linear(hidden, hidden))),
        head_(register_module("head", Head(hidden, dueling))) {}
  torch::Tensor Forward(const torch::Tensor& input) override {
    if (!CanFuse(input, first_->weight)) return head_(second_(first_(input).relu_()).relu_());
    const nn::Linear& advantage = head_->advantage();
    const nn::Linear& value = head_->value();
    return FusedMlp(input, first_->weight, first_->bias, second_->weight, second_->bias,
                    advantage->weight, advantage->bias, value ? value->weight : torch::Tensor(),
                    value ? value->bias : torch::Tensor());
  }

 private:
  nn::Linear first_;
  nn::Linear second_;
  Head head_;
};

// Two 3 × 3 convolutions, the second with stride 2, and a hidden layer.
class CnnNetwork final : public QNetwork {
 public:
  CnnNetwork(std::int64_t planes, std::int64_t height, std::int64_t width, std::int64_t hidden,
             bool dueling)
      : first_(register_module("first",
                               nn::Conv2d(nn::Conv2dOptions(planes, kChannels, 3).padding(1)))),
        second_(register_module(
            "second", nn::Conv2d(nn::Conv2dOptions(kChannels, kChannels, 3).stride(2).padding(1)))),
        hidden_(register_module(
            "hidden", nn::Linear(kChannels * ((height + 1) / 2) * ((width + 1) / 2), hidden))),
        head_(register_module("head", Head(hidden, dueling))) {}
  torch::Tensor Forward(const torch::Tensor& input) override {
    const torch::Tensor seen = second_(first_(input).relu_()).relu_();
    return head_(hidden_(seen.flatten(1)).relu_());
  }

 private:
  static constexpr std::int64_t kChannels = 16;
  nn::Conv2d first_;
  nn::Conv2d second_;
  nn::Linear hidden_;
  Head head_;
};

}  // namespace

torch::Device FindDevice(const std::string& name) {
  if (name == "cpu") return torch::kCPU;
  const bool has_cuda = torch::cuda::is_available();
  if (name == "cuda" && !has_cuda) {
    throw InputError("device: got cuda, which this machine or this libtorch lacks; expected cpu");
  }
  return has_cuda ? torch::kCUDA : torch::kCPU;
}

HeadImpl::HeadImpl(std::int64_t inputs, bool dueling)
    : advantage_(register_module("advantage", nn::Linear(inputs, kActionCount))) {
  if (dueling) value_ = register_module("value", nn::Linear(inputs, 1));
}

torch::Tensor HeadImpl::forward(const torch::Tensor& input) {
  const torch::Tensor advantage = advantage_(input);
  if (!value_) return advantage;
  return value_(input) + advantage - advantage.mean(-1, /*keepdim=*/true);
}

std::shared_ptr<QNetwork> MakeNetwork(const EnvironmentSpec& spec, const DeepOptions& options,
                                      std::uint64_t seed) {
  std::shared_ptr<QNetwork> network;
  if (options.network == NetworkKind::kCnn) {
    network = std::make_shared<CnnNetwork>(spec.plane_count, spec.height, spec.width,
                                           options.hidden_size, options.dueling);
  } else {
    network =
        std::make_shared<MlpNetwork>(spec.feature_count, options.hidden_size, options.dueling);
  }
  DrawWeights(*network, seed, 0);
  return network;
}

RecurrentNetwork::RecurrentNetwork(std::int64_t features, std::int64_t hidden, bool dueling,
                                   bool skip_connection)
    : skip_connection_(skip_connection),
      input_(register_module("input", nn::Linear(features, hidden))),
      lstm_(register_module("lstm", nn::LSTM(hidden, hidden))),
      lstm_weights_(lstm_->parameters()) {
  const std::int64_t width = skip_connection ? 2 * hidden : hidden;
  second_ = register_module("second", nn::Linear(width, width));
  head_ = register_module("head", Head(width, dueling));
}

// Advances the state over all steps of `seen` [T, B, hidden]. Returns h after each step.
torch::Tensor RecurrentNetwork::Step(const torch::Tensor& seen, State& state) {
  if (!CanFuse(seen, lstm_weights_[0])) {
    auto [output, after] = lstm_(seen, std::make_tuple(state.first, state.second));
    std::tie(state.first, state.second) = after;
    return output;
  }
  torch::Tensor output;
  std::tie(output, state.first, state.second) =
      FusedLstm(seen, state.first, state.second, lstm_weights_[0], lstm_weights_[1],
                lstm_weights_[2], lstm_weights_[3]);
  return output;
}

torch::Tensor RecurrentNetwork::Forward(const torch::Tensor& input, State& state) {
  const torch::Tensor seen = input_(input).relu_();
  const torch::Tensor output = Step(seen, state);
  const torch::Tensor joined = skip_connection_ ? torch::cat({output, seen}, -1) : output;
  return head_(second_(joined).relu_());
}

void RecurrentNetwork::WarmUp(const torch::Tensor& input, State& state) {
  Step(input_(input).relu_(), state);
}

FlatParameters::FlatParameters(nn::Module& module, torch::Device device) {
  const torch::NoGradGuard no_grad;
  std::vector<torch::Tensor> flat;
  for (const torch::Tensor& one : module.parameters()) flat.push_back(one.detach().flatten());
  values_ = torch::cat(flat).to(device);
  values_.set_requires_grad(true);
  values_.mutable_grad() = torch::zeros_like(values_);
  std::int64_t begin = 0;
  for (torch::Tensor& one : module.parameters()) {
    const std::int64_t size = one.numel();
    one.set_data(values_.detach().narrow(0, begin, size).view(one.sizes()));
    one.mutable_grad() = values_.grad().narrow(0, begin, size).view(one.sizes());
    begin += size;
  }
}

std::vector<float> FlatParameters::ToVector() const {
  const torch::Tensor values = values_.detach().cpu();
  return {values.data_ptr<float>(), values.data_ptr<float>() + values.numel()};
}

void FlatParameters::FromVector(const std::vector<float>& values) {
  if (static_cast<std::int64_t>(values.size()) != size()) {
    throw InputError("weights: got " + std::to_string(values.size()) + " numbers, expected " +
                     std::to_string(size()) + ": they belong to another network");
  }
  const torch::NoGradGuard no_grad;
  values_.copy_(torch::from_blob(const_cast<float*>(values.data()), {size()}));
}

void FlatParameters::MoveTowards(const FlatParameters& other, double rate) {
  if (CanFuse(values_, other.values_)) {
    const auto count = static_cast<std::size_t>(size());
    AdvanceTowards(count, other.values_.data_ptr<float>(), static_cast<float>(rate),
                   values_.data_ptr<float>());
    return;
  }
  const torch::NoGradGuard no_grad;
  values_.lerp_(other.values_, rate);
}

void DrawWeights(nn::Module& module, std::uint64_t seed, std::uint32_t stream) {
  const torch::NoGradGuard no_grad;
  RandomStream rng({seed, 0, RngStream::kLearner, stream});
  std::int64_t fan_in = 1;
  for (auto& item : module.named_parameters()) {
    torch::Tensor& weights = item.value();
    // A bias has the fan-in of the weights before it. The biases of an LSTM follow its recurrent
    // weights, so the fan-in of these biases is the hidden size.
    if (weights.dim() > 1) fan_in = weights.numel() / weights.size(0);
    const float limit = 1.0F / std::sqrt(static_cast<float>(fan_in));
    float* const values = weights.data_ptr<float>();
    for (std::int64_t i = 0; i < weights.numel(); ++i) values[i] = rng.Uniform(-limit, limit);
  }
}

}  // namespace aquafarm::agents
