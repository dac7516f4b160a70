// SPDX-License-Identifier: BSD-3-Clause
#include "curiosity/curiosity_module.h"

#include <cmath>
#include <string>

#include "aquafarm/agents/learning/learner.h"
#include "aquafarm/grid/action.h"

namespace aquafarm::agents {
namespace {

namespace nn = torch::nn;

constexpr std::int64_t kHiddenSize = 64;
constexpr std::int64_t kSize = 32;     // length of φ
constexpr double kForwardShare = 0.2;  // β of Pathak et al. 2017
constexpr double kLearningRate = 1e-3;
constexpr double kGradientLimit = 10.0;
constexpr std::size_t kBatch = 64;  // min number of transitions per update

nn::Sequential TwoLayers(std::int64_t inputs, std::int64_t outputs) {
  return nn::Sequential(nn::Linear(inputs, kHiddenSize), nn::ReLU(),
                        nn::Linear(kHiddenSize, outputs));
}

template <typename T>
torch::Tensor View(std::vector<T>& values, std::vector<std::int64_t> shape) {
  return torch::from_blob(values.data(), shape, torch::CppTypeToScalarType<T>::value);
}

}  // namespace

CuriosityNetwork::CuriosityNetwork(std::int64_t features)
    : phi_(register_module("phi", TwoLayers(features, kSize))),
      inverse_(register_module("inverse", TwoLayers(2 * kSize, kActionCount))),
      forward_(register_module("forward", TwoLayers(kSize + kActionCount, kSize))) {}

CuriosityNetwork::Output CuriosityNetwork::Forward(const torch::Tensor& from,
                                                   const torch::Tensor& to,
                                                   const torch::Tensor& actions) {
  const torch::Tensor a = phi_->forward(from);
  const torch::Tensor b = phi_->forward(to);
  const torch::Tensor chosen = inverse_->forward(torch::cat({a, b}, 1));
  const torch::Tensor taken = torch::one_hot(actions, kActionCount).to(a.dtype());
  const torch::Tensor foreseen = forward_->forward(torch::cat({a.detach(), taken}, 1));
  return {(foreseen - b.detach()).square().sum(1) * 0.5,
          torch::nn::functional::cross_entropy(chosen, actions)};
}

CuriosityModule::CuriosityModule(std::int64_t features, std::uint64_t seed)
    : features_(features),
      seed_(seed),
      network_([&] {
        auto network = std::make_shared<CuriosityNetwork>(features);
        DrawWeights(*network, seed, 2);
        return network;
      }()),
      adam_(*network_, torch::kCPU) {}

void CuriosityModule::Step(std::vector<float>& from, std::vector<float>& to,
                           std::vector<std::int64_t>& actions, std::uint64_t farm_steps,
                           std::vector<float>& errors) {
  const auto count = static_cast<std::int64_t>(actions.size());
  {
    const torch::NoGradGuard no_grad;
    const auto output = network_->Forward(View(from, {count, features_}),
                                          View(to, {count, features_}), View(actions, {count}));
    const float* const error = output.error.data_ptr<float>();
    errors.assign(error, error + count);
  }
  from_.insert(from_.end(), from.begin(), from.end());
  to_.insert(to_.end(), to.begin(), to.end());
  actions_.insert(actions_.end(), actions.begin(), actions.end());
  if (actions_.size() >= kBatch) Learn(farm_steps);
}

void CuriosityModule::Learn(std::uint64_t farm_steps) {
  const auto count = static_cast<std::int64_t>(actions_.size());
  const auto output = network_->Forward(View(from_, {count, features_}),
                                        View(to_, {count, features_}), View(actions_, {count}));
  const torch::Tensor loss =
      output.inverse * (1.0 - kForwardShare) + output.error.mean() * kForwardShare;
  if (!std::isfinite(loss.item<float>()) || !adam_.Step(loss, kLearningRate, kGradientLimit)) {
    throw LearnerFailed("curiosity: its loss or gradient is not finite after " +
                        std::to_string(farm_steps) + " farm steps, on the last " +
                        std::to_string(count) + " transitions of seed " + std::to_string(seed_) +
                        "; expected a number: train without icm");
  }
  from_.clear();
  to_.clear();
  actions_.clear();
}

void CuriosityModule::Save(Checkpoint& checkpoint) const {
  adam_.Save(checkpoint, "curiosity.");
  checkpoint.SetArray("curiosity.from", from_);
  checkpoint.SetArray("curiosity.to", to_);
  checkpoint.SetArray("curiosity.actions", actions_);
}

void CuriosityModule::Load(const Checkpoint& checkpoint) {
  std::vector<float> from;
  std::vector<float> to;
  std::vector<std::int64_t> actions;
  const std::size_t count = checkpoint.Section("curiosity.actions").size() / sizeof(std::int64_t);
  checkpoint.GetArray("curiosity.actions", count, actions);
  checkpoint.GetArray("curiosity.from", count * static_cast<std::size_t>(features_), from);
  checkpoint.GetArray("curiosity.to", count * static_cast<std::size_t>(features_), to);
  adam_.Load(checkpoint, "curiosity.");
  from_ = std::move(from);
  to_ = std::move(to);
  actions_ = std::move(actions);
}

}  // namespace aquafarm::agents
