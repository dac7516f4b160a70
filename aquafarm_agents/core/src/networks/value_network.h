// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Interface through which DQN and LSTM-DQN use a network. It computes the values of observations,
/// and the gradient of a loss that depends on these values. The implementation for features on the
/// CPU reuses its buffers and computes without libtorch (fused_values.h,
/// docs/decisions/fused_updates.md). The implementation for planes or CUDA uses the modules of
/// networks.h and the differentiation of libtorch.

#include <cstddef>
#include <memory>
#include <vector>

#include "networks/networks.h"

namespace aquafarm::agents {

/// A feed-forward network. @tparam Scalar type of an observation's values; see ObservationTraits
template <typename Scalar>
class ValueNetwork {
 public:
  virtual ~ValueNetwork() = default;
  /// @param observations [rows, …]; must stay valid until Backward
  /// @returns Q [rows, kActionCount], valid until the next call
  virtual const float* Forward(std::size_t rows, const Scalar* observations) = 0;
  /// Replaces the gradient of the parameters.
  /// @param rows the loss depends on the first `rows` rows of the last Forward
  /// @param slopes [rows, kActionCount] d loss / d Q of these rows
  virtual void Backward(std::size_t rows, const float* slopes) = 0;
};

/// A recurrent network.
class RecurrentValueNetwork {
 public:
  virtual ~RecurrentValueNetwork() = default;
  /// @param features [steps, rows, F]; must stay valid until Backward
  /// @param state [rows, 2, hidden] h and c before the first step; receives h and c after the last
  /// @returns Q [steps, rows, kActionCount], valid until the next call
  virtual const float* Forward(std::size_t steps, std::size_t rows, const float* features,
                               float* state) = 0;
  /// Does the same as Forward, but computes only the state.
  virtual void WarmUp(std::size_t steps, std::size_t rows, const float* features, float* state) = 0;
  /// Replaces the gradient of the parameters.
  /// @param count the loss depends on the first `count` (step, row) pairs of the last Forward.
  ///   `count` must be a multiple of `rows`, unless Forward had a single step
  /// @param slopes [count, kActionCount] d loss / d Q
  virtual void Backward(std::size_t count, const float* slopes) = 0;
};

/// Whether Backward may be called. If not, libtorch keeps no intermediate results.
enum class Learns : bool { kNo, kYes };

/// Makes the value network of `module`, which MakeNetwork made for the same spec and options.
/// @param parameters parameters of the module; must outlive the result
template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeValueNetwork(const EnvironmentSpec& spec,
                                                       const DeepOptions& options,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns);

/// Does the same as MakeValueNetwork, for LSTM-DQN.
std::unique_ptr<RecurrentValueNetwork> MakeRecurrentValueNetwork(
    const EnvironmentSpec& spec, const DeepOptions& options,
    std::shared_ptr<RecurrentNetwork> module, FlatParameters& parameters, Learns learns);

/// Does the same as MakeValueNetwork, but uses the modules of libtorch on every device.
template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeModuleValues(const EnvironmentSpec& spec,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns);
std::unique_ptr<RecurrentValueNetwork> MakeModuleValues(const EnvironmentSpec& spec,
                                                        std::shared_ptr<RecurrentNetwork> module,
                                                        FlatParameters& parameters, Learns learns);

}  // namespace aquafarm::agents
