// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "aquafarm/agents/networks/deep_options.h"

namespace aquafarm::agents {

/// The feature network of networks.h for one observation, without libtorch. A libtorch call costs
/// several times the arithmetic of one row, and more when many nodes share the processor's caches.
/// With finite weights the results differ only by rounding.
class RowNetwork {
 public:
  /// Takes ownership of the weights. Each copy of a policy has its own.
  /// @param features of an observation
  /// @param weights in the order of FlatParameters for MakeNetwork with network=mlp
  /// @throws LogicError if their number differs from that of the network
  RowNetwork(std::size_t features, const DeepOptions& options, std::vector<float> weights);
  /// Action values of one observation.
  /// @param features [features]
  /// @returns Q [kActionCount], valid until the next call
  const float* Forward(const float* features);

 private:
  const std::vector<float> weights_;
  const Eigen::Index features_;
  const bool dueling_;
  Eigen::VectorXf first_;
  Eigen::VectorXf second_;
  Eigen::VectorXf values_;
  Eigen::VectorXf state_value_;
};

}  // namespace aquafarm::agents
