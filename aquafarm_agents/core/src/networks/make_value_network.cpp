// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "networks/deep_policy.h"
#include "networks/fused_values.h"
#include "networks/value_network.h"

namespace aquafarm::agents {
namespace {

/// Keeps the values of a module's last evaluation, copied to the CPU, and differentiates them.
class ModuleOutput {
 public:
  ModuleOutput(FlatParameters& parameters, Learns learns)
      : parameters_(parameters), learns_(learns) {}

  torch::Device device() const { return parameters_.values().device(); }
  template <typename Evaluate>
  const float* Keep(const Evaluate& evaluate) {
    std::optional<torch::NoGradGuard> no_grad;
    if (learns_ == Learns::kNo) no_grad.emplace();
    output_ = evaluate();
    values_ = output_.detach().cpu().contiguous();
    return values_.data_ptr<float>();
  }
  void Backward(std::size_t rows, const float* slopes) {
    torch::Tensor all = torch::zeros_like(values_);
    std::copy_n(slopes, rows * kActionCount, all.data_ptr<float>());
    parameters_.values().mutable_grad().zero_();
    output_.backward(all.to(device()));
  }

 private:
  FlatParameters& parameters_;
  const Learns learns_;
  torch::Tensor output_;
  torch::Tensor values_;
};

template <typename Scalar>
class ModuleValues final : public ValueNetwork<Scalar> {
 public:
  ModuleValues(std::vector<std::int64_t> shape, std::shared_ptr<QNetwork> module,
               FlatParameters& parameters, Learns learns)
      : shape_(std::move(shape)), module_(std::move(module)), output_(parameters, learns) {}

  const float* Forward(std::size_t rows, const Scalar* observations) override {
    return output_.Keep([&] {
      return module_->Forward(ObservationTraits<Scalar>::ToInput(
          observations, WithCount(rows, shape_), output_.device()));
    });
  }
  void Backward(std::size_t rows, const float* slopes) override { output_.Backward(rows, slopes); }

 private:
  const std::vector<std::int64_t> shape_;
  const std::shared_ptr<QNetwork> module_;
  ModuleOutput output_;
};

class RecurrentModuleValues final : public RecurrentValueNetwork {
 public:
  RecurrentModuleValues(std::int64_t features, std::shared_ptr<RecurrentNetwork> module,
                        FlatParameters& parameters, Learns learns)
      : features_(features), module_(std::move(module)), output_(parameters, learns) {}

  const float* Forward(std::size_t steps, std::size_t rows, const float* features,
                       float* state) override {
    return output_.Keep([&] {
      RecurrentNetwork::State both = ToState(rows, state);
      const torch::Tensor values = module_->Forward(ToInput(steps, rows, features), both);
      Store(both, state);
      return values;
    });
  }
  void WarmUp(std::size_t steps, std::size_t rows, const float* features, float* state) override {
    const torch::NoGradGuard no_grad;
    RecurrentNetwork::State both = ToState(rows, state);
    module_->WarmUp(ToInput(steps, rows, features), both);
    Store(both, state);
  }
  void Backward(std::size_t count, const float* slopes) override {
    output_.Backward(count, slopes);
  }

 private:
  torch::Tensor ToInput(std::size_t steps, std::size_t rows, const float* features) const {
    return ObservationTraits<float>::ToInput(
        features, {static_cast<std::int64_t>(steps), static_cast<std::int64_t>(rows), features_},
        output_.device());
  }
  // Copies the state, because Store overwrites it before Backward needs it.
  RecurrentNetwork::State ToState(std::size_t rows, float* state) const {
    const torch::Tensor both =
        torch::from_blob(state, {static_cast<std::int64_t>(rows), 2, module_->hidden()})
            .transpose(0, 1)
            .clone(torch::MemoryFormat::Contiguous)
            .to(output_.device());
    return {both.narrow(0, 0, 1), both.narrow(0, 1, 1)};
  }
  static void Store(const RecurrentNetwork::State& from, float* state) {
    const torch::Tensor both =
        torch::stack({from.first.detach().squeeze(0), from.second.detach().squeeze(0)}, 1).cpu();
    std::copy_n(both.data_ptr<float>(), both.numel(), state);
  }

  const std::int64_t features_;
  const std::shared_ptr<RecurrentNetwork> module_;
  ModuleOutput output_;
};

// Returns whether the parameters are floats in the memory of the CPU.
bool IsPlain(const FlatParameters& parameters) {
  return parameters.values().is_cpu() && parameters.values().scalar_type() == torch::kFloat;
}

ParameterMemory MemoryOf(FlatParameters& parameters) {
  return {parameters.values().data_ptr<float>(),
          parameters.values().mutable_grad().data_ptr<float>()};
}

}  // namespace

template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeModuleValues(const EnvironmentSpec& spec,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns) {
  return std::make_unique<ModuleValues<Scalar>>(ObservationTraits<Scalar>::Shape(spec),
                                                std::move(module), parameters, learns);
}

std::unique_ptr<RecurrentValueNetwork> MakeModuleValues(const EnvironmentSpec& spec,
                                                        std::shared_ptr<RecurrentNetwork> module,
                                                        FlatParameters& parameters, Learns learns) {
  return std::make_unique<RecurrentModuleValues>(spec.feature_count, std::move(module), parameters,
                                                 learns);
}

template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeValueNetwork(const EnvironmentSpec& spec,
                                                       const DeepOptions& options,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns) {
  if constexpr (std::is_same_v<Scalar, float>) {
    if (IsPlain(parameters)) {
      return std::make_unique<FusedMlpValues>(static_cast<std::size_t>(spec.feature_count),
                                              static_cast<std::size_t>(options.hidden_size),
                                              options.dueling, MemoryOf(parameters));
    }
  }
  return MakeModuleValues<Scalar>(spec, std::move(module), parameters, learns);
}

std::unique_ptr<RecurrentValueNetwork> MakeRecurrentValueNetwork(
    const EnvironmentSpec& spec, const DeepOptions& options,
    std::shared_ptr<RecurrentNetwork> module, FlatParameters& parameters, Learns learns) {
  if (IsPlain(parameters)) {
    return std::make_unique<FusedLstmValues>(
        static_cast<std::size_t>(spec.feature_count), static_cast<std::size_t>(options.hidden_size),
        options.skip_connection, options.dueling, MemoryOf(parameters));
  }
  return MakeModuleValues(spec, std::move(module), parameters, learns);
}

template std::unique_ptr<ValueNetwork<float>> MakeModuleValues(const EnvironmentSpec&,
                                                               std::shared_ptr<QNetwork>,
                                                               FlatParameters&, Learns);
template std::unique_ptr<ValueNetwork<float>> MakeValueNetwork(const EnvironmentSpec&,
                                                               const DeepOptions&,
                                                               std::shared_ptr<QNetwork>,
                                                               FlatParameters&, Learns);
template std::unique_ptr<ValueNetwork<std::uint8_t>> MakeValueNetwork(const EnvironmentSpec&,
                                                                      const DeepOptions&,
                                                                      std::shared_ptr<QNetwork>,
                                                                      FlatParameters&, Learns);

}  // namespace aquafarm::agents
