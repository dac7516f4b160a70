// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What DQN and LSTM-DQN compute with a network: the values of rows of observations, and the
/// gradient of a loss of them. On the CPU, networks of features write out their layers and
/// gradients on buffers that are allocated once (docs/decisions/fused_updates.md). Planes and CUDA
/// use the modules of networks.h and their differentiation.

#include <cstddef>
#include <memory>
#include <vector>

#include "networks/networks.h"

namespace aquafarm::agents {

/// @tparam Scalar of an observation; see ObservationTraits
template <typename Scalar>
class ValueNetwork {
 public:
  virtual ~ValueNetwork() = default;
  /// @param observations [rows, …], valid until Backward
  /// @returns Q [rows, kActionCount], valid until the next call
  virtual const float* Forward(std::size_t rows, const Scalar* observations) = 0;
  /// Replaces the gradient of the parameters.
  /// @param slopes [rows, kActionCount] d loss / d Q of the first rows of the last Forward; the
  /// loss
  ///        does not read the others
  virtual void Backward(std::size_t rows, const float* slopes) = 0;
};

class RecurrentValueNetwork {
 public:
  virtual ~RecurrentValueNetwork() = default;
  /// @param features [steps, rows, F], valid until Backward
  /// @param state [rows, 2, hidden] h and c before the first step; receives those after the last
  /// @returns Q [steps, rows, kActionCount], valid until the next call
  virtual const float* Forward(std::size_t steps, std::size_t rows, const float* features,
                               float* state) = 0;
  /// Advances only the state.
  virtual void WarmUp(std::size_t steps, std::size_t rows, const float* features, float* state) = 0;
  /// Replaces the gradient of the parameters.
  /// @param count number of the first values of the last Forward that the loss reads: whole steps,
  ///        or rows of the only step
  /// @param slopes [count, kActionCount] d loss / d Q
  virtual void Backward(std::size_t count, const float* slopes) = 0;
};

/// Whether the loss of a network is differentiated; the values of the others are only read.
enum class Learns : bool { kNo, kYes };

/// Values of `module`, which must be that of MakeNetwork for the options.
/// @param parameters of the module; must outlive the result
template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeValueNetwork(const EnvironmentSpec& spec,
                                                       const DeepOptions& options,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns);

std::unique_ptr<RecurrentValueNetwork> MakeRecurrentValueNetwork(
    const EnvironmentSpec& spec, const DeepOptions& options,
    std::shared_ptr<RecurrentNetwork> module, FlatParameters& parameters, Learns learns);

/// The same by the modules, on every device.
template <typename Scalar>
std::unique_ptr<ValueNetwork<Scalar>> MakeModuleValues(const EnvironmentSpec& spec,
                                                       std::shared_ptr<QNetwork> module,
                                                       FlatParameters& parameters, Learns learns);
std::unique_ptr<RecurrentValueNetwork> MakeModuleValues(const EnvironmentSpec& spec,
                                                        std::shared_ptr<RecurrentNetwork> module,
                                                        FlatParameters& parameters, Learns learns);

}  // namespace aquafarm::agents
